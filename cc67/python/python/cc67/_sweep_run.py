"""One run of a sweep: from its inputs to its outputs, wherever it is executed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Mapping, Sequence, Union

from ._board import Board
from ._errors import InputError
from ._program import Program

__all__ = ["Batch", "Measure", "run_batch"]

Inputs = dict[str, Any]
Measure = Union[Callable[..., Any], Mapping[str, str]]


@dataclass(frozen=True)
class Batch:
    """Runs that are executed together.

    Attributes:
        runs: number, inputs and programs of each.
        options: the arguments of `cc67.Board` that all have in common.
        measure: what is measured.
        until: what ends a run before it is measured by expressions, or None for the end of the programs.
        timeout: seconds of board time that this may take.
    """

    runs: Sequence[tuple[int, Inputs, Sequence[Program]]]
    options: Mapping[str, Any]
    measure: Measure
    until: Any = None
    timeout: float = 60.0


def run_batch(batch: Batch) -> list[tuple[int, dict[str, Any]]]:
    """Executes the runs of a batch: the number and the outputs of each, or `error`."""
    return [(number, _run(batch, inputs, programs)) for number, inputs, programs in batch.runs]


def _run(batch: Batch, inputs: Inputs, programs: Sequence[Program]) -> dict[str, Any]:
    try:
        board = Board(programs=programs, **_options(batch.options, inputs))
        if callable(batch.measure):
            result = _call(batch.measure, board, inputs)
        else:
            result = _expressions(batch, board, batch.measure)
    except Exception as error:  # Whatever a run fails with is its result.
        return {"error": f"{type(error).__name__}: {error}"}
    return {**result, "error": None}


def _options(options: Mapping[str, Any], inputs: Inputs) -> dict[str, Any]:
    """The arguments of `Board`: those in common, and what the inputs change."""
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
    """What a function measures: a mapping, a number as `value`, or several as `value0`, `value1`, …"""
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
    """The values of expressions at the end of the run; `time` is the board time in seconds."""
    if batch.until is None:
        if not board.run(batch.timeout):
            raise TimeoutError(f"the programs have not ended after {batch.timeout:g} s of board time")
    elif isinstance(batch.until, float):
        board.run_for(batch.until)
    elif not board.run_until(batch.until, batch.timeout):
        raise TimeoutError(f"`{batch.until}` is not so after {batch.timeout:g} s of board time")
    return {name: board.time if text == "time" else board.read(text) for name, text in measure.items()}


def _plain(value: Any) -> Any:
    """A value as a table and JSON have it: numbers of NumPy become those of Python."""
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    item = getattr(value, "item", None)
    if item is not None and getattr(value, "ndim", 0) == 0:
        return item()
    raise InputError(f"a measure is a number or a text, not {value!r}")
