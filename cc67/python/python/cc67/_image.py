"""What is in an image, and what its code costs."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

from . import _native
from ._command import run
from ._errors import InputError, unknown
from ._program import PathLike, Program

__all__ = ["Image", "cycles", "inspect"]


class Image:
    """A TI COFF image, object or firmware file.

    Attributes:
        name: the file, or the program it is of.
        target: what the code is for.
        program: entry point and sizes in bytes, None for an object.
        sections: name, address, size in bytes and flags of each.
        symbols: name, address, size in bytes, section and kind of each, by address.
        lines: the source line of each address.
        functions: calls and stack of each function.
    """

    def __init__(self, content: bytes, name: str = "image") -> None:
        self.name = name
        self._bytes = bytes(content)
        members: dict[str, Any] = json.loads(_native.inspection(name, self._bytes))
        self.target: str = members["target"]
        self.program: dict[str, Any] | None = members["program"]
        self.sections: list[dict[str, Any]] = members["sections"]
        self.symbols: list[dict[str, Any]] = members["symbols"]
        self.lines: list[dict[str, Any]] = members["lines"]
        self.functions: list[dict[str, Any]] = members["functions"]

    @classmethod
    def read(cls, path: PathLike) -> Image:
        """The image in a file."""
        return cls(Path(path).read_bytes(), os.fspath(path))

    @classmethod
    def of(cls, program: Program, thread: int | None = None) -> Image:
        """The image of a program for a thread, 1 to 7."""
        return cls(program.image(thread), str(program.path))

    def symbol(self, name: str) -> dict[str, Any]:
        """The symbol of that name."""
        for symbol in self.symbols:
            if symbol["name"] == name:
                return symbol
        raise unknown("symbol", name, (symbol["name"] for symbol in self.symbols))

    def disassembly(self, function: str | None = None, *, sources: PathLike = ".") -> str:
        """The instructions with their source lines, of all functions or of one; sources are in a folder."""
        return _native.disassembly(self.name, self._bytes, os.fspath(sources), function)

    def __bytes__(self) -> bytes:
        return self._bytes

    def __repr__(self) -> str:
        return f"<cc67.Image {self.name!r}: {len(self.sections)} sections, {len(self.symbols)} symbols>"


def inspect(image: PathLike | Program | Image) -> str:
    """What `cc67 inspect` shows of an image: headers, symbols, lines, calls, stack."""
    if isinstance(image, Program):
        image = Image.of(image)
    elif not isinstance(image, Image):
        image = Image.read(image)
    return "\n".join(text for _, text in _native.parts(image.name, bytes(image)))


def cycles(*files: PathLike) -> str:
    """What the code costs on the real board: what `cc67 cycles` says of sources, objects or an image.

    Raises:
        InputError: a file cannot be read, or does not compile.
    """
    result = run(["cycles", *[os.fspath(file) for file in files]])
    if result.returncode == 0:
        return result.stdout
    raise InputError(result.stderr.strip())
