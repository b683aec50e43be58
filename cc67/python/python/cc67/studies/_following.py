"""The worst following error of an axis, and under which conditions it is worst."""

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
        worst: that distance in units, with its sign: destination less position.
        time: when, in seconds of board time.
        rms: root of the mean square over the whole time, in units.
        trace: destination, position and error.
    """

    worst: float
    time: float
    rms: float
    trace: Trace


def following_error(board: Board, axis: int | str = 0, seconds: float = 1.0) -> FollowingError:
    """Runs the board for some seconds and looks at the axis in every servo tick."""
    number = board.axes[axis].index
    trace = board.trace([f"dest{number}", f"pos{number}"], seconds)
    if not len(trace.time):
        raise Error("there is no tick to look at")
    error = trace[f"dest{number}"] - trace[f"pos{number}"]
    at = int(np.argmax(np.abs(error)))
    whole = Trace(trace.time, {**trace, "error": error}, trace.units)
    return FollowingError(float(error[at]), float(trace.time[at]), float(np.sqrt(np.mean(error**2))), whole)


class _Measure:
    """Of a board of a sweep."""

    def __init__(self, axis: int | str, seconds: float) -> None:
        self._axis, self._seconds = axis, seconds

    def __call__(self, board: Board) -> dict[str, float]:
        found = following_error(board, self._axis, self._seconds)
        return {"worst": found.worst, "time": found.time, "rms": found.rms}


def worst_following_error(
    program: Source, grid: Grid, axis: int | str = 0, seconds: float = 1.0, **options: Any
) -> tuple[Row, Table]:
    """The conditions under which the following error is worst, and the table of all; see `cc67.sweep`."""
    table = sweep(program, grid, _Measure(axis, seconds), **options)
    if not len(table.good):
        raise Error(f"every run failed: {table[0]['error'] if len(table) else 'there are none'}")
    return max(table.good, key=lambda row: abs(row["worst"])), table
