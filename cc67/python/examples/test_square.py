"""Tests of a program; run them with `pytest cc67/python/examples`."""

from __future__ import annotations

from typing import Callable

import pytest

import cc67
from cc67.pytest_plugin import AssertConsole, Expect, MakeBoard


@pytest.mark.cc67(programs=["square.c"])
@pytest.mark.cc67_engines("native", "bytecode")
def test_the_axis_arrives(
    board: cc67.Board, expect: Callable[[cc67.Board], Expect], assert_console: AssertConsole
) -> None:
    expect(board).enabled(0, within=0.1)
    expect(board).dest(0, 2000, within=3.0)
    expect(board).printed("at 2000", within=0.1)
    assert_console(board)


def test_it_arrives_later_from_farther_away(make_board: MakeBoard) -> None:
    near, far = (make_board(programs=["square.c"], stim=f'at 3s command "Move0={end}"') for end in (2100, 4000))
    for board in (near, far):
        board.run_for(3.1)
        assert board.run_until("ch0->last_vel == 0", timeout=10.0)
    assert near.time < far.time
