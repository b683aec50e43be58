"""Measures of sweeps, in a module so that other processes find them."""

from __future__ import annotations

import os
import signal
from typing import Any

import cc67

# A program without motion: it takes 0.05 s, and doubles element 5 of persist.UserData into element 20.
SPIN = """
#include "KMotionDef.h"
main() { printf("begin\\n"); Delay_sec(0.05); persist.UserData[20] = persist.UserData[5] * 2; }
"""

# A program that takes a tenth of a second for each unit in element 5 of persist.UserData.
DELAY = """
#include "KMotionDef.h"
main() { Delay_sec(persist.UserData[5] * 0.1); }
"""


def double(board: cc67.Board, inputs: dict[str, Any]) -> dict[str, float]:
    """Return the doubled start value, and when the program ends."""
    board.run()
    return {"double": board.persist[20], "time": board.time}


def fails_at_three(board: cc67.Board, inputs: dict[str, Any]) -> float:
    """Return the doubled start value; fail if the start value is 3."""
    board.run()
    if inputs["persist.5"] == 3:
        raise ValueError("three is too many")
    return float(board.persist[20])


MOVE = """
#include "KMotionDef.h"
main()
{
    ch0->InputMode = ENCODER_MODE;
    ch0->OutputMode = DAC_SERVO_MODE;
    ch0->P = 1; ch0->I = 0; ch0->D = 0;
    ch0->MaxOutput = 2000;
    ch0->MaxFollowingError = 1e6;
    EnableAxisDest(0, 0);
    ch0->Dest = 500;
}
"""


def following(board: cc67.Board) -> dict[str, float]:
    """Return how far a motor overshoots at a step, and where it is after 0.1 s."""
    trace = board.trace(["dest0", "load0"], 0.1, every=10)
    return {"lag": float((trace["load0"] - trace["dest0"]).max()), "end": float(trace["load0"][-1])}


VARIATIONS: dict[str, list[Any]] = {
    "axis.0.model": ["motor"],
    "axis.0.tau_s": [0.01 + 0.002 * n for n in range(10)],
    "axis.0.ku": [20, 35, 50, 65, 80],
    "axis.0.inertia": [1, 1.5],
}


def kills_at_three(board: cc67.Board) -> float:
    """Return the start value; the process of the run is killed if it is 3."""
    if board.persist[5] == 3:
        os.kill(os.getpid(), signal.SIGKILL)
    return float(board.persist[5])


def waits_for_ever(board: cc67.Board, inputs: dict[str, Any]) -> float:
    """Write the number of the process to a file, then never end."""
    with open(inputs["file"], "a") as file:
        file.write(f"{os.getpid()}\n")
    while True:
        board.run_for(1.0)
