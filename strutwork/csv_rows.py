"""Rows of CSV files in which no name is a formula."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable
from typing import IO, Any

#: Spreadsheets take a cell that begins so for a formula, or skip what it begins with. The quote
#: is among them so that what was marked and what began with a quote stay apart.
_FORMULA = ("=", "+", "-", "@", "\t", "\r", "\n", "＝", "＋", "－", "＠", "'")  # noqa: RUF001

_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", re.ASCII)

MARK = "'"


def csv_cell(value: Any) -> Any:
    """A cell as it is written: a text that a spreadsheet would calculate begins with a quote.

    Numbers, and texts that are numbers, stay as they are.

    Parameters
    ----------
    value : object
        Number, text or anything that the csv module writes.

    Examples
    --------
    >>> csv_cell("=1+1"), csv_cell("-2.5e-3"), csv_cell(-2.5), csv_cell("leg1")
    ("'=1+1", '-2.5e-3', -2.5, 'leg1')
    """
    if isinstance(value, str) and value.startswith(_FORMULA) and not _NUMBER.fullmatch(value):
        return MARK + value
    return value


def csv_name(cell: str) -> str:
    """The text that `csv_cell` wrote as `cell`.

    Parameters
    ----------
    cell : str
        As read from the file, with the mark or without.

    Examples
    --------
    >>> csv_name("'=1+1"), csv_name("leg1")
    ('=1+1', 'leg1')
    """
    return cell[1:] if cell.startswith(MARK) and cell[1:].startswith(_FORMULA) else cell


class RowWriter:
    """Writes rows through `csv_cell`.

    Parameters
    ----------
    stream : text file
        Opened with newline="".
    """

    def __init__(self, stream: IO[str]) -> None:
        self._writer = csv.writer(stream, lineterminator="\n")
        self._quoting = csv.writer(stream, lineterminator="\n", quoting=csv.QUOTE_ALL)

    def writerow(self, row: Iterable[Any]) -> None:
        """Write one row.

        Parameters
        ----------
        row : iterable of objects
            Its cells, each as `csv_cell` takes it.
        """
        cells = [csv_cell(value) for value in row]
        # Python's writer leaves a carriage return bare, where readers see the end of the row
        bare = any(isinstance(cell, str) and "\r" in cell for cell in cells)
        (self._quoting if bare else self._writer).writerow(cells)

    def writerows(self, rows: Iterable[Iterable[Any]]) -> None:
        """Write rows.

        Parameters
        ----------
        rows : iterable of rows
            Each as `writerow` takes it.
        """
        for row in rows:
            self.writerow(row)
