"""Runs the commands of the README with an installed cc67, and compares what they print with what the README shows.

tour.py COMMAND [README]: in an empty folder, with COMMAND under the name `cc67` in the path. A block `LANGUAGE file=NAME` is
written to that file, a block `sh run` is executed by a shell, the block `text` after it is what it prints. The example programs
that the README names are those that the command brings along.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def blocks(text: str) -> list[tuple[str, str]]:
    """The fenced blocks of a page: what follows the fence, and the text."""
    return re.findall(r"^```([^\n`]*)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def shell(line: str, folder: Path, environment: dict[str, str]) -> tuple[int, str]:
    done = subprocess.run(["bash", "-c", line], cwd=folder, env=environment, capture_output=True, text=True, encoding="utf-8")
    return done.returncode, done.stdout + done.stderr


def tour(command: Path, page: Path) -> int:
    count = 0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "tour"
        programs = Path(name) / "bin"
        folder.mkdir()
        programs.mkdir()
        shutil.copy(command, programs / f"cc67{command.suffix}")
        environment = {**os.environ, "PATH": f"{programs}{os.pathsep}{os.environ['PATH']}", "NO_COLOR": "1"}

        # All examples are there, and one of them starts a project.
        code, listed = shell("cc67 examples", folder, environment)
        examples = [line for line in listed.splitlines() if line.startswith("  ")]
        if code != 0 or len(examples) < 90:
            sys.exit(f"cc67 examples: {len(examples)} programs\n{listed}")
        code, printed = shell("cc67 init --example homing other && cc67 test other", folder, environment)
        if code != 0 or "2 passed, 0 failed" not in printed:
            sys.exit(f"cc67 init --example homing: exit {code}\n{printed}")

        # The README's commands name files of `c-programs`: the same files as the command has.
        shutil.copytree(ROOT / "c-programs", folder / "c-programs")
        here = folder
        all_blocks = blocks(page.read_text(encoding="utf-8"))
        for (info, text), (after, expected) in zip(all_blocks, [*all_blocks[1:], ("", "")], strict=True):
            if found := re.search(r"file=(\S+)", info):
                (here / found[1]).write_text(text, encoding="utf-8")
            if not re.match(r"sh run\b", info):
                continue
            wanted = int(found[1]) if (found := re.search(r"exit=(\d+)", info)) else 0
            printed = ""
            for line in filter(None, map(str.strip, text.splitlines())):
                if line.startswith("cd "):
                    here = (here / line[3:]).resolve()
                    continue
                code, output = shell(line, here, environment)
                if code != wanted:
                    sys.exit(f"{line}: exit {code}, not {wanted}\n{output}")
                printed += output
                count += 1
            if after == "text" and printed.strip() != expected.strip():
                sys.exit(f"{text}prints\n{printed}\nbut {page.name} shows\n{expected}")
    return count


if __name__ == "__main__":
    if not sys.argv[1:]:
        sys.exit(__doc__)
    command = Path(shutil.which(sys.argv[1]) or sys.argv[1]).resolve()
    page = Path(sys.argv[2]) if sys.argv[2:] else ROOT / "README.md"
    print(f"{tour(command, page)} commands of {page.name} work with {command}")
