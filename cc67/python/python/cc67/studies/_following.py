"""The worst following error of an axis, and the conditions under which it occurs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .._board import Board
from .._errors import Error
from .._sweep import Grid, Source, sweep
from .._table import Row, Table
from .._trace import Trace

__all__ = ["FollowingError", "following_error", "worst_following_error"]


@dataclass(frozen=True)
class FollowingError:
    """The largest distance of an axis from its destination.

    Attributes:
        worst: that distance in units of the axis, with its sign: destination minus position.
        time: when it occurred, in seconds of board time since power-up.
        rms: root mean square of the error over the whole time, in units of the axis.
        trace: destination, position and `error` in every tick.
    """

    worst: float
    time: float
    rms: float
    trace: Trace


def following_error(board: Board, axis: int | str = 0, seconds: float = 1.0) -> FollowingError:
    """Run a board and find the worst following error of an axis, which is checked in every servo tick.

    Args:
        board: the board.
        axis: number or name of the axis.
        seconds: board time to run.

    Raises:
        Error: `seconds` is shorter than a tick.
    """
    number = board.axes[axis].index
    trace = board.trace([f"dest{number}", f"pos{number}"], seconds)
    if not len(trace.time):
        raise Error("the time is shorter than a servo tick")
    error = trace[f"dest{number}"] - trace[f"pos{number}"]
    at = int(np.argmax(np.abs(error)))
    whole = Trace(trace.time, {**trace, "error": error}, trace.units)
    return FollowingError(float(error[at]), float(trace.time[at]), float(np.sqrt(np.mean(error**2))), whole)


@dataclass(frozen=True)
class _Measure:
    """A measure of `cc67.sweep`."""

    axis: int | str
    seconds: float

    def __call__(self, board: Board) -> dict[str, float]:
        found = following_error(board, self.axis, self.seconds)
        return {"worst": found.worst, "time": found.time, "rms": found.rms}


def worst_following_error(
    program: Source, grid: Grid, axis: int | str = 0, seconds: float = 1.0, **options: Any
) -> tuple[Row, Table]:
    """Run a sweep and find the run with the worst following error.

    Args:
        program, grid, **options: as for `cc67.sweep`.
        axis: number or name of the axis.
        seconds: board time of each run.

    Returns:
        The row of the worst run, and the table of all runs; both have `worst`, `time` and `rms` of `FollowingError`.

    Raises:
        Error: every run failed.
    """
    table = sweep(program, grid, _Measure(axis, seconds), **options)
    if not len(table.good):
        raise Error(f"every run failed: {table[0]['error'] if len(table) else 'there are none'}")
    return max(table.good, key=lambda row: abs(row["worst"])), table
