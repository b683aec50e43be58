"""A search for gains within limits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Mapping

from .._errors import InputError
from .._optional import optional

__all__ = ["GainSearch", "search_gains"]

Cost = Callable[[dict[str, float]], float]


@dataclass(frozen=True)
class GainSearch:
    """The result of a search for gains.

    Attributes:
        gains: the gains with the lowest cost.
        cost: that cost.
        tried: all gains that were tried, with their costs, in order.
    """

    gains: dict[str, float]
    cost: float
    tried: list[tuple[dict[str, float], float]]


def search_gains(
    cost: Cost,
    limits: Mapping[str, tuple[float, float]],
    start: Mapping[str, float] | None = None,
    *,
    method: str = "compass",
    evaluations: int = 200,
    tolerance: float = 1e-3,
    **options: Any,
) -> GainSearch:
    """Search for the gains with the lowest cost.

    Args:
        cost: a function of the gains that returns their cost; lower is better. It makes a board, sets the gains and
            measures. For impossible gains it returns `float("inf")`.
        limits: lower and upper limit of each gain by name.
        start: gains to start from; by default the middle of the limits.
        method: "compass", which needs no other package; or, with SciPy, "differential_evolution" or a method of
            `scipy.optimize.minimize` that accepts bounds, such as "Nelder-Mead" or "Powell".
        evaluations: most calls of `cost`; SciPy may exceed it to finish a step.
        tolerance: the smallest step, as a fraction of the range between the limits.
        **options: options of SciPy's function.

    Raises:
        InputError: the limits are invalid, or `start` is outside them.
        NotBuiltError: the method needs SciPy, which is not installed.
    """
    for name, (low, high) in limits.items():
        if not low < high:
            raise InputError(f"the limits of {name!r} must be a lower and an upper one, not {low!r} and {high!r}")
    if not limits:
        raise InputError("there are no gains to search for")
    names = list(limits)
    tried: list[tuple[dict[str, float], float]] = []

    def value(point: Any) -> float:
        """Return the cost at a point of the unit cube."""
        gains = {}
        for name, part in zip(names, point):
            low, high = limits[name]
            gains[name] = low + (high - low) * min(1.0, max(0.0, float(part)))
        found = float(cost(gains))
        # An optimiser cannot continue from NaN.
        tried.append((gains, found if found == found else float("inf")))
        return tried[-1][1]

    first = [_part(limits[name], start[name]) if start and name in start else 0.5 for name in names]
    if method == "compass":
        _compass(value, first, evaluations, tolerance)
    else:
        _scipy(value, first, method, evaluations, tolerance, options)
    gains, best = min(tried, key=lambda each: each[1])
    return GainSearch(gains, best, tried)


def _part(limits: tuple[float, float], value: float) -> float:
    low, high = limits
    if not low <= value <= high:
        raise InputError(f"the start {value!r} is outside its limits {low!r} and {high!r}")
    return (value - low) / (high - low)


def _compass(value: Callable[[list[float]], float], point: list[float], evaluations: int, tolerance: float) -> None:
    """Move to a better neighbour along an axis; if there is none, halve the step."""
    best, step, left = value(point), 0.25, evaluations - 1
    while step >= tolerance and left > 0:
        for index in range(len(point)):
            for sign in (1, -1):
                near = [*point]
                near[index] = min(1.0, max(0.0, near[index] + sign * step))
                if near == point or left == 0:
                    continue
                left -= 1
                found = value(near)
                if found < best:
                    best, point = found, near
                    break
            else:
                continue
            break
        else:
            step /= 2


def _scipy(
    value: Callable[[Any], float],
    first: list[float],
    method: str,
    evaluations: int,
    tolerance: float,
    options: dict[str, Any],
) -> None:
    optimize = optional("scipy.optimize", f"the method {method!r}", "SciPy", "cc67[studies]")
    bounds = [(0.0, 1.0)] * len(first)
    if method == "differential_evolution":
        population = max(5, options.pop("popsize", 8))
        rounds = max(1, evaluations // (population * len(first)) - 1)
        optimize.differential_evolution(value, bounds, maxiter=rounds, popsize=population, x0=first, seed=0, **options)
        return
    limit = {"maxfev": evaluations} if method.lower() in ("nelder-mead", "powell") else {"maxiter": evaluations}
    optimize.minimize(value, first, method=method, bounds=bounds, tol=tolerance, options={**limit, **options})
