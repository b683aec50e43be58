"""The examples do what they say."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"


def example(name: str, folder: Path) -> str:
    """Run an example and return what it prints."""
    copy = shutil.copytree(EXAMPLES, folder / "examples")
    result = subprocess.run([sys.executable, str(copy / name)], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    return result.stdout


def test_the_quick_start(tmp_path: Path) -> None:
    lines = example("quick_start.py", tmp_path).splitlines()
    assert lines[0].startswith("half way after 1.") and lines[1:] == ["at 2000 after 2.30 s", "axis 0 is at 2000"]


def test_the_sweep(tmp_path: Path) -> None:
    lines = example("sweep_speed.py", tmp_path).splitlines()
    assert lines[0] == "macro.SPEED,macro.ACCEL,took,speed,error" and len(lines) == 5
    took = [float(line.split(",")[2]) for line in lines[1:]]
    assert took[0] == max(took) and took[3] == min(took)


def test_the_tests(tmp_path: Path) -> None:
    copy = shutil.copytree(EXAMPLES, tmp_path / "examples")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(copy)]
    result = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert result.returncode == 0 and "3 passed" in result.stdout, result.stdout
