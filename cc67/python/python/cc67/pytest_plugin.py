"""The pytest plugin of cc67, which is there wherever the package is installed.

    @pytest.mark.cc67(programs=["home.c"], machine="mill.toml")
    @pytest.mark.cc67_engines("native", "bytecode")
    def test_homing(board, expect, assert_console):
        expect(board).printed("homed", within=20.0)
        expect(board).position("X", 0, tolerance=0.5)
        assert_console(board)

`board` is the board of the marker, whose files are beside the test's. `make_board` makes further ones. What a test that
fails has done to its boards is done again with a trace, and both the picture and the table are kept.
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

# Samples of the trace of a test that fails; of a longer run every so many ticks.
_SAMPLES = 20_000


def pytest_addoption(parser: pytest.Parser) -> None:
    """Options and settings."""
    group = parser.getgroup("cc67", "simulated KFLOP boards")
    group.addoption(
        "--cc67-bless",
        "--bless",
        action="store_true",
        dest="cc67_bless",
        help="write what consoles show now into their golden files; read them before you keep them",
    )
    group.addoption(
        "--cc67-engine",
        choices=["native", "bytecode", "both"],
        dest="cc67_engine",
        help="what executes programs in tests that do not say: native (default), bytecode or both",
    )
    group.addoption(
        "--cc67-attach",
        metavar="DIR",
        dest="cc67_attach",
        help="folder of traces and pictures of failed tests; else cc67-failed in pytest's cache; `none` makes none",
    )
    parser.addini("cc67_engine", "what executes programs: native, bytecode or both", default="native")


def pytest_configure(config: pytest.Config) -> None:
    """Markers."""
    config.addinivalue_line("markers", "cc67(**options): the arguments of cc67.Board for the fixture `board`")
    config.addinivalue_line("markers", "cc67_engines(*names): the engines that the test runs on, native and bytecode")


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """A test of several engines is one test each."""
    if "cc67_engine" not in metafunc.fixturenames:
        return
    marker = metafunc.definition.get_closest_marker("cc67_engines")
    names = list(marker.args) if marker else _usual_engines(metafunc.config)
    for name in names:
        if name not in ("native", "bytecode"):
            raise pytest.UsageError(f"an engine is native or bytecode, not {name!r}")
    if marker or len(names) > 1:
        metafunc.parametrize("cc67_engine", names)


def _usual_engines(config: pytest.Config) -> list[str]:
    name = config.getoption("cc67_engine") or config.getini("cc67_engine")
    return ["native", "bytecode"] if name == "both" else [str(name)]


@pytest.fixture
def cc67_engine(request: pytest.FixtureRequest) -> str:
    """What executes the programs of the test: "native" or "bytecode"."""
    return _usual_engines(request.config)[0]


@pytest.fixture
def make_board(request: pytest.FixtureRequest, cc67_engine: str) -> MakeBoard:
    """Makes boards: `make_board(programs=["home.c"])`, with the arguments of `cc67.Board`.

    Names of files that are not paths from the root are relative to the folder of the test.
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
    """The board of the marker `cc67(...)`; without a marker an empty one."""
    options: dict[str, Any] = {}
    for marker in reversed(list(request.node.iter_markers("cc67"))):
        options.update(marker.kwargs)
        if marker.args:
            options["programs"] = list(marker.args)
    return make_board(**options)


@pytest.fixture
def expect() -> Callable[[Board], Expect]:
    """What is expected of a board: `expect(board).position("X", 100, tolerance=0.5, within=2.0)`."""
    return Expect


