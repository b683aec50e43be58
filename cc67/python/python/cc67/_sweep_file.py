"""`cc67 sweep FILE.toml`: a sweep described by a file.

    program = "move.c"                  # or several, for threads 1, 2, …
    machine = "mill.toml"
    stim = "at 0.1s bit 136 = 1"        # statements, a file, or several
    until = "count == 3"                # when a run ends: an expression, or seconds; else at the end of the programs
    timeout = 10.0                      # seconds of board time after which a run that has not ended fails

    [measure]                           # expressions, evaluated at the end; `time` is the board time in seconds
    dest = "ch0->Dest"
    took = "time"

    [grid]                              # all combinations, the last name changing fastest
    "axis.0.inertia" = [0.5, 1, 2]
    "axis.0.friction" = { from = 0, to = 10, steps = 11 }

    [set]                               # start values and machine file keys of all runs
    "persist.5" = 3

Instead of `[grid]`, tables `[[sample]]` can give the inputs of each run. File names are relative to the folder of the
file.
"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path
from typing import Any, Mapping

from ._errors import CompileError, Error, InputError, unknown
from ._sweep import merge, sweep
from ._table import Table

__all__ = ["main"]

_KEYS = ("program", "machine", "stim", "until", "timeout", "measure", "grid", "sample", "set", "engine")


def main(arguments: list[str]) -> int:
    """Run the command and return its exit code.

    0 for success, 1 if a run failed or a program has errors, 2 for wrong usage or input, 130 after Ctrl-C.
    """
    parser = argparse.ArgumentParser("cc67 sweep", description="Run a program for many parameters and make a table")
    parser.add_argument("file", nargs="+", metavar="FILE", help="the sweep (.toml); with --merge, its logs")
    parser.add_argument("-o", "--output", metavar="TABLE", help="write a .csv, .json or .parquet file; otherwise print")
    parser.add_argument("--log", metavar="FILE", help="log of the results, to continue from [default: FILE.sweep]")
    parser.add_argument("--workers", type=int, metavar="N", help="run N at a time [default: one for each processor]")
    parser.add_argument(
        "--executor",
        choices=["threads", "processes"],
        default="threads",
        help="execute the runs in threads (default) or processes",
    )
    parser.add_argument("--shard", metavar="I/N", help="run only part I of N, for a job array")
    parser.add_argument("--merge", action="store_true", help="join the logs of all shards into one table")
    given = parser.parse_args(arguments)
    try:
        table = merge(*given.file) if given.merge else _run(given)
        if given.output:
            table.save(given.output)
        else:
            sys.stdout.write(table.csv())
    except CompileError as error:
        print(error, file=sys.stderr)
        return 1
    except (Error, OSError, TypeError) as error:
        print(f"cc67: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("cc67: interrupted; the same command continues from here", file=sys.stderr)
        return 130
    failed = len(table.failures)
    if failed:
        print(f"cc67: {failed} of {len(table)} runs failed; `error` in the table says why", file=sys.stderr)
    return 1 if failed else 0


def _run(given: argparse.Namespace) -> Table:
    if len(given.file) != 1:
        raise InputError("only one sweep file can be run; several files are for --merge")
    path = Path(given.file[0])
    request = _read(path)
    for key in request:
        if key not in _KEYS:
            raise unknown(f"key in {path}", key, _KEYS)
    for key in ("program", "measure"):
        if key not in request:
            raise InputError(f"{path} has no `{key}`")
    if ("grid" in request) == ("sample" in request):
        raise InputError(f"{path} needs either [grid] or [[sample]]")
    folder = path.parent
    programs = request["program"]
    programs = [folder / each for each in ([programs] if isinstance(programs, str) else programs)]
    board: dict[str, Any] = {key: request[key] for key in ("set", "engine") if key in request}
    if "machine" in request:
        board["machine"] = folder / request["machine"]
    if "stim" in request:
        board["stim"] = [_stim(folder, each) for each in _list(request["stim"])]
    shard = f".{given.shard.replace('/', '-')}" if given.shard else ""
    return sweep(
        programs,
        _grid(path, request["grid"]) if "grid" in request else request["sample"],
        request["measure"],
        executor=given.executor,
        workers=given.workers,
        log=given.log or path.with_suffix(f"{shard}.sweep"),
        shard=given.shard,
        until=request.get("until"),
        timeout=request.get("timeout", 60.0),
        **board,
    )


def _read(path: Path) -> dict[str, Any]:
    from importlib import import_module

    toml = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")
    try:
        request: dict[str, Any] = toml.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise InputError(f"{path}: {error}") from None
    return request


def _list(value: Any) -> list[Any]:
    return list(value) if isinstance(value, list) else [value]


def _stim(folder: Path, text: str) -> str:
    path = folder / text
    return os.fspath(path) if path.exists() else text


def _grid(path: Path, grid: Mapping[str, Any]) -> dict[str, list[Any]]:
    """Return the values of each name, given as a list or as `{ from, to, steps }`."""
    flat: dict[str, list[Any]] = {}
    for name, values in grid.items():
        if isinstance(values, Mapping):
            try:
                first, last, steps = float(values["from"]), float(values["to"]), int(values["steps"])
            except (KeyError, TypeError, ValueError):
                raise InputError(f"{path}: the values of {name!r} must be a list or {{ from, to, steps }}") from None
            if steps < 2:
                raise InputError(f"{path}: {name!r} needs at least 2 steps")
            values = [first + (last - first) * step / (steps - 1) for step in range(steps)]
        flat[name] = _list(values)
    return flat
