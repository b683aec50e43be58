"""The parts of a board that have numbers or names: bits, analog channels, axes, `persist`."""

from __future__ import annotations

import operator
import struct
from typing import TYPE_CHECKING, Any, Generic, Iterable, Iterator, NoReturn, SupportsIndex, TypeVar, overload

from . import _native
from ._axis_fields import AxisFields
from ._errors import Fixed, InputError, RangeError, UnknownNameError, unknown

__all__ = ["Adc", "Axes", "Axis", "Bits", "Console", "Dac", "Persist", "PersistDoubles", "PersistFloats"]

_Board = _native.Board

_FIELDS = {name: meaning for name, meaning, _ in _native.Board.field_names()}
_INTEGERS = {name for name, _, is_integer in _native.Board.field_names() if is_integer}
_NAMES = {
    "dest": "Dest",
    "position": "Position",
    "velocity": "Vel",
    "acceleration": "Accel",
    "jerk": "Jerk",
    "following_error": "LastFollowingError",
    "max_following_error": "MaxFollowingError",
    "output": "Output",
}


def _index(number: SupportsIndex, what: str, count: int) -> int:
    """Check the number of a part; unlike an index of Python, it must not be negative."""
    try:
        value = operator.index(number)
    except TypeError:
        raise TypeError(f"the number of the {what} must be an integer, not {number!r}") from None
    if not 0 <= value < count:
        raise IndexError(f"no such {what}: {value} (0 to {count - 1})")
    return value


def _number(value: float, what: str) -> float:
    """Convert a value to a number."""
    try:
        return float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{what} must be a number, not {value!r}") from None


class Console(list[str]):
    """The console lines that the programs have printed since power-up, without line ends.

    A list of lines; `text in console` is true if any line contains the text. `times` has the board time of each line,
    in seconds since power-up; `text` has all lines as one string.
    """

    def __init__(self, lines: list[tuple[float, str]]) -> None:
        super().__init__(text for _, text in lines)
        self.times = [time for time, _ in lines]

    @property
    def text(self) -> str:
        """All lines, each with its line end."""
        return "".join(f"{line}\n" for line in self)

    def __contains__(self, text: object) -> bool:
        return isinstance(text, str) and any(text in line for line in self)

    def __str__(self) -> str:
        return self.text


V = TypeVar("V")
W = TypeVar("W")


class Numbered(Fixed, Generic[V, W]):
    """Parts that have numbers: `part[3]`, `part[3:6]`. Unlike an index of Python, a number must not be negative."""

    __slots__ = ("_native",)
    _what: str
    _count: int

    def __init__(self, native: _Board) -> None:
        self._native = native

    def _get(self, number: int) -> V:
        raise NotImplementedError

    def _set(self, number: int, value: W) -> None:
        raise TypeError(f"the {self._what}s of a board can only be read")

    def _numbers(self, which: slice) -> range:
        """Check a slice: unlike one of Python, it must lie within."""
        for number in (which.start, which.stop):
            if number is not None:
                _index(number, self._what, self._count + 1)
        return range(*which.indices(self._count))

    @overload
    def __getitem__(self, which: SupportsIndex) -> V: ...
    @overload
    def __getitem__(self, which: slice) -> list[V]: ...
    def __getitem__(self, which: SupportsIndex | slice) -> V | list[V]:
        if isinstance(which, slice):
            return [self._get(number) for number in self._numbers(which)]
        return self._get(_index(which, self._what, self._count))

    @overload
    def __setitem__(self, which: SupportsIndex, value: W) -> None: ...
    @overload
    def __setitem__(self, which: slice, value: Iterable[W]) -> None: ...
    def __setitem__(self, which: SupportsIndex | slice, value: Any) -> None:
        if not isinstance(which, slice):
            self._set(_index(which, self._what, self._count), value)
            return
        numbers, values = self._numbers(which), list(value)
        if len(numbers) != len(values):
            raise InputError(f"{len(values)} values for {len(numbers)} {self._what}s")
        for number, each in zip(numbers, values):
            self._set(number, each)

    def __len__(self) -> int:
        return self._count

    def __iter__(self) -> Iterator[V]:
        return map(self._get, range(self._count))


class Bits(Numbered[bool, bool]):
    """The input and output bits, 0 to 2047: `board.bits[46]` is a level, `board.bits[136:140]` a list of them.

    An assignment drives an input at once, as a switch would. Only the board drives outputs: assigning one raises
    `InputError`; use `board.command("SetBit46")`.
    """

    __slots__ = ()
    _what, _count = "bit", 2048

    def _get(self, number: int) -> bool:
        return self._native.bit(number)

    def _set(self, number: int, value: bool) -> None:
        if value not in (0, 1):
            raise TypeError(f"a bit must be True or False, not {value!r}")
        self._native.drive(number, bool(value))


