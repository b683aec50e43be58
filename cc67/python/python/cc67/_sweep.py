"""Many runs over parameters, on one machine or many."""

from __future__ import annotations

import hashlib
import itertools
import json
import os
import pickle
import sys
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor, wait
from pathlib import Path
from typing import Any, Iterable, Iterator, Mapping, Sequence, Union

from . import _program
from ._errors import InputError
from ._program import PathLike, Program
from ._sweep_run import Batch, Inputs, Measure, run_batch
from ._table import Table

__all__ = ["Grid", "merge", "sweep"]

Grid = Union[Mapping[str, Iterable[Any]], Iterable[Mapping[str, Any]]]
Source = Union[Program, PathLike]

# Runs that are executed together: enough to hide what it takes to send them.
_BATCH = 16


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
    until: Any = None,
    timeout: float = 60.0,
    **board: Any,
) -> Table:
    """Runs a program once for each combination of parameters, and measures each run.

    Args:
        program: a program, or several for threads 1, 2, …; compiled once, or once for each combination of macros.
        grid: values by name, `{"axis.0.inertia": [1, 2], "persist.5": range(10)}`, all combinations of which are run
            with the last name changing fastest; or the inputs of each run, `[{"persist.5": 3}, …]`. A name is a key of
            the machine file, `persist.N`, `persist.float.N`, `persist.double.N`, `macro.NAME` (compiled in),
            `bit.N`, `adc.N` (levels from the beginning), `stim` (statements); any other, such as `seed`, is for
            `measure`.
        measure: a function of the board, or of the board and the inputs, that lets time pass and returns a number,
            several, or a mapping of names; or a mapping of names to expressions, whose values are taken at the end.
        executor: "threads" (the default), "processes", or any `concurrent.futures.Executor`: Dask's
            `client.get_executor()`, Ray's, `mpi4py.futures.MPIPoolExecutor`. Beyond threads, `measure` must be a function
            of a module.
        workers: how many threads or processes; else one for each processor.
        log: a file that takes every result as soon as it is there. A sweep with a log that exists goes on where it was
            interrupted.
        shard: "2/8" or (2, 8): only the second of eight parts, for a job array; `merge` joins the logs.
        progress: whether a bar is shown on stderr; by default on a terminal.
        until: for expressions, what ends a run: a condition of `Board.run_until`, or seconds as a float; else the end
            of all programs.
        timeout: seconds of board time that this may take.
        **board: arguments of `cc67.Board` that all runs have in common: `machine`, `stim`, `set`; `engine`, which is
            "bytecode" here, as short runs are over before a program is translated to machine code.

    Returns:
        A row for each run in the order of the inputs, the same on whatever executor. A run that fails is a row with its
        inputs and `error`.

    Example:
        >>> def settling(board: cc67.Board) -> float:
        ...     board.run()
        ...     return board.time
        >>> table = cc67.sweep("move.c", {"axis.0.inertia": [0.5, 1, 2]}, settling)
        >>> table["value"]
        [2.31, 2.31, 2.32]
    """
    if not callable(measure) and not isinstance(measure, Mapping):
        raise TypeError(f"measure is a function or a mapping of names to expressions, not {measure!r}")
    # Short runs are over before a program is translated to machine code.
    board.setdefault("engine", "bytecode")
    inputs = _inputs(grid)
    programs = _Programs(program)
    rows = _part(list(enumerate(inputs)), shard)
    _check_board(board)
    known = _Log(log, programs, inputs, board, measure)
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
    """The table of several logs of one sweep, each of a shard."""
    inputs: dict[int, Inputs] = {}
    results: dict[int, dict[str, Any]] = {}
    prints = set()
    for log in logs:
        lines = _lines(Path(log))
        if not lines or "sweep" not in lines[0]:
            raise InputError(f"{os.fspath(log)} is not the log of a sweep")
        prints.add(lines[0]["sweep"])
        for line in lines[1:]:
            inputs[line["run"]] = line["inputs"]
            results[line["run"]] = line["outputs"]
    if len(prints) > 1:
        raise InputError("the logs are of different sweeps")
    return _table([inputs[number] for number in sorted(inputs)], dict(enumerate(results[n] for n in sorted(results))))


def _table(inputs: Sequence[Inputs], results: Mapping[int, Mapping[str, Any]]) -> Table:
    names = list(dict.fromkeys(name for each in inputs for name in each))
    rows = [{**inputs[number], **results[number]} for number in sorted(results)]
    return Table(rows, names)


def _inputs(grid: Grid) -> list[Inputs]:
    """The inputs of each run."""
    if isinstance(grid, Mapping):
        for name, values in grid.items():
            if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
                raise TypeError(f"the values of {name!r} are a list, not {values!r}")
        names = [str(name) for name in grid]
        combinations = itertools.product(*[list(values) for values in grid.values()])
        rows = [dict(zip(names, values)) for values in combinations]
    elif isinstance(grid, (str, bytes)) or not isinstance(grid, Iterable):
        raise TypeError(f"a grid is a mapping of names to values, or the inputs of each run, not {grid!r}")
    else:
        rows = []
        for each in grid:
            if not isinstance(each, Mapping):
                raise TypeError(f"the inputs of a run are a mapping of names to values, not {each!r}")
            rows.append({str(name): value for name, value in each.items()})
    return [{name: _plain(name, value) for name, value in row.items()} for row in rows]


def _plain(name: str, value: Any) -> Any:
    if hasattr(value, "item") and getattr(value, "ndim", 1) == 0:
        value = value.item()
    if value is not None and not isinstance(value, (bool, int, float, str)):
        raise TypeError(f"a value of {name!r} is a number or a text, not {value!r}")
    return value


