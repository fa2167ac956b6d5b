"""Printing: JSON for programs, tables for people, progress on standard error."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Iterable, Mapping, Sequence
from math import isinf
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from strutwork.errors import NumericalError

#: Width of tables in a file or a pipe, characters.
WIDE = 120


def print_json(result: Mapping[str, Any]) -> None:
    """Print one JSON object on standard output.

    Raises
    ------
    NumericalError
        A number that is not finite; nothing is printed.
    """
    try:
        text = json.dumps(result, allow_nan=False, ensure_ascii=False)
    except ValueError:
        raise NumericalError(
            "result", "holds a number that is not finite and is withheld.", "Check the model."
        ) from None
    # one write, so that an error leaves no partial output
    sys.stdout.write(text + "\n")


class _Console(Console):
    """A console that leaves the end of its reader to the program."""

    def on_broken_pipe(self) -> None:
        """Called while the error is handled: let it pass."""
        raise  # noqa: PLE0704


def table(
    title: str, columns: Sequence[str], rows: Iterable[Sequence[object]], names: int = 1
) -> Table:
    """A table whose first `names` columns are names and the others numbers."""
    made = Table(title=title, title_justify="left", title_style="bold")
    for i, column in enumerate(columns):
        # a number cut short would be a wrong number: narrow columns fold instead
        made.add_column(Text(column), justify="left" if i < names else "right", overflow="fold")
    for row in rows:
        made.add_row(*(Text(show(entry)) for entry in row))
    return made


def show(value: object) -> str:
    """A number with four digits, anything else as it is."""
    if isinstance(value, float):
        if isinf(value):
            return "infinite" if value > 0 else "-infinite"
        return "0" if value == 0 else f"{value:.4g}"
    return str(value)


def console() -> Console:
    """Console on standard output; wide when it goes to a file, whose width nobody set."""
    free = not sys.stdout.isatty() and "COLUMNS" not in os.environ
    return _Console(highlight=False, width=WIDE if free else None)


def progress_console() -> Console:
    """Console on standard error."""
    return Console(stderr=True, highlight=False)
