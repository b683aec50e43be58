"""The runs of a sweep, from inputs to outputs, as any executor executes them."""

from __future__ import annotations

import multiprocessing
import os
from dataclasses import dataclass
from multiprocessing import connection
from threading import Thread
from typing import Any, Callable, Mapping, Sequence, Union

from ._board import Board, Condition
from ._errors import InputError
from ._program import Program

__all__ = ["Batch", "Measure", "Result", "end_with_parent", "is_timeout", "run_batch"]

Inputs = dict[str, Any]
# The number of a run, and its outputs.
Result = tuple[int, dict[str, Any]]
Measure = Union[Callable[..., Any], Mapping[str, str]]


@dataclass(frozen=True)
class Batch:
    """Runs that are executed together.

    Attributes:
        runs: number, inputs and programs of each run.
        options: the arguments of `cc67.Board` for all runs.
        measure: what to measure, a function or a mapping of names to expressions.
        until: what ends a run before expressions are evaluated: a condition, seconds of board time as a float, or None
            for the end of all programs.
        timeout: seconds of board time after which a run that has not ended fails.
    """

    runs: Sequence[tuple[int, Inputs, Sequence[Program]]]
    options: Mapping[str, Any]
    measure: Measure
    until: Condition | float | None = None
    timeout: float = 60.0


def end_with_parent() -> None:
    """End this process when the one that started it has ended, however it ends."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        Thread(target=_end_after, args=(parent.sentinel,), daemon=True).start()


def _end_after(sentinel: int) -> None:
    connection.wait([sentinel])
    os._exit(1)


def run_batch(batch: Batch) -> list[Result]:
    """Execute the runs of a batch; return the number of each, and its outputs or `error`."""
    return [(number, _run(batch, inputs, programs)) for number, inputs, programs in batch.runs]


def is_timeout(outputs: Mapping[str, Any]) -> bool:
    """Return whether it was the timeout of the sweep that ended the run with these outputs."""
    return str(outputs["error"]).startswith("TimeoutError:")


def _run(batch: Batch, inputs: Inputs, programs: Sequence[Program]) -> dict[str, Any]:
    try:
        with Board(programs=programs, **_options(batch.options, inputs)) as board:
            if callable(batch.measure):
                result = _call(batch.measure, board, inputs)
            else:
                result = _expressions(batch, board, batch.measure)
    except Exception as error:  # Whatever makes a run fail is its result.
        return {"error": f"{type(error).__name__}: {error}"}
    return {**result, "error": None}


def _options(options: Mapping[str, Any], inputs: Inputs) -> dict[str, Any]:
    """Return the arguments of `Board`: those of all runs, with the inputs of this one."""
    settings = dict(options.get("set", {}))
    statements = list(options.get("stim", []))
    for name, value in inputs.items():
        kind, _, rest = name.partition(".")
        if kind == "bit":
            statements.append(f"bit {rest} = {int(value)}")
        elif kind == "adc":
            statements.append(f"adc {rest} = {value}")
        elif name == "stim":
            statements.append(str(value))
        elif kind != "macro" and rest:
            settings[name] = value
    return {**options, "set": settings, "stim": statements}


def _call(measure: Callable[..., Any], board: Board, inputs: Inputs) -> dict[str, Any]:
    """Return what a function measures: a mapping, a number as `value`, or several as `value0`, `value1`, …"""
    result = measure(board, inputs) if _takes_inputs(measure) else measure(board)
    if isinstance(result, Mapping):
        return {str(name): _plain(value) for name, value in result.items()}
    if isinstance(result, (tuple, list)):
        return {f"value{index}": _plain(value) for index, value in enumerate(result)}
    return {"value": _plain(result)}


def _takes_inputs(measure: Callable[..., Any]) -> bool:
    from inspect import Parameter, signature

    try:
        parameters = signature(measure).parameters.values()
    except (TypeError, ValueError):
        return False
    positional = (Parameter.POSITIONAL_ONLY, Parameter.POSITIONAL_OR_KEYWORD)
    required = [each for each in parameters if each.kind in positional and each.default is Parameter.empty]
    return len(required) >= 2 or any(each.kind is Parameter.VAR_POSITIONAL for each in parameters)


def _expressions(batch: Batch, board: Board, measure: Mapping[str, str]) -> dict[str, Any]:
    """Return the values of expressions at the end of the run; `time` is the board time in seconds."""
    if batch.until is None:
        if not board.run(batch.timeout):
            raise TimeoutError(f"the programs have not ended after {batch.timeout:g} s of board time")
    elif isinstance(batch.until, float):
        board.run_for(batch.until)
    elif not board.run_until(batch.until, batch.timeout):
        raise TimeoutError(f"`{batch.until}` is not met after {batch.timeout:g} s of board time")
    return {name: board.time if text == "time" else board.read(text) for name, text in measure.items()}


def _plain(value: Any) -> Any:
    """Convert a value for a table and JSON: NumPy numbers become Python numbers."""
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    item = getattr(value, "item", None)
    if item is not None and getattr(value, "ndim", 0) == 0:
        return item()
    raise InputError(f"a measured value must be a number or a string, not {value!r}")
