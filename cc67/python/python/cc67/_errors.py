"""The exceptions of the package; each is an `Error`."""

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
    "LinkError",
    "LoadError",
    "NotBuiltError",
    "RangeError",
    "ThreadError",
    "TrapError",
    "UnknownNameError",
]


class Error(Exception):
    """The base class of all exceptions of cc67."""


class InputError(Error, ValueError):
    """A file, an option, an expression or a number is invalid; the message says where."""


class RangeError(InputError, OverflowError):
    """A number does not fit where it should be stored; the message names the least and the greatest that do."""


class UnknownNameError(InputError, KeyError):
    """Nothing has that name; the message suggests the name that was probably meant."""

    def __str__(self) -> str:
        # `KeyError` would show the message in quotation marks.
        return str(self.args[0]) if self.args else ""


class CompileError(Error):
    """A program has errors.

    `diagnostics` holds all messages of the compiler, including warnings, in source order. The text of the exception is
    what `cc67 check` prints: places, source lines, suggestions.
    """

    diagnostics: list[Diagnostic]

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics = list(diagnostics)
        super().__init__("".join(diagnostic.rendered for diagnostic in self.diagnostics).rstrip("\n"))

    def __reduce__(self) -> tuple[type[CompileError], tuple[list[Diagnostic]]]:
        return (CompileError, (self.diagnostics,))


class LinkError(Error, ConnectionError):
    """There is no controller at an address, it does not answer, or the link to it is lost."""


class LoadError(Error):
    """A board refuses a program, or a program cannot be linked for its thread."""


class ThreadError(Error, RuntimeError):
    """A second Python thread uses a board, which belongs to another one; see `Board.release`."""


class TrapError(Error):
    """A program did something impossible, which stopped its thread of the board; the other threads continue.

    Attributes:
        time: board time of the trap, in seconds since power-up.
        thread: number of the stopped thread, 1 to 7, or None for the call-back.
        file, line, function: place of the trap in the source, or None if the image does not record it.
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
    """An expectation of a stimulus or a test is not met."""


class NotBuiltError(Error, NotImplementedError):
    """An optional package is not installed, such as pyarrow or SciPy; the message says which, and how to install it."""


class Fixed:
    """A class whose objects have no attributes but those of the class: assigning another one is an error."""

    __slots__ = ()

    # Type checkers know the attributes; with this they would accept any.
    if not TYPE_CHECKING:

        def __setattr__(self, name: str, value: object) -> None:
            try:
                object.__setattr__(self, name, value)
            except AttributeError:
                kind = type(self).__name__
                if hasattr(type(self), name):
                    raise AttributeError(f"`{name}` of a {kind} can only be read") from None
                known = [each for each in dir(type(self)) if not each.startswith("_")]
                raise AttributeError(str(unknown(f"attribute of a {kind}", name, known))) from None


def unknown(what: str, name: object, known: Iterable[str]) -> UnknownNameError:
    """Make the exception for a name that is not one of `known`, with a suggestion."""
    names = [str(each) for each in known]
    text = str(name)
    lower = {each.lower(): each for each in reversed(names)}
    near = difflib.get_close_matches(text.lower(), list(lower), n=1)
    message = f"no such {what}: {name!r}"
    if near:
        message += f"; did you mean {lower[near[0]]!r}?"
    elif names and len(names) <= 12:
        message += f"; known names: {', '.join(names)}"
    return UnknownNameError(message)
