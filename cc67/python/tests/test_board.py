"""A board: time, conditions, console, commands, parts."""

from __future__ import annotations

import gc
import time
import weakref
from pathlib import Path
from typing import Any

import pytest
from conftest import COUNT, MOVE, WAIT, Write

import cc67

MACHINE = """
[axis.0]
name = "Slide"
units = "mm"
[[switch]]
bit = 136
axis = 0
when = ">= 1000"
"""


def test_a_program_runs_to_its_end_as_with_the_command(write: Write) -> None:
    board = cc67.Board(programs=[cc67.compile(write(MOVE))])
    assert board.run() is True
    assert board.console == ["at 2000 after 2.30 s"]
    assert "after 2.30" in board.console and board.console.text == "at 2000 after 2.30 s\n"
    assert board.ended and board.time == pytest.approx(2.3, abs=0.01)


def test_both_engines_do_the_same(write: Write) -> None:
    dests, times = [], []
    for engine in ("native", "bytecode"):
        board = cc67.Board(programs=[write(MOVE)], engine=engine)
        board.run_for(1.0)
        assert board.tick == 11111
        dests.append(board.axes[0].dest)
        board.run()
        assert board.console == ["at 2000 after 2.30 s"]
        times.append(board.console.times[0])
    assert dests[0] == dests[1] == pytest.approx(849.81, abs=1e-6), "0.15 s and two ticks of a jerk-limited start are lost"
    assert times[0] == times[1] == pytest.approx(2.3, abs=0.01)


def test_time_passes_only_where_it_is_asked_for(write: Write) -> None:
    board = cc67.Board(programs=[write(WAIT)])
    assert board.time == 0.0
    board.run_for(0.9)
    assert board.tick == 10000 and board.time == pytest.approx(0.9)
    board.step()
    board.step(9)
    assert board.tick == 10010
    assert board.step_thread(1) is True


def test_a_run_that_does_not_end_says_so(write: Write) -> None:
    board = cc67.Board(programs=[write(WAIT)])
    assert board.run(timeout=2.0) is False
    assert board.time == pytest.approx(2.0, abs=1e-4) and not board.ended


def test_run_until_takes_an_expression(write: Write) -> None:
    board = cc67.Board(programs=[write(COUNT)])
    assert board.run_until("count == 1", timeout=0.1) is False
    assert board.time == pytest.approx(0.1, abs=1e-4)
    board.bits[136] = True
    assert board.run_until("count == 1", 0.1) is True
    assert board.time < 0.11
    assert board.run_until("count == 1", 0.1) is True, "a condition that is already met takes no time"


def test_run_until_takes_events(write: Write) -> None:
    board = cc67.Board(programs=[write(MOVE)])
    assert board.run_until(cc67.printed("at 2000"), timeout=5.0)
    assert board.run_until(cc67.ended(1), timeout=0.1)
    board.start(1)
    assert board.run_until(cc67.started(1), timeout=0.1)


def test_run_until_takes_a_function(write: Write) -> None:
    board = cc67.Board(programs=[write(MOVE)])
    assert board.run_until(lambda b: b.axes[0].dest > 10, timeout=5.0)
    assert 10 < board.axes[0].dest < 12
    assert not board.run_until(lambda b: False, timeout=0.01)


def test_what_a_function_raises_ends_the_run(write: Write) -> None:
    board = cc67.Board(programs=[write(MOVE)])

    def wrong(board: cc67.Board) -> bool:
        raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        board.run_until(wrong, timeout=1.0)
    board.run()
    assert board.console == ["at 2000 after 2.30 s"]


def test_expressions_are_read_and_written(write: Write) -> None:
    board = cc67.Board(programs=[write(COUNT)])
    board.write("count", 2)
    board.write("row[3]", 7)
    board.bits[136] = True
    board.run()
    assert board.read("count") == 3 and board.read("half") == 1.5 and board.read("row[3] + 1") == 8
    assert board.read("1:count") == 3 and board.read("ch0->Vel") > 0 and board.read("bit136") == 1


