"""The simulated board."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Callable, Iterable, Mapping, Sequence, Union

from . import _native
from ._errors import Error, Fixed, InputError
from ._parts import Adc, Axes, Bits, Console, Dac, Persist
from ._program import PathLike, Program, _check_thread, compile, load
from ._trace import Trace

__all__ = ["Board", "Condition", "Snapshot", "ended", "printed", "started"]


class _Event:
    """A condition of `Board.run_until` that is not an expression."""

    def __init__(self, kind: str, value: object) -> None:
        self._pair = (kind, str(value))

    def __repr__(self) -> str:
        kind, value = self._pair
        names = {"printed": f"cc67.printed({value!r})", "ended": f"cc67.ended({value})"}
        return names.get(kind, f"cc67.started({value})")


Condition = Union[str, _Event, Callable[["Board"], object]]
Source = Union[Program, PathLike]


def printed(text: str) -> _Event:
    """Make a condition for `Board.run_until`: from now on, a console line is printed that contains the text."""
    return _Event("printed", text)


def ended(thread: int) -> _Event:
    """Make a condition for `Board.run_until`: a thread, 1 to 7, is not active."""
    _check_thread(thread)
    return _Event("ended", thread)


def started(thread: int) -> _Event:
    """Make a condition for `Board.run_until`: a thread, 1 to 7, is active."""
    _check_thread(thread)
    return _Event("active", thread)


class Snapshot(Fixed):
    """The state of a board at one time, made by `Board.snapshot` and valid for that board only.

    Attributes:
        time: the board time of the snapshot, in seconds since power-up.
    """

    __slots__ = ("_native", "_number", "time")

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


class Board(Fixed):
    """A simulated KFLOP board with its programs and the machine around it.

    Board time passes only in `run`, `run_for`, `run_until`, `step`, `step_thread`, `trace` and `command`, and in what
    sends a script command for an axis, such as `Axis.move`. The same arguments and the same calls give the same
    results, on any computer and on either engine. While a call runs the board, other Python threads continue, and
    Ctrl-C stops the call. A board belongs to the Python thread that uses it first; `release` hands it over.

    Args:
        programs: the programs to load and start: a `Program`, a source (.c) to compile, an image (.out), or several of
            them. Each goes to the thread it was compiled for, else to the lowest free thread; a mapping
            `{3: program}` chooses the thread.
        machine: what is connected to the board: a machine file, its text, or a mapping of its keys,
            `{"axis.0.model": "motor"}`.
        stim: the stimulus, what happens around the board and when: a file, statements such as
            "at 0.5s bit 136 = 1", or several of both.
        set: start values and keys of the machine file, `{"persist.5": 3, "persist.float.6": 1.5}`.
        load: programs to load without starting them, in the same forms as `programs`.
        files: the folder for the files that programs open on the PC; by default that of the machine file, else
            "cc67-files".
        answers: the PC's answers to programs, `{"msgbox": "no"}`, as with `--answer`.
        assist: whether to act as an operator: when all programs wait for inputs, those inputs are toggled one at a
            time.
        engine: the engine that executes the programs, "native" or "bytecode"; the results are the same.
        shortcuts: whether to skip over waits instead of simulating every tick in full; the results are the same.
        uart_input: bytes for the serial port to receive, once a program first looks for them.
        on_fault: what to do at a trap, or when an expectation of the stimulus is not met. "raise" ends the call in
            progress with `TrapError` or `ExpectationError`; "keep" adds the exception to `faults` and continues.
        boot: your own firmware file, executed in place of the modelled firmware, as with `--boot`. Sources are compiled
            for it; a `Program` must have been compiled with the same `boot`.

    Raises:
        CompileError: a source has errors.
        LoadError: the board refuses a program.
        InputError: the machine file, the stimulus or another argument is invalid.
        OSError: a file cannot be read.

    Example:
        >>> board = cc67.Board(programs=["home.c"], machine="mill.toml")
        >>> board.run_until("ch0->Dest > 100", timeout=5.0)
        True
        >>> board.axes[0].position
        100.02
    """

    # Everything that the parts refer to is the native board, so that there is no cycle: the memory of the board is free
    # when the last reference to it goes.
    __slots__ = ("_native", "_compiled_for", "_programs", "_bits", "_adc", "_dac", "_axes", "_persist", "__weakref__")

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
        boot: PathLike | None = None,
    ) -> None:
        if on_fault not in ("raise", "keep"):
            raise InputError(f'on_fault must be "raise" or "keep", not {on_fault!r}')
        settings = _settings(set)
        if isinstance(machine, Mapping):
            settings = [*_settings(machine), *settings]
            machine = None
        boot = None if boot is None else os.fspath(boot)
        self._compiled_for: Mapping[str, Any] = {"boot": boot}
        assigned = _assign(programs, load, self._compiled_for)
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
            "boot": boot,
        }
        self._begin(_native.Board(request, engine), assigned, on_fault)

    @classmethod
    def _on(
        cls,
        controller: _native.Controller,
        programs: Any,
        load: Any,
        *,
        set: Mapping[str, object] | Iterable[str],
        files: PathLike | None,
        answers: Mapping[str, object] | Iterable[str],
        terms: dict[str, bool],
        on_fault: str,
    ) -> Board:
        """Make the board of a controller, for `connect`."""
        board = cls.__new__(cls)
        board._compiled_for = {"board": controller.board, "target": "c67x"}
        assigned = _assign(programs, load, board._compiled_for)
        request = {
            "programs": [(thread, program._native, starts) for thread, program, starts in assigned],
            "machine": None,
            "settings": _settings(set),
            "stim": [],
            "files": None if files is None else os.fspath(files),
            "answers": _pairs(answers, "answers"),
            "assist": False,
            "shortcuts": True,
            "uart_input": b"",
            "boot": None,
        }
        board._begin(_native.Board.on(controller, request, terms), assigned, on_fault)
        return board

    def _begin(self, native: _native.Board, assigned: list[tuple[int, Program, bool]], on_fault: str) -> None:
        self._native = native
        self._programs = {thread: program for thread, program, _ in assigned}
        self._bits, self._adc, self._dac = Bits(native), Adc(native), Dac(native)
        self._axes, self._persist = Axes(native), Persist(native)
        if on_fault == "keep":
            self._native.stop_at_faults(False)
            self._native.release()

    # Board time.

    @property
    def time(self) -> float:
        """Board time since power-up, in seconds."""
        return self._native.time()

    @property
    def tick(self) -> int:
        """Number of the last completed servo tick; a tick is 90 µs."""
        return self._native.tick()

    def run_for(self, seconds: float) -> None:
        """Run for `seconds` of board time, even if all programs have ended.

        Raises:
            TrapError: a trap stopped a thread; the run ends there.
            ExpectationError: an expectation of the stimulus is not met; the run ends there.
            InputError: `seconds` is not in the range 0 to 1e12.
            KeyboardInterrupt: Ctrl-C was pressed; the run ends there.
        """
        self._native.run_for(seconds)

    def run(self, timeout: float = 60.0) -> bool:
        """Run until all programs have ended and nothing moves, for at most `timeout` seconds of board time.

        As in `cc67 run`, the run then ends with `finish`.

        Returns:
            Whether all programs have ended and nothing moves; False after the timeout.

        Raises:
            TrapError, ExpectationError, InputError, KeyboardInterrupt: as in `run_for`.
        """
        return self._native.run(timeout)

    def run_until(self, condition: Condition, timeout: float = 60.0) -> bool:
        """Run until a condition is met, for at most `timeout` seconds of board time.

        Args:
            condition: a C expression with the names of the programs, `"count == 3 && ch0->Dest > 100"`;
                `printed("text")`, `ended(thread)` or `started(thread)`; or a function that takes the board. It is
                checked after every servo tick of 90 µs. A condition that is already met takes no board time.
            timeout: seconds of board time.

        Returns:
            Whether the condition was met; False after the timeout.

        Raises:
            InputError: the expression is invalid, or `timeout` is not in the range 0 to 1e12.
            TrapError, ExpectationError, KeyboardInterrupt: as in `run_for`.
            Exception: the function raised it.
        """
        if isinstance(condition, _Event):
            return self._native.run_until(condition._pair, timeout)
        if isinstance(condition, str):
            return self._native.run_until(condition, timeout)
        if not callable(condition):
            raise TypeError(f"condition must be an expression, an event or a function, not {condition!r}")
        end = self._native.after(timeout)
        while not condition(self):
            if self.tick >= end:
                return False
            self._native.step(1)
        return True

    def step(self, ticks: int = 1) -> None:
        """Run for `ticks` servo ticks of 90 µs each.

        Raises:
            InputError: `ticks` is negative.
            TrapError, ExpectationError, KeyboardInterrupt: as in `run_for`.
        """
        if isinstance(ticks, bool) or not isinstance(ticks, int):
            raise TypeError(f"ticks must be an integer, not {ticks!r}")
        if ticks < 0:
            raise InputError(f"board time cannot go back: {ticks} ticks")
        self._native.step(ticks)

    def step_thread(self, thread: int, timeout: float = 1.0) -> bool:
        """Run to the end of the next time slice of a thread, 1 to 7.

        Returns:
            Whether the thread had a slice within `timeout` seconds of board time.
        """
        return self._native.step_thread(thread, timeout)

    def finish(self) -> None:
        """End the run: print console text that still lacks its line end, and check what the stimulus expects "at end".

        `run` does this by itself.

        Raises:
            ExpectationError: an expectation of the stimulus is not met.
        """
        self._native.finish()

    @property
    def ended(self) -> bool:
        """Whether no thread is active and nothing that a program has begun is still under way."""
        return self._native.has_ended()

    # Programs.

    @property
    def programs(self) -> dict[int, Program]:
        """The programs that were loaded, by thread number."""
        return dict(self._programs)

    def load(self, program: Source, *, thread: int | None = None, start: bool = False) -> None:
        """Load a program into a thread, in which any other program is stopped first.

        Args:
            program: a `Program`, a source (.c) to compile, or an image (.out).
            thread: 1 to 7; by default the thread that the program is for, else 1.
            start: whether to start it as well.

        Raises:
            LoadError: the board refuses the program; the current program of the thread continues.
            CompileError: the source has errors.
        """
        made = _program(program, None, self._compiled_for)
        number = thread or made.thread or 1
        self._native.load(number, made._native, start)
        self._programs[number] = made

    def start(self, thread: int) -> None:
        """Start a thread, 1 to 7, at the beginning of its program.

        Raises:
            LoadError: no program is loaded in the thread.
        """
        self._native.start(thread)

    def stop(self, thread: int) -> None:
        """Stop a thread, 1 to 7, where it is."""
        self._native.stop(thread)

    def active(self, thread: int) -> bool:
        """Return whether a thread, 1 to 7, is active."""
        return self._native.is_active(thread)

    # Output, and script commands.

    @property
    def console(self) -> Console:
        """The console lines printed since power-up: a list of lines, with their `times` in seconds."""
        return Console(self._native.console(0))

    @property
    def remarks(self) -> list[str]:
        """The remarks of the simulation: inputs that nothing drives, axes without an output, requests to the PC."""
        return [text for _, text in self._native.remarks()]

    @property
    def faults(self) -> list[Exception]:
        """All traps since power-up, and expectations that were not met, as exceptions."""
        return self._native.faults()

    @property
    def uart(self) -> bytes:
        """The bytes that the serial port has sent since power-up."""
        return bytes(self._native.uart())

    @property
    def recording(self) -> str:
        """Everything that was done to the board by hand, as a stimulus that repeats it on another board.

        What a stimulus cannot repeat, such as most calls of `write`, is a comment in it. The text ends after 1 MiB, with
        a comment that says so.
        """
        return self._native.recording()[0]

    def command(self, line: str) -> str:
        """Send a line of script commands, `"ReadBit46"` or `"EnableAxis0;Move0=100"`, and return the reply.

        The call takes as much board time as the line and its reply take on the wire, about 2.5 ms. The lines of a
        longer reply are separated by line ends; the reply is "" if there is none.

        Raises:
            InputError: `line` has a line end.
            TrapError, ExpectationError: as in `run_for`.
        """
        if not isinstance(line, str):
            raise TypeError(f"a command must be a string, not {line!r}")
        if "\n" in line or "\r" in line:
            raise InputError("a command must be one line, without line ends")
        return "\n".join(self._native.command(line.encode("latin-1", "replace")))

    # Inputs, outputs, axes and variables.

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
        """The axes of the board, by number or by the name in the machine file."""
        return self._axes

    @property
    def persist(self) -> Persist:
        """The elements of `persist.UserData` as integers; also as `persist.float` and `persist.double`."""
        return self._persist

    def act(self, statement: str) -> None:
        """Execute a statement of a stimulus, `"pulse bit 137 for 50ms"`, at the beginning of the next servo tick.

        Raises:
            InputError: the statement is invalid; nothing happens.
        """
        self._native.act(statement)

    def send_uart(self, data: bytes) -> None:
        """Send bytes to the serial port; they arrive at its baud rate as board time passes."""
        self._native.send_to_uart(bytes(data))

    def read(self, expression: str) -> float:
        """Return the value of a C expression with the names of the programs, or of an item such as "dest0" or "adc2".

        `2:count` is the variable `count` of the program in thread 2. Reading changes nothing and takes no board time.
        An integer division by zero gives NaN.

        Raises:
            InputError: the expression is invalid; the message suggests the name that was probably meant.
        """
        if not isinstance(expression, str):
            raise TypeError(f"an expression is a text, not {expression!r}")
        return self._native.read(expression)

    def write(self, expression: str, value: float) -> None:
        """Store a value in a variable, a field or an element, as an assignment in C would: `write("count", 2)`.

        Writing takes no board time. An expression is compiled when it is used first, and then again when a program is
        loaded.

        Raises:
            InputError: the expression is invalid, or is not a variable, a field or an element.
            RangeError: it is an integer, and the value does not fit in its type; `RangeError` is an `OverflowError`.
        """
        if not isinstance(expression, str):
            raise TypeError(f"an expression is a text, not {expression!r}")
        if isinstance(value, (str, bytes)):
            raise TypeError(f"a value is a number, not {value!r}")
        self._native.write(expression, float(value))

    # Snapshots and traces.

    def snapshot(self) -> Snapshot:
        """Save the state of the board; `restore` returns to it, any number of times."""
        return Snapshot(self._native)

    def restore(self, snapshot: Snapshot) -> None:
        """Return to the state of a snapshot; from there, the same calls give the same results again.

        Raises:
            Error: the snapshot belongs to another board.
        """
        if not isinstance(snapshot, Snapshot):
            raise TypeError(f"snapshot must be a cc67.Snapshot, not {snapshot!r}")
        if snapshot._native is not self._native or not self._native.restore(snapshot._number):
            raise Error("the snapshot belongs to another board")

    def trace(self, items: str | Iterable[str], seconds: float, *, every: int = 1) -> Trace:
        """Run for `seconds` of board time and record values after every tick, or after every few ticks.

        Args:
            items: items and expressions, `"axis0,bit46"` or `["ch0->Dest - home", "persist.5"]`; `axis0` stands for
                `dest0`, `pos0` and `out0`.
            seconds: board time to run.
            every: servo ticks of 90 µs from one sample to the next.

        Returns:
            The values as NumPy arrays of doubles, which own their memory: `trace["dest0"]`, `trace.time`.

        Raises:
            InputError: an item is unknown, an expression is invalid, or the trace is too long.
            TrapError, ExpectationError, KeyboardInterrupt: as in `run_for`; what was recorded is lost.
        """
        if isinstance(every, bool) or not isinstance(every, int) or every < 1:
            raise InputError(f"every must be a number of ticks, at least 1, not {every!r}")
        names = _split(items) if isinstance(items, str) else [str(item) for item in items]
        time, columns = self._native.trace(names, seconds, every)
        units = {f"{kind}{axis.index}": axis.units for axis in self.axes for kind in ("dest", "pos", "load")}
        return Trace(time, dict(columns), {name: units.get(name, "") for name, _ in columns})

    def release(self) -> None:
        """Give up the board; it then belongs to the Python thread that uses it next."""
        self._native.release()

    def close(self) -> None:
        """Free the memory of the board now; using the board afterwards raises `Error`. `with` does this at its end."""
        self._native.close()

    def __enter__(self) -> Board:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        if self._native.is_closed:
            return "<cc67.Board, closed>"
        programs = ", ".join(f"{thread}: {program.path.name}" for thread, program in self._programs.items())
        return f"<cc67.Board {self._native.number}: {programs or 'no program'}>"


def _split(items: str) -> list[str]:
    """Split a list at its commas, except those within brackets, which belong to an expression."""
    parts, depth, part = [], 0, ""
    for character in items:
        depth += (character in "([") - (character in ")]")
        if character == "," and depth == 0:
            parts.append(part.strip())
            part = ""
        else:
            part += character
    return [*parts, part.strip()]


def _program(source: Source, thread: int | None, compiled_for: Mapping[str, Any]) -> Program:
    if isinstance(source, Program):
        return source
    if not isinstance(source, (str, os.PathLike)):
        raise TypeError(f"a program must be a cc67.Program or a file, not {source!r}")
    if Path(source).suffix.lower() == ".out":
        return load(source, thread=thread)
    return compile(source, thread=thread, **compiled_for)


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


def _assign(programs: Any, load: Any, compiled_for: Mapping[str, Any]) -> list[tuple[int, Program, bool]]:
    """Assign each program its thread: the one it is for, else the lowest free one."""
    rows = [(*row, True) for row in _rows(programs)] + [(*row, False) for row in _rows(load)]
    made = [(thread, _program(source, thread, compiled_for), starts) for thread, source, starts in rows]
    fixed = [(thread or program.thread, program, starts) for thread, program, starts in made]
    free = iter([n for n in range(1, 8) if n not in {thread for thread, _, _ in fixed}])
    result = []
    for thread, program, starts in fixed:
        number = thread or next(free, None)
        if number is None:
            raise InputError("there are more programs than the 7 user threads")
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
        raise TypeError(f"{name} must be a mapping or a list of KEY=VALUE, not the string {pairs!r}")
    if isinstance(pairs, Mapping):
        return [f"{key}={_value(value)}" for key, value in pairs.items()]
    texts = [str(pair) for pair in pairs]
    for text in texts:
        if "=" not in text:
            raise InputError(f"{name}: {text!r} has no `=`")
    return texts


def _value(value: object) -> str:
    """Write a value in the syntax of TOML."""
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
    """Return name, folder and text of a machine file; a string with a line end or a table is the text itself."""
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
