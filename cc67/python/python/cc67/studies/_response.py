"""How an axis answers: to a step, and to each frequency.

A step is what excites both. The board jumps with the destination and records destination and position in every servo
tick, 90 µs. The frequency response is the quotient of the transforms of their differences from tick to tick: where the
axis has come to rest at the end of the record, nothing is cut off, so it is exact for a linear axis.
"""

from __future__ import annotations

import cmath
import math
import os
import struct
from dataclasses import dataclass
from typing import Any, Iterable, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from .._board import Board
from .._errors import Error, InputError
from .._trace import Trace

__all__ = [
    "FrequencyResponse",
    "StepFigures",
    "StepResponse",
    "frequency_response",
    "step_figures",
    "step_response",
]

Array = NDArray[np.float64]

_TICK = 90e-6
# Samples before the step: 0.02 s.
_REST = 222
# The most that a board records for GetGather.
_MOST = 40_000


@dataclass(frozen=True)
class StepFigures:
    """The figures of a step response.

    Attributes:
        rise: seconds from 10 % to 90 % of the way.
        overshoot: how far it goes beyond the end, as a part of the way: 0.05 is 5 %.
        peak_time: seconds from the step to the peak.
        settling: seconds from the step until it stays within the band.
        band: that band, as a part of the way.
        error: what is missing at the end, in units.
    """

    rise: float
    overshoot: float
    peak_time: float
    settling: float
    band: float
    error: float


