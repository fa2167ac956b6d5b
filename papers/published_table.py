"""Published numbers with their sources, as they are printed.

Each paper has its data in its own folder, `published.py`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from strutwork.errors import ModelError
from strutwork.machines.literature import Paper


@dataclass(frozen=True)
class PublishedValue:
    """One number of a table.

    Parameters
    ----------
    row : str
        What it belongs to: a machine's name in the catalogue, with its variant if any.
    quantity : str
    unit : str
        The unit it is printed in, readable by pint; empty for a pure number.
    value : float
        As printed.
    note : str
        A doubt about the print, if any.
    """

    row: str
    quantity: str
    unit: str
    value: float
    note: str = ""


def rows_of(
    quantity: str, unit: str, columns: Sequence[str], *numbers: float, note: str = ""
) -> tuple[PublishedValue, ...]:
    """One printed line of a table: a quantity for several machines or variants."""
    return tuple(
        PublishedValue(row, quantity, unit, value, note)
        for row, value in zip(columns, numbers, strict=True)
    )


@dataclass(frozen=True)
class PublishedTable:
    """A table of a paper, one value a row.

    Parameters
    ----------
    key : str
        `PAPER-table-N`, unique.
    paper : Paper
    title : str
    values : tuple of PublishedValue
    note : str
        What a reader should know about the table as a whole.
    """

    key: str
    paper: Paper
    title: str
    values: tuple[PublishedValue, ...]
    note: str = ""

    def __repr__(self) -> str:
        return f"<PublishedTable {self.key}: {len(self.values)} values>"

    def __iter__(self) -> Iterator[PublishedValue]:
        return iter(self.values)

    def value(self, row: str, quantity: str) -> float:
        """A number in its printed unit.

        Raises
        ------
        ModelError
            The table has no such entry.
        """
        for entry in self.values:
            if (entry.row, entry.quantity) == (row, quantity):
                return entry.value
        raise ModelError(
            f"table {self.key}",
            f'has no "{quantity}" of "{row}".',
            "Rows: "
            + ", ".join(dict.fromkeys(v.row for v in self.values))
            + "; quantities: "
            + ", ".join(dict.fromkeys(v.quantity for v in self.values))
            + ".",
        )
