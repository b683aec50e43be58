"""The speed of the package, measured on a release build by `CC67_LONG=1 pytest tests/test_speed.py -s`."""

from __future__ import annotations

import os
import time
from typing import Callable

import numpy as np
import pytest
from conftest import WAIT, Write
from sweep_measures import SPIN

import cc67

pytestmark = pytest.mark.skipif(not os.environ.get("CC67_LONG"), reason="runs on a release build, with CC67_LONG=1")


def best(work: Callable[[], object], times: int = 5) -> float:
    """Return the seconds of the fastest of several calls."""
    found = []
    for _ in range(times):
        begin = time.perf_counter()
        work()
        found.append(time.perf_counter() - begin)
    return min(found)


def short(board: cc67.Board) -> int:
    """Execute a short run."""
    board.run()
    return board.persist[20]


def test_short_runs(write: Write) -> None:
    program = cc67.compile(write(SPIN))
    for executor in ("threads", "processes"):
        for engine in ("native", "bytecode"):
            grid = {"persist.5": range(1000)}
            took = best(lambda: cc67.sweep(program, grid, short, executor=executor, workers=2, engine=engine), 2)
            print(f"short runs, {executor}, {engine}: {1000 / took:.0f} a second")
    assert 1000 / took >= 300


@pytest.mark.parametrize("engine", ["native", "bytecode"])
def test_a_waiting_board(write: Write, engine: str) -> None:
    from cc67._command import run

    path = write(WAIT)
    board = cc67.Board(programs=[path], engine=engine)
    seconds = best(lambda: board.run_for(20.0))

    def command(limit: int) -> float:
        return best(lambda: run(["run", str(path), "--for", str(limit), "--engine", engine]))

    theirs = command(40) - command(20)
    print(f"20 s of a waiting board, {engine}: run_for {seconds:.4f} s, command {theirs:.4f} s")


@pytest.mark.parametrize("engine", ["native", "bytecode"])
def test_a_trace_of_a_million_samples(write: Write, engine: str) -> None:
    board = cc67.Board(programs=[write(WAIT)], engine=engine)
    begin = time.perf_counter()
    trace = board.trace([f"dest{n}" for n in range(8)] + ["pos0", "pos1"], 9.0)
    took = time.perf_counter() - begin
    values = sum(len(column) for column in trace.values())
    print(f"a trace of {values} values, {engine}: {1000 * took:.1f} ms")
    assert values == 1_000_000 and np.isfinite(trace["dest0"]).all()


@pytest.mark.parametrize("engine", ["native", "bytecode"])
def test_steps_of_an_environment(write: Write, engine: str) -> None:
    board = cc67.Board(programs=[write(WAIT)], engine=engine)
    axis = board.axes[0]

    def writes() -> None:
        for number in range(10_000):
            axis.dest = number

    def steps() -> None:
        for number in range(10_000):
            axis.dest = number
            board.step(11)
            (axis.dest, axis.position, axis.velocity, axis.output)

    write_time, step_time = best(writes) / 10_000, best(steps) / 10_000
    print(f"{engine}: a write {write_time * 1e6:.2f} us, {1 / step_time:.0f} steps of an environment a second")
    assert write_time <= 5e-6