@dataclass(frozen=True)
class StepResponse:
    """A step of an axis: time in seconds from the step on, destination and position in units, output in counts."""

    time: Array
    dest: Array
    position: Array
    output: Array
    figures: StepFigures

    @property
    def trace(self) -> Trace:
        """The same as a trace, for tables and pictures."""
        return Trace(self.time, {"dest": self.dest, "position": self.position, "output": self.output})

    def picture(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Draws destination and position: .svg, .png or .html."""
        Trace(self.time, {"dest": self.dest, "position": self.position}).picture(path)


def step_figures(time: Sequence[float] | Array, values: Sequence[float] | Array, end: float, *, band: float = 0.02) -> StepFigures:
    """The figures of a response that begins at its first value, at time 0, and is to come to `end`.

    Between samples the response is taken as a straight line, at its peak as a parabola.
    """
    t, v = np.asarray(time, dtype=np.float64), np.asarray(values, dtype=np.float64)
    if t.shape != v.shape or t.ndim != 1 or len(t) < 3:
        raise InputError("a response needs at least 3 values, each with its time")
    if end == v[0]:
        raise InputError("a response that ends where it begins has no figures")
    way = (v - v[0]) / (end - v[0])
    peak_time, peak = _peak(t, way)
    outside = np.flatnonzero(np.abs(way - 1) > band)
    settling = 0.0
    if len(outside):
        last = int(outside[-1])
        settling = math.nan if last + 1 == len(t) else _crossing(t, np.abs(way - 1), band, last)
    rise = _first(t, way, 0.9) - _first(t, way, 0.1)
    begin = float(t[0])
    return StepFigures(rise, max(0.0, peak - 1), peak_time - begin, settling - begin, band, float(end - v[-1]))


def _first(time: Array, way: Array, level: float) -> float:
    """When a level is reached first."""
    reached = np.flatnonzero(way >= level)
    if not len(reached):
        return math.nan
    return float(time[0]) if reached[0] == 0 else _crossing(time, way, level, int(reached[0]) - 1)


def _crossing(time: Array, values: Array, level: float, before: int) -> float:
    part = (level - values[before]) / (values[before + 1] - values[before])
    return float(time[before] + part * (time[before + 1] - time[before]))


def _peak(time: Array, way: Array) -> tuple[float, float]:
    at = int(np.argmax(way))
    if at in (0, len(way) - 1):
        return float(time[at]), float(way[at])
    before, top, after = way[at - 1 : at + 2]
    curve = before - 2 * top + after
    if curve >= 0:
        return float(time[at]), float(top)
    shift = 0.5 * (before - after) / curve
    return float(time[at] + shift * (time[at + 1] - time[at])), float(top - 0.25 * (before - after) * shift)


def step_response(
    board: Board, axis: int | str = 0, size: float = 100.0, seconds: float = 0.5, *, band: float = 0.02
) -> StepResponse:
    """Lets an enabled axis jump by `size` units, records it for `seconds`, and jumps back.

    What the board does on the script command GatherStep; the answer is read with GetGather. At most 1.78 s.
    """
    time, dest, position, output = _record(board, axis, size, seconds)
    return StepResponse(time, dest, position, output, step_figures(time, position, float(dest[-1]), band=band))


def _record(board: Board, axis: int | str, size: float, seconds: float) -> tuple[Array, Array, Array, Array]:
    """Time, destination, position and output from the last tick before the step on."""
    which = board.axes[axis]
    if not which.enabled:
        raise Error(f"axis {axis} is not enabled, so it does not answer")
    if not size:
        raise InputError("a step has a size")
    half = _REST + math.ceil(seconds / _TICK)
    if not (seconds > 0 and 2 * half <= _MOST):
        raise InputError(f"a step is recorded for at most {(_MOST // 2 - _REST) * _TICK:.2f} s, not {seconds!r}")
    board.command(f"GatherStep{which.index} {size:.17g} {2 * half}")
    board.run_for((2 * half + 2) * _TICK)
    if board.command("CheckDoneGather") != "1":
        raise Error("the board has not recorded the step")
    if not which.enabled:
        raise Error(f"axis {axis} was disabled by the step: its error exceeded MaxFollowingError")
    words = board.command(f"GetGather {half}").split()
    values = np.array([struct.unpack(">f", bytes.fromhex(word))[0] for word in words], dtype=np.float64).reshape(-1, 3)
    jump = int(np.flatnonzero(np.diff(values[:, 0]) != 0)[0])
    rows = values[jump:half]
    # The destination that a tick records is the one before its jump, or the one after: the jump itself is at 0.
    return (np.arange(len(rows), dtype=np.float64) * _TICK, rows[:, 0], rows[:, 1], rows[:, 2])


@dataclass(frozen=True)
class FrequencyResponse:
    """Position over destination of an axis at some frequencies.

    Attributes:
        frequency: in Hz.
        response: the complex quotient.
    """

    frequency: Array
    response: NDArray[np.complex128]

    @property
    def magnitude(self) -> Array:
        """The magnitude; 1 is as far as the destination goes."""
        return np.abs(self.response)

    @property
    def magnitude_db(self) -> Array:
        """The magnitude in decibels."""
        return np.asarray(20 * np.log10(np.abs(self.response)), dtype=np.float64)

    @property
    def phase_deg(self) -> Array:
        """The phase in degrees, without jumps of a turn."""
        return np.degrees(np.unwrap(np.angle(self.response)))

    @property
    def open_loop(self) -> FrequencyResponse:
        """Of the loop that is closed around it: H / (1 - H)."""
        return FrequencyResponse(self.frequency, self.response / (1 - self.response))

    @property
    def bandwidth(self) -> float:
        """The frequency in Hz at which it is 3 dB below 1 for the first time; not a number if it never is."""
        below = np.flatnonzero(self.magnitude_db <= -3)
        if not len(below) or below[0] == 0:
            return math.nan
        at = int(below[0])
        before, after = self.magnitude_db[at - 1], self.magnitude_db[at]
        part = (-3 - before) / (after - before)
        return float(self.frequency[at - 1] * (self.frequency[at] / self.frequency[at - 1]) ** part)

    def plot(self, axes: Any = None) -> Any:
        """Draws magnitude and phase with Matplotlib; returns both Matplotlib axes."""
        if axes is None:
            from importlib import import_module

            _, axes = import_module("matplotlib.pyplot").subplots(2, 1, sharex=True)
        axes[0].semilogx(self.frequency, self.magnitude_db)
        axes[0].set_ylabel("magnitude (dB)")
        axes[1].semilogx(self.frequency, self.phase_deg)
        axes[1].set_ylabel("phase (°)")
        axes[1].set_xlabel("frequency (Hz)")
        return axes


def frequency_response(
    board: Board,
    axis: int | str = 0,
    frequencies: Iterable[float] | None = None,
    size: float = 100.0,
    seconds: float = 1.0,
) -> FrequencyResponse:
    """Measures position over destination by a step of `size` units that is recorded for `seconds`.

    Args:
        board: a board whose axis is enabled and at rest.
        axis: its number or name.
        frequencies: in Hz, up to half of the servo's 11,111 Hz; by default 50 from 1 Hz to 1 kHz.
        size: in position units: as large as the output allows, so that the encoder's counts do not matter.
        seconds: long enough that the axis comes to rest.
    """
    wanted = np.logspace(0, 3, 50) if frequencies is None else np.asarray(list(frequencies), dtype=np.float64)
    if not len(wanted) or not np.all((wanted > 0) & (wanted <= 0.5 / _TICK)):
        raise InputError(f"frequencies are above 0 and at most {0.5 / _TICK:.0f} Hz")
    _, dest, position, _ = _record(board, axis, size, seconds)
    answers = [_transform(np.diff(position), f) / _transform(np.diff(dest), f) for f in wanted]
    return FrequencyResponse(wanted, np.asarray(answers, dtype=np.complex128))


def _transform(differences: Array, frequency: float) -> complex:
    turn = cmath.exp(-2j * math.pi * frequency * _TICK)
    return complex(np.sum(differences * turn ** np.arange(len(differences))))
