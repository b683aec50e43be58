"""Many runs over parameters, on one computer or many."""

from __future__ import annotations

import hashlib
import itertools
import json
import os
import pickle
import sys
from collections import deque
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from dataclasses import is_dataclass, replace
from numbers import Real
from pathlib import Path
from typing import Any, Iterable, Iterator, Mapping, Sequence, TextIO, Union

from . import _program
from ._board import Board, Condition, _assign, _Event, _machine, _stimuli
from ._errors import InputError, unknown
from ._program import PathLike, Program, _macro_value
from ._sweep_run import Batch, Inputs, Measure, Result, end_with_parent, is_timeout, run_batch
from ._table import Table

__all__ = ["Grid", "merge", "sweep"]

Grid = Union[Mapping[str, Iterable[Any]], Iterable[Mapping[str, Any]]]
Source = Union[Program, PathLike]

# Most runs in a batch: enough to make the cost of sending a batch small.
_BATCH = 16

# Times that a run may kill its process before it has failed.
_KILLS = 3


def sweep(
    program: Source | Sequence[Source],
    grid: Grid,
    measure: Measure,
    *,
    executor: Executor | str | None = None,
    workers: int | None = None,
    log: PathLike | None = None,
    shard: str | tuple[int, int] | None = None,
    progress: bool | None = None,
    until: Condition | float | None = None,
    timeout: float = 60.0,
    **board: Any,
) -> Table:
    """Run a program once for each combination of parameters, and measure each run.

    Args:
        program: a program, or several for threads 1, 2, …; compiled once, or once for each combination of macros.
        grid: a mapping of names to values, `{"axis.0.inertia": [1, 2], "persist.5": range(10)}`, all combinations of
            which are run, the last name changing fastest; or a list with the inputs of each run,
            `[{"persist.5": 3}, …]`. A name is a key of the machine file, `persist.N`, `persist.float.N`,
            `persist.double.N`, `macro.NAME` (compiled in), `bit.N` or `adc.N` (the level from the beginning), or `stim`
            (statements); any other name, such as `seed`, is for `measure` only.
        measure: a function `measure(board)` or `measure(board, inputs)` that lets board time pass and returns a number
            (column `value`), several (`value0`, `value1`, …), or a mapping of names to values; or a mapping of names to
            expressions, which are evaluated at the end of the run.
        executor: "threads" (the default), "processes", or any `concurrent.futures.Executor`, such as Dask's
            `client.get_executor()`. Except with threads, `measure` must be a function of a module. With "processes", a
            run that kills its process three times has failed, and the sweep continues; the processes end with this one.
        workers: the number of threads or processes; by default one for each processor.
        log: a file that receives each result as soon as it is known. If it exists, the sweep continues where it was
            interrupted. It belongs to a sweep with the same programs, inputs, arguments of the board, measure and
            `until`; of a function, only the name is compared. With another `timeout`, the runs that ended in time keep
            their results, and those that the old timeout ended are repeated.
        shard: "2/8" or (2, 8) runs only the second of eight parts, for a job array; `merge` joins the logs.
        progress: whether to show a progress bar on stderr; by default only on a terminal.
        until: if `measure` has expressions, when a run ends: a condition of `Board.run_until`, or seconds of board
            time; by default, when all programs have ended.
        timeout: if `measure` has expressions, the seconds of board time after which a run that has not ended fails.
        **board: arguments of `cc67.Board` for all runs, such as `machine`, `stim` and `set`. `engine` is "bytecode" by
            default, because short runs end before translating the program to machine code pays off.

    Returns:
        A table with a row for each run in the order of the inputs, the same with every executor. The row of a run that
        failed has its inputs and the reason, `error`.

    Raises:
        CompileError: a program has errors.
        InputError: the log belongs to another sweep, or an argument is invalid.
        OSError: a file cannot be read or written.

    Example:
        >>> def settling(board: cc67.Board) -> float:
        ...     board.run()
        ...     return board.time
        >>> table = cc67.sweep("move.c", {"axis.0.inertia": [0.5, 1, 2]}, settling)
        >>> table["value"]
        [2.31, 2.31, 2.32]
    """
    if not callable(measure) and not isinstance(measure, Mapping):
        raise TypeError(f"measure must be a function or a mapping of names to expressions, not {measure!r}")
    # Short runs end before translating the program to machine code pays off.
    board.setdefault("engine", "bytecode")
    until, timeout = _until(until), _seconds("timeout must be a number of seconds", timeout)
    inputs = _inputs(grid)
    programs = _Programs(program)
    rows = _part(list(enumerate(inputs)), shard)
    _check_board(board)
    known = _Log(timeout)
    if log is not None:
        known.open(Path(log), _fingerprint(programs, inputs, board, measure, until), len(inputs))
    left = [(number, each) for number, each in rows if number not in known.results]
    batches = [
        Batch([(number, each, programs.of(each)) for number, each in part], board, measure, until, timeout)
        for part in _parts(left)
    ]
    bar = _Bar(len(rows), len(rows) - len(left), progress)
    try:
        for number, outputs in _execute(batches, executor, workers):
            known.add(number, inputs[number], outputs)
            bar.step()
    finally:
        bar.close()
        known.close()
    return _table(inputs, {number: known.results[number] for number, _ in rows})


