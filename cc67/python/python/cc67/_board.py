"""The simulated board."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Callable, Iterable, Mapping, Sequence, Union

from . import _native
from ._errors import Error, InputError
from ._parts import Adc, Axes, Bits, Console, Dac, Persist
from ._program import PathLike, Program, _check_thread, compile, load
from ._trace import Trace

__all__ = ["Board", "Condition", "Snapshot", "ended", "printed", "started"]

_TICK = 90e-6


class _Event:
    """Something that a run may wait for and that no expression says."""

    def __init__(self, kind: str, value: object) -> None:
        self._pair = (kind, str(value))

    def __repr__(self) -> str:
        kind, value = self._pair
        names = {"printed": f"cc67.printed({value!r})", "ended": f"cc67.ended({value})"}
        return names.get(kind, f"cc67.started({value})")


Condition = Union[str, _Event, Callable[["Board"], object]]
Source = Union[Program, PathLike]


def printed(text: str) -> _Event:
    """For `Board.run_until`: a console line that contains the text is printed from now on."""
    return _Event("printed", text)


def ended(thread: int) -> _Event:
    """For `Board.run_until`: a thread, 1 to 7, is not active."""
    _check_thread(thread)
    return _Event("ended", thread)


def started(thread: int) -> _Event:
    """For `Board.run_until`: a thread, 1 to 7, is active."""
    _check_thread(thread)
    return _Event("active", thread)


class Snapshot:
    """A board as it was at an instant; made by `Board.snapshot`, and good for that board alone.

    Attributes:
        time: the instant, seconds of board time since power-up.
    """

    def __init__(self, native: _native.Board) -> None:
        self._native = native
        self.time = native.time()
        self._number = native.snapshot()

    def __del__(self) -> None:
        native = getattr(self, "_native", None)
        if native is not None and hasattr(self, "_number"):
            native.forget(self._number)

    def __repr__(self) -> str:
        return f"<cc67.Snapshot at {self.time:.6f} s>"


class Board:
    """A simulated KFLOP board with its programs and the machine around it.

    Board time passes only in the calls that say so: `run`, `run_for`, `run_until`, `step`, `trace`, `command`. The
    same arguments and the same calls give the same results, on any computer and on either engine. While time passes,
    other Python threads run, and Ctrl-C stops the call. A board is for one thread: the one that uses it first.

    Args:
        programs: what is loaded and started: programs, or files, which are compiled (.c) or loaded (.out). A program
            goes to the thread it was compiled for, else to the lowest free one; a mapping `{3: program}` says it.
        machine: what is connected: a machine file, its text, or a mapping of its keys, `{"axis.0.model": "motor"}`.
        stim: what the world does and when: statements such as "at 0.5s bit 136 = 1", a file, or several of both.
        set: start values `{"persist.5": 3, "persist.float.6": 1.5}` and keys of the machine file.
        load: programs that are loaded but not started, as `programs`.
        files: the folder of the files that programs open on the PC.
        answers: what the PC answers to programs, `{"msgbox": "no"}`, as `--answer`.
        assist: whether an operator is played who moves inputs that programs wait for.
        engine: what executes the programs, "native" or "bytecode"; results are the same.
        shortcuts: whether waits are skipped; results are the same.
        uart_input: characters that wait on the line to the serial port.
        on_fault: "raise": a trap, or an expectation of the stimulus that is not met, ends the call in progress with
            `TrapError` or `ExpectationError`; "keep": it is kept in `faults`, and time goes on.

    Example:
        >>> board = cc67.Board(programs=["home.c"], machine="mill.toml")
        >>> board.run_until("ch0->Dest > 100", timeout=5.0)
        True
        >>> board.axes[0].position
        100.02
    """

    def __init__(
        self,
        programs: Source | Iterable[Source] | Mapping[int, Source] = (),
        *,
        machine: PathLike | Mapping[str, object] | None = None,
        stim: PathLike | Iterable[PathLike] = (),
        set: Mapping[str, object] | Iterable[str] = (),
        load: Source | Iterable[Source] | Mapping[int, Source] = (),
        files: PathLike | None = None,
        answers: Mapping[str, object] | Iterable[str] = (),
        assist: bool = False,
        engine: str = "native",
        shortcuts: bool = True,
        uart_input: bytes = b"",
        on_fault: str = "raise",
    ) -> None:
        if on_fault not in ("raise", "keep"):
            raise InputError(f'on_fault must be "raise" or "keep", not {on_fault!r}')
        settings = _settings(set)
        if isinstance(machine, Mapping):
            settings = [*_settings(machine), *settings]
            machine = None
        assigned = _assign(programs, load)
        request = {
            "programs": [(thread, program._native, starts) for thread, program, starts in assigned],
            "machine": None if machine is None else _machine(machine),
            "settings": settings,
            "stim": _stimuli(stim),
            "files": None if files is None else os.fspath(files),
            "answers": _pairs(answers, "answers"),
            "assist": bool(assist),
            "shortcuts": bool(shortcuts),
            "uart_input": bytes(uart_input),
        }
        self._native = _native.Board(request, engine)
        self._programs = {thread: program for thread, program, _ in assigned}
        self._bits = Bits(self)
        self._adc = Adc(self)
        self._dac = Dac(self)
        self._axes = Axes(self)
        self._persist = Persist(self)
        if on_fault == "keep":
            self._native.stop_at_faults(False)
            self._native.release()

    # How far time goes.

    @property
    def time(self) -> float:
        """Board time since power-up, in seconds."""
        return self._native.time()

    @property
    def tick(self) -> int:
        """Number of the last servo tick that is over; a tick is 90 µs."""
        return self._native.tick()

    def run_for(self, seconds: float) -> None:
        """Lets `seconds` of board time pass, also when all programs have ended.

        Raises:
            TrapError: a thread was stopped; time has gone as far as that.
            ExpectationError: the stimulus expects what is not so.
            KeyboardInterrupt: Ctrl-C; time has gone as far as that.
        """
        self._native.run_for(seconds)

    def run(self, timeout: float = 60.0) -> bool:
        """Runs until all programs have ended and nothing moves, at most `timeout` seconds of board time.

        What `cc67 run` does: at the end, text that is held without a line end is printed, and what the stimulus
        expects "at end" is looked at.

        Returns:
            Whether all has ended.
        """
        return self._native.run(timeout)

    def run_until(self, condition: Condition, timeout: float = 60.0) -> bool:
        """Runs until a condition is met, at most `timeout` seconds of board time.

        Args:
            condition: a C expression in the words of the programs, `"count == 3 && ch0->Dest > 100"`;
                `printed("text")`, `ended(thread)`, `started(thread)`; or a function that is given the board. It is
                looked at after every servo tick of 90 µs; one that is met already takes no time.

        Returns:
            Whether it was met. What a function raises ends the call.
        """
        if isinstance(condition, _Event):
            return self._native.run_until(condition._pair, timeout)
        if isinstance(condition, str):
            return self._native.run_until(condition, timeout)
        if not callable(condition):
            raise TypeError(f"a condition is an expression, an event or a function, not {condition!r}")
        end = self.tick + round(timeout / _TICK)
        while not condition(self):
            if self.tick >= end:
                return False
            self._native.step(1)
        return True

    def step(self, ticks: int = 1) -> None:
        """Runs so many servo ticks of 90 µs."""
        if isinstance(ticks, bool) or not isinstance(ticks, int):
            raise TypeError(f"ticks is a whole number, not {ticks!r}")
        if ticks < 0:
            raise InputError(f"time does not go back: {ticks} ticks")
        self._native.step(ticks)

    def step_thread(self, thread: int, timeout: float = 1.0) -> bool:
        """Runs to the end of the next time slice of a thread; whether it had one within `timeout` seconds."""
        return self._native.step_thread(thread, timeout)

    def finish(self) -> None:
        """The run is over: prints text that is held without a line end, and looks at what the stimulus expects."""
        self._native.finish()

    @property
    def ended(self) -> bool:
        """Whether no thread is active and nothing is under way that a program has begun."""
        return self._native.has_ended()

    # Programs.

    @property
    def programs(self) -> dict[int, Program]:
        """The programs that were loaded, by their threads."""
        return dict(self._programs)

    def load(self, program: Source, *, thread: int | None = None, start: bool = False) -> None:
        """Loads a program into its thread, else thread 1; what runs there is stopped.

        Raises:
            LoadError: why it is refused; the program in the thread goes on.
        """
        made = _program(program, None)
        number = thread or made.thread or 1
        self._native.load(number, made._native, start)
        self._programs[number] = made

    def start(self, thread: int) -> None:
        """Starts a thread, 1 to 7, at the beginning of its program."""
        self._native.start(thread)

    def stop(self, thread: int) -> None:
        """Stops a thread, 1 to 7, where it is."""
        self._native.stop(thread)

    def active(self, thread: int) -> bool:
        """Whether a thread, 1 to 7, is active."""
        return self._native.is_active(thread)

    # What the board says.

    @property
    def console(self) -> Console:
        """The console lines printed since power-up: a list of lines, with `times` in seconds."""
        return Console(self._native.console(0))

    @property
    def remarks(self) -> list[str]:
        """What the simulation remarks: inputs that nothing drives, axes that drive nothing, requests to the PC."""
        return [text for _, text in self._native.remarks()]

    @property
    def faults(self) -> list[Exception]:
        """Traps and expectations that were not met, as the exceptions that say so."""
        return self._native.faults()

    @property
    def uart(self) -> bytes:
        """What the serial port has sent since power-up."""
        return bytes(self._native.uart())

    @property
    def recording(self) -> str:
        """What was done by hand, as a stimulus: a board with it does the same."""
        return self._native.recording()[0]

    def command(self, line: str) -> str:
        """Sends a line of script commands, `"ReadBit46"` or `"EnableAxis0;Move0=100"`, and returns the reply.

        The time that the line and its reply take on the wire passes, about 2.5 ms. Lines of a longer reply are
        separated by line ends; a command without a reply returns "".
        """
        if not isinstance(line, str):
            raise TypeError(f"a command is a text, not {line!r}")
        if "\n" in line or "\r" in line:
            raise InputError("a command is one line")
        return "\n".join(self._native.command(line.encode("latin-1", "replace")))

    # The board as the world sees it.

    @property
    def bits(self) -> Bits:
        """The input and output bits: `board.bits[136] = True` closes a switch."""
        return self._bits

    @property
    def adc(self) -> Adc:
        """The analog inputs, in counts from -2048 to 2047."""
        return self._adc

    @property
    def dac(self) -> Dac:
        """The analog outputs, in counts from -2048 to 2047."""
        return self._dac

    @property
    def axes(self) -> Axes:
        """The eight axes, by number or by the name in the machine file."""
        return self._axes

    @property
    def persist(self) -> Persist:
        """The elements of `persist.UserData`; `persist.float` and `persist.double` for other types."""
        return self._persist

    def act(self, statement: str) -> None:
        """Does what a statement of a stimulus says, with the next servo tick: `"pulse bit 137 for 50ms"`."""
        self._native.act(statement)

    def send_uart(self, data: bytes) -> None:
        """Sends characters to the serial port; they arrive at its rate."""
        self._native.send_to_uart(bytes(data))

    def read(self, expression: str) -> float:
        """The value of a C expression in the words of the programs, or of an item such as "dest0", "bit46", "adc2".

        `2:count` is the `count` of the program in thread 2. Looking changes nothing and takes no board time.

        Raises:
            InputError: what is wrong with the expression, with the name that was meant.
        """
        if not isinstance(expression, str):
            raise TypeError(f"an expression is a text, not {expression!r}")
        return self._native.read(expression)

    def write(self, expression: str, value: float) -> None:
        """Stores a value in a variable, a field or an element, as an assignment in C would: `write("count", 2)`."""
        if not isinstance(expression, str):
            raise TypeError(f"an expression is a text, not {expression!r}")
        if isinstance(value, (str, bytes)):
            raise TypeError(f"a value is a number, not {value!r}")
        self._native.write(expression, float(value))

    # Looking back.

    def snapshot(self) -> Snapshot:
        """Keeps the board as it is, to go back to with `restore`, as often as one likes."""
        return Snapshot(self._native)

    def restore(self, snapshot: Snapshot) -> None:
        """Makes the board what it was when the snapshot was taken; with the same calls it goes on the same way."""
        if not isinstance(snapshot, Snapshot):
            raise TypeError(f"restore needs a snapshot, not {snapshot!r}")
        if snapshot._native is not self._native or not self._native.restore(snapshot._number):
            raise Error("the snapshot is of another board")

    def trace(self, items: str | Iterable[str], seconds: float, *, every: int = 1) -> Trace:
        """Runs for `seconds` of board time and records values after every tick, or every so many ticks.

        Args:
            items: names and expressions, `"axis0,bit46"` or `["ch0->Dest - home", "persist.5"]`; `axis0` is `dest0`,
                `pos0` and `out0`.
            seconds: board time.
            every: servo ticks of 90 µs from one sample to the next.

        Returns:
            The values as NumPy arrays of doubles, which own what was recorded: `trace["dest0"]`, `trace.time`.
        """
        if isinstance(every, bool) or not isinstance(every, int) or every < 1:
            raise InputError(f"every must be a number of ticks from 1, not {every!r}")
        names = _split(items) if isinstance(items, str) else [str(item) for item in items]
        time, columns = self._native.trace(names, seconds, every)
        units = {f"{kind}{axis.index}": axis.units for axis in self._axes for kind in ("dest", "pos", "load")}
        return Trace(time, dict(columns), {name: units.get(name, "") for name, _ in columns})

    def release(self) -> None:
        """Gives the board to the thread that uses it next."""
        self._native.release()

    def __repr__(self) -> str:
        programs = ", ".join(f"{thread}: {program.path.name}" for thread, program in self._programs.items())
        return f"<cc67.Board {self._native.number}: {programs or 'no program'}>"


def _split(items: str) -> list[str]:
    """The parts of a list; commas within brackets belong to an expression."""
    parts, depth, part = [], 0, ""
    for character in items:
        depth += (character in "([") - (character in ")]")
        if character == "," and depth == 0:
            parts.append(part.strip())
            part = ""
        else:
            part += character
    return [*parts, part.strip()]


def _program(source: Source, thread: int | None) -> Program:
    if isinstance(source, Program):
        return source
    if not isinstance(source, (str, os.PathLike)):
        raise TypeError(f"a program is a cc67.Program or a file, not {source!r}")
    if Path(source).suffix.lower() == ".out":
        return load(source, thread=thread)
    return compile(source, thread=thread)


def _rows(sources: Any) -> list[tuple[int | None, Source]]:
    if isinstance(sources, Mapping):
        for thread in sources:
            _check_thread(thread)
        return list(sources.items())
    if isinstance(sources, (str, os.PathLike, Program)):
        return [(None, sources)]
    if not isinstance(sources, Iterable):
        raise TypeError(f"programs must be programs or files, not {sources!r}")
    return [(None, source) for source in sources]


def _assign(programs: Any, load: Any) -> list[tuple[int, Program, bool]]:
    """Gives each program its thread: the one it is for, else the lowest free one."""
    rows = [(*row, True) for row in _rows(programs)] + [(*row, False) for row in _rows(load)]
    made = [(thread, _program(source, thread), starts) for thread, source, starts in rows]
    fixed = [(thread or program.thread, program, starts) for thread, program, starts in made]
    free = iter([n for n in range(1, 8) if n not in {thread for thread, _, _ in fixed}])
    result = []
    for thread, program, starts in fixed:
        number = thread or next(free, None)
        if number is None:
            raise InputError("more programs than the 7 user threads")
        result.append((number, program, starts))
    return result


def _settings(settings: Mapping[str, object] | Iterable[str]) -> list[tuple[str, str]]:
    pairs = []
    for text in _pairs(settings, "set"):
        key, _, value = text.partition("=")
        for name, mark in (("persist.float.", "f:"), ("persist.double.", "d:")):
            if key.startswith(name):
                key, value = f"persist.{key.removeprefix(name)}", mark + value
        pairs.append((key, value))
    return pairs


def _pairs(pairs: Mapping[str, object] | Iterable[str], name: str) -> list[str]:
    if isinstance(pairs, (str, bytes)):
        raise TypeError(f"{name} must be a mapping or a list of KEY=VALUE, not the text {pairs!r}")
    if isinstance(pairs, Mapping):
        return [f"{key}={_value(value)}" for key, value in pairs.items()]
    texts = [str(pair) for pair in pairs]
    for text in texts:
        if "=" not in text:
            raise InputError(f"{name}: {text!r} has no `=`")
    return texts


def _value(value: object) -> str:
    """A value as TOML has it."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_inner(each)}" for key, each in value.items()) + " }"
    if isinstance(value, Sequence) and not isinstance(value, str):
        return "[" + ", ".join(_inner(each) for each in value) + "]"
    return str(value)


def _inner(value: object) -> str:
    return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"' if isinstance(value, str) else _value(value)


def _machine(machine: PathLike) -> tuple[str, str, str]:
    """Name, folder and text of a machine file; a text with a line end or a table is one itself."""
    text = os.fspath(machine)
    if isinstance(machine, str) and ("\n" in text or text.lstrip().startswith("[")):
        return ("machine", ".", text)
    path = Path(text)
    return (str(path), str(path.parent), _text(path))


def _stimuli(stim: PathLike | Iterable[PathLike]) -> list[tuple[str, str]]:
    if isinstance(stim, (str, os.PathLike)):
        stim = [stim]
    result = []
    for each in stim:
        if isinstance(each, str) and (any(mark in each for mark in " =\n") and not Path(each).exists()):
            result.append(("stim", each))
        else:
            result.append((os.fspath(each), _text(Path(each))))
    return result


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except UnicodeDecodeError:
        raise InputError(f"{path} is not text") from None
