"""The exceptions of the package; every one is an `Error`."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING, Iterable, Sequence

if TYPE_CHECKING:
    from ._diagnostics import Diagnostic

__all__ = [
    "CompileError",
    "Error",
    "ExpectationError",
    "InputError",
    "LoadError",
    "NotBuiltError",
    "ThreadError",
    "TrapError",
    "UnknownNameError",
]


class Error(Exception):
    """Whatever cc67 refuses to do."""


class InputError(Error, ValueError):
    """A file, an option, an expression or a number is wrong; the message has the place."""


class UnknownNameError(InputError, KeyError):
    """There is nothing of that name; the message has the names that are near."""

    def __str__(self) -> str:
        # A `KeyError` would put the message in quotation marks.
        return str(self.args[0]) if self.args else ""


class CompileError(Error):
    """A program has errors.

    `diagnostics` holds all that the compiler found, warnings included, in the order of the program. The text of the
    exception is what `cc67 check` prints: places, source lines, suggestions.
    """

    diagnostics: list[Diagnostic]

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics = list(diagnostics)
        super().__init__("".join(diagnostic.rendered for diagnostic in self.diagnostics).rstrip("\n"))

    def __reduce__(self) -> tuple[type[CompileError], tuple[list[Diagnostic]]]:
        return (CompileError, (self.diagnostics,))


class LoadError(Error):
    """A board refuses a program, or a program cannot be linked for the thread."""


class ThreadError(Error, RuntimeError):
    """A board is used by a second thread: a board is for one thread at a time."""


class TrapError(Error):
    """A thread of the board was stopped because its program did the impossible; the others go on.

    Attributes:
        time: board time of the trap, seconds since power-up.
        thread: number of the stopped thread, 1 to 7, or None for the call-back.
        file, line, function: where it was, or None where the image does not say.
    """

    def __init__(
        self,
        message: str,
        time: float = 0.0,
        thread: int | None = None,
        place: tuple[str, int | None, str] | None = None,
    ) -> None:
        super().__init__(message)
        self.time = time
        self.thread = thread
        self.file: str | None = place[0] if place else None
        self.line: int | None = place[1] if place else None
        self.function: str | None = place[2] if place else None

    def __reduce__(self) -> tuple[type[TrapError], tuple[object, ...]]:
        place = None if self.file is None else (self.file, self.line, self.function)
        return (TrapError, (self.args[0], self.time, self.thread, place))


class ExpectationError(Error, AssertionError):
    """Something that a stimulus or a test expects is not so."""


class NotBuiltError(Error, NotImplementedError):
    """A part of cc67 that this version does not have; the message has its name."""


def unknown(what: str, name: object, known: Iterable[str]) -> UnknownNameError:
    """The exception for a name that is not one of `known`, with those that are near."""
    names = [str(each) for each in known]
    text = str(name)
    lower = {each.lower(): each for each in reversed(names)}
    near = difflib.get_close_matches(text.lower(), list(lower), n=1)
    message = f"there is no {what} {name!r}"
    if near:
        message += f"; did you mean {lower[near[0]]!r}?"
    elif names and len(names) <= 12:
        message += f"; there are {', '.join(names)}"
    return UnknownNameError(message)