def merge(*logs: PathLike) -> Table:
    """Join the logs of all shards of one sweep into a table.

    Raises:
        InputError: a file is not the log of a sweep, the logs belong to different sweeps, or runs are missing.
        OSError: a file cannot be read.
    """
    if not logs:
        raise InputError("there is no log to merge")
    inputs: dict[int, Inputs] = {}
    results: dict[int, dict[str, Any]] = {}
    sweeps = set()
    for log in logs:
        lines = _lines(Path(log))
        if not lines or not {"sweep", "runs"} <= lines[0].keys():
            raise InputError(f"{os.fspath(log)} is not the log of a sweep, or not of this version of cc67")
        sweeps.add((lines[0]["sweep"], lines[0]["runs"]))
        for line in lines[1:]:
            inputs[line["run"]] = line["inputs"]
            results[line["run"]] = line["outputs"]
    if len(sweeps) > 1:
        raise InputError("the logs belong to different sweeps")
    ((_, runs),) = sweeps
    if len(results) < runs:
        raise InputError(
            f"{runs - len(results)} of {runs} runs are missing: merge the logs of all shards, after all have finished"
        )
    return _table([inputs[number] for number in range(runs)], results)


def _table(inputs: Sequence[Inputs], results: Mapping[int, Mapping[str, Any]]) -> Table:
    names = list(dict.fromkeys(name for each in inputs for name in each))
    rows = [{**inputs[number], **results[number]} for number in sorted(results)]
    return Table(rows, names)


def _inputs(grid: Grid) -> list[Inputs]:
    """Return the inputs of each run."""
    if isinstance(grid, Mapping):
        for name, values in grid.items():
            if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
                raise TypeError(f"the values of {name!r} must be a list, not {values!r}")
        names = [str(name) for name in grid]
        combinations = itertools.product(*[list(values) for values in grid.values()])
        rows = [dict(zip(names, values)) for values in combinations]
    elif isinstance(grid, (str, bytes)) or not isinstance(grid, Iterable):
        raise TypeError(f"grid must be a mapping of names to values, or a list of the inputs of each run, not {grid!r}")
    else:
        rows = []
        for each in grid:
            if not isinstance(each, Mapping):
                raise TypeError(f"the inputs of a run must be a mapping of names to values, not {each!r}")
            rows.append({str(name): value for name, value in each.items()})
    plain = [{name: _plain(name, value) for name, value in row.items()} for row in rows]
    # An input has one type in all shards, whichever of its values a shard has.
    floats = {name for row in plain for name, value in row.items() if isinstance(value, float)}
    return [{name: _alike(name in floats, value) for name, value in row.items()} for row in plain]


