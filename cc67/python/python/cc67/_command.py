"""The command `cc67`, which is part of the package."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
import tempfile
from typing import TYPE_CHECKING, Sequence

from . import _native
from ._errors import Error

if TYPE_CHECKING:
    from ._trace import Trace

__all__ = ["main", "run"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit code; by default with the arguments of the process."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    if given[:1] == ["sweep"]:
        from ._sweep_file import main as sweep

        return sweep(given[1:])
    if given[:1] == ["study"]:
        from .studies._command import main as study

        return study(given[1:])
    # Replace Python's handler, so that Ctrl-C ends the command as it ends any other program.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.stdout.flush()
    # Commands such as `cc67 test` start `cc67` again; without this they would start Python instead.
    script = shutil.which("cc67", path=os.path.dirname(sys.executable)) or shutil.which("cc67")
    if script is not None:
        os.environ["CC67_COMMAND"] = script
    return _native.command(["cc67", *given])


def run(arguments: Sequence[str]) -> subprocess.CompletedProcess[str]:
    """Run the command in a separate process; return its exit code and output."""
    return subprocess.run([sys.executable, "-m", "cc67", *arguments], capture_output=True, text=True)


def draw(trace: Trace, path: str) -> None:
    """Draw a trace with `cc67 plot`; raise `Error` with its message if it fails."""
    with tempfile.TemporaryDirectory() as folder:
        table = os.path.join(folder, "trace.csv")
        trace.save(table)
        result = run(["plot", table, "-o", path])
    if result.returncode != 0:
        raise Error(result.stderr.strip())
