"""Printing: JSON for programs, tables for people, progress on standard error."""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Iterable, Mapping, Sequence
from math import isinf
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from strutwork.errors import NumericalError
from strutwork.names import visible

#: What JSON leaves as it is and a terminal may obey: DEL, C1 controls, bidirectional marks.
_HIDDEN = re.compile(
    "[\x7f-\x9f\xad\u0600-\u0605\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff]"
)

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
        if not _shows(text):
            text = json.dumps(result, allow_nan=False)
    except ValueError:
        raise NumericalError(
            "result", "holds a number that is not finite and is withheld.", "Check the model."
        ) from None
    # one write, so that an error leaves no partial output
    sys.stdout.write(_HIDDEN.sub(_escape, text) + "\n")


def _escape(found: re.Match[str]) -> str:
    return f"\\u{ord(found[0]):04x}"


def tell(text: str) -> None:
    """Say something on standard error."""
    sys.stderr.write(visible(text, lines=True) + "\n")


def table(
    title: str, columns: Sequence[str], rows: Iterable[Sequence[object]], names: int = 1
) -> Table:
    """A table whose first `names` columns are names and the others numbers."""
    made = Table(title=visible(title), title_justify="left", title_style="bold")
    for i, column in enumerate(columns):
        # a number cut short would be a wrong number: narrow columns fold instead
        made.add_column(
            Text(visible(column)), justify="left" if i < names else "right", overflow="fold"
        )
    for row in rows:
        made.add_row(*(Text(visible(show(entry))) for entry in row))
    return made


def show(value: object) -> str:
    """A number with four digits, anything else as it is."""
    if isinstance(value, float):
        if isinf(value):
            return "infinite" if value > 0 else "-infinite"
        return "0" if value == 0 else f"{value:.4g}"
    return str(value)


class Screen(Console):
    """A console to which names are text: no markup, no signs for words, nothing hidden."""

    def print(self, *objects: Any, **options: Any) -> None:
        """Print as the console does, with the hidden characters of texts written out."""
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
