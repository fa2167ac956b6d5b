"""One kind of input: a table of groups for the reader, and every one in a file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from strutwork.reports.alike import grouped
from strutwork.reports.content import Column, Table
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.numbers import significant

#: Where a cell has nothing to say.
NONE = "–"


@dataclass(frozen=True)
class Echo:
    """Inputs of one kind.

    Parameters
    ----------
    key : str
        Of the file, `inputs-KEY.csv`.
    caption : str
    columns : sequence of Column
        The first is of the names.
    shown : mapping of name to cells
        As the table shows them, without the name; rows alike become one.
    heads : sequence of str
        Of the file, the first of the names; SI.
    exact : mapping of name to values
        As the file has them.
    loose : tuple of int
        Cells that may differ between rows of one group.
    """

    key: str
    caption: str
    columns: Sequence[Column]
    shown: Mapping[str, Sequence[str]]
    heads: Sequence[str]
    exact: Mapping[str, Sequence[Any]]
    loose: tuple[int, ...] = ()

    @property
    def name(self) -> str:
        """Of the file."""
        return f"inputs-{self.key}.csv"

    @property
    def table(self) -> Table:
        """Equal rows in one; columns in which nobody has anything are left out."""
        rows = [[g.label, *g.cells] for g in grouped(self.shown, self.loose)]
        kept = [
            i for i in range(len(self.columns)) if i == 0 or any(row[i] != NONE for row in rows)
        ]
        columns = [self.columns[i] for i in kept]
        return Table(self.caption, columns, [[row[i] for i in kept] for row in rows], self.name)

    @property
    def file(self) -> DataFile:
        """Every one, unrounded."""
        rows = [[name, *values] for name, values in self.exact.items()]
        return csv_file(self.name, f"{self.caption[0].lower()}{self.caption[1:]}", self.heads, rows)


def number(value: float | None, factor: float = 1.0, digits: int = 4) -> str:
    """A number of an input in a shown unit; a mark where it is not given.

    >>> number(2.1e11, 1e-9), number(None)
    ('210', '–')
    """
    if value is None:
        return NONE
    shown, mark, power = significant(factor * value, digits).partition("e")
    return (shown.rstrip("0").rstrip(".") if "." in shown else shown) + mark + power


def vector(values: Sequence[float], factor: float = 1.0) -> str:
    """Components with commas between."""
    return ", ".join(number(0.0 if abs(v) < 1e-12 else float(v), factor) for v in values)
