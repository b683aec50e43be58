"""Programs: compiled, refused, linked for threads, pickled."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest
from conftest import MOVE, WAIT, Write

import cc67

WRONG = """#include "KMotionDef.h"

main()
{
    if (Readbit(136)) Jog(0, 500.0);
    printf("%d\\n", ch0->Dest);
}
"""


def test_a_program_is_for_any_thread(write: Write) -> None:
    program = cc67.compile(write(MOVE))
    assert program.thread is None and program.diagnostics == []
    assert program.image(1) != program.image(2)


def test_the_image_is_that_of_the_command(write: Write, tmp_path: Path) -> None:
    from cc67._command import run

    path = write(MOVE)
    result = run(["build", str(path), "--target", "sim", "--thread", "3", "-o", str(tmp_path / "out.out")])
    assert result.returncode == 0, result.stderr
    assert cc67.compile(path).image(3) == (tmp_path / "out.out").read_bytes()


def test_an_error_has_all_diagnostics_with_their_places(write: Write) -> None:
    path = write(WRONG)
    with pytest.raises(cc67.CompileError) as caught:
        cc67.compile(path)
    first, second = caught.value.diagnostics
    assert (first.level, first.file, first.line, first.column) == ("error", str(path), 5, 9)
    assert first.message == "undefined function `Readbit`" and first.suggestion == "did you mean `ReadBit`?"
    assert (second.level, second.code, second.line) == ("warning", "format", 6)
    text = str(caught.value)
    assert "did you mean `ReadBit`?" in text and f"{path}:5:9" in text


def test_warnings_come_with_the_program_and_have_switches(write: Write) -> None:
    path = write(WRONG.replace("Readbit", "ReadBit"))
    assert [each.code for each in cc67.compile(path).diagnostics] == ["format"]
    assert cc67.compile(path, warnings=["no-format"]).diagnostics == []
    with pytest.raises(cc67.CompileError):
        cc67.compile(path, warnings=["error=format"])


def test_an_unknown_warning_is_named_with_the_one_that_was_meant(write: Write) -> None:
    with pytest.raises(cc67.UnknownNameError, match="did you mean 'format'"):
        cc67.compile(write(MOVE), warnings=["no-fromat"])


def test_macros_and_include_folders_reach_the_program(write: Write, tmp_path: Path) -> None:
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep" / "speed.h").write_text("#define UNIT 10\n")
    path = write('#include "KMotionDef.h"\n#include "speed.h"\nmain() { printf("%d\\n", SPEED * UNIT); }')
    program = cc67.compile(path, include=[tmp_path / "deep"], define={"SPEED": 7})
    board = cc67.Board(programs=[program])
    board.run()
    assert board.console == ["70"]
    assert cc67.compile(path, include=[tmp_path / "deep"], define=["SPEED=7"]).image() == program.image()


def test_several_files_make_one_program(write: Write) -> None:
    one = write('#include "KMotionDef.h"\nint twice(int);\nmain() { printf("%d\\n", twice(21)); }', "one.c")
    two = write("int twice(int n) { return 2 * n; }", "two.c")
    board = cc67.Board(programs=cc67.compile([one, two]))
    board.run()
    assert board.console == ["42"]


def test_a_program_pickles_without_its_source(write: Write) -> None:
    path = write(MOVE)
    program = cc67.compile(path, thread=2)
    image = program.image()
    text = pickle.dumps(program)
    path.unlink()
    copy = pickle.loads(text)
    assert copy.thread == 2 and copy.image() == image
    board = cc67.Board(programs=[copy])
    board.run()
    assert board.console == ["at 2000 after 2.30 s"]


def test_an_error_pickles(write: Write) -> None:
    with pytest.raises(cc67.CompileError) as caught:
        cc67.compile(write(WRONG))
    copy = pickle.loads(pickle.dumps(caught.value))
    assert str(copy) == str(caught.value) and copy.diagnostics == caught.value.diagnostics


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"files": []}, cc67.InputError, "no file"),
        ({"files": 5}, TypeError, "files must be a path"),
        ({"files": "missing.c"}, OSError, "missing.c"),
        ({"thread": 8}, cc67.InputError, r"no such thread 8 \(1-7\)"),
        ({"thread": "1"}, TypeError, "from 1 to 7"),
        ({"optimize": 3}, cc67.InputError, "0, 1, 2 or"),
        ({"std": "c42"}, cc67.InputError, "vendor"),
        ({"define": {"1X": 2}}, cc67.InputError, "not a macro name"),
        ({"define": "X"}, TypeError, "must be a list"),
        ({"include": "folder"}, TypeError, "must be a list"),
    ],
)
def test_wrong_arguments_are_exceptions(
    write: Write, arguments: dict[str, object], error: type[Exception], message: str
) -> None:
    files = arguments.pop("files", write(WAIT))
    with pytest.raises(error, match=message):
        cc67.compile(files, **arguments)  # type: ignore[arg-type]


def test_a_missing_file_is_the_error_that_python_has_for_it(tmp_path: Path) -> None:
    path = tmp_path / "missing.c"
    with pytest.raises(FileNotFoundError) as ours:
        cc67.compile(path)
    with pytest.raises(FileNotFoundError) as theirs:
        open(path)
    assert str(ours.value) == str(theirs.value)
    assert (ours.value.errno, ours.value.strerror, ours.value.filename) == (
        theirs.value.errno,
        theirs.value.strerror,
        str(path),
    )


def test_bytes_that_are_not_c_are_an_error(tmp_path: Path) -> None:
    path = tmp_path / "picture.c"
    path.write_bytes(b"\x89PNG\r\n\x1a\n\0\0\0\0")
    with pytest.raises(cc67.CompileError, match="PNG|not C"):
        cc67.compile(path)
