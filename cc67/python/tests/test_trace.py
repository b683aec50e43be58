"""Traces and pictures."""

from __future__ import annotations

import pickle
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import COUNT, MOVE, Write

import cc67


@pytest.mark.parametrize("engine", ["native", "bytecode"])
def test_a_trace_is_arrays_of_doubles(write: Write, engine: str) -> None:
    board = cc67.Board(programs=[write(MOVE)], engine=engine)
    trace = board.trace("axis0,bit46", 2.5)
    assert list(trace) == ["dest0", "pos0", "out0", "bit46"] and len(trace) == 4
    dest = trace["dest0"]
    assert dest.dtype == np.float64 and dest.flags["C_CONTIGUOUS"] and dest.flags["WRITEABLE"]
    assert len(dest) == len(trace.time) == round(2.5 / 90e-6)
    assert dest[-1] == 2000 and np.all(np.diff(dest) >= 0)
    assert np.allclose(np.diff(trace.time), 90e-6)
    assert np.max(np.diff(dest)) / 90e-6 == pytest.approx(1000, rel=1e-6), "the speed of the move"


def test_a_trace_is_what_the_command_writes(write: Write, tmp_path: Path) -> None:
    from cc67._command import run

    path, table = write(MOVE), tmp_path / "trace.csv"
    result = run(["run", str(path), "--trace", str(table), "--watch", "dest0,ch0->Dest * 2", "--trace-every", "100"])
    assert result.returncode == 0, result.stderr
    rows = np.genfromtxt(table, delimiter=",", skip_header=1)
    trace = cc67.Board(programs=[path]).trace(["dest0", "ch0->Dest * 2"], 2.2, every=100)
    theirs = dict(zip(np.round(rows[:, 0] / 90e-6).astype(int), rows[:, 1]))
    ticks = np.round(trace.time / 90e-6).astype(int)
    shared = np.array([(theirs[tick], dest) for tick, dest in zip(ticks, trace["dest0"]) if tick in theirs])
    assert len(shared) > 200
    assert np.allclose(shared[:, 0], shared[:, 1], rtol=1e-5)
    assert np.array_equal(trace["ch0->Dest * 2"], 2 * trace["dest0"])


def test_a_trace_goes_on_from_now_at_its_rate(write: Write) -> None:
    board = cc67.Board(programs=[write(COUNT)])
    board.run_for(0.1)
    trace = board.trace(["count", "half"], 0.9, every=1000)
    assert len(trace.time) == 10 and trace.time[0] == pytest.approx(0.1 + 0.09, abs=1e-4)
    assert board.time == pytest.approx(1.0, abs=1e-4)


def test_a_wrong_trace_is_refused(write: Write) -> None:
    board = cc67.Board(programs=[write(COUNT)])
    with pytest.raises(cc67.InputError, match="dest0 to dest7"):
        board.trace("dest9", 1.0)
    with pytest.raises(cc67.InputError, match="count"):
        board.trace(["cuont"], 1.0)
    with pytest.raises(cc67.InputError, match=f"too long; the limit is {2**29}"):
        board.trace(["count"], 1e9)
    with pytest.raises(cc67.InputError, match="every"):
        board.trace(["count"], 1.0, every=0)
    with pytest.raises(cc67.UnknownNameError, match="did you mean 'count'"):
        board.trace("count", 0.1)["cuont"]


def test_a_trace_is_a_table_for_numpy_and_pandas(write: Write) -> None:
    trace = cc67.Board(programs=[write(MOVE)]).trace("dest0,bit46", 0.5, every=100)
    array = np.asarray(trace)
    assert array.dtype == np.float64 and array.shape == (len(trace.time), 2)
    assert np.array_equal(array[:, 0], trace["dest0"]) and trace["dest0"][-1] > 0
    copy = pickle.loads(pickle.dumps(trace))
    assert np.array_equal(copy.time, trace.time) and np.array_equal(copy["dest0"], trace["dest0"])
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(trace)
    assert list(frame.columns) == ["dest0", "bit46"] and np.array_equal(frame.to_numpy(), array)
    frame = trace.pandas()
    assert frame.index.name == "time" and np.array_equal(frame["dest0"].to_numpy(), trace["dest0"])
    table = cc67.Table([{"a": 1, "b": 2.5, "error": None}, {"a": 2, "error": "ValueError: x"}], ["a"])
    assert list(pandas.DataFrame(table).columns) == ["a", "b", "error"] and len(pandas.DataFrame(table)) == 2
    assert np.array_equal(np.asarray(table), [[1, 2.5], [2, np.nan]], equal_nan=True)


def test_pictures_and_tables(write: Write, tmp_path: Path) -> None:
    trace = cc67.Board(programs=[write(MOVE)], machine={"axis.0.units": "mm"}).trace("dest0", 2.5, every=50)
    trace.picture(tmp_path / "move.svg")
    assert (tmp_path / "move.svg").read_text().startswith("<svg") and trace.units["dest0"] == "mm"
    trace.save(tmp_path / "move.csv")
    assert (tmp_path / "move.csv").read_text().startswith("time,dest0\n")
    with pytest.raises(cc67.Error, match="svg"):
        trace.picture(tmp_path / "move.jpeg2000")


def test_matplotlib_draws_a_trace(write: Write) -> None:
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = cc67.Board(programs=[write(MOVE)]).trace("dest0", 0.1).plot()
    assert len(axes.get_lines()) == 1


def test_a_missing_package_is_named_with_its_installation(
    write: Write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    trace = cc67.Board(programs=[write(COUNT)]).trace("bit46", 0.01)
    table = cc67.Table([{"a": 1}], ["a"])
    for name in ("matplotlib", "matplotlib.pyplot", "pandas", "pyarrow"):
        monkeypatch.setitem(sys.modules, name, None)
    with pytest.raises(cc67.NotBuiltError, match=r"a plot needs Matplotlib: pip install cc67\[plot\]"):
        trace.plot()
    with pytest.raises(cc67.NotBuiltError, match="a DataFrame needs pandas: pip install pandas"):
        table.pandas()
    with pytest.raises(cc67.NotBuiltError, match=r"a .parquet table needs pyarrow: pip install cc67\[parquet\]"):
        table.save(tmp_path / "table.parquet")
