"""The result of the comparison of two machines."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from strutwork.html import table
from strutwork.machines.naming import is_machine, named_machine
from strutwork.names import listed
from strutwork.reports.designs.design import Design
from strutwork.reports.designs.quantities import QUESTIONS, Question
from strutwork.reports.designs.row import Row
from strutwork.reports.designs.space import Space

if TYPE_CHECKING:
    import pandas as pd

#: Difference from which two numbers are marked, percent.
MARKED = 5.0


@dataclass(frozen=True)
class DesignComparison:
    """Two machines asked the same questions.

    Parameters
    ----------
    a, b : Design
    where : str
        Where they stand: "at home", or a pose.
    space : Space
        Poses over which they are looked at.
    band : (float, float) or None
        Hz; in which the least dynamic stiffness is looked for.
    threshold : float
        Difference from which two numbers are marked, in %.
    rows : tuple of Row
        One per quantity, in the order of `QUANTITIES`.
    notes : tuple of str
        What a reader must know, sentences.
    """

    a: Design
    b: Design
    where: str
    space: Space
    band: tuple[float, float] | None
    threshold: float
    rows: tuple[Row, ...]
    notes: tuple[str, ...]

    def __repr__(self) -> str:
        return f"<DesignComparison of {self.a.name} and {self.b.name}: {self.summary}>"

    def __getitem__(self, key: str) -> Row:
        """The row of a quantity by its key, as "home_stiffness_free_x".

        Raises
        ------
        KeyError
            There is none.
        """
        for row in self.rows:
            if row.quantity.key == key:
                return row
        raise KeyError(key)

    @property
    def summary(self) -> str:
        """How often either is better, in words."""
        return tally(self.rows)

    @property
    def named(self) -> bool:
        """Whether the names alone ask for it again."""
        asked = all(known_as(design.name) for design in (self.a, self.b))
        own = not (self.a.moved or self.b.moved or self.a.damping or self.b.damping)
        return asked and own and self.threshold == MARKED and not self.space.asked

    def of(self, question: str) -> tuple[Row, ...]:
        """The rows of a question by its key.

        Parameters
        ----------
        question : str
            Of `QUESTIONS`.
        """
        return tuple(row for row in self.rows if row.quantity.question == question)

    def title_of(self, question: Question) -> str:
        """Title of the table of a question.

        Parameters
        ----------
        question : Question
        """
        return question.title.format(where=self.where)

    def asks(self, question: Question) -> str:
        """A question in words.

        Parameters
        ----------
        question : Question
        """
        return question.asks.format(where=self.where)

    def to_dict(self) -> dict[str, Any]:
        """Plain values in SI."""
        return {
            "a": {"name": self.a.name, "title": self.a.title},
            "b": {"name": self.b.name, "title": self.b.title},
            "where": self.where,
            "poses": self.space.words,
            "shared_poses": self.space.shared,
            "band": None if self.band is None else list(self.band),
            "threshold_percent": self.threshold,
            "summary": self.summary,
            "notes": list(self.notes),
            "questions": {
                q.key: {
                    "title": self.title_of(q),
                    "criterion": q.criterion,
                    "rows": [row.to_dict() for row in self.of(q.key)],
                }
                for q in QUESTIONS
            },
        }

    def to_dataframe(self) -> pd.DataFrame:
        """One line per quantity, indexed by its key; SI, missing and infinite as in pandas."""
        import pandas as pd

        lines = [flat(row) for row in self.rows]
        return pd.DataFrame(lines).set_index("key")

    def report(self, file: Path | str) -> Path:
        """Write the comparison as one page that needs no other file; its data are in it.

        Parameters
        ----------
        file : Path or str

        Raises
        ------
        OutputError
            It cannot be written.
        """
        from strutwork.reports.designs.page import write_comparison

        return write_comparison(self, Path(file))

    def _repr_html_(self) -> str:
        lines = [
            (
                f"{row.quantity.name}, {row.quantity.question}",
                row.a.shown(row.quantity.unit),
                row.b.shown(row.quantity.unit),
                row.shown_unit,
                row.shown_difference,
                row.verdict,
            )
            for row in self.rows
        ]
        heads = ("", f"A: {self.a.name}", f"B: {self.b.name}", "", "B − A", "")
        return table(f"A and B {self.where}: {self.summary}", lines, heads)


def tally(rows: tuple[Row, ...]) -> str:
    """How often either is better, in words: "A better in 3, B better in 5, alike in 4".

    Parameters
    ----------
    rows : tuple of Row
    """
    counts = Counter(row.verdict for row in rows)
    words = [
        (counts["A better"], "A better in"),
        (counts["B better"], "B better in"),
        (counts["differs"], "different in"),
        (counts["alike"] + counts["equal"], "alike in"),
        (counts["not compared"], "not compared in"),
    ]
    return listed([f"{text} {n}" for n, text in words if n])


def unanswered(found: DesignComparison) -> list[str]:
    """What either machine does not answer and why, a sentence for each reason.

    Parameters
    ----------
    found : DesignComparison
    """
    reasons: dict[tuple[str, tuple[str, ...]], str] = {}
    for mark in ("A", "B"):
        by_reason: dict[str, list[Row]] = {}
        for row in found.rows:
            why = (row.a if mark == "A" else row.b).why
            if why:
                by_reason.setdefault(why, []).append(row)
        for why, rows in by_reason.items():
            key = why, _asked(found, rows)
            reasons[key] = f"{reasons[key]} and {mark}" if key in reasons else mark
    return [
        f"No result for {who} ({listed(words)}): {why}" for (why, words), who in reasons.items()
    ]


def _asked(found: DesignComparison, rows: list[Row]) -> tuple[str, ...]:
    """What some rows ask: the title of a question of which all are among them, else each."""
    words: list[str] = []
    for question in QUESTIONS:
        some = [row.quantity.name for row in rows if row.quantity.question == question.key]
        title = found.title_of(question)
        complete = len(some) > 1 and len(some) == len(found.of(question.key))
        words += [title[0].lower() + title[1:]] if complete else some
    return tuple(words)


def flat(row: Row) -> dict[str, Any]:
    """A row as one line of a table, SI.

    Parameters
    ----------
    row : Row
    """
    q = row.quantity
    return {
        "key": q.key,
        "question": q.question,
        "quantity": q.name,
        "unit": q.unit,
        "a": row.a.words or row.a.number,
        "b": row.b.words or row.b.number,
        "difference_percent": row.difference,
        "verdict": row.verdict,
        "better": {"more": "the larger", "less": "the smaller"}.get(q.better, ""),
        "a_at": row.a.at,
        "b_at": row.b.at,
        "a_reason": row.a.why,
        "b_reason": row.b.why,
    }


def known_as(name: str) -> str | None:
    """One name for all that mean the same machine or file; None where it means neither.

    Parameters
    ----------
    name : str
    """
    if is_machine(name):
        return named_machine(name).name
    try:
        return str(Path(name).resolve(strict=True))
    except (OSError, ValueError):
        return None
