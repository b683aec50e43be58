"""The pytest plugin, tested as its users run it: in a separate pytest."""

from __future__ import annotations

from pathlib import Path

import pytest
from conftest import COUNT, MOVE

pytest_plugins = ["pytester"]

MACHINE = '[axis.0]\nname = "X"\n'


@pytest.fixture
def tests(pytester: pytest.Pytester) -> pytest.Pytester:
    """A folder with programs."""
    pytester.path.joinpath("move.c").write_text(MOVE)
    pytester.path.joinpath("count.c").write_text(COUNT)
    pytester.path.joinpath("mill.toml").write_text(MACHINE)
    return pytester


GOOD = """
import pytest, cc67

@pytest.mark.cc67(programs=["move.c"], machine="mill.toml")
@pytest.mark.cc67_engines("native", "bytecode")
def test_move(board, expect, assert_console):
    expect(board).enabled("X", within=0.1)
    expect(board).dest(0, 1000, tolerance=1, within=2.0)
    expect(board).position("X", 1000, tolerance=3)
    expect(board).that("ch0->Dest > 1500", within=1.0)
    expect(board).printed("at 2000", within=5.0)
    expect(board).value("ch0->Vel", 1000)
    expect(board).ended(within=1.0)
    assert_console(board)

@pytest.mark.cc67("count.c", stim="at 0.1s bit 136 = 1")
def test_count(board, make_board, expect):
    expect(board).bit(136, True, within=0.2)
    expect(board).value("count", 1, within=0.1)
    other = make_board(programs={3: "count.c"})
    expect(other).value("3:count", 0)
    expect(other).bit(136, False)

def test_without_a_marker(board):
    assert board.command("ReadBit136") == "0"
"""


def test_consoles_are_compared_with_golden_files(tests: pytest.Pytester) -> None:
    tests.makepyfile(test_machine=GOOD)
    tests.runpytest_subprocess("-k", "move").assert_outcomes(failed=2)
    tests.runpytest_subprocess("--cc67-bless").assert_outcomes(passed=4)
    golden = tests.path / "test_machine" / "test_move.expected"
    assert golden.read_text() == "at 2000 after 2.30 s\n"
    tests.runpytest_subprocess().assert_outcomes(passed=4)
    golden.write_text("at 2001\n")
    result = tests.runpytest_subprocess("-k", "move")
    result.assert_outcomes(failed=2)
    result.stdout.fnmatch_lines(["*-at 2001", "*+at 2000 after 2.30 s"])


def test_both_engines_are_an_option(tests: pytest.Pytester) -> None:
    tests.makepyfile(test_machine=GOOD)
    result = tests.runpytest_subprocess("--cc67-engine", "both", "-k", "count or marker", "-v")
    result.assert_outcomes(passed=4)
    result.stdout.fnmatch_lines(["*test_count?native? PASSED*", "*test_count?bytecode? PASSED*"])
    result = tests.runpytest_subprocess("--cc67-engine", "bytecode", "-k", "count")
    result.assert_outcomes(passed=1)


BAD = """
import pytest

@pytest.mark.cc67(programs=["move.c"])
def test_wrong(board, expect):
    expect(board).printed("at 2001", within=5.0)

@pytest.mark.cc67(programs=["count.c"])
def test_by_hand(board, expect):
    board.bits[136] = True
    board.run_for(0.5)
    expect(board).value("count", 2, tolerance=0.5)

@pytest.mark.cc67(programs=["count.c"])
def test_changed(board, expect):
    board.write("count", 2)
    board.run_for(0.1)
    expect(board).bit(136, within=0.1)
"""


def test_a_failure_has_console_trace_and_picture(tests: pytest.Pytester, tmp_path: Path) -> None:
    tests.makepyfile(test_machine=BAD)
    folder = tmp_path / "kept"
    result = tests.runpytest_subprocess("--cc67-attach", str(folder), "--junit-xml", "report.xml")
    result.assert_outcomes(failed=3)
    result.stdout.fnmatch_lines(
        [
            "*ExpectationError: no console line contains 'at 2001'; the last one is 'at 2000 after 2.30 s' after 5 s*",
            "*2.3*  at 2000 after 2.30 s",
        ]
    )
    result.stdout.fnmatch_lines(["*ExpectationError: count is 1, not 2 ± 0.5 (board time 0.500040 s)*"])
    result.stdout.fnmatch_lines(["*ExpectationError: bit 136 is 0 after 0.1 s*", "*no trace: the board was changed*"])
    names = sorted(path.name for path in folder.iterdir())
    assert names == [f"test_machine.py_{test}{suffix}" for test in ("test_by_hand", "test_wrong") for suffix in (".csv", ".svg")]
    table = (folder / "test_machine.py_test_wrong.csv").read_text().splitlines()
    assert table[0] == "time,dest0,pos0" and table[-1].split(",")[1] == "2000"
    assert (folder / "test_machine.py_test_wrong.svg").read_text().startswith("<svg")
    assert "ExpectationError" in (tests.path / "report.xml").read_text()


def test_an_unknown_engine_is_refused(tests: pytest.Pytester) -> None:
    tests.makepyfile("import pytest\n@pytest.mark.cc67_engines('quantum')\ndef test_it(board): pass\n")
    result = tests.runpytest_subprocess()
    assert result.ret != 0
    result.stdout.fnmatch_lines(["*an engine must be native or bytecode, not 'quantum'*"])
