"""Values over time."""

from __future__ import annotations

import csv
import os
from typing import TYPE_CHECKING, Any, Mapping, Union

from ._errors import unknown
from ._optional import optional

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

__all__ = ["Trace"]


class Trace(dict[str, "Array"]):
    """Values over time as NumPy arrays of doubles: `trace["dest0"]`, with their times in `trace.time`.

    A dictionary in the order of the items. `pandas.DataFrame(trace)` has a column for each item, and `numpy.asarray(trace)`
    too, with a row for each sample; `trace.pandas()` has the times as its index.

    Attributes:
        time: board time of each sample, in seconds since power-up: the end of the sampled tick.
        units: the unit of each item, or "" if it is unknown.
    """

    def __init__(self, time: Array, columns: Mapping[str, Array], units: Mapping[str, str] | None = None) -> None:
        super().__init__(columns)
        self.time = time
        self.units = dict(units or {})

    def __missing__(self, name: str) -> Array:
        raise unknown("item in the trace", name, self)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        import numpy as np

        if copy is False:
            raise ValueError("the columns of a trace are arrays of their own, so one array of all is a copy")
        return np.column_stack(list(self.values())).astype(dtype or np.float64, copy=False)

    def __eq__(self, other: object) -> bool:
        return self is other

    def __ne__(self, other: object) -> bool:
        return self is not other

    def __reduce__(self) -> tuple[type[Trace], tuple[Array, dict[str, Array], dict[str, str]]]:
        return (Trace, (self.time, dict(self), self.units))

    def pandas(self) -> Any:
        """Return the trace as a pandas.DataFrame: a column for each item, the times in seconds as the index.

        Raises:
            NotBuiltError: pandas is not installed.
        """
        pandas = optional("pandas", "a DataFrame", "pandas", "pandas")
        return pandas.DataFrame(dict(self), index=pandas.Index(self.time, name="time"))

    def __repr__(self) -> str:
        return f"<cc67.Trace of {', '.join(self)}: {len(self.time)} samples>"

    def save(self, path: Union[str, "os.PathLike[str]"], first: str = "time") -> None:
        """Write a CSV table for `cc67 plot`: the time in seconds, then a column for each item.

        Args:
            path: the file.
            first: the heading of the first column.
        """
        with open(path, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow([first, *self])
            rows = zip(self.time.tolist(), *(column.tolist() for column in self.values()))
            writer.writerows([f"{value:.10g}" for value in row] for row in rows)

    def plot(self, axes: Any = None) -> Any:
        """Plot the items over time with Matplotlib, on `axes` or in a new figure, and return the Matplotlib axes.

        Raises:
            NotBuiltError: Matplotlib is not installed; `picture` needs no package.
        """
        if axes is None:
            pyplot = optional("matplotlib.pyplot", "a plot", "Matplotlib", "cc67[plot]")
            _, axes = pyplot.subplots()
        for name, column in self.items():
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
