"""The pytest plugin of cc67, active wherever the package is installed.

    @pytest.mark.cc67(programs=["home.c"], machine="mill.toml")
    @pytest.mark.cc67_engines("native", "bytecode")
    def test_homing(board, expect, assert_console):
        expect(board).printed("homed", within=20.0)
        expect(board).position("X", 0, tolerance=0.5)
        assert_console(board)

`board` is the board that the marker describes; its files are relative to the folder of the test. `make_board` makes
more boards. When a test fails, the plugin repeats on new boards what the test did, with a trace, and keeps a table and
a plot of it.
"""

from __future__ import annotations

import difflib
import os
import re
from pathlib import Path
from typing import Any, Callable, Generator, Iterator, Mapping

import pytest

from ._board import Board, Condition, printed
from ._errors import Error, ExpectationError
from ._parts import Axis
from ._program import Program

__all__ = ["AssertConsole", "Expect", "MakeBoard"]

MakeBoard = Callable[..., Board]
AssertConsole = Callable[..., None]

_MADE: pytest.StashKey[list[tuple[Board, dict[str, Any]]]] = pytest.StashKey()

# Most samples in the trace of a failed test; a longer run is sampled less often.
_SAMPLES = 20_000


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options and settings of the plugin."""
    group = parser.getgroup("cc67", "simulated KFLOP boards")
    group.addoption(
        "--cc67-bless",
        "--bless",
        action="store_true",
        dest="cc67_bless",
        help="write the current consoles to their golden files; review them before you keep them",
    )
    group.addoption(
        "--cc67-engine",
        choices=["native", "bytecode", "both"],
        dest="cc67_engine",
        help="engine of tests without the marker cc67_engines: native (default), bytecode or both",
    )
    group.addoption(
        "--cc67-attach",
        metavar="DIR",
        dest="cc67_attach",
        help="folder for traces and plots of failed tests (default: cc67-failed in pytest's cache); `none`: no traces",
    )
    parser.addini("cc67_engine", "engine that executes programs: native, bytecode or both", default="native")


def pytest_configure(config: pytest.Config) -> None:
    """Add the markers of the plugin."""
    config.addinivalue_line("markers", "cc67(**options): arguments of cc67.Board for the fixture `board`")
    config.addinivalue_line("markers", "cc67_engines(*names): engines to run the test on, native and bytecode")


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Make one test for each engine of a test that has several."""
    if "cc67_engine" not in metafunc.fixturenames:
        return
    marker = metafunc.definition.get_closest_marker("cc67_engines")
    names = list(marker.args) if marker else _usual_engines(metafunc.config)
    for name in names:
        if name not in ("native", "bytecode"):
            raise pytest.UsageError(f"an engine must be native or bytecode, not {name!r}")
    if marker or len(names) > 1:
        metafunc.parametrize("cc67_engine", names)


def _usual_engines(config: pytest.Config) -> list[str]:
    name = config.getoption("cc67_engine") or config.getini("cc67_engine")
    return ["native", "bytecode"] if name == "both" else [str(name)]


@pytest.fixture
def cc67_engine(request: pytest.FixtureRequest) -> str:
    """The engine that executes the programs of the test: "native" or "bytecode"."""
    return _usual_engines(request.config)[0]


@pytest.fixture
def make_board(request: pytest.FixtureRequest, cc67_engine: str) -> MakeBoard:
    """A function that makes boards: `make_board(programs=["home.c"])`, with the arguments of `cc67.Board`.

    Relative file names start from the folder of the test.
    """
    folder = request.path.parent
    made: list[tuple[Board, dict[str, Any]]] = request.node.stash.setdefault(_MADE, [])

    def make(*programs: Any, **options: Any) -> Board:
        if programs:
            options["programs"] = programs[0]
        options.setdefault("engine", cc67_engine)
        options = {key: _beside(folder, key, value) for key, value in options.items()}
        board = Board(**options)
        made.append((board, options))
        return board

    return make


@pytest.fixture
def board(request: pytest.FixtureRequest, make_board: MakeBoard) -> Board:
    """The board described by the marker `cc67(...)`; without a marker, a board without programs."""
    options: dict[str, Any] = {}
    for marker in reversed(list(request.node.iter_markers("cc67"))):
        options.update(marker.kwargs)
        if marker.args:
            options["programs"] = list(marker.args)
    return make_board(**options)


@pytest.fixture
def expect() -> Callable[[Board], Expect]:
    """Expectations of a board: `expect(board).position("X", 100, tolerance=0.5, within=2.0)`."""
    return Expect


