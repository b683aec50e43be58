"""The command `cc67`, which the package brings along."""

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
    """Runs the command with the arguments of the process; the exit code."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    if given[:1] == ["sweep"]:
        from ._sweep_file import main as sweep

        return sweep(given[1:])
    if given[:1] == ["study"]:
        from .studies._command import main as study

        return study(given[1:])
    # Without Python's handler, Ctrl-C ends the command as it ends others.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.stdout.flush()
    # What runs itself, as `cc67 test` does, would find Python in the place of the command.
    script = shutil.which("cc67", path=os.path.dirname(sys.executable)) or shutil.which("cc67")
    if script is not None:
        os.environ["CC67_COMMAND"] = script
    return _native.command(["cc67", *given])


def run(arguments: Sequence[str]) -> subprocess.CompletedProcess[str]:
    """Runs the command in a process of its own and returns what it prints."""
    return subprocess.run([sys.executable, "-m", "cc67", *arguments], capture_output=True, text=True)


def draw(trace: Trace, path: str) -> None:
    """Draws a trace with `cc67 plot`."""
    with tempfile.TemporaryDirectory() as folder:
        table = os.path.join(folder, "trace.csv")
        trace.save(table)
        result = run(["plot", table, "-o", path])
    if result.returncode != 0:
        raise Error(result.stderr.strip())
