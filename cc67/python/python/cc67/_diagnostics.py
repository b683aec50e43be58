"""The compiler's messages as objects."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

__all__ = ["Diagnostic", "Span"]


@dataclass(frozen=True)
class Span:
    """A range in a source file.

    Lines and columns count from 1, and columns count bytes; the end column is the one after the last byte.
    `byte_start` and `byte_end` are offsets in the file from 0. `is_primary` marks the place of the mistake; the other
    spans explain it. `label` is a short comment on the span, if there is one.
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
    """A message of the compiler.

    Attributes:
        level: "error", "warning" or "note".
        code: the name of the warning, as in `-W`; None if no switch controls the message.
        message: the message in one line.
        spans: the places, starting with that of the mistake; empty for a message about the whole program.
        notes: explanations, one line each.
        suggestion: what to do, or None if that is unknown.
        rendered: the whole message with the source lines, as `cc67 check` prints it.
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
        """The file of the mistake, or None for a message about the whole program."""
        return self.spans[0].file if self.spans else None

    @property
    def line(self) -> int | None:
        """The line of the mistake, counted from 1, or None."""
        return self.spans[0].line_start if self.spans else None

    @property
    def column(self) -> int | None:
        """The column of the mistake in bytes, counted from 1, or None."""
        return self.spans[0].column_start if self.spans else None

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}:{self.column}: " if self.spans else ""
        return f"{place}{self.level}: {self.message}"


def from_json(text: str) -> Diagnostic:
    """Make a diagnostic from a line of `cc67 check --message-format json`."""
    members: dict[str, Any] = json.loads(text)
    spans = tuple(Span(**span) for span in members.pop("spans"))
    notes = tuple(members.pop("notes"))
    names = ("level", "code", "message", "suggestion", "rendered")
    return Diagnostic(spans=spans, notes=notes, **{name: members[name] for name in names})