def test_a_wrong_expression_names_what_was_meant(write: Write) -> None:
    board = cc67.Board(programs=[write(COUNT)])
    with pytest.raises(cc67.InputError, match="count"):
        board.read("cuont")
    with pytest.raises(cc67.InputError, match="not a variable"):
        board.write("count + 1", 2)
    with pytest.raises(TypeError):
        board.write("count", "2")  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        board.read(5)  # type: ignore[arg-type]


def test_commands_return_their_reply() -> None:
    board = cc67.Board()
    assert board.command("SetPersistDec 10 1200") == ""
    assert board.command("GetPersistDec 10") == "1200"
    assert board.command("Version").startswith("KFLOP 4.34")
    assert board.time > 0
    with pytest.raises(cc67.InputError):
        board.command("a\nb")
    with pytest.raises(TypeError):
        board.command(5)  # type: ignore[arg-type]


def test_bits_are_levels_and_inputs_are_driven() -> None:
    board = cc67.Board()
    levels = [board.bits[136]]
    board.bits[136] = True
    levels.append(board.bits[136])
    board.command("SetBit46")
    levels.append(board.bits[46])
    assert levels == [False, True, True]
    with pytest.raises(cc67.InputError, match="output"):
        board.bits[46] = False
    for wrong in (-1, 2048):
        with pytest.raises(IndexError, match="0 to 2047"):
            board.bits[wrong]
    with pytest.raises(TypeError):
        board.bits["x"]  # type: ignore[call-overload]
    with pytest.raises(TypeError):
        board.bits[136] = "on"  # type: ignore[call-overload]


def test_analog_inputs_are_counts() -> None:
    board = cc67.Board(machine={"board.kanalog": True})
    board.adc[3] = 1500
    board.run_for(0.01)
    assert board.adc[3] == 1500
    with pytest.raises(cc67.InputError, match="-2048 to 2047"):
        board.adc[3] = 5000
    with pytest.raises(IndexError):
        board.adc[8]


def test_persist_has_integers_floats_and_doubles() -> None:
    board = cc67.Board(set={"persist.5": 3, "persist.float.6": 1.5, "persist.double.10": -0.1})
    assert (board.persist[5], board.persist.float[6], board.persist.double[10]) == (3, 1.5, -0.1)
    board.persist[7] = -1
    assert board.persist[7] == -1 and board.persist[5:8] == [3, 0x3FC00000, -1]
    board.persist[20:23] = [1, 2, 3]
    assert board.persist[19:24] == [0, 1, 2, 3, 0] and list(board.persist)[20:23] == [1, 2, 3]
    board.persist.float[8] = 1.23
    assert board.persist[8] == 0x3F9D70A4
    assert board.command("GetPersistHex 8").lower().endswith("3f9d70a4")
    board.persist.double[198] = 1e300
    assert board.persist.double[198] == 1e300
    with pytest.raises(IndexError, match="0 to 199"):
        board.persist[200]
    with pytest.raises(IndexError):
        board.persist.double[199] = 1.0
    with pytest.raises(TypeError, match=r"persist.float\[5\]"):
        board.persist[5] = 1.5  # type: ignore[call-overload]
    with pytest.raises(cc67.InputError, match="2 values for 3 element"):
        board.persist[0:3] = [1, 2]
    with pytest.raises(IndexError, match="0 to 200"):
        board.persist[190:201]


def test_a_number_that_does_not_fit_is_an_overflow(write: Write) -> None:
    board = cc67.Board(programs=[write('#include "KMotionDef.h"\nchar c; int count; unsigned u; main() { c = count = u = 0; }')])
    for number in (2**31, 1 << 40, -(2**31) - 1):
        with pytest.raises(OverflowError, match="does not fit"):
            board.persist[5] = number
        with pytest.raises(cc67.RangeError, match="-2147483648 to 2147483647"):
            board.write("count", number)
    for expression, value in (("c", 200), ("u", -1), ("chan[0].OutputMode", 1e10), ("count", float("nan"))):
        with pytest.raises(OverflowError, match="does not fit"):
            board.write(expression, value)
    with pytest.raises(OverflowError):
        board.axes[0].OutputMode = 2**31
    with pytest.raises(OverflowError):
        board.persist.float[5] = 1e300
    with pytest.raises(OverflowError):
        board.adc[0] = 2048
    board.write("c", -128)
    board.write("u", 2**32 - 1)
    assert board.read("c") == -128 and board.read("u") == 2**32 - 1 and board.read("count") == 0