@pytest.fixture
def assert_console(request: pytest.FixtureRequest) -> AssertConsole:
    """Compares a board's console with its golden file; `pytest --cc67-bless` writes it.

    The file is `FILE/TEST.expected` beside the test's, or the name that is given; it has the lines of the console.
    All engines have the same.
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
            pytest.fail("the console is not as expected\n" + "\n".join(lines), pytrace=False)

    return check


class Expect:
    """What is expected of a board, at once or within some seconds of board time.

    Each raises `cc67.ExpectationError`, an `AssertionError`, with what was so instead. With `within` time passes until
    it is so; without, it has to be so now.
    """

    def __init__(self, board: Board) -> None:
        self._board = board

    def that(self, condition: Condition, within: float = 0.0) -> None:
        """A condition of `Board.run_until`."""
        __tracebackhide__ = True
        if not self._board.run_until(condition, within):
            self._fail(f"{_describe(condition)} is not so", within)

    def printed(self, text: str, within: float = 0.0) -> None:
        """A console line contains the text: one printed already, or one within the time."""
        __tracebackhide__ = True
        if text in self._board.console or (within > 0 and self._board.run_until(printed(text), within)):
            return
        last = self._board.console[-1:]
        self._fail(f"no console line contains {text!r}; the last one is {last[0]!r}" if last else
                   f"no console line contains {text!r}; there is none", within)

    def value(self, expression: str, expected: float, tolerance: float = 0.0, within: float = 0.0) -> None:
        """An expression has a value, give or take the tolerance."""
        __tracebackhide__ = True
        # `3:count` is of thread 3, which a whole expression has in front.
        thread, rest = re.fullmatch(r"(\d+:)?(.*)", expression, re.DOTALL).groups("")  # type: ignore[union-attr]
        near = f"{thread}({rest}) - ({expected!r}) <= {tolerance!r} && ({expected!r}) - ({rest}) <= {tolerance!r}"
        if not self._board.run_until(near, within):
            found = self._board.read(expression)
            self._fail(f"{expression} is {found:.10g}, not {_range(expected, tolerance)}", within)

    def dest(self, axis: int | str, expected: float, tolerance: float = 0.0, within: float = 0.0) -> None:
        """The destination of an axis, in its position units."""
        __tracebackhide__ = True
        self.value(f"chan[{self._axis(axis).index}].Dest", expected, tolerance, within)

    def position(self, axis: int | str, expected: float, tolerance: float = 0.0, within: float = 0.0) -> None:
        """The position of an axis, in its position units."""
        __tracebackhide__ = True
        self.value(f"chan[{self._axis(axis).index}].Position", expected, tolerance, within)

    def enabled(self, axis: int | str, expected: bool = True, within: float = 0.0) -> None:
        """Whether the servo of an axis is active."""
        __tracebackhide__ = True
        number = self._axis(axis).index
        if not self._board.run_until(f"(chan[{number}].Enable != 0) == {int(expected)}", within):
            self._fail(f"axis {axis} is {'dis' if expected else 'en'}abled", within)

    def bit(self, number: int, level: bool = True, within: float = 0.0) -> None:
        """The level of a bit."""
        __tracebackhide__ = True
        if not self._board.run_until(f"bit{number} == {int(level)}", within):
            self._fail(f"bit {number} is {int(not level)}", within)

    def ended(self, within: float = 0.0) -> None:
        """All programs have ended and nothing moves."""
        __tracebackhide__ = True
        if not (self._board.run(within) if within else self._board.ended):
            active = [str(thread) for thread in range(1, 8) if self._board.active(thread)]
            self._fail(f"threads {', '.join(active)} are active" if active else "something moves", within)

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
    """An argument of `Board`, with names of files relative to the folder of the test."""
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
    """What the boards of a failed test show, as sections of its report."""
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
            # The report of the failure matters more than what would have been beside it.
            report.sections.append((f"cc67 {title}", f"cannot be shown: {error}"))


def _summary(board: Board) -> Iterator[str]:
    yield f"{board!r} at {board.time:.6f} s"
    yield from (f"{time:12.6f}  {line}" for time, line in zip(board.console.times, board.console))
    yield from (f"remark: {remark}" for remark in board.remarks)
    yield from (repr(axis) for axis in board.axes if axis.enabled or axis.dest or axis.position)


def _attach(item: pytest.Item, title: str, board: Board, options: dict[str, Any]) -> Iterator[str]:
    """The run again, with a trace, as a table and a picture."""
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
