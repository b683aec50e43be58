"""Sweeps: the same table with every executor, and after being killed."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from conftest import WAIT, Write
from sweep_measures import DELAY, MOVE, SPIN, VARIATIONS, double, fails_at_three, following, kills_at_three

import cc67


def test_a_grid_is_all_combinations_in_order(write: Write) -> None:
    table = cc67.sweep(write(SPIN), {"persist.5": range(3), "persist.6": [7, 8]}, double)
    assert [(row["persist.5"], row["persist.6"], row["double"]) for row in table] == [
        (0, 7, 0),
        (0, 8, 0),
        (1, 7, 2),
        (1, 8, 2),
        (2, 7, 4),
        (2, 8, 4),
    ]
    assert table.columns == ["persist.5", "persist.6", "double", "time", "error"] and len(table.failures) == 0
    assert table["double"] == [0, 0, 2, 2, 4, 4] and table.array("double").shape == (6, 1)


def test_samples_measures_and_their_forms(write: Write) -> None:
    path = write(SPIN)
    samples = [{"persist.5": 4}, {"persist.5": 5, "seed": 1}]
    table = cc67.sweep(path, samples, lambda board: (board.run(), board.persist[20]))
    assert table["value1"] == [8, 10] and table["seed"] == [None, 1]
    table = cc67.sweep(cc67.compile(path), samples, {"twice": "persist.20", "took": "time"})
    assert table["twice"] == [8, 10] and table["took"][0] == pytest.approx(0.05, abs=0.01)


def test_macros_are_compiled_in_once(write: Write) -> None:
    path = write('#include "KMotionDef.h"\nmain() { persist.UserData[0] = SPEED * 2 + ReadBit(136); }')
    program = cc67.compile(path, define={"SPEED": 0, "OTHER": 3})
    grid = {"macro.SPEED": [1, 2], "bit.136": [0, 1]}
    assert cc67.sweep(program, grid, {"value": "persist.0"})["value"] == [2, 3, 4, 5]


def test_a_macro_of_a_sweep_needs_no_default_in_the_source(write: Write, tmp_path: Path) -> None:
    path = write('#include "KMotionDef.h"\nmain() { persist.UserData[0] = SPEED * 2; }')
    grid, log = {"macro.SPEED": [1, 2, 2.0]}, tmp_path / "sweep.log"
    for _ in range(2):
        assert cc67.sweep(path, grid, {"value": "persist.0"}, log=log)["value"] == [2, 4, 4]
    path.write_text(path.read_text().replace("SPEED * 2", "SPEED == 2 ? 9 : 2"))
    with pytest.raises(cc67.InputError, match="another sweep"):
        cc67.sweep(path, grid, {"value": "persist.0"}, log=log)
    with pytest.raises(cc67.CompileError, match="SPEED"):
        cc67.sweep(path, {"persist.5": [1]}, {"value": "persist.0"})


def test_failures_are_kept_with_their_inputs(write: Write) -> None:
    table = cc67.sweep(write(SPIN), {"persist.5": range(5)}, fails_at_three)
    assert len(table) == 5 and len(table.good) == 4
    (failure,) = table.failures
    assert failure["persist.5"] == 3 and failure["error"] == "ValueError: three is too many"


def test_a_program_that_does_not_end_is_a_failure(write: Write) -> None:
    table = cc67.sweep(write(WAIT), {"persist.5": [1]}, {"x": "persist.5"}, timeout=0.5)
    assert "not ended after 0.5 s" in table[0]["error"]
    table = cc67.sweep(write(WAIT), {"persist.5": [1]}, {"x": "persist.5", "t": "time"}, until=0.09)
    assert table[0]["x"] == 1 and table[0]["t"] == pytest.approx(0.09)


def test_times_of_a_sweep_may_be_integers(write: Write) -> None:
    path, grid = write(WAIT), {"persist.5": [1]}
    for second in (1, np.int64(1), np.float32(1)):
        table = cc67.sweep(path, grid, {"t": "time"}, until=second)  # type: ignore[arg-type, unused-ignore]
        assert table[0]["error"] is None and table[0]["t"] == pytest.approx(1, abs=1e-4)
    assert "not ended after 1 s" in cc67.sweep(path, grid, {"t": "time"}, timeout=1)[0]["error"]


def test_executors_give_the_same_table(write: Write) -> None:
    program = cc67.compile(write(MOVE))
    one = cc67.sweep(program, VARIATIONS, following, workers=1)
    assert len(one) == 100 and len(one.failures) == 0 and len(set(one["lag"])) > 10
    assert cc67.sweep(program, VARIATIONS, following, workers=2) == one
    assert cc67.sweep(program, VARIATIONS, following, executor="processes", workers=1) == one
    assert cc67.sweep(program, VARIATIONS, following, executor="processes", workers=2) == one
    with ProcessPoolExecutor(2) as pool:
        assert cc67.sweep(program, VARIATIONS, following, executor=pool) == one
    with ThreadPoolExecutor(2) as threads:
        assert cc67.sweep(program, VARIATIONS, following, executor=threads, engine="bytecode") == one


KILLED = """
import sys
sys.path.insert(0, {tests!r})
import cc67, sweep_measures
if __name__ == "__main__":
    table = cc67.sweep({program!r}, sweep_measures.VARIATIONS, sweep_measures.following, log={log!r},
                       executor={executor!r}, workers=2)
    table.save({out!r})