class Adc(Numbered[int, float]):
    """The analog inputs 0 to 7, in counts from -2048 to 2047 for -10 V to 10 V.

    An assignment takes effect at the beginning of the next servo tick; reading gives the old value until the board has
    sampled the new one.
    """

    __slots__ = ()
    _what, _count = "analog input", 8

    def _get(self, number: int) -> int:
        return int(self._native.read(f"adc{number}"))

    def _set(self, number: int, value: float) -> None:
        counts = _number(value, "the value of an analog input")
        if not -2048 <= counts <= 2047:
            raise RangeError(f"an analog input must be -2048 to 2047 counts, not {value!r}")
        self._native.act(f"adc {number} = {round(counts)}")


class Dac(Numbered[int, NoReturn]):
    """The analog outputs 0 to 7, in counts from -2048 to 2047; only the board changes them."""

    __slots__ = ()
    _what, _count = "analog output", 8

    def _get(self, number: int) -> int:
        return int(self._native.read(f"dac{number}"))


class Axis(AxisFields):
    """An axis of the board, 0 to 7.

    Every numeric field of the board's structure `chan[n]` is also an attribute under its C name: `axis.Vel`, `axis.P`,
    `axis.OutputMode`; `dir(axis)` lists them. An assignment stores the value at once, as a program would. What sends a
    script command (`enabled = …`, `done`, `enable`, `disable`, `move`, `jog`) takes about 2.5 ms of board time.

    Attributes:
        index: the number of the axis.
        name: the name in the machine file, or "".
        units: the unit in the machine file, or "".
    """

    index: int
    name: str
    units: str
    _native: _Board

    def __init__(self, native: _Board, index: int, name: str, units: str) -> None:
        for key, value in (("_native", native), ("index", index), ("name", name), ("units", units)):
            object.__setattr__(self, key, value)

    @property
    def dest(self) -> float:
        """The commanded position, in units of the axis (`chan[n].Dest`)."""
        return self._field("Dest")

    @dest.setter
    def dest(self, value: float) -> None:
        self._store("Dest", value)

    @property
    def position(self) -> float:
        """The measured position, in units of the axis (`chan[n].Position`)."""
        return self._field("Position")

    @position.setter
    def position(self, value: float) -> None:
        self._store("Position", value)

    @property
    def enabled(self) -> bool:
        """Whether the servo is active (`chan[n].Enable`); an assignment sends the command EnableAxis or DisableAxis."""
        return self._field("Enable") != 0

    @enabled.setter
    def enabled(self, value: bool) -> None:
        self.enable() if value else self.disable()

    @property
    def following_error(self) -> float:
        """Dest minus position at the last servo tick, in units of the axis (`chan[n].LastFollowingError`)."""
        return self._field("LastFollowingError")

    @property
    def velocity(self) -> float:
        """The maximum velocity of moves, in units/s (`chan[n].Vel`)."""
        return self._field("Vel")

    @velocity.setter
    def velocity(self, value: float) -> None:
        self._store("Vel", value)

    @property
    def acceleration(self) -> float:
        """The maximum acceleration of moves, in units/s² (`chan[n].Accel`)."""
        return self._field("Accel")

    @acceleration.setter
    def acceleration(self, value: float) -> None:
        self._store("Accel", value)

    @property
    def jerk(self) -> float:
        """The maximum jerk of moves, in units/s³ (`chan[n].Jerk`)."""
        return self._field("Jerk")

    @jerk.setter
    def jerk(self, value: float) -> None:
        self._store("Jerk", value)

    @property
    def output(self) -> float:
        """The output that drives the axis, in the counts of its output mode (`chan[n].Output`)."""
        return self._field("Output")

    @property
    def load(self) -> float:
        """The position of the simulated load in machine coordinates, in units of the axis."""
        return self._native.read(f"load{self.index}")

    @property
    def done(self) -> bool:
        """Whether the last motion has finished: the reply to the script command CheckDone."""
        return "".join(self._native.command(b"CheckDone%d" % self.index)).strip() == "1"

    def enable(self) -> None:
        """Enable the axis at its current position: the script command EnableAxis."""
        self._command(f"EnableAxis{self.index}")

    def disable(self) -> None:
        """Disable the axis: the script command DisableAxis."""
        self._command(f"DisableAxis{self.index}")

    def move(self, dest: float) -> None:
        """Start a move to a destination in units of the axis: the script command Move."""
        self._command(f"Move{self.index}={_number(dest, 'a destination'):.10g}")

    def jog(self, velocity: float) -> None:
        """Move continuously at a velocity in units/s, or stop at 0: the script command Jog."""
        self._command(f"Jog{self.index}={_number(velocity, 'a velocity'):.10g}")

    def _command(self, line: str) -> None:
        self._native.command(line.encode("ascii"))

    def _field(self, name: str) -> float:
        value = self._native.field(self.index, name)
        if value is None:
            raise unknown("field of an axis", name, [*_NAMES, *_FIELDS])
        return value

    def _store(self, field: str, value: float) -> None:
        self._native.set_field(self.index, field, _number(value, f"{field} of an axis"))

    # Type checkers go by the names in `AxisFields`.
    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> float:
            if name.startswith("_") or name not in _FIELDS:
                known = [*_NAMES, "enabled", "load", "done", *_FIELDS]
                raise AttributeError(str(unknown("attribute of an axis", name, known)))
            value = self._field(name)
            return int(value) if name in _INTEGERS else value

        def __setattr__(self, name: str, value: float) -> None:
            if isinstance(getattr(type(self), name, None), property):
                object.__setattr__(self, name, value)
            elif name in _FIELDS:
                self._store(name, value)
            else:
                raise AttributeError(str(unknown("attribute of an axis", name, [*_NAMES, "enabled", *_FIELDS])))

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *_FIELDS]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Axis) and self.index == other.index and self._native is other._native

    def __hash__(self) -> int:
        return hash((self.index, id(self._native)))

    def __repr__(self) -> str:
        name = f" {self.name!r}" if self.name else ""
        return f"<cc67.Axis {self.index}{name}: dest {self.dest:g}, position {self.position:g}>"


