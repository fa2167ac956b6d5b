"""Comparing two machines, question by question."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from strutwork.errors import ModelError, UnreachableError
from strutwork.fea import Damping
from strutwork.html import table
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model import Model
from strutwork.machines.model_poses import Coordinate, at_pose
from strutwork.machines.naming import is_machine, named_machine
from strutwork.names import listed, visible
from strutwork.reports.answer_store import model_key
from strutwork.reports.designs.design import Design
from strutwork.reports.designs.over_poses import over_poses
from strutwork.reports.designs.quantities import QUANTITIES, QUESTIONS, Question
from strutwork.reports.designs.row import Row, Value
from strutwork.reports.designs.space import Space, space_of
from strutwork.reports.numbers import significant
from strutwork.studies.progress import Teller

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
        Difference from which two numbers are marked, percent.
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
        asked = all(_named(design.name) for design in (self.a, self.b))
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
        """Title of the table of a question."""
        return question.title.format(where=self.where)

    def asks(self, question: Question) -> str:
        """A question in words."""
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


def compare_designs(
    a: tuple[str, Model],
    b: tuple[str, Model],
    standing: tuple[Model, Model] | None = None,
    where: str = "at home",
    *,
    around: TaskGrid | None = None,
    threshold: float = MARKED,
    damping: Damping | None = None,
    progress: Teller | None = None,
) -> DesignComparison:
    """Ask two machines the same questions.

    Parameters
    ----------
    a, b : (str, Model)
        Name and machine at home. A name of the catalogue lets it be asked for the tolerances of
        its document, and whether it is a model for statics.
    standing : (Model, Model), optional
        The same two where they are asked; at home else.
    where : str
        That place in words.
    around : TaskGrid, optional
        Poses counted from the home of each; else what their workspaces share, or each its own.
    threshold : float
        Difference from which two numbers are marked, percent.
    damping : Damping, optional
        Of both, in place of their own.
    progress : callable, optional

    Returns
    -------
    DesignComparison
        A question that one cannot answer is a row with the reason.

    Raises
    ------
    ModelError
        The same machine twice, or a threshold below zero.
    """
    if not (isfinite(threshold) and threshold >= 0.0):
        raise ModelError("threshold", f"is {threshold:g} %.", "Give a number of 0 or more.")
    _require_two(a, b)
    there = (a[1], b[1]) if standing is None else standing
    first, second = (
        Design(name, model, at, damping) for (name, model), at in zip((a, b), there, strict=True)
    )
    space = space_of(first.model, second.model, around)
    bands = [band for d in (first, second) if (band := d.band()) is not None]
    band = (min(low for low, _ in bands), max(high for _, high in bands)) if bands else None
    over = over_poses(first, second, space, progress)
    answers = [
        design.answers() | design.vibration(band) | more
        for design, more in ((first, over.a), (second, over.b))
    ]
    rows = tuple(
        Row(q, _answer(answers[0], q.key), _answer(answers[1], q.key), threshold)
        for q in QUANTITIES
    )
    notes = [space.words, over.words]
    if band is not None:
        low, high = (significant(f) for f in band)
        notes.append(
            f"The least dynamic stiffness is the minimum from {low} to {high} Hz, a band that "
            "contains the modes that matter at either tool."
        )
    freedoms = next(row for row in rows if row.quantity.key == "tool_freedoms")
    if freedoms.marked:
        notes.append(
            f"The tools do not have the same degrees of freedom: {freedoms.a.words} in A; "
            f"{freedoms.b.words} in B. In a direction without a drive the stiffness is that of the "
            "structure alone."
        )
    return DesignComparison(
        first, second, where, space, band, threshold, rows, tuple(n for n in notes if n)
    )


def standing_at(
    named: tuple[str, Model], task: Mapping[str, float], joints: Mapping[Coordinate, float]
) -> Model:
    """A machine elsewhere; where it cannot stand there, the message names it.

    Parameters
    ----------
    named : (str, Model)
    task : mapping of direction to float
        Of the tool, m and rad.
    joints : mapping of (joint, direction) to float
        Joint coordinates, m and rad.

    Raises
    ------
    ModelError, UnreachableError
        As `strutwork.machines.model_poses.at_pose`.
    """
    name, model = named
    try:
        return at_pose(model, task, joints)
    except (ModelError, UnreachableError) as error:
        part = f"{visible(name)}, {error.part}" if error.part else visible(name)
        raise type(error)(part, error.problem, error.remedy) from error


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


def _answer(found: dict[str, Value], key: str) -> Value:
    return found.get(key) or Value(why="it has no answer")


def _require_two(a: tuple[str, Model], b: tuple[str, Model]) -> None:
    """Refuse a machine beside itself."""
    (first, one), (second, other) = a, b
    named = _named(first)
    same = one is other or (named is not None and named == _named(second))
    if not same:
        try:
            same = model_key(one) == model_key(other)
        except ModelError:
            # it holds what has no hash, such as a function of the user's own
            same = False
    if same:
        raise ModelError(
            "compare",
            f'finds one machine: "{visible(first)}" and "{visible(second)}" are the same.',
            "Name another machine or variant, or a changed copy of the model file.",
        )


def _named(name: str) -> str | None:
    """One name for all that mean the same machine or file; None where it means neither."""
    if is_machine(name):
        return named_machine(name).name
    try:
        return str(Path(name).resolve(strict=True))
    except (OSError, ValueError):
        return None
