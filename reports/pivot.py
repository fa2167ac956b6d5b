"""Long tables turned: what is compared stands side by side, a group of columns each."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

from strutwork.errors import ModelError
from strutwork.reports.content import Cell, Column, Table


@dataclass(frozen=True)
class Entry:
    """What one row of a long table says.

    Parameters
    ----------
    line : sequence of str or Cell
        First cells of its row in the turned table; the same texts are the same row.
    group : str
        The thing compared: heading over its columns.
    cells : sequence of str or Cell
        One for each of the columns below that heading.
    """

    line: Sequence[str | Cell]
    group: str
    cells: Sequence[str | Cell]


def pivoted(
    caption: str,
    heads: Sequence[Column],
    columns: Sequence[Column],
    entries: Iterable[Entry],
    data: str = "",
) -> Table:
    """A table with a group of columns for each thing compared, in the order of their first.

    Parameters
    ----------
    caption : str
    heads : sequence of Column
        Of the first cells of a row.
    columns : sequence of Column
        Below the heading of each group. A single one without a title takes the group's name.
    entries : iterable of Entry
        Rows of the long form; what is missing stays empty.
    data : str
        Data file that holds the numbers unrounded, in long form.

    Returns
    -------
    Table

    Raises
    ------
    ModelError
        Two entries for one place, or cells that do not match the columns.

    >>> entries = [Entry([q], m, [v]) for q, m, v in [("Kx", "A", "5"), ("Kx", "B", "4")]]
    >>> table = pivoted("Stiffness", [Column("", "", False)], [Column("", "N/µm")], entries)
    >>> [column.title for column in table.columns], table.rows
    (['', 'A', 'B'], [['Kx', '5', '4']])
    """
    lines: dict[tuple[str, ...], Sequence[str | Cell]] = {}
    places: dict[tuple[tuple[str, ...], str], Sequence[str | Cell]] = {}
    for entry in entries:
        key = tuple(c.text if isinstance(c, Cell) else c for c in entry.line)
        if len(key) != len(heads) or len(entry.cells) != len(columns):
            raise ModelError(
                f'table "{caption}"',
                f"has an entry of {len(key)} and {len(entry.cells)} cells for {len(heads)} and "
                f"{len(columns)} columns.",
                "Give one cell each.",
            )
        if (key, entry.group) in places:
            raise ModelError(
                f'table "{caption}"',
                f'has two entries for "{", ".join(key)}" of "{entry.group}".',
                "Tell them apart in their first cells.",
            )
        lines.setdefault(key, entry.line)
        places[key, entry.group] = entry.cells
    groups = list(dict.fromkeys(group for _, group in places))
    empty = ("",) * len(columns)
    return Table(
        caption,
        (*heads, *(_column(c, group, columns) for group in groups for c in columns)),
        [
            [*line, *(cell for group in groups for cell in places.get((key, group), empty))]
            for key, line in lines.items()
        ],
        data,
    )


def _column(column: Column, group: str, columns: Sequence[Column]) -> Column:
    if len(columns) == 1 and not column.title:
        return replace(column, title=group)
    return replace(column, group=group)
