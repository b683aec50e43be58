"""The package itself: the command, images, help, types."""

from __future__ import annotations

import builtins
import pydoc
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import MOVE, WAIT, Write

import cc67
from cc67._command import run


def test_the_command_comes_along(write: Write) -> None:
    result = run(["run", str(write(MOVE))])
    assert (result.returncode, result.stdout) == (0, "at 2000 after 2.30 s\n"), result.stderr
    assert run(["--version"]).stdout.startswith(f"cc67 {cc67.__version__} ")
    assert run(["check", str(write("main() { x }"))]).returncode == 1
    assert run(["run"]).returncode == 2


def test_the_command_tests_programs(write: Write, tmp_path: Path) -> None:
    path = write(MOVE)
    assert run(["test", "--bless", str(path)]).returncode == 0
    result = run(["test", str(tmp_path)])
    assert result.returncode == 0 and "1 passed" in result.stdout + result.stderr


def test_the_script_is_installed() -> None:
    script = Path(sys.executable).parent / "cc67"
    if not script.exists():
        pytest.skip("the package is not installed in this environment")
    assert subprocess.run([script, "--version"], capture_output=True, text=True).stdout.startswith("cc67 ")


def test_help_reads_well() -> None:
    text = pydoc.plain(pydoc.render_doc(cc67.Board))
    for name in ("run_for", "run_until", "persist", "snapshot", "trace"):
        assert name in text
    assert "seconds" in text and "counts" in text
    undocumented = [name for name, each in vars(cc67.Board).items() if not name.startswith("_") and not each.__doc__]
    assert undocumented == []


def test_every_public_name_is_documented() -> None:
    assert [name for name in (*cc67.__all__, "compile") if name != "Condition" and not getattr(cc67, name).__doc__] == []


def test_importing_all_names_hides_none_of_python() -> None:
    names: dict[str, object] = {}
    exec("from cc67 import *", names)
    hidden = [name for name in names if hasattr(builtins, name) and not name.startswith("__")]
    assert hidden == [] and names["Board"] is cc67.Board


def test_an_image_is_looked_at(write: Write, tmp_path: Path) -> None:
    program = cc67.compile(write(MOVE))
    image = cc67.Image.of(program, thread=2)
    assert image.program is not None and image.symbol("main")["kind"] == "function"
    assert {".text", ".bss"} <= {section["name"] for section in image.sections}
    assert "main" in image.disassembly("main")
    path = tmp_path / "move(2).out"
    path.write_bytes(bytes(image))
    assert cc67.Image.read(path).symbols == image.symbols
    assert "main" in cc67.inspect(path)
    for look in (image.symbol, image.disassembly):
        with pytest.raises(cc67.UnknownNameError, match="did you mean 'main'"):
            look("mian")
    board = cc67.Board(programs=[path])
    assert list(board.programs) == [2]
    board.run()
    assert board.console == ["at 2000 after 2.30 s"]


def test_another_file_is_named(write: Write, tmp_path: Path) -> None:
    with pytest.raises(cc67.InputError, match="picture.out"):
        cc67.Image(b"\x89PNG\r\n\x1a\n" + bytes(100), "picture.out")
    with pytest.raises(OSError):
        cc67.Image.read(tmp_path / "missing.out")


def test_what_code_costs(write: Write, tmp_path: Path) -> None:
    text = cc67.cycles(write(WAIT))
    assert text.startswith("cycles at 200 MHz") and "main" in text
    with pytest.raises(cc67.InputError, match="missing"):
        cc67.cycles(tmp_path / "missing.c")
