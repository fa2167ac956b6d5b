"""Which part gives way: shares of the parts in the tool's displacement, parts alike together."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.machines.model import Model
from strutwork.msa import ComplianceBudget, compliance_budget
from strutwork.reports.axis_words import direction_words
from strutwork.reports.content import Block, Chapter, Column, Details, Figure, Table, Text
from strutwork.reports.data_files import csv_file
from strutwork.reports.figures.charts import stacked_shares
from strutwork.reports.long_tables import shortened
from strutwork.reports.numbers import count, share, significant
from strutwork.reports.part_groups import PartGroup, part_groups, split, titles, told_apart

Array = NDArray[Any]

FILE = "budget.csv"

#: A part with less than this share along every axis stands in the file alone.
SMALL = 5e-4


def budget_chapter(model: Model) -> Chapter:
    """Share of every part in the deflection under a force along each axis."""
    budgets = [compliance_budget(model.placed, wrench) for wrench in np.eye(6)[:3]]
    shares = np.stack([b.shares.reshape(-1) for b in budgets])
    by_part = {part: shares[:, i] for i, part in enumerate(budgets[0].parts)}
    groups = part_groups(by_part)
    named = dict(zip(titles(groups), groups, strict=True))
    frames = _frames(model)
    blocks: list[Block] = [
        Text(
            f"A force at the tool{_opposite(model)} does work on the parts in proportion to their "
            "strain energy; the shares of one force add up to 100 %. Other directions are free to "
            "follow. Parts "
            "whose names differ only in their numbers form one group."
        ),
        Figure(
            "budget-bars",
            "Compliance budget: share of the parts in the tool's deflection along the force.",
            stacked_shares(
                [f"force along {axis}" for axis in "xyz"],
                told_apart({title: 100.0 * np.asarray(g.shares) for title, g in named.items()}),
                "share of the deflection",
            ),
            "Stacked bars of the share of the parts in the deflection along x, y and z.",
            FILE,
            height=330,
        ),
        # the sum stays below the largest shares
        *shortened(_table(named, budgets), kept=1),
        *(
            _details(title, group, by_part, frames)
            for title, group in named.items()
            if len(group.rows) > 1 and group.share >= SMALL
        ),
    ]
    file = csv_file(
        FILE,
        "share of every part in the tool's deflection along a force",
        ("part", "share_x", "share_y", "share_z"),
        [
            ["deflection_m_per_N", *(float(b.deflection) for b in budgets)],
            *([part, *(float(v) for v in values)] for part, values in by_part.items()),
        ],
    )
    return Chapter("budget", "Compliance budget", tuple(blocks), (file,))


def _table(named: dict[str, PartGroup], budgets: list[ComplianceBudget]) -> Table:
    deflections = [
        "total, µm/N",
        *(significant(1e6 * float(b.deflection), 3) for b in budgets),
    ]
    rows = [
        [title, *(share(float(v)) for v in np.asarray(group.shares))]
        for title, group in named.items()
        if group.share >= SMALL
    ]
    columns = (
        Column("parts", "", False),
        *(Column(f"force along {axis}", "share") for axis in "xyz"),
    )
    return Table("Shares of the parts", columns, [*rows, deflections], FILE)


def _frames(model: Model) -> dict[str, Array]:
    joints = model.structure.linkage.joints
    frames = np.asarray(model.placement.frames)
    return {joint.name: frame for joint, frame in zip(joints, frames, strict=True)}


def _details(
    title: str, group: PartGroup, by_part: dict[str, Array], frames: dict[str, Array]
) -> Details:
    """The parts of a group, directions of joints in words."""
    rows = []
    for part in sorted(group.rows, key=lambda p: -float(np.max(by_part[p]))):
        _, name, direction = split(part)
        words = direction_words(direction, frames[name]) if direction else ""
        if np.max(by_part[part]) >= SMALL:
            rows.append([name, words, *(share(float(v)) for v in by_part[part])])
    directed = any(row[1] for row in rows)
    columns = [
        Column("part", "", False),
        Column("direction", "", False),
        *(Column(f"force along {axis}", "share") for axis in "xyz"),
    ]
    if not directed:
        columns, rows = [columns[0], *columns[2:]], [[r[0], *r[2:]] for r in rows]
    what = "direction" if directed and len(group.members) == 1 else "part"
    if directed and len(group.rows) > len(group.members) > 1:
        what = "part and direction"
        many = f"{len(group.rows)} parts and directions"
    else:
        many = count(len(group.rows), what)
    left = len(group.rows) - len(rows)
    small = f", {left} of them below 0.05 %" if left else ""
    table = Table(f"Shares within {title}", columns, rows, FILE)
    return Details(f"{title}: {many}{small}", (table,))


def _opposite(model: Model) -> str:
    against = model.structure.linkage.against
    return "" if against is None else f" and the opposite one at {against}"
