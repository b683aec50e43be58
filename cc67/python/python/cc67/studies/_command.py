"""`cc67 study NAME PROGRAM`: studies from the command line, with tables and plots."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Callable

import numpy as np

from .._board import Board
from .._errors import CompileError, Error, InputError, NotBuiltError
from .._trace import Trace
from ._following import following_error
from ._response import frequency_response, step_response
from ._tolerance import tolerance

__all__ = ["main"]


def main(arguments: list[str]) -> int:
    """Run the command and return its exit code: 0, 1 if a program has errors, 2 for wrong usage or input."""
    given = _parser().parse_args(arguments)
    study: Callable[[argparse.Namespace], None] = given.study
    try:
        study(given)
    except CompileError as error:
        print(error, file=sys.stderr)
        return 1
    except (Error, OSError, TypeError, ValueError) as error:
        print(f"cc67: {error}", file=sys.stderr)
        return 2
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser("cc67 study", description="Study an axis or a program")
    studies = parser.add_subparsers(required=True, metavar="STUDY")
    rows: list[tuple[str, str, Callable[[argparse.Namespace], None]]] = [
        ("step", "measure the step response: rise, overshoot, settling", _step),
        ("frequency", "measure the frequency response: position relative to destination (Bode)", _frequency),
        ("following", "find the worst following error while the program runs", _following),
        ("tolerance", "run the program on machines that vary at random", _tolerance),
    ]
    for name, text, study in rows:
        one = studies.add_parser(name, help=text, description=text)
        one.set_defaults(study=study)
        one.add_argument(
            "program", nargs="+", metavar="PROGRAM", help="programs that set up the axis, for threads 1, 2, …"
        )
        one.add_argument("--machine", metavar="FILE", help="machine file: what is connected to the board")
        one.add_argument(
            "--stim", metavar="FILE|TEXT", action="append", default=[], help="stimulus: a file, or statements"
        )
        one.add_argument(
            "--set", metavar="KEY=VALUE", action="append", default=[], help="start value, or machine file key"
        )
        one.add_argument("-o", "--output", metavar="FILE", help="write a table (.csv) or a plot (.svg, .png, .html)")
        if name == "tolerance":
            one.add_argument("--vary", metavar="KEY=LOW:HIGH", action="append", required=True, help="vary a key")
            one.add_argument(
                "--measure", metavar="NAME=EXPRESSION", action="append", required=True, help="measure this at the end"
            )
            one.add_argument("--samples", type=int, default=100, metavar="N", help="number of machines (100)")
            one.add_argument("--seed", type=int, default=0, metavar="N", help="seed of the random numbers (0)")
            continue
        one.add_argument("--axis", default="0", help="number or name of the axis (0)")
        one.add_argument("--seconds", type=float, default=0.5, help="board time to record, in s (0.5)")
        if name != "following":
            one.add_argument("--size", type=float, default=100.0, help="size of the step in units of the axis (100)")
            one.add_argument("--after", type=float, default=5.0, help="limit for the programs to end, in s (5)")
        if name == "frequency":
            one.add_argument("--band", default="1:1000", metavar="LOW:HIGH", help="frequencies in Hz (1:1000)")
    return parser


def _board(given: argparse.Namespace) -> Board:
    return Board(given.program, machine=given.machine, stim=given.stim, set=given.set)


def _ready(given: argparse.Namespace) -> Board:
    """Make a board and let its programs set up the axis."""
    board = _board(given)
    board.run(given.after)
    return board


def _axis(given: argparse.Namespace) -> int | str:
    return int(given.axis) if given.axis.isdigit() else str(given.axis)


def _write(trace: Trace, path: str | None) -> None:
    if path is None:
        return
    if Path(path).suffix.lower() == ".csv":
        trace.save(path)
    else:
        trace.picture(path)


def _step(given: argparse.Namespace) -> None:
    response = step_response(_ready(given), _axis(given), given.size, given.seconds)
    figures = response.figures
    print(f"rise       {figures.rise:.5f} s")
    print(f"overshoot  {100 * figures.overshoot:.2f} %")
    print(f"settling   {figures.settling:.5f} s, to {100 * figures.band:g} %")
    print(f"error      {figures.error:.6g} units at the end")
    _write(Trace(response.time, {"dest": response.dest, "position": response.position}), given.output)


def _frequency(given: argparse.Namespace) -> None:
    low, high = _pair(given.band)
    wanted = np.geomspace(low, high, 60)
    response = frequency_response(_ready(given), _axis(given), wanted, given.size, given.seconds)
    print("frequency,magnitude_db,phase_deg")
    for row in zip(response.frequency, response.magnitude_db, response.phase_deg):
        print(",".join(f"{value:.6g}" for value in row))
    if given.output is None:
        return
    if Path(given.output).suffix.lower() == ".csv":
        columns = {"magnitude_db": response.magnitude_db, "phase_deg": response.phase_deg}
        Trace(response.frequency, columns).save(given.output, "frequency")
        return
    try:
        figure = response.plot()[0].figure
    except ImportError:
        raise NotBuiltError("a plot of a frequency response needs Matplotlib: pip install cc67[plot]") from None
    figure.savefig(given.output)


def _following(given: argparse.Namespace) -> None:
    found = following_error(_board(given), _axis(given), given.seconds)
    print(f"worst  {found.worst:.6g} units at {found.time:.5f} s")
    print(f"rms    {found.rms:.6g} units")
    _write(found.trace, given.output)


def _tolerance(given: argparse.Namespace) -> None:
    variations = {name: _pair(bounds) for name, bounds in map(_equation, given.vary)}
    measure = dict(map(_equation, given.measure))
    options = {"machine": given.machine, "stim": given.stim, "set": dict(map(_equation, given.set))}
    program = given.program if len(given.program) > 1 else given.program[0]
    study = tolerance(program, variations, measure, samples=given.samples, seed=given.seed, **options)
    for name in measure:
        figures = ", ".join(f"{figure} {value:.6g}" for figure, value in study.spread(name).items())
        print(f"{name}: {figures}")
    print(f"{len(study.table.failures)} of {len(study.table)} runs failed")
    if given.output is not None:
        study.table.save(given.output)


def _equation(text: str) -> tuple[str, str]:
    name, equals, value = text.partition("=")
    if not equals:
        raise InputError(f"{text!r} has no `=`")
    return name, value


def _pair(text: str) -> tuple[float, float]:
    low, colon, high = text.partition(":")
    try:
        return float(low), float(high if colon else low)
    except ValueError:
        raise InputError(f"{text!r} is not LOW:HIGH") from None
