"""Comparing two machines, question by question."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from typing import Any

from strutwork.errors import ModelError, UnreachableError
from strutwork.fea import Damping
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model import Model
from strutwork.machines.model_poses import Coordinate, at_pose, pose_words
from strutwork.names import visible
from strutwork.reports.answer_store import model_key
from strutwork.reports.designs.design import Design
from strutwork.reports.designs.over_poses import over_poses
from strutwork.reports.designs.quantities import QUANTITIES
from strutwork.reports.designs.result import MARKED, DesignComparison, known_as
from strutwork.reports.designs.row import Row, Value
from strutwork.reports.designs.space import space_of
from strutwork.reports.numbers import significant
from strutwork.studies.progress import Teller


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
        Difference from which two numbers are marked, in %.
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


def compare_standing(
    a: tuple[str, Model],
    b: tuple[str, Model],
    task: Mapping[str, float],
    joints: Mapping[Coordinate, float],
    **options: Any,
) -> DesignComparison:
    """The same at a pose, or at home where none is given.

    Parameters
    ----------
    a, b : (str, Model)
        Name and machine at home.
    task : mapping of direction to float
        Of the tool, m and rad.
    joints : mapping of (joint, direction) to float
        Joint coordinates, m and rad.
    **options
        Of `compare_designs`.

    Raises
    ------
    ModelError, UnreachableError
        As `compare_designs` and `standing_at`.
    """
    if not (task or joints):
        return compare_designs(a, b, **options)
    standing = standing_at(a, task, joints), standing_at(b, task, joints)
    return compare_designs(a, b, standing, f"at {pose_words(task, joints)}", **options)


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


def _answer(found: dict[str, Value], key: str) -> Value:
    return found.get(key) or Value(why="it has no answer")


def _require_two(a: tuple[str, Model], b: tuple[str, Model]) -> None:
    """Refuse a machine beside itself."""
    (first, one), (second, other) = a, b
    named = known_as(first)
    same = one is other or (named is not None and named == known_as(second))
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