def _alike(is_float: bool, value: Any) -> Any:
    return float(value) if is_float and type(value) is int else value


def _plain(name: str, value: Any) -> Any:
    if hasattr(value, "item") and getattr(value, "ndim", 1) == 0:
        value = value.item()
    if value is not None and not isinstance(value, (bool, int, float, str)):
        raise TypeError(f"a value of {name!r} must be a number or a string, not {value!r}")
    return value


def _until(until: Condition | float | None) -> Condition | float | None:
    if until is None or isinstance(until, (str, _Event)) or callable(until):
        return until
    return _seconds("until must be a condition or a number of seconds", until)


def _seconds(rule: str, value: float) -> float:
    """Return a time as a float; raise `TypeError` with the rule if it is not a number."""
    if isinstance(value, bool) or not isinstance(value, Real):
        raise TypeError(f"{rule}, not {value!r}")
    return float(value)


def _check_board(board: Mapping[str, Any]) -> None:
    from inspect import signature

    known = [name for name in signature(Board).parameters if name != "programs"]
    for name in board:
        if name not in known:
            raise unknown("argument of a sweep or a board", name, known)
    stim = board.get("stim", [])
    if isinstance(stim, (str, os.PathLike)):
        assert isinstance(board, dict)
        board["stim"] = [stim]
    if not isinstance(board.get("set", {}), Mapping):
        raise TypeError("set must be a mapping in a sweep")


def _part(rows: list[tuple[int, Inputs]], shard: str | tuple[int, int] | None) -> list[tuple[int, Inputs]]:
    """Return the rows of a shard: every n-th."""
    if shard is None:
        return rows
    try:
        which, count = (int(each) for each in (shard.split("/") if isinstance(shard, str) else shard))
    except ValueError:
        raise InputError(f'shard must be like "2/8", the second of eight, not {shard!r}') from None
    if not 1 <= which <= count:
        raise InputError(f"no such shard: {which} of {count}")
    return rows[which - 1 :: count]


