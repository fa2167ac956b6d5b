"""What the tables of the papers' pages share: columns, differences, files of published rows."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from strutwork.files import write_whole
from strutwork.papers.published_rows import CLOSE, COLUMNS, FAIR, PublishedRow, file_name
from strutwork.reports.content import Cell, Column, Points, Table
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.numbers import percent, significant


def texts(*titles: str, group: str = "") -> tuple[Column, ...]:
    """Columns of text."""
    return tuple(Column(title, "", False, group) for title in titles)


def numbers(*titles: str, unit: str = "", group: str = "") -> tuple[Column, ...]:
    """Columns of numbers of one unit."""
    return tuple(Column(title, unit, True, group) for title in titles)


def ours(groups: Iterable[str], unit: str = "") -> tuple[Column, ...]:
    """Our number, its difference from the print and its status, for each of several models."""
    return tuple(
        column
        for group in groups
        for column in (
            Column("computed", unit, True, group),
            *numbers("difference", group=group),
            Column("status", "", False, group, "narrow"),
        )
    )


def assumed(title: str, rows: Sequence[Sequence[str]]) -> Points:
    """Assumptions in sentences: those of one source together.

    Parameters
    ----------
    title : str
    rows : sequence of (str, str, str)
        Assumption, value, source.

    >>> assumed("Dimensions", [("Rod", "1 m", "assumed"), ("Load", "none", "assumed")]).items
    ('Rod: 1 m; Load: none (assumed).',)
    """
    found: dict[str, list[str]] = {}
    for what, value, source in rows:
        found.setdefault(source, []).append(f"{what}: {value}" if value else what)
    return Points(
        tuple(f"{'; '.join(values)} ({source})." for source, values in found.items()), title
    )


def difference(row: PublishedRow) -> Cell:
    """Difference from the print, coloured by its size."""
    size = abs(row.difference_percent)
    tone = "good" if size < CLOSE else "fair" if size < FAIR else "poor"
    return Cell(percent(nearly(row.difference_percent)), tone)  # type: ignore[arg-type]


def beside(row: PublishedRow, text: str) -> Cell:
    """The computed number with its difference from the print below it."""
    found = difference(row)
    return Cell(text, found.tone, found.text)


def nearly(percentage: float) -> float:
    """A difference in percent whose rounding to one decimal keeps no sign of zero."""
    return percentage if abs(percentage) >= 0.05 else 0.0


def rows_table(title: str, rows: Iterable[PublishedRow], file: str) -> Table:
    """Published rows beside the computed values, one a line, with their status and note."""
    columns = (
        *texts("quantity", "unit"),
        *numbers("published", "computed", "difference"),
        *texts("status", "note"),
    )
    lines: list[list[str | Cell]] = [
        [
            r.quantity,
            r.unit,
            significant(r.published, 4),
            significant(r.computed, 4),
            difference(r),
            r.status,
            r.note,
        ]
        for r in rows
    ]
    return Table(title, columns, lines, file)


def rows_file(name: str, what: str, rows: Iterable[PublishedRow]) -> DataFile:
    """Published rows beside the computed values as CSV."""
    content = [row.to_dict() for row in rows]
    return csv_file(name, what, COLUMNS, [[row[c] for c in COLUMNS] for row in content])


def write_published(folder: Path, table: str, rows: Iterable[PublishedRow]) -> Path:
    """Write the rows of a table as CSV, whole or not at all.

    Parameters
    ----------
    folder : Path
    table : str
        Key of the published table.
    rows : iterable of PublishedRow

    Returns
    -------
    Path

    Raises
    ------
    OutputError
        The folder cannot be written.
    """
    file = rows_file(
        file_name(table), f"published numbers of {table} beside the computed values", rows
    )
    return write_whole(Path(folder) / file.name, file.write)
