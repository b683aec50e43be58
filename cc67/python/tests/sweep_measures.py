"""Measures of sweeps, in a module so that other processes find them."""

from __future__ import annotations

from typing import Any

import cc67

# A motor on the analog output of axis 0 that is turned by hand: no servo, so what it does is the plant's alone.
SPIN = """
#include "KMotionDef.h"
main() { printf("begin\\n"); Delay_sec(0.05); persist.UserData[20] = persist.UserData[5] * 2; }
"""


def double(board: cc67.Board, inputs: dict[str, Any]) -> dict[str, float]:
    """What the program makes of its start value, and when it ends."""
    board.run()
    return {"double": board.persist[20], "time": board.time}


def fails_at_three(board: cc67.Board, inputs: dict[str, Any]) -> float:
    """Fails for one of its inputs."""
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
    """How far a motor goes too far on a step, and where it is after a while."""
    trace = board.trace(["dest0", "load0"], 0.1, every=10)
    return {"lag": float((trace["load0"] - trace["dest0"]).max()), "end": float(trace["load0"][-1])}


VARIATIONS: dict[str, list[Any]] = {
    "axis.0.model": ["motor"],
    "axis.0.tau_s": [0.01 + 0.002 * n for n in range(10)],
    "axis.0.ku": [20, 35, 50, 65, 80],
    "axis.0.inertia": [1, 1.5],
}
