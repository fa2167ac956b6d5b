"""No table on a page is longer than a reader takes in at a look: parted, or its rest folded."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby

from strutwork.reports.content import Block, Cell, Details, Table
from strutwork.reports.numbers import count

#: Most rows of a table that lies open.
LONGEST = 12


def shortened(table: Table, kept: int = 0) -> tuple[Block, ...]:
    """A table of at most `LONGEST` rows, and the others behind a line that opens.

    Parameters
    ----------
    table : Table
        Its rows by weight, or in another order in which the first say most.
    kept : int
        Rows at its end that stay, as sums.

    Returns
    -------
    tuple of Table or Details
    """
    if len(table.rows) <= LONGEST:
        return (table,)
    rows = list(table.rows)
    last = rows[len(rows) - kept :]
    first, rest = rows[: LONGEST - kept], rows[LONGEST - kept : len(rows) - kept]
    # two regions of one name cannot be told apart by who hears the page
    more = replace(table, caption=f"{table.caption}, continued", rows=rest)
    return (
        replace(table, rows=[*first, *last]),
        Details(f"{count(len(rest), 'further row')}: {table.caption}", (more,)),
    )


def parted(table: Table, column: int, most: int = LONGEST) -> tuple[Table, ...]:
    """A table in several of at most `most` rows, rows with the same cell kept together.

    Neighbouring groups share a table while there is room, as evenly as the fewest tables allow;
    the caption of each says which rows it has, and the column is left out where all of them have
    the same.

    Parameters
    ----------
    table : Table
    column : int
        Whose cells tell the groups; rows of one group stand together.
    most : int
        Rows of one table.

    Returns
    -------
    tuple of Table
        The table itself where it is short.
    """
    if len(table.rows) <= most:
        return (table,)
    runs = [list(run) for _, run in groupby(table.rows, key=lambda row: _text(row[column]))]
    found = []
    for rows in together(runs, most):
        names = list(dict.fromkeys(_text(row[column]) for row in rows))
        caption = f"{table.caption}: {_enumerated(names)}"
        part = replace(table, caption=caption, rows=rows)
        found.append(part if len(names) > 1 else _without(part, column))
    return tuple(found)


def together(
    runs: Sequence[Sequence[Sequence[str | Cell]]], most: int = LONGEST
) -> list[list[Sequence[str | Cell]]]:
    """Runs of rows joined into the fewest lists of at most `most`, the longest as short as may be.

    A run that is longer by itself is cut.

    >>> [len(rows) for rows in together([[["a"]] * n for n in (5, 5, 2, 1)])]
    [5, 8]
    """
    cut = [run[i : i + most] for run in runs for i in range(0, len(run), most)]
    fewest = len(_greedy(cut, most))
    sizes = range(max((len(run) for run in cut), default=1), most + 1)
    return next(found for size in sizes if len(found := _greedy(cut, size)) == fewest)


def _greedy(
    runs: Sequence[Sequence[Sequence[str | Cell]]], most: int
) -> list[list[Sequence[str | Cell]]]:
    found: list[list[Sequence[str | Cell]]] = []
    for run in runs:
        if found and len(found[-1]) + len(run) <= most:
            found[-1] += run
        else:
            found.append(list(run))
    return found


def _without(table: Table, column: int) -> Table:
    def left(cells: Sequence[str | Cell]) -> list[str | Cell]:
        return [*cells[:column], *cells[column + 1 :]]

    columns = [c for i, c in enumerate(table.columns) if i != column]
    return replace(table, columns=columns, rows=[left(row) for row in table.rows])


def _text(cell: str | Cell) -> str:
    return cell.text if isinstance(cell, Cell) else cell


def _enumerated(names: Sequence[str]) -> str:
    return " and ".join((", ".join(names[:-1]), names[-1]) if len(names) > 1 else names)