def _parts(rows: Sequence[tuple[int, Inputs]]) -> Iterator[Sequence[tuple[int, Inputs]]]:
    size = max(1, min(_BATCH, len(rows) // 8))
    return (rows[first : first + size] for first in range(0, len(rows), size))


class _Programs:
    """The programs of a sweep, compiled once for each combination of macros."""

    def __init__(self, program: Source | Sequence[Source]) -> None:
        self._sources: list[Source]
        if isinstance(program, (str, os.PathLike, Program)):
            self._sources = [program]
        else:
            self._sources = list(program)
        self._made: dict[tuple[tuple[str, str], ...], list[Program]] = {}

    def of(self, inputs: Inputs) -> list[Program]:
        """Return the programs for a run."""
        macros = {name[6:]: _macro_value(value) for name, value in inputs.items() if name.startswith("macro.")}
        key = tuple(sorted(macros.items()))
        if key not in self._made:
            self._made[key] = [_compile(source, macros) for source in self._sources]
        return self._made[key]

    def images(self, inputs: Iterable[Inputs]) -> list[bytes]:
        """Return the images of the programs for these runs, each once."""
        made = {id(programs): programs for programs in map(self.of, inputs)}
        return [program.image() for programs in made.values() for program in programs]


def _compile(source: Source, macros: Mapping[str, str]) -> Program:
    if not isinstance(source, Program):
        if Path(source).suffix.lower() == ".out":
            return _without_macros(_program.load(source), macros)
        return _program.compile(source, define=macros)
    if not macros:
        return source
    request = source._request
    if request is None:
        return _without_macros(source, macros)
    options: dict[str, Any] = {**request}
    options["define"] = [*(f"{name}={value}" for name, value in request["define"])]
    options["define"] += [f"{name}={value}" for name, value in macros.items()]
    return _program.compile(source._files, thread=source.thread, **options)


def _without_macros(program: Program, macros: Mapping[str, Any]) -> Program:
    if macros:
        raise InputError(f"{program.path} is an image; macros such as {next(iter(macros))!r} need its source")
    return program


def _execute(
    batches: Sequence[Batch], executor: Executor | str | None, workers: int | None
) -> Iterator[Result]:
    """Yield the results as they become known."""
    if executor is None or executor == "threads":
        with ThreadPoolExecutor(workers or os.cpu_count()) as pool:
            yield from _on(pool, batches)
    elif executor == "processes":
        _check_pickle(batches)
        yield from _on_processes(batches, workers or os.cpu_count() or 1)
    elif hasattr(executor, "submit"):
        if not isinstance(executor, ThreadPoolExecutor):
            _check_pickle(batches)
        yield from _on(executor, batches)  # type: ignore[arg-type]
    else:
        raise TypeError(f'executor must be "threads", "processes" or a concurrent.futures.Executor, not {executor!r}')


def _context() -> Any:
    """Return how to start processes: on Linux as copies of this one, so that they have the functions of a notebook."""
    import multiprocessing

    return multiprocessing.get_context("fork" if sys.platform == "linux" else "spawn")


def _check_pickle(batches: Sequence[Batch]) -> None:
    try:
        for batch in batches[:1]:
            pickle.dumps(batch)
    except Exception as error:
        raise TypeError(
            f"`measure` and other functions are sent to other processes, so they must be functions of a module: {error}"
        ) from error


def _on(executor: Executor, batches: Iterable[Batch]) -> Iterator[Result]:
    left = {executor.submit(run_batch, batch) for batch in batches}
    try:
        while left:
            done, left = wait(left, return_when=FIRST_COMPLETED)
            for future in done:
                yield from future.result()
    finally:
        for future in left:
            future.cancel()


def _on_processes(batches: Sequence[Batch], workers: int) -> Iterator[Result]:
    """Yield the results of runs in processes; a run that kills its process again and again is a failed one."""
    left = deque(batches)
    while left:
        suspects: list[Batch] = []
        with _pool(workers) as pool:
            yield from _until_broken(pool, workers, left, suspects)
        # It is unknown which of them it was; alone in its process, a run can be blamed.
        for batch in suspects:
            for number, inputs, programs in batch.runs:
                yield from _alone(replace(batch, runs=[(number, inputs, programs)]))


def _until_broken(
    pool: ProcessPoolExecutor, workers: int, left: deque[Batch], suspects: list[Batch]
) -> Iterator[Result]:
    """Yield the results of the batches in `left`; if a process dies, keep those that it may have had in `suspects`."""
    running: dict[Future[list[Result]], Batch] = {}
    try:
        while left or running:
            while left and len(running) < 2 * workers and not suspects:
                try:
                    running[pool.submit(run_batch, left[0])] = left[0]
                except BrokenProcessPool:
                    break
                left.popleft()
            if not running:
                return
            for future in wait(running, return_when=FIRST_COMPLETED).done:
                batch = running.pop(future)
                try:
                    yield from future.result()
                except BrokenProcessPool:
                    suspects.append(batch)
    finally:
        for future in running:
            future.cancel()


def _alone(batch: Batch) -> Iterator[Result]:
    """Yield the result of a run in a process of its own: after some that died, a failure."""
    for _ in range(_KILLS):
        try:
            with _pool(1) as pool:
                yield from pool.submit(run_batch, batch).result()
            return
        except BrokenProcessPool:
            continue
    (number, _, _), *_ = batch.runs
    yield number, {"error": f"ProcessError: the process of this run was killed {_KILLS} times"}


def _pool(workers: int) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(workers, mp_context=_context(), initializer=end_with_parent)


def _fingerprint(
    programs: _Programs,
    inputs: Sequence[Inputs],
    board: Mapping[str, Any],
    measure: Measure,
    until: Condition | float | None,
) -> str:
    """Return what identifies a sweep in its log: all that can change the result of a run, except its timeout."""
    boot = board.get("boot")
    arguments = sorted((name, repr(_content(name, value, boot))) for name, value in board.items())
    # A function decides by itself when its run ends.
    end = until if isinstance(measure, Mapping) else None
    parts = (programs.images(inputs), list(inputs), arguments, _identity(measure), _identity(end))
    return hashlib.sha256(repr(parts).encode()).hexdigest()


def _content(name: str, value: Any, boot: str | None) -> Any:
    """Return an argument of `Board` with the content of the files that it names."""
    if name == "machine" and isinstance(value, (str, os.PathLike)):
        return _machine(value)
    if name == "stim":
        return _stimuli(value)
    if name == "boot" and value is not None:
        return Path(value).read_bytes()
    if name == "load":
        return [(thread, program.image(thread)) for thread, program, _ in _assign((), value, {"boot": boot})]
    return value


def _identity(value: Any) -> str:
    """Return a measure or a condition as a text that is the same in every process: for a function, its name."""
    if callable(value) and not is_dataclass(value):
        return str(getattr(value, "__qualname__", type(value)))
    return repr(value)


class _Log:
    """The results of a sweep, and the file that keeps them: a line for the sweep, then one for each run."""

    def __init__(self, timeout: float) -> None:
        self.results: dict[int, dict[str, Any]] = {}
        self._timeout = timeout
        self._file: TextIO | None = None

    def open(self, path: Path, fingerprint: str, runs: int) -> None:
        """Take the results that a file has, and write all others to it."""
        lines = _lines(path) if path.exists() else []
        if lines and lines[0].get("sweep") != fingerprint:
            raise InputError(
                f"{path} is the log of another sweep: program, inputs, board, measure or until differ, or it was "
                "written by another version of cc67; delete it, or choose another log"
            )
        kept = [line for line in lines[1:] if line.get("timeout", self._timeout) == self._timeout]
        self.results = {line["run"]: line["outputs"] for line in kept}
        # Drop a line that was interrupted in the middle, and the runs that another timeout ended.
        kept.insert(0, {"sweep": fingerprint, "runs": runs})
        path.write_text("".join(json.dumps(line) + "\n" for line in kept), encoding="utf-8")
        self._file = path.open("a", encoding="utf-8")

    def add(self, number: int, inputs: Inputs, outputs: dict[str, Any]) -> None:
        """Add a result."""
        self.results[number] = outputs
        if self._file is not None:
            line: dict[str, Any] = {"run": number, "inputs": inputs, "outputs": outputs}
            if is_timeout(outputs):
                line["timeout"] = self._timeout
            self._file.write(json.dumps(line) + "\n")
            self._file.flush()

    def close(self) -> None:
        """Close the file."""
        if self._file is not None:
            self._file.close()


def _lines(path: Path) -> list[dict[str, Any]]:
    """Return the lines of a log, up to the first incomplete one."""
    lines: list[dict[str, Any]] = []
    for text in path.read_text(encoding="utf-8", errors="replace").splitlines():
        try:
            line = json.loads(text)
        except ValueError:
            break
        if not isinstance(line, dict):
            break
        lines.append(line)
    if not lines and path.stat().st_size:
        raise InputError(f"{path} is not the log of a sweep")
    return lines


class _Bar:
    """The progress of a sweep, on a terminal."""

    def __init__(self, total: int, done: int, is_shown: bool | None) -> None:
        self._total, self._done = total, done
        self._is_shown = sys.stderr.isatty() if is_shown is None else is_shown

    def step(self) -> None:
        """Count one more run."""
        self._done += 1
        if self._is_shown:
            width = 40 * self._done // max(1, self._total)
            bar = "#" * width + "." * (40 - width)
            print(f"\r[{bar}] {self._done}/{self._total}", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        """End the line of the bar."""
        if self._is_shown:
            print(file=sys.stderr)