"""


@pytest.mark.parametrize("executor", ["threads", "processes"])
def test_a_sweep_that_was_killed_goes_on(write: Write, tmp_path: Path, executor: str) -> None:
    program, log, out = write(MOVE), tmp_path / "sweep.log", tmp_path / "table.csv"
    script = tmp_path / "script.py"
    names = {"tests": str(Path(__file__).parent), "program": str(program), "log": str(log), "out": str(out)}
    script.write_text(KILLED.format(executor=executor, **names))
    process = subprocess.Popen([sys.executable, str(script)], start_new_session=True)
    while process.poll() is None and not (log.exists() and log.read_text().count("\n") > 20):
        time.sleep(0.005)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    done = len(log.read_text().splitlines())
    assert 20 < done and not out.exists(), "it was killed in the middle"
    with open(log, "a") as file:
        file.write('{"run": 99, "inp')
    subprocess.run([sys.executable, str(script)], check=True)
    assert len(log.read_text().splitlines()) == 101
    assert out.read_text() == cc67.sweep(program, VARIATIONS, following).csv()


posix = pytest.mark.skipif(sys.platform == "win32", reason="processes are killed by signals")


@posix
def test_a_run_that_kills_its_process_is_a_failed_row(write: Write, tmp_path: Path) -> None:
    program, grid, log = cc67.compile(write(WAIT)), {"persist.5": range(40)}, tmp_path / "sweep.log"
    table = cc67.sweep(program, grid, kills_at_three, executor="processes", workers=2, log=log)
    (failure,) = table.failures
    assert failure["persist.5"] == 3 and failure["error"] == "ProcessError: the process of this run was killed 3 times"
    assert table.good["value"] == [number for number in range(40) if number != 3]
    again = cc67.sweep(program, grid, kills_at_three, executor="processes", workers=2, log=log)
    assert again == table


WAITING = """
import sys
sys.path.insert(0, {tests!r})
import cc67, sweep_measures
if __name__ == "__main__":
    cc67.sweep({program!r}, {{"file": [{file!r}] * 8}}, sweep_measures.waits_for_ever, executor="processes", workers=2)
