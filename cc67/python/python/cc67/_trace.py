"""Values over time."""

from __future__ import annotations

import csv
import os
from typing import TYPE_CHECKING, Any, Iterator, Mapping, Union

from ._errors import unknown
from ._optional import optional

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["Trace"]


class Trace(Mapping[str, "Array"]):
    """Values over time as NumPy arrays of doubles: `trace["dest0"]`, with their times in `trace.time`.

    Attributes:
        time: board time of each sample, in seconds since power-up: the end of the sampled tick.
        units: the unit of each item, or "" if it is unknown.
    """

    def __init__(self, time: Array, columns: Mapping[str, Array], units: Mapping[str, str] | None = None) -> None:
        self.time = time
        self._columns = dict(columns)
        self.units = dict(units or {})

    def __getitem__(self, name: str) -> Array:
        try:
            return self._columns[name]
        except KeyError:
            raise unknown("item in the trace", name, self._columns) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        return f"<cc67.Trace of {', '.join(self._columns)}: {len(self.time)} samples>"

    def save(self, path: Union[str, "os.PathLike[str]"], first: str = "time") -> None:
        """Write a CSV table for `cc67 plot`: the time in seconds, then a column for each item.

        Args:
            path: the file.
            first: the heading of the first column.
        """
        with open(path, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow([first, *self._columns])
            rows = zip(self.time.tolist(), *(column.tolist() for column in self._columns.values()))
            writer.writerows([f"{value:.10g}" for value in row] for row in rows)

    def plot(self, axes: Any = None) -> Any:
        """Plot the items over time with Matplotlib, on `axes` or in a new figure, and return the Matplotlib axes.

        Raises:
            NotBuiltError: Matplotlib is not installed; `picture` needs no package.
        """
        if axes is None:
            pyplot = optional("matplotlib.pyplot", "a plot", "Matplotlib", "cc67[plot]")
            _, axes = pyplot.subplots()
        for name, column in self._columns.items():
            unit = self.units.get(name)
            axes.plot(self.time, column, label=f"{name} ({unit})" if unit else name)
        axes.set_xlabel("board time (s)")
        axes.legend()
        return axes

    def picture(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Plot the items to a file, as `cc67 plot` does.

        Args:
            path: the file: .svg, .png, or .html for a page with zoom and cursor.

        Raises:
            Error: the file cannot be written, or has another suffix.
        """
        from ._command import draw

        draw(self, os.fspath(path))
