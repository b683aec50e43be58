"""What the compiler says of a program, as objects."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

__all__ = ["Diagnostic", "Span"]


@dataclass(frozen=True)
class Span:
    """A range in a source file.

    Lines and columns count from 1, columns in bytes; the end column is the one after the last byte. `byte_start` and
    `byte_end` count from 0.
    """

    file: str
    line_start: int
    column_start: int
    line_end: int
    column_end: int
    byte_start: int
    byte_end: int
    is_primary: bool
    label: str | None


@dataclass(frozen=True)
class Diagnostic:
    """One finding of the compiler.

    Attributes:
        level: "error", "warning" or "note".
        code: the name of the warning's switch, None for what no switch controls.
        message: the finding in one line.
        spans: the places, that of the mistake first; none for findings about the whole program.
        notes: explanations, a line each.
        suggestion: what to do, if that is known.
        rendered: all of it with the source lines, as `cc67 check` prints it.
    """

    level: str
    code: str | None
    message: str
    spans: tuple[Span, ...]
    notes: tuple[str, ...]
    suggestion: str | None
    rendered: str

    @property
    def file(self) -> str | None:
        """The file of the mistake."""
        return self.spans[0].file if self.spans else None

    @property
    def line(self) -> int | None:
        """The line of the mistake, from 1."""
        return self.spans[0].line_start if self.spans else None

    @property
    def column(self) -> int | None:
        """The column of the mistake, from 1, in bytes."""
        return self.spans[0].column_start if self.spans else None

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}:{self.column}: " if self.spans else ""
        return f"{place}{self.level}: {self.message}"


def from_json(text: str) -> Diagnostic:
    """A diagnostic of a line of `cc67 check --message-format json`."""
    members: dict[str, Any] = json.loads(text)
    spans = tuple(Span(**span) for span in members.pop("spans"))
    notes = tuple(members.pop("notes"))
    names = ("level", "code", "message", "suggestion", "rendered")
    return Diagnostic(spans=spans, notes=notes, **{name: members[name] for name in names})