def test_what_is_written_is_in_the_words_of_the_program_that_is_there(write: Write) -> None:
    board = cc67.Board(load=[write("int first, count; main() { first = count; }", "one.c")])
    board.write("count", 5)
    board.load(write("int count, other; main() { other = count; }", "two.c"), thread=1)
    board.write("count", 7)
    assert board.read("count") == 7 and board.read("other") == 0
    board.load(write("int other; main() { other = 1; }", "three.c"), thread=1)
    with pytest.raises(cc67.InputError, match="`count` is not declared"):
        board.write("count", 7)


def test_unknown_attributes_are_refused() -> None:
    board = cc67.Board()
    with pytest.raises(AttributeError, match="did you mean 'time'"):
        board.tme = 5  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match="`time` of a Board can only be read"):
        board.time = 5  # type: ignore[misc]
    for part in (board.bits, board.adc, board.dac, board.axes, board.persist, board.persist.float, board.snapshot()):
        with pytest.raises(AttributeError, match="no such attribute"):
            part.colour = 5  # type: ignore[union-attr]


def test_what_is_done_by_hand_costs_the_same_each_time_and_its_recording_ends() -> None:
    board = cc67.Board(machine={"board.kanalog": True})

    def took(calls: int) -> float:
        begin = time.perf_counter()
        for number in range(calls):
            board.adc[3] = number % 1000
            board.axes[0].Dest = number
            board.step()
        return time.perf_counter() - begin

    first = min(took(500) for _ in range(3))
    took(30_000)
    assert min(took(500) for _ in range(3)) < 3 * first
    text = board.recording
    assert 2**20 <= len(text) < 2**20 + 300
    assert text.endswith("what was done later is missing\n")


def test_memory_of_a_closed_board_is_free_even_if_parts_of_it_are_kept() -> None:
    resource = pytest.importorskip("resource")
    kept: list[object] = []
    for number in range(300):
        with cc67.Board() as board:
            kept += [board.bits, board.axes, board.snapshot(), board]
        if number == 50:
            before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 100_000


def test_axes_have_numbers_and_names(write: Write) -> None:
    board = cc67.Board(programs=[write(MOVE)], machine=MACHINE)
    axis = board.axes["Slide"]
    assert axis == board.axes[0] != board.axes[1] and axis.units == "mm" and not axis.enabled
    board.run()
    assert axis.dest == 2000 and axis.position == pytest.approx(2000, abs=1) and axis.enabled
    assert axis.Vel == 1000 and axis.velocity == 1000 and axis.done
    assert board.bits[136] is True, "the switch of the machine file"
    axis.Vel = 500
    axis.enabled = False
    assert board.read("ch0->Vel") == 500 and not axis.enabled
    assert len(board.axes) == 8 and [each.index for each in board.axes] == list(range(8))


def test_an_axis_has_its_fields_whatever_the_program_includes(write: Write) -> None:
    board = cc67.Board(programs=[write("main() {}")])
    board.axes[3].Vel = 12.5
    board.axes[3].OutputMode = 2
    board.axes[3].dest = -3
    assert (board.axes[3].Vel, board.axes[3].OutputMode, board.axes[3].dest) == (12.5, 2, -3)
    assert board.command("Vel3") == "12.500000" and isinstance(board.axes[3].OutputMode, int)


def test_an_unknown_axis_or_field_names_what_was_meant() -> None:
    board = cc67.Board(machine=MACHINE)
    with pytest.raises(KeyError, match="did you mean 'Slide'"):
        board.axes["slid"]
    with pytest.raises(AttributeError, match="did you mean 'position'"):
        board.axes[0].postion  # type: ignore[attr-defined]
    with pytest.raises(AttributeError, match="did you mean 'dest'"):
        board.axes[0].dset = 5  # type: ignore[attr-defined]
    with pytest.raises(IndexError):
        board.axes[8]
    with pytest.raises(KeyError, match="names none"):
        cc67.Board().axes["Slide"]


def test_axes_are_moved_by_hand() -> None:
    board = cc67.Board()
    axis = board.axes[2]
    axis.enabled = True
    axis.move(100)
    board.run()
    assert axis.dest == 100 and axis.done
    axis.jog(50)
    board.run_for(1.0)
    axis.jog(0)
    assert axis.dest > 130


