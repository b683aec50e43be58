"""Faults of a running board: traps, use by other threads, signals."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import pytest
from conftest import COUNT, WAIT, Write

import cc67

WILD = """#include "KMotionDef.h"
int *p = (int *)0x10;
main()
{
    printf("before\\n");
    Delay_sec(0.5);
    *p = 5;
}
"""

BUSY = '#include "KMotionDef.h"\nvolatile int n;\nmain() { for (;;) n = n * 3 + 1; }\n'


@pytest.mark.parametrize("engine", ["native", "bytecode"])
def test_a_trap_is_an_exception_with_the_place(write: Write, engine: str) -> None:
    board = cc67.Board(programs=[write(WILD, "wild.c")], engine=engine)
    with pytest.raises(cc67.TrapError, match="wild.c:7") as caught:
        board.run_for(10.0)
    trap = caught.value
    assert trap.thread == 1 and trap.line == 7 and trap.function == "main"
    assert trap.file is not None and trap.file.endswith("wild.c")
    assert trap.time == pytest.approx(0.5, abs=0.01) and board.time == pytest.approx(trap.time, abs=0.001)
    board.run_for(1.0)
    assert board.console == ["before"] and len(board.faults) == 1
    copy = pickle.loads(pickle.dumps(trap))
    assert str(copy) == str(trap) and copy.line == 7


def test_traps_may_be_kept(write: Write) -> None:
    board = cc67.Board(programs=[write(WILD, "wild.c")], on_fault="keep")
    board.run_for(2.0)
    assert board.time == pytest.approx(2.0, abs=1e-4) and isinstance(board.faults[0], cc67.TrapError)


def test_run_until_ends_at_a_trap(write: Write) -> None:
    board = cc67.Board(programs=[write(WILD, "wild.c")])
    with pytest.raises(cc67.TrapError):
        board.run_until("0", timeout=3.0)


def test_what_a_stimulus_expects_is_an_assertion(write: Write) -> None:
    board = cc67.Board(programs=[write(COUNT)], stim="at 0.5s expect persist 5 = 3; at end expect printed \"x\"")
    with pytest.raises(AssertionError, match="is 0, expected 3"):
        board.run_for(1.0)
    with pytest.raises(cc67.ExpectationError, match="x"):
        board.finish()


@pytest.mark.parametrize("engine", ["native", "bytecode"])
def test_a_board_is_for_one_thread(write: Write, engine: str) -> None:
    board = cc67.Board(programs=[write(WAIT)], engine=engine)
    board.run_for(0.1)
    caught: list[BaseException] = []

    def other() -> None:
        try:
            board.run_for(0.1)
        except BaseException as error:
            caught.append(error)

    thread = threading.Thread(target=other)
    thread.start()
    thread.join()
    assert isinstance(caught[0], cc67.ThreadError) and "that thread can give it up" in str(caught[0])
    board.run_for(0.1)
    assert board.time == pytest.approx(0.2, abs=1e-3)


# Long enough for this thread to use the board meanwhile, even if other tests keep the processor busy.
@pytest.mark.parametrize(("engine", "seconds"), [("native", 20.0), ("bytecode", 1.0)])
def test_a_board_that_runs_elsewhere_says_so_and_goes_on(write: Write, engine: str, seconds: float) -> None:
    board = cc67.Board(programs=[write(BUSY)], engine=engine)
    began, caught = threading.Event(), []

    def run() -> None:
        began.set()
        board.run_for(seconds)

    thread = threading.Thread(target=run)
    thread.start()
    began.wait()
    # The interpreter's lock is free while the board runs, so this loop continues meanwhile.
    turns = 0
    while thread.is_alive():
        turns += 1
        try:
            board.time
        except cc67.ThreadError as error:
            caught.append(error)
        time.sleep(0.001)
    thread.join()
    assert caught and turns > 1


def test_a_board_is_handed_to_another_thread(write: Write) -> None:
    board = cc67.Board(programs=[write(WAIT)])
    board.run_for(0.1)
    board.release()
    thread = threading.Thread(target=board.run_for, args=(0.1,))
    thread.start()
    thread.join()
    with pytest.raises(cc67.ThreadError):
        board.time


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGINT to send")
@pytest.mark.parametrize("engine", ["native", "bytecode"])
@pytest.mark.parametrize("call", ["run_for(1e6)", "run(1e6)", "run_until('0', 1e6)", "trace('bit0', 2000.0)"])
def test_ctrl_c_stops_a_long_run(write: Write, engine: str, call: str) -> None:
    path = write(BUSY)
    script = f"""
import cc67, signal
# Tests that were started in the background may inherit a signal that is ignored.
signal.signal(signal.SIGINT, signal.default_int_handler)
board = cc67.Board(programs=[{str(path)!r}], engine={engine!r})
print("ready", flush=True)
try:
    board.{call}
except KeyboardInterrupt:
    print(f"stopped {{board.time > 0}}")
"""
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None and process.stdout.readline() == "ready\n"
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=20)
    assert out == "stopped True\n"


def test_a_board_ends_in_whatever_thread_its_last_user_is(write: Write) -> None:
    for engine in ("native", "bytecode"):
        boards = [cc67.Board(programs=[write(WAIT)], engine=engine)]
        boards[0].run_for(0.01)
        snapshots = [boards[0].snapshot()]

        def drop() -> None:
            boards.clear()
            snapshots.clear()

        thread = threading.Thread(target=drop)
        thread.start()
        thread.join()