class Axes(Fixed):
    """The axes of the board: `board.axes[0]`, or by the name in the machine file, `board.axes["Slide"]`."""

    __slots__ = ("_axes",)

    def __init__(self, native: _Board) -> None:
        self._axes = [Axis(native, index, name, units) for index, (name, units) in enumerate(native.axes)]

    def __getitem__(self, which: SupportsIndex | str) -> Axis:
        if isinstance(which, str):
            found = [axis for axis in self._axes if axis.name and axis.name == which]
            if not found:
                names = [axis.name for axis in self._axes if axis.name]
                if not names:
                    raise UnknownNameError(f"no such axis: {which!r}; the machine file names none")
                raise unknown("axis", which, names)
            return found[0]
        return self._axes[_index(which, "axis", len(self._axes))]

    def __len__(self) -> int:
        return len(self._axes)

    def __iter__(self) -> Iterator[Axis]:
        return iter(self._axes)


class PersistFloats(Numbered[float, float]):
    """The elements of `persist.UserData` as 32-bit floats: `board.persist.float[5] = 1.25`."""

    __slots__ = ()
    _what, _count = "element of persist", 200

    def _get(self, number: int) -> float:
        (value,) = struct.unpack("<f", struct.pack("<i", _word(self._native, number)))
        return float(value)

    def _set(self, number: int, value: float) -> None:
        try:
            word = struct.pack("<f", _number(value, "an element of persist.float"))
        except OverflowError:
            raise RangeError(f"{value!r} does not fit in a 32-bit float: -3.4028235e38 to 3.4028235e38") from None
        self._native.set_user_data(number, struct.unpack("<i", word)[0])


class PersistDoubles(Fixed):
    """Pairs of elements of `persist.UserData` as doubles: `board.persist.double[10]` is elements 10 and 11."""

    __slots__ = ("_native",)

    def __init__(self, native: _Board) -> None:
        self._native = native

    def __getitem__(self, index: SupportsIndex) -> float:
        first = _index(index, "double of persist", 199)
        words = struct.pack("<ii", _word(self._native, first), _word(self._native, first + 1))
        return float(struct.unpack("<d", words)[0])

    def __setitem__(self, index: SupportsIndex, value: float) -> None:
        first = _index(index, "double of persist", 199)
        low, high = struct.unpack("<ii", struct.pack("<d", _number(value, "an element of persist.double")))
        self._native.set_user_data(first, low)
        self._native.set_user_data(first + 1, high)


class Persist(Numbered[int, int]):
    """The board's `persist.UserData`, elements 0 to 199, as signed 32-bit integers; `board.persist[5:8]` is a list.

    `persist.float[n]` reads and writes element n as a float, `persist.double[n]` the elements n and n + 1 as a double.
    """

    __slots__ = ("_float", "_double")
    _what, _count = "element of persist", 200

    def __init__(self, native: _Board) -> None:
        super().__init__(native)
        self._float, self._double = PersistFloats(native), PersistDoubles(native)

    @property
    def float(self) -> PersistFloats:
        """The elements as floats."""
        return self._float

    @property
    def double(self) -> PersistDoubles:
        """The pairs of elements as doubles."""
        return self._double

    def _get(self, number: int) -> int:
        return _word(self._native, number)

    def _set(self, number: int, value: int) -> None:
        try:
            word = operator.index(value)
        except TypeError:
            hint = f"; use persist.float[{number}] or persist.double[{number}]"
            raise TypeError(f"an element of persist must be an integer, not {value!r}{hint}") from None
        if not -(2**31) <= word < 2**31:
            raise RangeError(f"{word} does not fit in an element of persist: {-(2**31)} to {2**31 - 1}")
        self._native.set_user_data(number, word)


def _word(native: _Board, number: int) -> int:
    value = native.user_data(number)
    assert value is not None, "the number is checked"
    return value
