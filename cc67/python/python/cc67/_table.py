"""Tables of results."""

from __future__ import annotations

import csv
import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterable, Iterator, Mapping, Sequence, overload

from ._errors import InputError, unknown
from ._optional import optional

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["Row", "Table"]

Row = dict[str, Any]


class Table(Sequence[Row]):
    """The results of many runs: a row for each run, in the order of the inputs.

    A row has the inputs, the outputs, and `error`: None, or the reason why the run failed. `table["overshoot"]` is a
    column, `table[3]` a row. `numpy.asarray(table)` is `table.array()`.
    """

    def __init__(self, rows: Iterable[Mapping[str, Any]], inputs: Iterable[str] = ()) -> None:
        self.rows = [dict(row) for row in rows]
        self.inputs = list(inputs)
        names = dict.fromkeys(name for row in self.rows for name in row)
        names.pop("error", None)
        self.columns = [*self.inputs, *(name for name in names if name not in self.inputs), "error"]

    @property
    def failures(self) -> Table:
        """The rows of runs that failed, with their inputs."""
        return Table([row for row in self.rows if row.get("error")], self.inputs)

    @property
    def good(self) -> Table:
        """The rows of runs that did not fail."""
        return Table([row for row in self.rows if not row.get("error")], self.inputs)

    @overload
    def __getitem__(self, which: int) -> Row: ...
    @overload
    def __getitem__(self, which: slice) -> Table: ...
    @overload
    def __getitem__(self, which: str) -> list[Any]: ...
    def __getitem__(self, which: int | slice | str) -> Row | Table | list[Any]:
        if isinstance(which, str):
            if which not in self.columns:
                raise unknown("column", which, self.columns)
            return [row.get(which) for row in self.rows]
        if isinstance(which, slice):
            return Table(self.rows[which], self.inputs)
        return self.rows[which]

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[Row]:
        return iter(self.rows)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Table) and self.csv() == other.csv()

    def __repr__(self) -> str:
        failed = len(self.failures)
        return f"<cc67.Table of {len(self)} rows: {', '.join(self.columns)}{f'; {failed} failed' if failed else ''}>"

    def array(self, *names: str) -> NDArray[np.float64]:
        """Return columns as a NumPy array of doubles, with a row for each run.

        Args:
            *names: the columns; by default all but `error`. Texts, and values that a failed run lacks, become NaN.
        """
        import numpy as np

        columns = [self[name] for name in names or [name for name in self.columns if name != "error"]]
        return np.array([[_float(value) for value in column] for column in columns], dtype=np.float64).T

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        if copy is False:
            raise ValueError("a table has no array of its own, so an array of it is a copy")
        array = self.array()
        return array if dtype is None else array.astype(dtype)

    def csv(self) -> str:
        """Return the table as comma-separated values."""
        import io

        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.columns)
        writer.writerows([_cell(row.get(name)) for name in self.columns] for row in self.rows)
        return text.getvalue()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the table to a file: .csv, .json or .jsonl (one object per line), or .parquet, which needs pyarrow.

        Raises:
            InputError: the name has another suffix.
            NotBuiltError: pyarrow is not installed.
        """
        path = Path(path)
        suffix = path.suffix.lower()
        temporary = path.with_name(path.name + ".part")
        if suffix == ".csv":
            temporary.write_text(self.csv(), encoding="utf-8", newline="")
        elif suffix in (".json", ".jsonl"):
            lines = (json.dumps({name: row.get(name) for name in self.columns}) + "\n" for row in self.rows)
            temporary.write_text("".join(lines), encoding="utf-8")
        elif suffix == ".parquet":
            self._save_parquet(temporary)
        else:
            raise InputError(f"a table file must end in .csv, .json or .parquet, unlike {path}")
        temporary.replace(path)

    def _save_parquet(self, path: Path) -> None:
        arrow, parquet = (
            optional(module, "a .parquet table", "pyarrow", "cc67[parquet]") for module in ("pyarrow", "pyarrow.parquet")
        )
        columns = {name: self._arrow(arrow, name) for name in self.columns}
        parquet.write_table(arrow.table(columns), path)

    def _arrow(self, arrow: Any, name: str) -> Any:
        """Return a column with a type that does not depend on which rows a shard has.

        Texts are strings, as `error` always is. Outputs are doubles unless all are booleans, and so are inputs unless
        all are integers; a column without a value is one of doubles.
        """
        values = self[name]
        kinds = {type(value) for value in values if value is not None}
        if name == "error" or str in kinds:
            return arrow.array([None if value is None else str(value) for value in values], arrow.string())
        if kinds == {bool}:
            return arrow.array(values, arrow.bool_())
        if kinds == {int} and name in self.inputs and all(abs(value or 0) < 2**63 for value in values):
            return arrow.array(values, arrow.int64())
        return arrow.array([None if value is None else float(value) for value in values], arrow.float64())

    def pandas(self) -> Any:
        """Return the table as a pandas.DataFrame.

        Raises:
            NotBuiltError: pandas is not installed.
        """
        pandas = optional("pandas", "a DataFrame", "pandas", "pandas")
        return pandas.DataFrame(self.rows, columns=self.columns)


def _float(value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        return float("nan")


def _cell(value: Any) -> Any:
    """Convert a value for a text table, where None is an empty cell."""
    return "" if value is None else value
