"""The response of an axis to a step, and at each frequency.

Both are measured with a step. The board makes the destination jump, and records destination and position in every servo
tick of 90 µs. The frequency response is the quotient of the Fourier transforms of their differences from tick to tick:
if the axis is at rest at the end of the record, nothing is cut off, so it is exact for a linear axis.
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
from .._optional import optional
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
# Most samples that a board records for GetGather.
_MOST = 40_000


@dataclass(frozen=True)
class StepFigures:
    """The figures of a step response.

    Attributes:
        rise: seconds from 10 % to 90 % of the step; NaN if it is not reached.
        overshoot: how far the response exceeds the end value, as a fraction of the step: 0.05 is 5 %.
        peak_time: seconds from the step to the peak.
        settling: seconds from the step until the response stays within the band; NaN if it does not.
        band: half the width of that band, as a fraction of the step.
        error: end value minus the last value, in units of the axis.
    """

    rise: float
    overshoot: float
    peak_time: float
    settling: float
    band: float
    error: float


@dataclass(frozen=True)
class StepResponse:
    """The response of an axis to a step.

    Attributes:
        time: seconds since the step.
        dest: commanded position, in units of the axis.
        position: measured position, in units of the axis.
        output: output of the axis, in counts.
        figures: the figures of the response.
    """

    time: Array
    dest: Array
    position: Array
    output: Array
    figures: StepFigures

    @property
    def trace(self) -> Trace:
        """The response as a trace, for tables and plots."""
        return Trace(self.time, {"dest": self.dest, "position": self.position, "output": self.output})

    def picture(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Plot destination and position to a file: .svg, .png or .html."""
        Trace(self.time, {"dest": self.dest, "position": self.position}).picture(path)


