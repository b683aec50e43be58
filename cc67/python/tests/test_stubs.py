"""The type stubs name everything that the native module has, and nothing else."""

from __future__ import annotations

import ast
from pathlib import Path

import cc67
from cc67 import _native

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