def _check_board(board: Mapping[str, Any]) -> None:
    from inspect import signature

    from ._board import Board
    from ._errors import unknown

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
    """The rows of a shard: every n-th."""
    if shard is None:
        return rows
    try:
        which, count = (int(each) for each in (shard.split("/") if isinstance(shard, str) else shard))
    except ValueError:
        raise InputError(f'a shard is "2/8", the second of eight, not {shard!r}') from None
    if not 1 <= which <= count:
        raise InputError(f"there is no shard {which} of {count}")
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
        self._made: dict[tuple[tuple[str, Any], ...], list[Program]] = {}
        self.of({})

    def of(self, inputs: Inputs) -> list[Program]:
        """Those of a run."""
        macros = {name[6:]: value for name, value in inputs.items() if name.startswith("macro.")}
        key = tuple(sorted(macros.items()))
        if key not in self._made:
            self._made[key] = [_compile(source, macros) for source in self._sources]
        return self._made[key]


def _compile(source: Source, macros: Mapping[str, Any]) -> Program:
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
    options["define"] += [f"{name}={_program._macro_value(value)}" for name, value in macros.items()]
    return _program.compile(source._files, thread=source.thread, **options)


def _without_macros(program: Program, macros: Mapping[str, Any]) -> Program:
    if macros:
        raise InputError(f"{program.path} is an image: macros such as {next(iter(macros))!r} need its source")
    return program


def _execute(
    batches: Sequence[Batch], executor: Executor | str | None, workers: int | None
) -> Iterator[tuple[int, dict[str, Any]]]:
    """The results as they come."""
    if executor is None or executor == "threads":
        with ThreadPoolExecutor(workers or os.cpu_count()) as pool:
            yield from _on(pool, batches)
    elif executor == "processes":
        _check_pickle(batches)
        with ProcessPoolExecutor(workers or os.cpu_count(), mp_context=_context()) as pool:
            yield from _on(pool, batches)
    elif hasattr(executor, "submit"):
        if not isinstance(executor, ThreadPoolExecutor):
            _check_pickle(batches)
        yield from _on(executor, batches)  # type: ignore[arg-type]
    else:
        raise TypeError(f'executor is "threads", "processes" or a concurrent.futures.Executor, not {executor!r}')


def _context() -> Any:
    """Processes that begin as copies of this one where that is usual, so that functions of a notebook are there."""
    import multiprocessing

    return multiprocessing.get_context("fork" if sys.platform == "linux" else "spawn")


def _check_pickle(batches: Sequence[Batch]) -> None:
    try:
        for batch in batches[:1]:
            pickle.dumps(batch)
    except Exception as error:
        raise TypeError(
            f"`measure` and its like go to other processes, so they must be functions of a module: {error}"
        ) from error


def _on(executor: Executor, batches: Sequence[Batch]) -> Iterator[tuple[int, dict[str, Any]]]:
    left: set[Future[list[tuple[int, dict[str, Any]]]]] = {executor.submit(run_batch, batch) for batch in batches}
    try:
        while left:
            done, left = wait(left, return_when=FIRST_COMPLETED)
            for future in done:
                yield from future.result()
    finally:
        for future in left:
            future.cancel()


class _Log:
    """The results of a sweep, and the file that keeps them: a line for the sweep, then one for each run."""

    def __init__(
        self,
        path: PathLike | None,
        programs: _Programs,
        inputs: Sequence[Inputs],
        board: Mapping[str, Any],
        measure: Measure,
    ) -> None:
        self.results: dict[int, dict[str, Any]] = {}
        self._file = None
        if path is None:
            return
        name = measure if isinstance(measure, Mapping) else getattr(measure, "__qualname__", repr(type(measure)))
        images = [program.image() for program in programs.of({})]
        told = repr((images, list(inputs), sorted((key, repr(value)) for key, value in board.items()), name))
        fingerprint = hashlib.sha256(told.encode()).hexdigest()
        lines = _lines(Path(path))
        if lines and lines[0].get("sweep") != fingerprint:
            raise InputError(
                f"{os.fspath(path)} is the log of another sweep: program, inputs, board or measure differ; remove it, or "
                "name another log"
            )
        for line in lines[1:]:
            self.results[line["run"]] = line["outputs"]
        kept = [{"sweep": fingerprint}, *lines[1:]]
        # What was interrupted in the middle of a line is rewritten.
        Path(path).write_text("".join(json.dumps(line) + "\n" for line in kept), encoding="utf-8")
        self._file = open(path, "a", encoding="utf-8")

    def add(self, number: int, inputs: Inputs, outputs: dict[str, Any]) -> None:
        """Takes up a result."""
        self.results[number] = outputs
        if self._file is not None:
            self._file.write(json.dumps({"run": number, "inputs": inputs, "outputs": outputs}) + "\n")
            self._file.flush()

    def close(self) -> None:
        """No more come."""
        if self._file is not None:
            self._file.close()


def _lines(path: Path) -> list[dict[str, Any]]:
    """The lines of a log, up to the first that is not whole."""
    lines: list[dict[str, Any]] = []
    if not path.exists():
        return lines
    for text in path.read_text(encoding="utf-8").splitlines():
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
    """How far the sweep is, on a terminal."""

    def __init__(self, total: int, done: int, is_shown: bool | None) -> None:
        self._total, self._done = total, done
        self._is_shown = sys.stderr.isatty() if is_shown is None else is_shown

    def step(self) -> None:
        """One more run is over."""
        self._done += 1
        if self._is_shown:
            width = 40 * self._done // max(1, self._total)
            bar = "#" * width + "." * (40 - width)
            print(f"\r[{bar}] {self._done}/{self._total}", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        """The sweep is over."""
        if self._is_shown:
            print(file=sys.stderr)
