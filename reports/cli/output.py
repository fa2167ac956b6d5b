"""Printing: JSON for programs, tables for people, progress on standard error."""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from math import isinf
from typing import IO, Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from strutwork.csv_rows import RowWriter
from strutwork.errors import ModelError, NumericalError
from strutwork.names import visible
from strutwork.reports.cli.manner import MANNER

#: What JSON leaves as it is and a terminal may obey: DEL, C1 controls, bidirectional marks.
_HIDDEN = re.compile(
    "[\x7f-\x9f\xad\u0600-\u0605\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff]"
)

#: Rows from which a table is written as plain text.
LONG = 200

#: Width of tables in a file or a pipe, characters.
WIDE = 120


def print_json(result: Mapping[str, Any]) -> None:
    """Print one JSON object on standard output.

    Raises
    ------
    ModelError
        CSV is asked as well.
    NumericalError
        A number that is not finite; nothing is printed.
    """
    if MANNER.csv:
        raise ModelError("--json", "cannot be combined with --csv.", "Choose one of the two.")
    try:
        text = json.dumps(result, allow_nan=False, ensure_ascii=False)
        if not _shows(text):
            text = json.dumps(result, allow_nan=False)
    except ValueError:
        raise NumericalError(
            "result", "contains a number that is not finite and is withheld.", "Check the model."
        ) from None
    # one write, so that an error leaves no partial output
    sys.stdout.write(_HIDDEN.sub(_escape, text) + "\n")


def _escape(found: re.Match[str]) -> str:
    return f"\\u{ord(found[0]):04x}"


def tell(text: str) -> None:
    """Say something on standard error."""
    sys.stderr.write(visible(text, lines=True) + "\n")


class Rows(Table):
    """A table that keeps what its cells show."""

    def __init__(
        self, title: str, columns: Sequence[str], rows: Sequence[Sequence[object]]
    ) -> None:
        super().__init__(title=visible(title), title_justify="left", title_style="bold")
        self.kept = (title, columns, rows)

    def write_csv(self, out: IO[str], *, first: bool) -> None:
        """Write it as CSV with every digit, below a line of its title."""
        title, columns, rows = self.kept
        words = " ".join(visible(title).split())
        out.write(f"{'' if first else chr(10)}# {words}\n")
        writer = RowWriter(out)
        writer.writerow([visible(c) or ("value" if i else "name") for i, c in enumerate(columns)])
        for row in rows:
            writer.writerow([_plain(v) for v in row])


def table(
    title: str, columns: Sequence[str], rows: Iterable[Sequence[object]], names: int = 1
) -> Rows:
    """A table whose first `names` columns are names and the others numbers."""
    rows = list(rows)
    made = Rows(title, columns, rows)
    for i, column in enumerate(columns):
        # a number cut short would be a wrong number: narrow columns fold instead
        made.add_column(
            Text(visible(column)), justify="left" if i < names else "right", overflow="fold"
        )
    for row in rows:
        made.add_row(*(_shown(entry) for entry in row))
    return made


def _shown(entry: object) -> Text:
    """A cell of a table; a text with a style keeps it."""
    if isinstance(entry, Text):
        return Text(visible(entry.plain), entry.style)
    return Text(visible(show(entry)))


def _plain(entry: object) -> object:
    """A cell of a CSV file."""
    text = entry.plain if isinstance(entry, Text) else entry
    return visible(text) if isinstance(text, str) else text


def print_table(
    out: Console, title: str, columns: Sequence[str], rows: Sequence[Sequence[object]]
) -> None:
    """Print a table whose first column is a name and the others numbers; a long one as text.

    Rich measures and wraps every cell, a millisecond a row; a long table is for searching and
    has columns as wide as what stands in them.
    """
    if len(rows) <= LONG or MANNER.csv:
        out.print(table(title, columns, rows))
        return
    cells = [list(columns), *([visible(show(entry)) for entry in row] for row in rows)]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    layout = f"{{:<{widths[0]}}}" + "".join(f"  {{:>{w}}}" for w in widths[1:]) + "\n"
    out.print(title, markup=False, style="bold")
    out.file.write("".join(layout.format(*row) for row in cells))


def show(value: object) -> str:
    """A number with four digits, anything else as it is."""
    if isinstance(value, float):
        if isinf(value):
            return "infinite" if value > 0 else "-infinite"
        return "0" if value == 0 else f"{value:.4g}"
    return str(value)


class Screen(Console):
    """A console to which names are text: no markup, no signs for words, nothing hidden."""

    #: Whether nothing was written as CSV yet.
    first = True

    def print(self, *objects: Any, **options: Any) -> None:
        """Print as the console does, with the hidden characters of texts written out.

        As CSV, tables alone.
        """
        if MANNER.csv and not self.stderr:
            for made in objects:
                if isinstance(made, Rows):
                    made.write_csv(self.file, first=self.first)
                    self.first = False
            return
        shown = (visible(o, lines=True) if isinstance(o, str) else o for o in objects)
        super().print(*shown, **options)

    def on_broken_pipe(self) -> None:
        """Leave the end of the reader to the program: called while the error is handled."""
        raise  # noqa: PLE0704


def console() -> Console:
    """Console on standard output; wide when it goes to a file, whose width nobody set."""
    free = not sys.stdout.isatty() and "COLUMNS" not in os.environ
    return Screen(highlight=False, markup=False, emoji=False, width=WIDE if free else None)


def progress_console() -> Console:
    """Console on standard error."""
    return Screen(stderr=True, highlight=False, markup=False, emoji=False)


def _shows(text: str) -> bool:
    """Whether standard output has every character of a text."""
    try:
        text.encode(sys.stdout.encoding or "utf-8")
    except UnicodeEncodeError:
        return False
    return True
