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
from strutwork.papers.tables import difference
from strutwork.reports.content import Cell, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.numbers import MINUS, percent, significant

NONE = "–"

#: Kinds of status in the order in which they are counted.
STATUSES: tuple[Status, ...] = ("predicted", "calibrated", "not reproducible")
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


def statements_name(paper: str) -> str:
    """Name of the file of all statements of a document."""
    return f"published-{paper}-statements.csv"


def statements_file(paper: str, said: Sequence[Statement]) -> DataFile:
    """All statements of a document, unrounded."""
    return csv_file(
        statements_name(paper),
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
    parts = ", ".join(f"{counts[status]} {status}" for status in STATUSES if status in counts)
    return Text(
        f"{len(said)} results of the document are shown beside the computed values: {parts}. "
        "Predicted means that no choice was made to match the published value; calibrated, that "
        "one was."
    )


def printed(text: str) -> str:
    """Units and signs of a data file as a page prints them."""
    text = re.sub(r"\bum\b", "µm", text).replace("^2", "²").replace("^3", "³")
    return re.sub(r"(?<![\w.)])-(?=\d)", MINUS, text)


def shown(value: float | str, unit: str = "") -> str:
    """A number with its unit, or words, which have theirs in them, as a page prints them."""
    if isinstance(value, str):
        return printed(value) or NONE
    if value != value:  # noqa: PLR0124 - not a number
        return NONE
    # what is counted has no decimals
    text = f"{value:.0f}".replace("-", MINUS) if value == round(value) else significant(value)
    # a number and its unit stay on one line
    return f"{text}{HARD_SPACE}{printed(unit)}" if unit else text


def difference_cell(said: Statement) -> Cell:
    """Difference in percent, coloured by its size; a dash where there is none."""
    if isinstance(said.published, str) or isinstance(said.computed, str):
        return Cell(NONE)
    if said.difference == NONE:
        return Cell(NONE)
    row = PublishedRow("", "", said.unit, said.published, said.computed, said.status)
    return difference(row)
