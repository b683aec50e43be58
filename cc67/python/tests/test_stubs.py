"""The type stubs name everything that the native module has, and nothing else."""

from __future__ import annotations

import ast
import os
import subprocess
import sys
from pathlib import Path

import pytest

import cc67
from cc67 import _native

FIELDS = Path(__file__).parent.parent / "python" / "cc67" / "_axis_fields.py"
STUBS = Path(cc67.__file__).parent / "_native.pyi"


def stubbed() -> dict[str, set[str]]:
    """The public names of the stubs: classes with those of their members, functions and values with none."""
    names: dict[str, set[str]] = {}
    for node in ast.parse(STUBS.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ClassDef):
            names[node.name] = members(node)
        elif isinstance(node, ast.FunctionDef):
            names[node.name] = set()
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            names[node.target.id] = set()
    return {name: each for name, each in names.items() if not name.startswith("__")}


def members(node: ast.ClassDef) -> set[str]:
    found = {each.name for each in node.body if isinstance(each, ast.FunctionDef)}
    found |= {each.target.id for each in node.body if isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Name)}
    return {name for name in found if not name.startswith("_")}


def test_stubs_name_what_the_module_has() -> None:
    has = {name for name in vars(_native) if not name.startswith("__")}
    assert set(stubbed()) == has


def test_stubs_name_the_members_of_each_class() -> None:
    for name, named in stubbed().items():
        each = getattr(_native, name)
        if isinstance(each, type) and not issubclass(each, BaseException):
            assert named == {member for member in vars(each) if not member.startswith("_")}, name


def field_source() -> str:
    """The source of the attributes of an axis that have the names of C, as the native module names them."""
    lines = [
        '"""The numeric fields of the board\'s structure `chan[n]`, so that type checkers know them.',
        "",
        "Made by `CC67_WRITE_FIELDS=1 pytest tests/test_stubs.py`; the test fails if it differs from the board's table.",
        '"""',
        "",
        "",
        "class AxisFields:",
        '    """The attributes of an axis that have the names of C."""',
        "",
    ]
    for name, meaning, is_integer in _native.Board.field_names():
        lines += [f"    {name}: {'int' if is_integer else 'float'}", f'    """{meaning}"""']
    return "\n".join(lines) + "\n"


def test_the_fields_of_an_axis_are_those_of_the_board() -> None:
    if os.environ.get("CC67_WRITE_FIELDS"):
        FIELDS.write_text(field_source(), encoding="utf-8", newline="")
    assert FIELDS.read_text(encoding="utf-8") == field_source()


def test_type_checkers_know_the_attributes(tmp_path: Path) -> None:
    source = """
import cc67
board = cc67.Board()
board.axes[0].Vel = 5.0
mode: int = board.axes[0].OutputMode
row: list[bool] = board.bits[136:138]
word: int = board.persist[5]
program = cc67.compile("a.c")
"""
    mistakes = ["board.axes[0].Velo", "board.tme = 5", "board.dac[0] = 5", 'board.persist[1] = "x"', "board.bits[1:3].level"]
    good, bad = tmp_path / "good.py", tmp_path / "bad.py"
    good.write_text(source)
    bad.write_text(source + "\n".join(mistakes) + "\n")
    mypy = [sys.executable, "-m", "mypy", "--strict", "--cache-dir", str(tmp_path / "cache")]
    checked = [subprocess.run([*mypy, str(path)], capture_output=True, text=True) for path in (good, bad)]
    if "No module named mypy" in checked[0].stderr:
        pytest.skip("mypy is not installed")
    assert checked[0].returncode == 0, checked[0].stdout
    first = source.count("\n") + 1
    found = {int(line.split(":")[1]) for line in checked[1].stdout.splitlines() if ": error:" in line}
    assert found == set(range(first, first + len(mistakes))), checked[1].stdout