def test_a_machine_file_may_be_a_file_a_text_or_keys(tmp_path: Path) -> None:
    path = tmp_path / "mill.toml"
    path.write_text(MACHINE)
    machines: list[Any] = [path, str(path), MACHINE, {"axis.0.name": "Slide"}]
    for machine in machines:
        assert cc67.Board(machine=machine).axes["Slide"].index == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"machine": "[axis.0]\nmodle = 5\n"}, "machine:2:1: .*did you mean `model`"),
        ({"machine": {"axis.0.modle": "motor"}}, "did you mean `model`"),
        ({"set": {"persist.200": 1}}, "outside"),
        ({"set": {"persist.5": 1.5}}, "f:FLOAT"),
        ({"set": ["persist.5"]}, "no `=`"),
        ({"stim": "at 1s bit 46 = 1"}, "46"),
        ({"stim": "at 1s bti 136 = 1"}, "bit"),
        ({"answers": {"msgbocks": "no"}}, "msgbox"),
        ({"engine": "quantum"}, "native"),
        ({"on_fault": "ignore"}, "keep"),
    ],
)
def test_wrong_options_name_the_place(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(cc67.InputError, match=message):
        cc67.Board(**arguments)  # type: ignore[arg-type]


def test_programs_go_to_threads(write: Write) -> None:
    one = write('#include "KMotionDef.h"\nmain() { persist.UserData[CurrentThread] = 1; }', "one.c")
    program = cc67.compile(one)
    board = cc67.Board(programs={3: program, 5: cc67.compile(one)})
    board.run()
    assert [n for n in range(8) if board.persist[n]] == [3, 5] and sorted(board.programs) == [3, 5]
    board = cc67.Board(programs=[program, program])
    board.run()
    assert [n for n in range(8) if board.persist[n]] == [1, 2]
    with pytest.raises(cc67.InputError, match="two programs for thread 2"):
        cc67.Board(programs=[cc67.compile(one, thread=2), cc67.compile(one, thread=2)])
    with pytest.raises(cc67.InputError, match="7 user threads"):
        cc67.Board(programs=[program] * 8)
    with pytest.raises(TypeError, match="a cc67.Program or a file"):
        cc67.Board(programs=[5])  # type: ignore[list-item]


def test_programs_are_loaded_started_and_stopped(write: Write) -> None:
    board = cc67.Board(load={2: write(WAIT)})
    assert not board.active(2)
    board.start(2)
    board.run_for(0.01)
    assert board.active(2)
    board.stop(2)
    board.run_for(0.01)
    assert not board.active(2)
    board.load(write(MOVE), thread=4, start=True)
    board.run()
    assert board.console == ["at 2000 after 2.32 s"]
    with pytest.raises(cc67.LoadError, match="no program"):
        board.start(7)


def test_an_image_is_refused_with_a_reason(tmp_path: Path) -> None:
    path = tmp_path / "wrong(1).out"
    path.write_bytes(b"\x7fELF" + bytes(100))
    with pytest.raises(cc67.LoadError, match="ELF"):
        cc67.Board(programs=[path])


def test_a_stimulus_is_played(write: Write) -> None:
    board = cc67.Board(programs=[write(COUNT)], stim=["every 100ms from 1s until 3s pulse bit 136 for 50ms"])
    board.run()
    assert board.console == ["three"] and 1.1 < board.time < 1.3


def test_what_is_done_by_hand_is_a_stimulus(write: Write) -> None:
    path = write(COUNT)
    board = cc67.Board(programs=[path])
    for _ in range(3):
        board.act("pulse bit 136 for 20ms")
        board.run_for(0.05)
    board.run()
    again = cc67.Board(programs=[path], stim=board.recording)
    again.run()
    assert again.console.times == board.console.times and board.console == ["three"]


def test_a_snapshot_is_gone_back_to(write: Write) -> None:
    for engine in ("native", "bytecode"):
        board = cc67.Board(programs=[write(MOVE)], engine=engine)
        board.run_for(1.0)
        then = board.snapshot()
        dest = board.axes[0].dest
        ways = []
        for _ in range(2):
            board.restore(then)
            assert board.time == then.time and board.axes[0].dest == dest and board.console == []
            board.run()
            ways.append((board.console.times, board.time, board.axes[0].dest))
        assert ways[0] == ways[1]


def test_a_snapshot_of_another_board_is_refused() -> None:
    then = cc67.Board().snapshot()
    with pytest.raises(cc67.Error, match="another board"):
        cc67.Board().restore(then)
    with pytest.raises(TypeError):
        cc67.Board().restore(5)  # type: ignore[arg-type]


def test_the_serial_port_is_heard(write: Write) -> None:
    path = write('#include "KMotionDef.h"\nmain() { EnableRS232Cmds(RS232_BAUD_115200); RS232_PutChar(\'h\'); RS232_PutChar(\'i\'); }')
    board = cc67.Board(programs=[path])
    board.run()
    board.run_for(0.1)
    assert board.uart == b"hi"


def test_remarks_are_kept(write: Write) -> None:
    board = cc67.Board(programs=[write('#include "KMotionDef.h"\nmain() { ReadBit(137); }')])
    board.run()
    assert any("bit 137" in remark for remark in board.remarks)


@pytest.mark.parametrize("seconds", [-1, float("nan"), float("inf"), 1e13])
def test_impossible_times_are_refused(seconds: float) -> None:
    board = cc67.Board()
    with pytest.raises(cc67.InputError, match="a time must be 0 to 1e12 seconds"):
        board.run_for(seconds)
    for condition in ("0", lambda board: False):
        with pytest.raises(cc67.InputError, match="a time must be 0 to 1e12 seconds"):
            board.run_until(condition, seconds)


def test_times_may_be_integers(write: Write) -> None:
    board = cc67.Board(programs=[write(WAIT)])
    board.run_for(1)
    assert not board.run(1) and not board.run_until("0", 1) and not board.run_until(lambda board: False, timeout=1)
    assert board.step_thread(1, 1)
    assert len(board.trace("dest0", 1).time) == 11111
    assert board.time == pytest.approx(5, abs=1e-3)


def test_wrong_types_are_type_errors() -> None:
    board = cc67.Board()
    with pytest.raises(TypeError):
        board.run_for("1")  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        board.run_until(5, 1)  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        board.step(1.5)  # type: ignore[arg-type]
    with pytest.raises(cc67.InputError, match="back"):
        board.step(-1)


def test_boards_are_freed_without_the_collector_and_can_be_closed(write: Write) -> None:
    program = cc67.compile(write("main() {}\n"))
    gc.collect()
    gc.disable()
    try:
        gone = []
        for _ in range(2000):
            board = cc67.Board(programs=[program])
            board.persist[0] = 1
            gone.append(weakref.ref(board))
        assert sum(reference() is not None for reference in gone) == 1
    finally:
        gc.enable()
    with cc67.Board(programs=[program]) as board:
        bits = board.bits
        assert board.time == 0
    assert repr(board) == "<cc67.Board, closed>"
    for use in (lambda: board.time, lambda: bits[0], lambda: board.run(1)):
        with pytest.raises(cc67.Error, match="the board is closed"):
            use()
    board.close()


def test_a_kogna_has_sixteen_axes(write: Write) -> None:
    text = """
    #include "KMotionDef.h"
    main()
    {
        ch12->OutputMode = NO_OUTPUT_MODE; ch12->InputMode = NO_INPUT_MODE;
        ch12->Vel = 1000; ch12->Accel = 10000; ch12->Jerk = 100000;
        EnableAxisDest(12, 0);
        Move(12, 250);
        while (!CheckDone(12)) ;
    }
    """
    program = cc67.compile(write(text), board="kogna-5.3.2")
    board = cc67.Board(programs=[program], machine="[axis.12]\nname = 'Turret'\n")
    board.run()
    assert len(board.axes) == 16 and board.axes["Turret"] == board.axes[12]
    assert (board.axes[12].dest, board.axes[12].Vel, board.axes[15].dest) == (250, 1000, 0)
    board.axes[12].Vel = 2000
    assert board.axes[12].Vel == 2000
    assert any("never compared" in str(remark) for remark in board.remarks)
    with pytest.raises(IndexError):
        cc67.Board(programs=[write(MOVE)]).axes[12]