def step_figures(time: Sequence[float] | Array, values: Sequence[float] | Array, end: float, *, band: float = 0.02) -> StepFigures:
    """Compute the figures of a step response.

    Between samples the response is taken as a straight line, at its peak as a parabola.

    Args:
        time: the time of each value in seconds; the first is that of the step.
        values: the response, beginning with the value from which the step starts.
        end: the value that the response should reach.
        band: the band for settling, `end` ± this fraction of the step.

    Raises:
        InputError: there are fewer than 3 values, or the step has no size.
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
    """Return when a level is first reached, or NaN."""
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
    """Let the destination of an enabled axis jump by `size` units, record the response, and jump back.

    The board makes and records the step with the script command GatherStep; GetGather reads the record.

    Args:
        board: a board whose axis is enabled and at rest.
        axis: number or name of the axis.
        size: size of the step in units of the axis.
        seconds: board time to record after the step, at most 1.78.
        band: the band for settling, as a fraction of the step.

    Raises:
        Error: the axis is not enabled, or the step disables it.
        InputError: `size` or `seconds` is out of range.
    """
    time, dest, position, output = _record(board, axis, size, seconds)
    return StepResponse(time, dest, position, output, step_figures(time, position, float(dest[-1]), band=band))


def _record(board: Board, axis: int | str, size: float, seconds: float) -> tuple[Array, Array, Array, Array]:
    """Return time, destination, position and output, from the last tick before the step."""
    which = board.axes[axis]
    if not which.enabled:
        raise Error(f"axis {axis} is not enabled, so it does not respond")
    if not size:
        raise InputError("the size of a step must not be 0")
    half = _REST + math.ceil(seconds / _TICK)
    if not (seconds > 0 and 2 * half <= _MOST):
        raise InputError(f"a step can be recorded for at most {(_MOST // 2 - _REST) * _TICK:.2f} s, not {seconds!r}")
    board.command(f"GatherStep{which.index} {size:.17g} {2 * half}")
    board.run_for((2 * half + 2) * _TICK)
    if board.command("CheckDoneGather") != "1":
        raise Error("the board did not record the step")
    if not which.enabled:
        raise Error(f"axis {axis} was disabled by the step: its error exceeded MaxFollowingError")
    words = board.command(f"GetGather {half}").split()
    values = np.array([struct.unpack(">f", bytes.fromhex(word))[0] for word in words], dtype=np.float64).reshape(-1, 3)
    jump = int(np.flatnonzero(np.diff(values[:, 0]) != 0)[0])
    rows = values[jump:half]
    # A tick records the destination before its jump, or the one after it; the jump itself is at time 0.
    return (np.arange(len(rows), dtype=np.float64) * _TICK, rows[:, 0], rows[:, 1], rows[:, 2])


@dataclass(frozen=True)
class FrequencyResponse:
    """Position relative to destination of an axis at some frequencies.

    Attributes:
        frequency: the frequencies in Hz.
        response: position divided by destination at each frequency, complex.
    """

    frequency: Array
    response: NDArray[np.complex128]

    @property
    def magnitude(self) -> Array:
        """The magnitude; 1 if the position moves as far as the destination."""
        return np.abs(self.response)

    @property
    def magnitude_db(self) -> Array:
        """The magnitude in decibels."""
        return np.asarray(20 * np.log10(np.abs(self.response)), dtype=np.float64)

    @property
    def phase_deg(self) -> Array:
        """The phase in degrees, unwrapped: without jumps of 360°."""
        return np.degrees(np.unwrap(np.angle(self.response)))

    @property
    def open_loop(self) -> FrequencyResponse:
        """The response of the open loop, H / (1 - H), where H is this response, of the closed loop."""
        return FrequencyResponse(self.frequency, self.response / (1 - self.response))

    @property
    def bandwidth(self) -> float:
        """The lowest frequency in Hz at which the magnitude is -3 dB; NaN if it is outside the range of frequencies."""
        below = np.flatnonzero(self.magnitude_db <= -3)
        if not len(below) or below[0] == 0:
            return math.nan
        at = int(below[0])
        before, after = self.magnitude_db[at - 1], self.magnitude_db[at]
        part = (-3 - before) / (after - before)
        return float(self.frequency[at - 1] * (self.frequency[at] / self.frequency[at - 1]) ** part)

    def plot(self, axes: Any = None) -> Any:
        """Plot magnitude and phase with Matplotlib, on two `axes` or in a new figure, and return both axes.

        Raises:
            NotBuiltError: Matplotlib is not installed.
        """
        if axes is None:
            pyplot = optional("matplotlib.pyplot", "a plot", "Matplotlib", "cc67[plot]")
            _, axes = pyplot.subplots(2, 1, sharex=True)
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
    """Measure position relative to destination at some frequencies, with a step.

    Args:
        board: a board whose axis is enabled and at rest.
        axis: number or name of the axis.
        frequencies: frequencies in Hz, above 0 and up to half of the servo's 11,111 Hz; by default 50 from 1 Hz to
            1 kHz.
        size: size of the step in units of the axis. Make it as large as the output allows, so that the encoder's
            counts do not matter.
        seconds: board time to record after the step, at most 1.78; long enough for the axis to come to rest.

    Raises:
        Error: the axis is not enabled, or the step disables it.
        InputError: an argument is out of range.
    """
    wanted = np.logspace(0, 3, 50) if frequencies is None else np.asarray(list(frequencies), dtype=np.float64)
    if not len(wanted) or not np.all((wanted > 0) & (wanted <= 0.5 / _TICK)):
        raise InputError(f"frequencies must be above 0 and at most {0.5 / _TICK:.0f} Hz")
    _, dest, position, _ = _record(board, axis, size, seconds)
    answers = [_transform(np.diff(position), f) / _transform(np.diff(dest), f) for f in wanted]
    return FrequencyResponse(wanted, np.asarray(answers, dtype=np.complex128))


def _transform(differences: Array, frequency: float) -> complex:
    turn = cmath.exp(-2j * math.pi * frequency * _TICK)
    return complex(np.sum(differences * turn ** np.arange(len(differences))))
