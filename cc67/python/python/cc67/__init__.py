"""C programs for KFLOP motion controllers, compiled and run on a simulated board.

    import cc67

    program = cc67.compile("square.c")          # CompileError has the diagnostics
    board = cc67.Board(programs=[program])
    board.run()                                 # or run_for, run_until, step
    print(board.console)

Times are seconds of board time since power-up, positions are in the units of the axis, analog values in counts.
"""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version

from ._board import Board, Condition, Snapshot, ended, printed, started
from ._controller import connect
from ._diagnostics import Diagnostic, Span
from ._errors import (
    CompileError,
    Error,
    ExpectationError,
    InputError,
    LinkError,
    LoadError,
    NotBuiltError,
    RangeError,
    ThreadError,
    TrapError,
    UnknownNameError,
)
from ._image import Image, cycles, inspect
from ._parts import Adc, Axes, Axis, Bits, Console, Dac, Persist
from ._program import Program, load

# Not in `__all__`: `from cc67 import *` leaves the function `compile` of Python as it is.
from ._program import compile as compile
from ._sweep import merge, sweep
from ._table import Table
from ._trace import Trace

try:
    __version__ = version("cc67")
except PackageNotFoundError:  # The sources are used without being installed.
    __version__ = "0"

__all__ = [
    "Adc",
    "Axes",
    "Axis",
    "Bits",
    "Board",
    "CompileError",
    "Condition",
    "Console",
    "Dac",
    "Diagnostic",
    "Error",
    "ExpectationError",
    "Image",
    "InputError",
    "LinkError",
    "LoadError",
    "NotBuiltError",
    "Persist",
    "Program",
    "RangeError",
    "Snapshot",
    "Span",
    "Table",
    "ThreadError",
    "Trace",
    "TrapError",
    "UnknownNameError",
    "connect",
    "cycles",
    "ended",
    "inspect",
    "load",
    "merge",
    "printed",
    "started",
    "sweep",
]
