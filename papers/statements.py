"""Every result that a document prints: published, ours, status, reason, and its test."""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import astuple, dataclass, fields
from pathlib import Path
from typing import cast

from strutwork.papers.published_rows import PublishedRow, Status
from strutwork.papers.tables import difference, texts
from strutwork.reports.content import Cell, Chapter, Column, Points, Table, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.numbers import MINUS, percent, significant

NONE = "–"
HARD_SPACE = "\N{NO-BREAK SPACE}"


@dataclass(frozen=True)
class Statement:
    """One result of a document beside the computed values, in words where it is no number.

    Parameters
    ----------
    place : str
        Where the document prints it: "Table 2", "section 6.4".
    what : str
    unit : str
    published, computed : float or str
        Of a text, what is said. Not a number where we have none.
    status : "predicted", "calibrated" or "not reproducible"
    reason : str
        What was chosen, or why it does not come out; empty where there is nothing to say.
    test : str
        Path and name of the test that holds it, `tests/…py::test_…`.
    """

    place: str
    what: str
    unit: str
    published: float | str
    computed: float | str
    status: Status
    reason: str
    test: str

    @property
    def difference(self) -> str:
        """In percent, where both are numbers."""
        if isinstance(self.published, str) or isinstance(self.computed, str) or not self.published:
            return NONE
        if self.computed != self.computed:
            return NONE
        return percent(100.0 * (self.computed - self.published) / self.published)


def stated(rows: Iterable[PublishedRow], place: str, test: str) -> tuple[Statement, ...]:
    """Rows of a published table as statements."""
    return tuple(
        Statement(
            place,
            f"{row.row}: {row.quantity}",
            row.unit,
            row.published,
            row.computed,
            row.status,
            row.note,
            test,
        )
        for row in rows
    )


def statements_chapter(key: str, title: str, said: Sequence[Statement]) -> Chapter:
    """A chapter with one table of statements, and below it reasons and tests, each once."""
    reasons = list(dict.fromkeys(s.reason for s in said if s.reason))
    tests = list(dict.fromkeys(s.test for s in said))
    # among words a unit stands with its number, which leaves the words more room
    words = any(isinstance(v, str) for s in said for v in (s.published, s.computed))
    columns = (
        Column("place", "", False, width="narrow"),
        Column("what", "", False, width="wide"),
        # words wrap, numbers stand to the right
        Column("published", "", not any(isinstance(s.published, str) for s in said)),
        Column("computed", "", not any(isinstance(s.computed, str) for s in said)),
        *(() if words else texts("unit")),
        Column("difference"),
        Column("status", "", False, width="narrow"),
        *(texts("test") if len(tests) > 1 else ()),
    )
    rows: list[list[str | Cell]] = [
        [
            s.place,
            _printed(s.what),
            *(shown(v, s.unit if words else "") for v in (s.published, s.computed)),
            *(() if words else (_printed(s.unit),)),
            _difference(s),
            s.status + (f" ({reasons.index(s.reason) + 1})" if s.reason else ""),
            *([_letter(tests.index(s.test))] if len(tests) > 1 else ()),
        ]
        for s in said
    ]
    table = Table(f"Published and computed: {len(said)}", columns, rows)
    why = tuple(f"({n}) {reason[0].upper()}{reason[1:]}." for n, reason in enumerate(reasons, 1))
    held = tuple(
        f"Held by {test}" if len(tests) == 1 else f"{_letter(n)}:{HARD_SPACE}{test}"
        for n, test in enumerate(tests)
    )
    return Chapter(key, title, (table, Points((*why, *held))))


def _letter(number: int) -> str:
    """A to z, then aa and so on."""
    text = ""
    number += 1
    while number:
        number, digit = divmod(number - 1, 26)
        text = chr(ord("a") + digit) + text
    return text


def statements_file(paper: str, said: Sequence[Statement]) -> DataFile:
    """All statements of a document, unrounded."""
    return csv_file(
        f"published-{paper}-statements.csv",
        "every result that the document prints, beside the computed values, with the test that "
        "holds it",
        [f.name for f in fields(Statement)],
        [list(astuple(s)) for s in said],
    )


def read_statements(path: Path) -> tuple[Statement, ...]:
    """What `statements_file` has written; what is a number there is one again."""
    with path.open(encoding="utf-8", newline="") as stream:
        rows = list(csv.DictReader(stream))
    return tuple(
        Statement(
            row["place"],
            row["what"],
            row["unit"],
            _read(row["published"]),
            _read(row["computed"]),
            cast(Status, row["status"]),
            row["reason"],
            row["test"],
        )
        for row in rows
    )


def _read(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def count_text(said: Sequence[Statement]) -> Text:
    """How many have which status."""
    counts = Counter(s.status for s in said)
    parts = ", ".join(f"{counts[status]} {status}" for status in sorted(counts))
    return Text(
        f"{len(said)} results of the document are shown beside the computed values: {parts}. "
        "Predicted means that no choice was made to match the published value; calibrated, that "
        "one was."
    )


def _printed(text: str) -> str:
    """Units and signs of a data file as a page prints them."""
    text = re.sub(r"\bum\b", "µm", text).replace("^2", "²").replace("^3", "³")
    return re.sub(r"(?<![\w.)])-(?=\d)", MINUS, text)


def shown(value: float | str, unit: str = "") -> str:
    """A number with its unit, or words, which have theirs in them, as a page prints them."""
    if isinstance(value, str):
        return _printed(value) or NONE
    if value != value:  # noqa: PLR0124 - not a number
        return NONE
    # what is counted has no decimals
    text = f"{value:.0f}".replace("-", MINUS) if value == round(value) else significant(value)
    # a number and its unit stay on one line
    return f"{text}{HARD_SPACE}{_printed(unit)}" if unit else text


def _difference(said: Statement) -> Cell:
    if isinstance(said.published, str) or isinstance(said.computed, str):
        return Cell(NONE)
    if said.difference == NONE:
        return Cell(NONE)
    row = PublishedRow("", "", said.unit, said.published, said.computed, said.status)
    return difference(row)
