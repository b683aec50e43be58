"""Connected controllers."""

from __future__ import annotations

from typing import Iterable, Mapping

from . import _native
from ._board import Board, Source
from ._errors import InputError
from ._program import PathLike

__all__ = ["connect"]


def connect(
    address: str,
    programs: Source | Iterable[Source] | Mapping[int, Source] = (),
    *,
    load: Source | Iterable[Source] | Mapping[int, Source] = (),
    set: Mapping[str, object] | Iterable[str] = (),
    files: PathLike | None = None,
    answers: Mapping[str, object] | Iterable[str] = (),
    force: bool = False,
    verify: bool = False,
    monitor: bool = False,
    yes: bool = False,
    on_fault: str = "raise",
) -> Board:
    """Connect to a controller, and load and start programs on it, as `cc67 run --on` does.

    cc67 has never been tried on a controller, only on the released firmware in emulation: switch the drives off for the
    first trials. The result is a `Board` whose time passes by itself; calls such as `run` and `run_until` wait. It
    cannot stop its time, has no snapshots, and takes no stimulus. Without `monitor` only `persist` and what the status
    record has can be read of its memory: positions, modes and enables of axes, bits, analog channels, threads.
    Conditions are tested about 20 times a second.

    Args:
        address: `usb`, `usb:LOCATION`, `serial:/dev/ttyUSB0`, `serial:COM3`, `server`, `kogna`,
            `tcp:HOST:PORT`, as with `--on`.
        programs, load, set, files, answers, on_fault: as for `Board`. Sources are compiled for the controller's
            processor and firmware; a `Program` must have been compiled with `target="c67x"`. Boxes that programs open
            stay open until they are answered; each of `answers` answers one.
        force: whether to load programs also if they were linked for another firmware; their calls may then jump
            anywhere.
        verify: whether to compare the controller's memory with each program after its load, with the monitor.
        monitor: whether cc67 may load a small program of its own into the highest free thread. It runs for the time of
            a request, reads memory, so that variables of programs have values, and overwrites the last 258 words of
            the gather buffer.
        yes: True confirms that the risks are known: real machines move.

    Raises:
        InputError: `yes` is not given, or an argument is invalid.
        LinkError: there is no controller, it does not answer, or the link is lost.
        CompileError: a source has errors.
        LoadError: a program is refused.

    Example:
        >>> with cc67.connect("usb", ["home.c"], yes=True) as board:
        ...     board.run_until(cc67.printed("homed"), timeout=30.0)
        True
    """
    if not yes:
        raise InputError(f"connect needs yes=True\n{_native.first_time()}")
    if on_fault not in ("raise", "keep"):
        raise InputError(f'on_fault must be "raise" or "keep", not {on_fault!r}')
    controller = _native.Controller(address)
    terms = {"force": force, "verify": verify, "monitor": monitor}
    return Board._on(
        controller, programs, load, set=set, files=files, answers=answers, terms=terms, on_fault=on_fault
    )
