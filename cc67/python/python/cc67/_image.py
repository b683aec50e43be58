"""The contents of an image, and the cycles that its code takes."""

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
        name: the file, or the program from which the image was made.
        target: the target of the code, "cc67" for bytecode.
        program: entry point, and sizes in bytes; None for an object.
        sections: name, address, size in bytes and flags of each section.
        symbols: name, address, size in bytes, section and kind of each symbol, in order of address.
        lines: file, line and function of each address that begins a line.
        functions: calls and stack frame of each function.
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
        """Read an image from a file.

        Raises:
            OSError: the file cannot be read.
            InputError: it is not a TI COFF image.
        """
        return cls(Path(path).read_bytes(), os.fspath(path))

    @classmethod
    def of(cls, program: Program, thread: int | None = None) -> Image:
        """Make the image of a program for a thread, 1 to 7; by default for the thread of the program, else thread 1."""
        return cls(program.image(thread), str(program.path))

    def symbol(self, name: str) -> dict[str, Any]:
        """Return the symbol with this name.

        Raises:
            UnknownNameError: the image has no such symbol.
        """
        for symbol in self.symbols:
            if symbol["name"] == name:
                return symbol
        raise unknown("symbol", name, (symbol["name"] for symbol in self.symbols))

    def disassembly(self, function: str | None = None, *, sources: PathLike = ".") -> str:
        """Return the instructions of one function, or of all, with their source lines.

        Args:
            function: the name of the function.
            sources: the folder of the source files.

        Raises:
            UnknownNameError: the image has no such function.
        """
        text = _native.disassembly(self.name, self._bytes, os.fspath(sources), function)
        if not text and function is not None:
            raise unknown("function", function, (each["name"] for each in self.functions))
        return text

    def __bytes__(self) -> bytes:
        return self._bytes

    def __repr__(self) -> str:
        return f"<cc67.Image {self.name!r}: {len(self.sections)} sections, {len(self.symbols)} symbols>"


def inspect(image: PathLike | Program | Image) -> str:
    """Return what `cc67 inspect --all` shows of an image: headers, symbols, lines, calls, stack."""
    if isinstance(image, Program):
        image = Image.of(image)
    elif not isinstance(image, Image):
        image = Image.read(image)
    return "\n".join(text for _, text in _native.parts(image.name, bytes(image)))


def cycles(*files: PathLike) -> str:
    """Return the report of `cc67 cycles`: the cycles that code takes on the real board.

    Args:
        *files: sources, objects or an image.

    Raises:
        InputError: a file cannot be read or does not compile.
    """
    result = run(["cycles", *[os.fspath(file) for file in files]])
    if result.returncode == 0:
        return result.stdout
    raise InputError(result.stderr.strip())