@pytest.fixture
def assert_console(request: pytest.FixtureRequest) -> AssertConsole:
    """A function that compares a board's console with its golden file; `pytest --cc67-bless` writes that file.

    The golden file has the lines of the console. It is `FILE/TEST.expected` in the folder of the test, or the file
    given as the second argument, and is the same for all engines.
    """
    config = request.config
    name = request.node.originalname if isinstance(request.node, pytest.Function) else request.node.name
    usual = request.path.parent / request.path.stem / f"{name}.expected"

    def check(board: Board, golden: str | os.PathLike[str] | None = None) -> None:
        __tracebackhide__ = True
        path = usual if golden is None else request.path.parent / golden
        shown = board.console.text
        if config.getoption("cc67_bless"):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(shown, encoding="utf-8", newline="\n")
            return
        if not path.exists():
            pytest.fail(f"there is no golden file {path}; `pytest --cc67-bless` writes it\n{shown}", pytrace=False)
        wanted = path.read_text(encoding="utf-8")
        if wanted != shown:
            lines = difflib.unified_diff(
                wanted.splitlines(), shown.splitlines(), str(path), "the console", lineterm="", n=2
            )
            pytest.fail("the console differs from its golden file\n" + "\n".join(lines), pytrace=False)

    return check


class Expect:
    """Expectations of a board, now or within some seconds of board time.

    Without `within`, the expectation must be met now. With it, the board runs until the expectation is met, for at most
    `within` seconds of board time. If it is not met, `cc67.ExpectationError`, an `AssertionError`, says what was found
    instead.
    """

    def __init__(self, board: Board) -> None:
        self._board = board

    def that(self, condition: Condition, within: float = 0.0) -> None:
        """Expect a condition of `Board.run_until` to be met."""
        __tracebackhide__ = True
        if not self._board.run_until(condition, within):
            self._fail(f"{_describe(condition)} is not met", within)

    def printed(self, text: str, within: float = 0.0) -> None:
        """Expect a console line that contains the text, already printed or printed in time."""
        __tracebackhide__ = True
        if text in self._board.console or (within > 0 and self._board.run_until(printed(text), within)):
            return
        last = self._board.console[-1:]
        self._fail(f"no console line contains {text!r}; the last one is {last[0]!r}" if last else
                   f"no console line contains {text!r}; the console is empty", within)

    def value(self, expression: str, expected: float, tolerance: float = 0.0, within: float = 0.0) -> None:
        """Expect an expression to have a value, within ± `tolerance`."""
        __tracebackhide__ = True
        # The thread of `3:count` must come before the whole expression.
        thread, rest = re.fullmatch(r"(\d+:)?(.*)", expression, re.DOTALL).groups("")  # type: ignore[union-attr]
        near = f"{thread}({rest}) - ({expected!r}) <= {tolerance!r} && ({expected!r}) - ({rest}) <= {tolerance!r}"
        if not self._board.run_until(near, within):
            found = self._board.read(expression)
            self._fail(f"{expression} is {found:.10g}, not {_range(expected, tolerance)}", within)

    def dest(self, axis: int | str, expected: float, tolerance: float = 0.0, within: float = 0.0) -> None:
        """Expect the commanded position of an axis, in its units, within ± `tolerance`."""
        __tracebackhide__ = True
        self.value(f"chan[{self._axis(axis).index}].Dest", expected, tolerance, within)

    def position(self, axis: int | str, expected: float, tolerance: float = 0.0, within: float = 0.0) -> None:
        """Expect the measured position of an axis, in its units, within ± `tolerance`."""
        __tracebackhide__ = True
        self.value(f"chan[{self._axis(axis).index}].Position", expected, tolerance, within)

    def enabled(self, axis: int | str, expected: bool = True, within: float = 0.0) -> None:
        """Expect an axis to be enabled, or disabled if `expected` is False."""
        __tracebackhide__ = True
        number = self._axis(axis).index
        if not self._board.run_until(f"(chan[{number}].Enable != 0) == {int(expected)}", within):
            self._fail(f"axis {axis} is {'dis' if expected else 'en'}abled", within)

    def bit(self, number: int, level: bool = True, within: float = 0.0) -> None:
        """Expect a bit to have a level."""
        __tracebackhide__ = True
        if not self._board.run_until(f"bit{number} == {int(level)}", within):
            self._fail(f"bit {number} is {int(not level)}", within)

    def ended(self, within: float = 0.0) -> None:
        """Expect all programs to have ended and nothing to move."""
        __tracebackhide__ = True
        if not (self._board.run(within) if within else self._board.ended):
            active = [str(thread) for thread in range(1, 8) if self._board.active(thread)]
            self._fail(f"threads still active: {', '.join(active)}" if active else "something still moves", within)

    def _axis(self, axis: int | str) -> Axis:
        return self._board.axes[axis]

    def _fail(self, what: str, within: float) -> None:
        __tracebackhide__ = True
        waited = f" after {within:g} s" if within else ""
        raise ExpectationError(f"{what}{waited} (board time {self._board.time:.6f} s)")


