"""How a program performs on machines that differ slightly from the one it was written for."""

from __future__ import annotations

import random
from dataclasses import dataclass
from typing import Any, Callable, Mapping, Sequence, Union

import numpy as np

from .._errors import InputError
from .._sweep import Source, sweep
from .._sweep_run import Measure
from .._table import Row, Table

__all__ = ["Tolerance", "normal", "tolerance", "uniform"]

Draw = Callable[[random.Random], float]
Variation = Union[tuple[float, float], Draw]


def uniform(low: float, high: float) -> Draw:
    """Make a uniform distribution between two values."""
    return lambda source: source.uniform(low, high)


def normal(mean: float, deviation: float) -> Draw:
    """Make a normal distribution with a mean and a standard deviation."""
    return lambda source: source.gauss(mean, deviation)


@dataclass(frozen=True)
class Tolerance:
    """The runs of a tolerance study.

    Attributes:
        table: inputs and outputs of each run.
    """

    table: Table

    def spread(self, output: str) -> dict[str, float]:
        """Return `min`, `mean`, `max` and standard deviation `std` of an output over the runs that did not fail.

        Raises:
            InputError: every run failed.
        """
        values = np.array(self.table.good[output], dtype=np.float64)
        if not len(values):
            raise InputError("every run failed")
        figures = {"min": values.min(), "mean": values.mean(), "max": values.max(), "std": values.std()}
        return {name: float(value) for name, value in figures.items()}

    def worst(self, output: str, wanted: float = 0.0) -> Row:
        """Return the run whose output is farthest from the wanted value."""
        return max(self.table.good, key=lambda row: abs(row[output] - wanted))

    def yield_within(self, output: str, low: float, high: float) -> float:
        """Return the fraction of all runs, including failed ones, whose output is from `low` to `high`."""
        good = sum(low <= row[output] <= high for row in self.table.good)
        return good / len(self.table) if len(self.table) else float("nan")


def tolerance(
    program: Source | Sequence[Source],
    variations: Mapping[str, Variation],
    measure: Measure,
    *,
    samples: int = 100,
    seed: int = 0,
    **options: Any,
) -> Tolerance:
    """Run a program on machines that vary at random: switch positions, delays, noise, plants.

    Args:
        program: the program, as for `cc67.sweep`.
        variations: what varies, by the names of `cc67.sweep`: a tuple of two bounds, `uniform(a, b)`,
            `normal(mean, deviation)`, or a function of a `random.Random` that returns a number or a string, such as a
            statement for `stim`.
        measure: as for `cc67.sweep`.
        samples: the number of machines.
        seed: the seed of the random numbers; the same seed gives the same machines.
        **options: as for `cc67.sweep`.
    """
    if samples < 1:
        raise InputError(f"a study needs at least 1 sample, not {samples!r}")
    source = random.Random(seed)
    draws = {name: uniform(*each) if isinstance(each, tuple) else each for name, each in variations.items()}
    inputs = [{name: draw(source) for name, draw in draws.items()} for _ in range(samples)]
    return Tolerance(sweep(program, inputs, measure, **options))
