"""Programs and a fixture for several tests."""

from __future__ import annotations

from pathlib import Path
from typing import Callable

import pytest

Write = Callable[..., Path]

MOVE = """
#include "KMotionDef.h"
main()
{
    ch0->OutputMode = STEP_DIR_MODE;
    ch0->Vel = 1000; ch0->Accel = 5000; ch0->Jerk = 50000;
    EnableAxisDest(0, 0);
    Move(0, 2000);
    while (!CheckDone(0)) WaitNextTimeSlice();
    printf("at %g after %.2f s\\n", ch0->Dest, Time_sec());
}
"""

COUNT = """
#include "KMotionDef.h"
int count;
double half;
int row[4];
main()
{
    int now, last = 0;
    row[0] = 1;
    while (count < 3)
    {
        now = ReadBit(136);
        if (now && !last) { ++count; half = count / 2.0; }
        last = now;
        WaitNextTimeSlice();
    }
    printf("three\\n");
}
"""

WAIT = """
#include "KMotionDef.h"
main() { for (;;) WaitNextTimeSlice(); }
"""


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """A function that writes a source into the folder of the test."""

    def source(text: str, name: str = "program.c") -> Path:
        path = tmp_path / name
        path.write_text(text)
        return path

    return source