def _range(expected: float, tolerance: float) -> str:
    return f"{expected:.10g} ± {tolerance:g}" if tolerance else f"{expected:.10g}"


def _describe(condition: Condition) -> str:
    return f"`{condition}`" if isinstance(condition, str) else repr(condition)


def _beside(folder: Path, key: str, value: Any) -> Any:
    """Make the file names in an argument of `Board` relative to the folder of the test."""
    if key in ("programs", "load"):
        return _sources(folder, value)
    if key in ("machine", "files"):
        return _file(folder, value, suffixes=(".toml",) if key == "machine" else None)
    if key == "stim":
        texts = [value] if isinstance(value, (str, os.PathLike)) else list(value)
        return [_file(folder, text, suffixes=(".stim", ".txt")) for text in texts]
    return value


def _sources(folder: Path, value: Any) -> Any:
    if isinstance(value, Mapping):
        return {thread: _sources(folder, source) for thread, source in value.items()}
    if isinstance(value, (str, os.PathLike)):
        return folder / value
    return value if isinstance(value, Program) else [_sources(folder, source) for source in value]


def _file(folder: Path, value: Any, suffixes: tuple[str, ...] | None) -> Any:
    if isinstance(value, os.PathLike) or (isinstance(value, str) and (not suffixes or value.endswith(suffixes))):
        return folder / value
    return value


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]) -> Generator[None, Any, None]:
    """Add the boards of a failed test to its report, with their consoles and traces."""
    outcome = yield
    report = outcome.get_result()
    if report.when != "call" or not report.failed:
        return
    made: list[tuple[Board, dict[str, Any]]] = item.stash[_MADE] if _MADE in item.stash else []
    for number, (board, options) in enumerate(made, start=1):
        title = "board" if number == 1 else f"board {number}"
        try:
            report.sections.append((f"cc67 {title}", "\n".join(_summary(board))))
            for line in _attach(item, title, board, options):
                report.sections.append((f"cc67 {title} trace", line))
        except Error as error:
            # The report of the failure matters more than this addition to it.
            report.sections.append((f"cc67 {title}", f"cannot be shown: {error}"))


def _summary(board: Board) -> Iterator[str]:
    yield f"{board!r} at {board.time:.6f} s"
    yield from (f"{time:12.6f}  {line}" for time, line in zip(board.console.times, board.console))
    yield from (f"remark: {remark}" for remark in board.remarks)
    yield from (repr(axis) for axis in board.axes if axis.enabled or axis.dest or axis.position)


def _attach(item: pytest.Item, title: str, board: Board, options: dict[str, Any]) -> Iterator[str]:
    """Repeat the run with a trace; save it as a table and a plot, and yield their paths."""
    folder = _folder(item)
    recording, is_complete = board._native.recording()
    if folder is None or board.tick == 0:
        return
    if not is_complete:
        yield "no trace: the board was changed in a way that cannot be repeated"
        return
    axes = [axis.index for axis in board.axes if axis.enabled or axis.dest or axis.position] or [0]
    again = Board(**{**options, "on_fault": "keep", "stim": [*options.get("stim", []), *([recording] if recording else [])]})
    every = -(-board.tick // _SAMPLES)
    trace = again.trace([f"{kind}{axis}" for axis in axes for kind in ("dest", "pos")], board.time, every=every)
    folder.mkdir(parents=True, exist_ok=True)
    base = folder / (re.sub(r"[^A-Za-z0-9_.-]+", "_", item.nodeid) + ("" if title == "board" else f"_{title[6:]}"))
    for suffix, write in ((".csv", trace.save), (".svg", trace.picture)):
        path = Path(f"{base}{suffix}")
        write(path)
        yield str(path)


def _folder(item: pytest.Item) -> Path | None:
    chosen = item.config.getoption("cc67_attach")
    if chosen == "none":
        return None
    if chosen:
        return Path(chosen)
    cache = getattr(item.config, "cache", None)
    return None if cache is None else Path(cache.mkdir("cc67-failed"))
