"""Connected controllers: a simulated board at the other end of a link."""

from __future__ import annotations

import math
import subprocess
import sys
import time
from typing import Iterator

import pytest
from conftest import Write

import cc67

PROGRAM = """#include "KMotionDef.h"
main()
{
    ch0->InputMode = NO_INPUT_MODE;
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->OutputChan0 = 8;
    ch0->Vel = 5000; ch0->Accel = 100000; ch0->Jerk = 1e6;
    EnableAxisDest(0, 0);
    MoveAtVel(0, 500, 4000);
    while (!CheckDone(0)) ;
    persist.UserData[5]++;
    printf("moved %d\\n", persist.UserData[5]);
}
"""

ENDLESS = '#include "KMotionDef.h"\nmain() { for (;;) { persist.UserData[6]++; Delay_sec(0.01); } }\n'


class Served:
    """A simulated board that is served on a port."""

    def __init__(self, *options: str) -> None:
        command = [sys.executable, "-m", "cc67", "serve", "--listen", "tcp-raw:0", *options]
        self.process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
        assert self.process.stderr is not None
        self.address = self.process.stderr.readline().split()[-1]

    def end(self) -> None:
        self.process.kill()
        self.process.wait()
        assert self.process.stderr is not None
        self.process.stderr.close()


@pytest.fixture
def served() -> Iterator[Served]:
    board = Served()
    yield board
    board.end()


def test_a_program_runs_on_a_controller(write: Write, served: Served) -> None:
    assert served.address.startswith("tcp:")
    with cc67.connect(served.address, [write(PROGRAM, "move.c")], set={"persist.5": 41}, yes=True) as board:
        assert board.run_until(cc67.printed("moved"), timeout=20.0)
        assert list(board.console) == ["moved 42"]
        assert board.persist[5] == 42
        assert board.axes[0].Dest == 500.0 and board.axes[0].Enable == 1
        assert board.read("persist.UserData[5] + 1") == 43.0
        assert board.command("GetPersistDec 5") == "42"
        board.persist[7] = -3
        assert board.command("GetPersistDec 7") == "-3"


def test_time_passes_by_itself_and_threads_are_started_and_stopped(write: Write, served: Served) -> None:
    with cc67.connect(served.address, load=[write(ENDLESS, "endless.c")], yes=True) as board:
        before = board.time
        time.sleep(0.2)
        assert board.time >= before + 0.2
        board.start(1)
        assert board.run_until("persist.UserData[6] > 5", timeout=20.0)
        assert board.active(1)
        board.stop(1)
        assert not board.active(1)
        board.load(write(PROGRAM, "move.c"), thread=1, start=True)
        assert board.run(timeout=20.0)


def test_what_a_controller_cannot_do_is_said(write: Write, served: Served) -> None:
    with pytest.raises(cc67.InputError, match="yes=True"):
        cc67.connect(served.address)
    simulated = cc67.compile(write(PROGRAM, "move.c"))
    with pytest.raises(cc67.LoadError, match="image for simulation"):
        cc67.connect(served.address, [simulated], yes=True)
    compiled = cc67.compile(write(PROGRAM, "move.c"), target="c67x")
    with cc67.connect(served.address, [compiled], yes=True) as board:
        with pytest.raises(cc67.Error, match="cannot"):
            board.snapshot()
        with pytest.raises(cc67.Error):
            board.bits[136] = True
        with pytest.raises(cc67.Error, match="no command of the controller reads"):
            print(board.axes[0].P)
        with pytest.raises(cc67.Error, match="cannot be read"):
            board.read("ch0->P")
        assert not math.isnan(board.read("dest0"))
    other = cc67.compile(write(PROGRAM, "move.c"), board="kflop-5.3.2", target="c67x")
    with pytest.raises(cc67.LoadError, match="another firmware"):
        cc67.connect(served.address, [other], yes=True)


def test_a_link_that_is_lost_is_an_exception(write: Write, served: Served) -> None:
    board = cc67.connect(served.address, [write(ENDLESS, "endless.c")], yes=True)
    board.run_for(0.1)
    served.end()
    with pytest.raises(cc67.LinkError):
        board.run_for(30.0)
    with pytest.raises(cc67.LinkError, match="refused"):
        cc67.connect(served.address, yes=True)


def test_a_controller_with_firmware_5_gets_programs_for_it(write: Write) -> None:
    served = Served("--board", "kflop-5.3.2")
    try:
        with cc67.connect(served.address, [write(PROGRAM, "move.c")], yes=True) as board:
            assert board.run(timeout=20.0)
            assert list(board.console) == ["moved 1"]
            assert board.read("persist.UserData[5]") == 1.0
    finally:
        served.end()


def test_the_monitor_reads_variables_of_programs(write: Write, served: Served) -> None:
    program = write(
        '#include "KMotionDef.h"\nint count = 5; double level = 2.5;\nmain() { count++; level *= 2; }\n', "names.c"
    )
    with cc67.connect(served.address, [program], monitor=True, verify=True, yes=True) as board:
        assert board.run(timeout=10.0)
        assert board.read("count") == 6.0
        assert board.read("level") == 5.0
        board.write("count", 40)
        assert board.read("count + 2") == 42.0
    with cc67.connect(served.address, [program], yes=True) as board:
        with pytest.raises(cc67.Error, match="monitor=True"):
            board.read("count")
