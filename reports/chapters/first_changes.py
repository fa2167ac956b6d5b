"""What to change first: gradients of the worst stiffness, in the chapter on the workspace."""

from __future__ import annotations

from collections.abc import Sequence
from math import isfinite

import xarray as xr

from strutwork.errors import StrutworkError
from strutwork.reports.content import Block, Column, Details, Figure, Note, Table, Text
from strutwork.reports.data_files import DataFile
from strutwork.reports.figures.effect_bars import effect_bars
from strutwork.reports.first_changes import (
    SMALL,
    Effect,
    effects,
    largest,
    what_to_change_file,
)
from strutwork.reports.numbers import percent, significant
from strutwork.reports.subject import Subject
from strutwork.reports.survey_words import pose_text

FILE = "first-changes.csv"

#: Dimensions drawn, and listed before those with less effect are folded away.
DRAWN, LISTED = 8, 12

#: Effects above this share say where to look, and not what comes.
STEEP = 0.5


def first_changes(subject: Subject) -> tuple[tuple[Block, ...], tuple[DataFile, ...]]:
    """What ten percent more of each dimension brings where the machine is least stiff.

    Nothing where its numbers have no paths, or none has an effect.

    Parameters
    ----------
    subject : Subject
    """
    try:
        found = subject.first_changes
    except StrutworkError as error:
        return (Note(f"What to change first is not known: {error.problem}"),), ()
    if not found:
        return (), ()
    axes = [str(one["quantity"].to_numpy()[0]).removeprefix("stiffness_") for one in found]
    every = _together(found)
    shown = [e for e in every if max(_size(s) for s in e.shares) >= SMALL]
    if not shown:
        return (), ()
    poses = [
        f"{axis}: {significant(1e-6 * float(one['value'].to_numpy()[0, 0]))} N/µm at "
        f"{pose_text({d: float(one[d][0]) for d in one.coords if d in _DIRECTIONS})}"
        for axis, one in zip(axes, found, strict=True)
    ]
    blocks: list[Block] = [
        Text(
            "What to change first. Where the stiffness along each axis is least, its gradient "
            "tells what 10 % more of a dimension brings, all else held: a linear estimate, which "
            "is good for small changes. Dimensions whose paths differ by numbers alone change "
            f"together. The poses: {'; '.join(poses)}."
        ),
        Figure(
            "first-changes",
            "Effect of 10 % more of each dimension on the least stiffness along each axis, linear "
            "estimate from the gradient.",
            effect_bars(
                [e.label for e in shown[:DRAWN]],
                {
                    axis: [100.0 * (s if isfinite(s) else 0.0) for s in column]
                    for axis, column in zip(
                        axes, zip(*(e.shares for e in shown[:DRAWN]), strict=True), strict=True
                    )
                },
                "change of the stiffness",
            ),
            "Horizontal bars of the change of the least stiffness along x, y and z by 10 % more of "
            "each dimension.",
            FILE,
            height=140 + 22 * len(axes) * min(len(shown), DRAWN),
        ),
        _table("Effect of 10 % more of a dimension, linear", axes, shown[:LISTED]),
    ]
    if len(shown) > LISTED:
        rest = _table("Those with less effect", axes, shown[LISTED:])
        blocks.append(Details(f"{len(shown) - LISTED} dimensions with less effect", (rest,)))
    none = [e.label for e in every if e not in shown]
    if none:
        blocks.append(Note(f"Less than 0.005 % each: {', '.join(none)}."))
    steep = [e.label for e in shown if max(_size(s) for s in e.shares) > STEEP]
    if steep:
        blocks.append(
            Note(
                f"{', '.join(steep)}: so steep that 10 % is beyond a linear estimate; 1 % more "
                "brings about a tenth of what is shown."
            )
        )
    remarks = dict.fromkeys(
        words for one in found for words in (*one.attrs["remarks"], *one.attrs["refused"])
    )
    blocks.extend(Note(words) for words in remarks)
    return tuple(blocks), (what_to_change_file(found, FILE),)


_DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")


def _size(share: float) -> float:
    return abs(share) if isfinite(share) else 0.0


def _together(found: Sequence[xr.Dataset]) -> list[Effect]:
    """Effects on the stiffness along every axis, each at its own pose."""
    by_axis = [{e.names: e for e in effects(one)} for one in found]
    rows = [
        Effect(names, first.value, tuple(of[names].shares[0] for of in by_axis))
        for names, first in by_axis[0].items()
    ]
    return sorted(rows, key=lambda row: -largest(row.shares))


def _table(title: str, axes: Sequence[str], rows: Sequence[Effect]) -> Table:
    columns = (
        Column("dimension", "", False),
        Column("is", "", False),
        *(Column(f"stiffness along {axis}", "change") for axis in axes),
    )
    cells = [
        [e.label, e.value, *(percent(100.0 * s) if isfinite(s) else "none" for s in e.shares)]
        for e in rows
    ]
    return Table(title, columns, cells, FILE)
