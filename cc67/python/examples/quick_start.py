"""Compile and run a program; print its output and the final position of the axis."""

from __future__ import annotations

import sys
from pathlib import Path

import cc67

HERE = Path(__file__).parent


def main() -> int:
    try:
        program = cc67.compile(HERE / "square.c")
    except cc67.CompileError as error:
        for diagnostic in error.diagnostics:
            print(diagnostic)
        return 1
    board = cc67.Board(programs=[program])
    board.run_until("ch0->Dest > 1000", timeout=5.0)
    print(f"half way after {board.time:.3f} s")
    board.run()
    print(board.console.text, end="")
    print(f"axis 0 is at {board.axes[0].position:g}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
