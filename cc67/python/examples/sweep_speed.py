"""Print a table of the duration of a move at several speeds and accelerations, with two processes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import cc67

HERE = Path(__file__).parent


def duration(board: cc67.Board) -> dict[str, float]:
    """Return the seconds until the axis arrives, and its highest speed in units/s."""
    trace = board.trace(["dest0"], 3.0, every=10)
    arrived = int(np.argmax(trace["dest0"] == 2000))
    return {"took": float(trace.time[arrived]), "speed": float(np.max(np.diff(trace["dest0"])) / 900e-6)}


def main() -> None:
    source = (HERE / "square.c").read_text()
    path = HERE / "moved.c"
    path.write_text(source.replace("Vel = 1000", "Vel = SPEED").replace("Accel = 5000", "Accel = ACCEL"))
    try:
        program = cc67.compile(path, define={"SPEED": 1000, "ACCEL": 5000})
        table = cc67.sweep(
            program,
            {"macro.SPEED": [1000, 2000], "macro.ACCEL": [5000, 20000]},
            duration,
            executor="processes",
            workers=2,
        )
    finally:
        path.unlink()
    print(table.csv(), end="")


if __name__ == "__main__":
    main()