"""


@posix
def test_the_processes_of_a_sweep_end_with_the_one_that_started_them(write: Write, tmp_path: Path) -> None:
    script, file = tmp_path / "script.py", tmp_path / "numbers"
    file.touch()
    names = {"tests": str(Path(__file__).parent), "program": str(write(WAIT)), "file": str(file)}
    script.write_text(WAITING.format(**names))
    process = subprocess.Popen([sys.executable, str(script)])
    while process.poll() is None and file.read_text().count("\n") < 2:
        time.sleep(0.01)
    process.kill()
    process.wait()
    children = [int(line) for line in file.read_text().split()]
    assert len(children) >= 2
    deadline = time.monotonic() + 20
    while any(is_running(child) for child in children):
        assert time.monotonic() < deadline, "a process has outlived the one that started it"
        time.sleep(0.02)


def is_running(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    status = Path(f"/proc/{process}/stat")
    # Where nobody waits for orphans, a process that has ended keeps its number.
    return not (status.exists() and status.read_text().rpartition(")")[2].split()[0] == "Z")


def test_columns_of_parquet_have_one_type_in_all_shards(write: Write, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    path, grid = write(SPIN), {"persist.5": range(6), "scale": [1, 2.5]}
    types = set()
    for shard in ("1/4", "2/4", "3/4", "4/4"):
        table = cc67.sweep(path, grid, fails_at_three, shard=shard)
        table.save(tmp_path / "shard.parquet")
        schema = parquet.read_schema(tmp_path / "shard.parquet")
        types.add(tuple((name, str(schema.field(name).type)) for name in schema.names))
    assert types == {(("persist.5", "int64"), ("scale", "double"), ("value", "double"), ("error", "string"))}


def test_the_log_of_another_sweep_is_refused(write: Write, tmp_path: Path) -> None:
    path, log = write(SPIN), tmp_path / "sweep.log"
    cc67.sweep(path, {"persist.5": [1, 2]}, double, log=log)
    with pytest.raises(cc67.InputError, match="another sweep"):
        cc67.sweep(path, {"persist.5": [1, 3]}, double, log=log)
    for options in ({"until": 0.01}, {"set": {"persist.6": 1}}):
        with pytest.raises(cc67.InputError, match="another sweep"):
            cc67.sweep(path, {"persist.5": [1, 2]}, {"t": "time"}, log=log, **options)
    (tmp_path / "text").write_text("not a log\n")
    with pytest.raises(cc67.InputError, match="not the log"):
        cc67.sweep(path, {"persist.5": [1, 2]}, double, log=tmp_path / "text")


def test_a_log_belongs_to_one_end_of_the_runs(write: Write, tmp_path: Path) -> None:
    path, log = write(WAIT), tmp_path / "sweep.log"

    def times(until: float | cc67.Condition) -> list[float]:
        return cc67.sweep(path, {"persist.5": [1]}, {"t": "time"}, log=log, until=until)["t"]

    assert times(1.0) == times(1) == [pytest.approx(1.0, abs=1e-4)]
    for other in (0.5, "persist.5 == 1", cc67.ended(2)):
        with pytest.raises(cc67.InputError, match="until"):
            times(other)


def test_a_log_belongs_to_the_content_of_its_machine_file(write: Write, tmp_path: Path) -> None:
    path, machine, log = write(SPIN), tmp_path / "mill.toml", tmp_path / "sweep.log"
    machine.write_text("[axis.0]\nlag_s = 0.001\n")
    cc67.sweep(path, {"persist.5": [1]}, double, log=log, machine=machine)
    machine.write_text("[axis.0]\nlag_s = 0.002\n")
    with pytest.raises(cc67.InputError, match="another sweep"):
        cc67.sweep(path, {"persist.5": [1]}, double, log=log, machine=machine)


def test_another_timeout_repeats_the_runs_that_it_ended(write: Write, tmp_path: Path) -> None:
    path, log = write(DELAY), tmp_path / "sweep.log"

    def errors(timeout: float) -> list[bool]:
        table = cc67.sweep(path, {"persist.5": [1, 3]}, {"t": "time"}, log=log, timeout=timeout)
        return [error is not None for error in table["error"]]

    assert errors(0.2) == [False, True]
    first = log.read_text()
    assert errors(0.2) == [False, True] and log.read_text() == first
    assert errors(1) == [False, False] and len(log.read_text().splitlines()) == 3
    assert errors(0.01) == [False, False], "runs that ended in time keep their results"


def test_shards_are_merged(write: Write, tmp_path: Path) -> None:
    path = write(SPIN)
    grid = {"persist.5": range(7)}
    logs = [tmp_path / f"{number}.log" for number in (1, 2, 3)]
    parts = [cc67.sweep(path, grid, double, log=log, shard=f"{n}/3") for n, log in enumerate(logs, 1)]
    assert [len(part) for part in parts] == [3, 2, 2]
    assert cc67.merge(*logs) == cc67.sweep(path, grid, double)
    with pytest.raises(cc67.InputError, match="2 of 7 runs are missing"):
        cc67.merge(*logs[:2])
    with pytest.raises(cc67.InputError, match="shard"):
        cc67.sweep(path, grid, double, shard="4/3")


def test_what_is_not_the_log_of_a_sweep_is_not_merged(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="missing.log"):
        cc67.merge(tmp_path / "missing.log")
    with pytest.raises(cc67.InputError, match="no log"):
        cc67.merge()
    for name, content in {"text": b"not a log\n", "binary": b"\xff\xfe\n", "empty": b"", "old": b'{"sweep": "x"}\n'}.items():
        (tmp_path / name).write_bytes(content)
        with pytest.raises(cc67.InputError, match="not the log of a sweep"):
            cc67.merge(tmp_path / name)


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"grid": 5}, TypeError, "grid"),
        ({"grid": {"persist.5": 5}}, TypeError, "list"),
        ({"grid": {"persist.5": [object()]}}, TypeError, "number or a string"),
        ({"measure": 5}, TypeError, "measure"),
        ({"executor": "quantum"}, TypeError, "threads"),
        ({"until": [1]}, TypeError, "a condition or a number of seconds"),
        ({"timeout": "1"}, TypeError, "a number of seconds"),
        ({"machin": "x.toml"}, cc67.UnknownNameError, "did you mean 'machine'"),
        ({"executor": "processes", "measure": lambda board: 1}, TypeError, "functions of a module"),
    ],
)
def test_wrong_sweeps_are_exceptions(
    write: Write, arguments: dict[str, object], error: type[Exception], message: str
) -> None:
    given = {"grid": {"persist.5": [1]}, "measure": double, **arguments}
    with pytest.raises(error, match=message):
        cc67.sweep(write(SPIN), **given)  # type: ignore[arg-type]


def test_tables_are_saved(write: Write, tmp_path: Path) -> None:
    table = cc67.sweep(write(SPIN), {"persist.5": range(3)}, fails_at_three)
    table.save(tmp_path / "table.csv")
    assert (tmp_path / "table.csv").read_text() == "persist.5,value,error\n0,0.0,\n1,2.0,\n2,4.0,\n"
    table.save(tmp_path / "table.json")
    assert json.loads((tmp_path / "table.json").read_text().splitlines()[2])["value"] == 4.0
    with pytest.raises(cc67.InputError, match=".parquet"):
        table.save(tmp_path / "table.xls")
    try:
        import pyarrow.parquet as parquet  # type: ignore[import-untyped, import-not-found, unused-ignore]
    except ImportError:
        with pytest.raises(cc67.NotBuiltError, match="pyarrow"):
            table.save(tmp_path / "table.parquet")
    else:
        table.save(tmp_path / "table.parquet")
        assert parquet.read_table(tmp_path / "table.parquet").column("value").to_pylist() == [0.0, 2.0, 4.0]


SWEEP = """
program = "spin.c"
[measure]
double = "persist.20"
took = "time"
[grid]
"persist.5" = [1, 2]
"axis.0.lag_s" = { from = 0.001, to = 0.002, steps = 3 }
"""


def test_a_sweep_is_written_down(write: Write, tmp_path: Path) -> None:
    from cc67._command import run

    write(SPIN, "spin.c")
    file = tmp_path / "spin.toml"
    file.write_text(SWEEP)
    result = run(["sweep", str(file), "-o", str(tmp_path / "table.csv"), "--workers", "2"])
    assert result.returncode == 0, result.stderr
    rows = (tmp_path / "table.csv").read_text().splitlines()
    assert rows[0] == "persist.5,axis.0.lag_s,double,took,error" and len(rows) == 7 and rows[4].startswith("2,0.001,4.0,")
    for shard in ("1/2", "2/2"):
        assert run(["sweep", str(file), "--shard", shard]).returncode == 0
    logs = [str(tmp_path / f"spin.{shard}.sweep") for shard in ("1-2", "2-2")]
    assert run(["sweep", "--merge", *logs]).stdout.splitlines() == rows
    result = run(["sweep", "--merge", logs[0]])
    assert result.returncode == 2 and "3 of 6 runs are missing" in result.stderr
    file.write_text("until = 1\ntimeout = 2\n" + SWEEP)
    result = run(["sweep", str(file), "--log", str(tmp_path / "until.sweep")])
    assert result.returncode == 0 and ",0.99999," in result.stdout, result.stderr
    file.write_text(SWEEP.replace("[grid]", "[gird]"))
    result = run(["sweep", str(file)])
    assert result.returncode == 2 and "did you mean 'grid'" in result.stderr
