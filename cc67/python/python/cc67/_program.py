"""Programs: compiled once, then linked for each thread that they run in."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Iterable, Mapping, Sequence, TypedDict, Union

from . import _native
from ._diagnostics import Diagnostic, from_json
from ._errors import CompileError, InputError, unknown

__all__ = ["PathLike", "Program", "compile", "load"]

PathLike = Union[str, "os.PathLike[str]"]


class _Request(TypedDict):
    """Options of the compiler, in the form that the native half takes."""

    include: list[str]
    define: list[tuple[str, str]]
    undefine: list[str]
    optimize: str
    warnings: list[str]
    std: str
    firmware: str | None
    boot: str | None
    board: str | None
    target: str | None


class Program:
    """A compiled program, made by `compile` or `load`.

    It can run on any number of boards: one made by `compile` in any thread, an image only in the thread it was linked
    for. It can be pickled, and so sent to other processes, without its sources; but expressions (`Board.read`) need
    the source file on the computer that has the board.

    Attributes:
        path: the first file from which it was made.
        thread: the thread that it is for, 1 to 7, or None for any.
        diagnostics: warnings and notes of the compiler.
    """

    def __init__(
        self,
        native: _native.Program,
        path: Path,
        thread: int | None,
        diagnostics: Sequence[Diagnostic],
        request: _Request | None,
        files: Sequence[Path] = (),
    ) -> None:
        self._native = native
        self._files = list(files)
        self.path = path
        self.thread = thread
        self.diagnostics = list(diagnostics)
        self._request = request

    def image(self, thread: int | None = None) -> bytes:
        """Return the program linked for a thread, as the TI COFF image that `cc67 build --target sim` writes.

        Args:
            thread: 1 to 7; by default the thread of the program, else 1.
        """
        return bytes(self._native.image(thread or self.thread or 1))

    def __repr__(self) -> str:
        thread = "" if self.thread is None else f", thread={self.thread}"
        return f"<cc67.Program {str(self.path)!r}{thread}>"

    def __getstate__(self) -> dict[str, Any]:
        objects = self._native.objects()
        return {
            "path": self.path,
            "thread": self.thread,
            "diagnostics": self.diagnostics,
            "request": self._request,
            "files": self._files,
            "objects": objects,
            "image": bytes(self._native.image(self.thread or 1)) if objects is None else None,
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.path = state["path"]
        self.thread = state["thread"]
        self.diagnostics = state["diagnostics"]
        self._request = state["request"]
        self._files = state["files"]
        if state["objects"] is None:
            self._native = _native.Program.from_image(str(self.path), state["image"])
        else:
            self._native = _native.Program.from_objects(str(self.path), state["objects"], state["request"])


def compile(
    files: PathLike | Iterable[PathLike],
    *,
    thread: int | None = None,
    include: Iterable[PathLike] = (),
    define: Mapping[str, object] | Iterable[str] = (),
    undefine: Iterable[str] = (),
    optimize: int | str = 1,
    warnings: Iterable[str] = (),
    std: str = "vendor",
    firmware: PathLike | None = None,
    boot: PathLike | None = None,
    board: str | None = None,
    target: str | None = None,
) -> Program:
    """Compile a C program for the board.

    Args:
        files: one source, or several sources and objects (.o) that make one program together.
        thread: the thread that it is for, 1 to 7; by default the board chooses one.
        include: folders in which to search for included files, as with `-I`.
        define: macros to define, as with `-D`: a mapping of names to values, `{"SPEED": 20}`, or a list of `NAME` or
            `NAME=VALUE`. A name alone, `True` or `None` defines a macro as 1, `False` as 0.
        undefine: predefined macros to undefine, as with `-U`.
        optimize: the optimisation level, as with `-O`: 0 for none, 1 for speed, 2 for more speed, with larger code for
            the controller, "s" for small code.
        warnings: warning switches without `-W`: "error", "no-format", "error=format", "extra".
        std: the rules for constants: "vendor", "c90", "c99", "c11", "c17".
        firmware: a firmware file whose symbols replace the built-in ones of firmware 4.34.
        boot: the firmware file that the program is to run on: it is compiled for the processor, as
            `Board(boot=FILE)` needs it.
        board: the board and firmware that the program is for, such as "kflop-5.3.2", as with `--board`.
        target: "c67x" for code of the controller's processor, as a connected controller needs it, or "sim" for bytecode
            of the simulated board; by default "sim", and with `boot` "c67x".

    Returns:
        The program. Its warnings are in `Program.diagnostics`.

    Raises:
        CompileError: the program has errors; `diagnostics` holds all of them.
        OSError: a file cannot be read.
        InputError: an option is invalid.

    Example:
        >>> program = cc67.compile("home.c", define={"FAST": 1})
        >>> board = cc67.Board(programs=[program])
    """
    paths = _paths(files)
    if not paths:
        raise InputError("there is no file to compile")
    if thread is not None:
        _check_thread(thread)
    level = str(optimize)
    if level not in ("0", "1", "2", "s"):
        raise InputError(f"optimize must be 0, 1, 2 or \"s\", not {optimize!r}")
    request: _Request = {
        "include": [os.fspath(folder) for folder in _several(include, "include")],
        "define": _macros(define),
        "undefine": list(_several(undefine, "undefine")),
        "optimize": level,
        "warnings": _switches(warnings),
        "std": std,
        "firmware": None if firmware is None else os.fspath(firmware),
        "boot": None if boot is None else os.fspath(boot),
        "board": board,
        "target": target,
    }
    native, found = _native.compile([str(path) for path in paths], request, thread or 1)
    diagnostics = [from_json(text) for text in found]
    if native is None:
        raise CompileError(diagnostics)
    return Program(native, paths[0], thread, diagnostics, request, paths)


def load(image: PathLike, *, thread: int | None = None) -> Program:
    """Read an image, such as the file `NAME(N).out` that `cc67 build` writes.

    Args:
        image: the file.
        thread: the thread that it was linked for, 1 to 7; by default the number in its name, else 1.

    Returns:
        The program. A file that is not an image is refused only when a board loads it, with `LoadError`.

    Raises:
        OSError: the file cannot be read.
    """
    path = Path(image)
    if thread is None:
        head, _, tail = path.stem.rpartition("(")
        thread = int(tail[:-1]) if head and tail.endswith(")") and tail[:-1].isdigit() else 1
    _check_thread(thread)
    return Program(_native.Program.from_image(str(path), path.read_bytes()), path, thread, [], None)


def _check_thread(thread: int) -> None:
    if isinstance(thread, bool) or not isinstance(thread, int):
        raise TypeError(f"thread must be an integer from 1 to 7, not {thread!r}")
    if not 1 <= thread <= 7:
        raise InputError(f"no such thread {thread} (1-7)")


def _paths(files: PathLike | Iterable[PathLike]) -> list[Path]:
    if isinstance(files, (str, os.PathLike)):
        return [Path(files)]
    if isinstance(files, bytes) or not isinstance(files, Iterable):
        raise TypeError(f"files must be a path or a list of paths, not {type(files).__name__}")
    return [Path(file) for file in files]


def _several(items: Any, name: str) -> list[Any]:
    if isinstance(items, (str, bytes)):
        raise TypeError(f"{name} must be a list, not the string {items!r}")
    return list(items)


def _macros(define: Mapping[str, object] | Iterable[str]) -> list[tuple[str, str]]:
    if isinstance(define, Mapping):
        return [(str(name), _macro_value(value)) for name, value in define.items()]
    pairs = []
    for text in _several(define, "define"):
        name, equals, value = str(text).partition("=")
        pairs.append((name, value if equals else "1"))
    return pairs


def _macro_value(value: object) -> str:
    if value is None or value is True:
        return "1"
    return "0" if value is False else str(value)


def _switches(warnings: Iterable[str]) -> list[str]:
    switches = _several(warnings, "warnings")
    known = {"all", "extra", "error", *_native.lints()}
    for switch in switches:
        name = str(switch).removeprefix("error=").removeprefix("no-")
        if name not in known:
            raise unknown("warning", name, known)
    return switches


