"""Stiffness at the tool of a model file, and which part gives way."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model import Model
from strutwork.msa import (
    axis_stiffness_blocked,
    axis_stiffness_free,
    compliance_budget,
    stiffness_ellipsoid,
)
from strutwork.reports.content import Block, Chapter, Column, Figure, Note, Table, Text
from strutwork.reports.data_files import csv_file, json_file
from strutwork.reports.figures.charts import REST, stacked_shares
from strutwork.reports.model_solution import ModelSolution
from strutwork.reports.numbers import clean, matrix_without_rounding, share, significant

Array = NDArray[Any]

#: Parts told apart in the chart; the rest is one colour.
LARGEST = 7

FREE = "1/C_ii, other directions free"
BLOCKED = "(C⁻¹)_ii, other directions blocked"


def tool_chapter(solution: ModelSolution) -> Chapter:
    """The 6 x 6 at the tool and the two meanings of stiffness along an axis."""
    compliance, stiffness = solution.compliance, solution.stiffness
    if compliance is None:
        note = Note("The tool moves freely under one of its six unit wrenches: no stiffness.")
        return Chapter("tool", "Stiffness at the tool", (note,))
    free = axis_stiffness_free(compliance)
    blocked = axis_stiffness_blocked(compliance)
    rows = []
    for i, direction in enumerate(DIRECTIONS):
        scale, unit = (1e-6, "N/µm") if i < 3 else (1e-3, "kN·m/rad")
        values = (significant(scale * float(v[i]), 4) for v in (free, blocked))
        rows.append([direction, unit, *values])
    blocks: list[Block] = [
        Text(
            f"At node “{solution.model.tool}”, global axes, drives held. Along an axis stiffness "
            "has two meanings: with the five others free to follow, and with them blocked."
        ),
        Table(
            "Stiffness along each axis",
            (Column("axis", "", False), Column("unit", "", False), Column(FREE), Column(BLOCKED)),
            rows,
            "tool.json",
        ),
    ]
    if not np.all(np.isfinite([free, blocked])):
        blocks.append(
            Note(
                "Infinite: rigid joints leave the tool no such motion, alone or with the others "
                "following."
            )
        )
    if stiffness is not None:
        blocks.append(
            _matrix("Stiffness matrix, N/m, N and N·m/rad (force then moment)", stiffness)
        )
    blocks.append(_matrix("Compliance matrix, m/N, 1/N and rad/(N·m)", compliance))
    ellipsoid = stiffness_ellipsoid(compliance, "free")
    principal = [
        [significant(v / 1e6, 4), clean(ellipsoid.directions[:, i].tolist())]
        for i, v in enumerate(ellipsoid.values)
    ]
    blocks.append(
        Table(
            "Principal translational stiffness, rotations free",
            (Column("stiffness", "N/µm"), Column("direction x, y, z")),
            principal,
            "tool.json",
        )
    )
    content = {
        "tool": solution.model.tool,
        "compliance": compliance.tolist(),
        "stiffness": None if stiffness is None else stiffness.tolist(),
        # null stands for a direction in which the tool cannot move: its stiffness is infinite
        "axis_stiffness_free": _finite(free),
        "axis_stiffness_blocked": _finite(blocked),
        "principal_stiffness_rotations_free": {
            "values": _finite(ellipsoid.values),
            "directions_as_columns": ellipsoid.directions.tolist(),
        },
    }
    file = json_file("tool.json", "compliance and stiffness at the tool, SI", content)
    return Chapter("tool", "Stiffness at the tool", tuple(blocks), (file,))


def budget_chapter(model: Model) -> Chapter:
    """Share of every part in the deflection under a force along each axis."""
    budgets = [compliance_budget(model.placed, wrench) for wrench in np.eye(6)[:3]]
    parts = budgets[0].parts
    shares = 100.0 * np.stack([b.shares.reshape(-1) for b in budgets])
    order = np.argsort(-shares.max(axis=0), kind="stable")
    named = {parts[i]: shares[:, i] for i in order[:LARGEST]}
    if len(order) > LARGEST:
        named[REST] = shares[:, order[LARGEST:]].sum(axis=1)
    categories = [f"force along {axis}" for axis in "xyz"]
    rows = [
        [parts[i], *(share(value / 100) for value in shares[:, i])] for i in order[: 3 * LARGEST]
    ]
    columns: Sequence[Column] = (
        Column("part", "", False),
        *(Column(f"along {axis}", "share") for axis in "xyz"),
    )
    deflections = [
        "deflection, µm/N",
        *(significant(1e6 * float(b.deflection), 4) for b in budgets),
    ]
    blocks: list[Block] = [
        Text(
            "A force at the tool does work on the parts in proportion to their strain energy; the "
            "shares of one force add to 100 %. Other directions are free to follow."
        ),
        Figure(
            "budget-bars",
            "Compliance budget: share of the parts in the tool's deflection along the force.",
            stacked_shares(categories, named, "share of the deflection"),
            "Stacked bars of the share of the parts in the deflection along x, y and z.",
            "budget.csv",
            height=330,
        ),
        Table("Shares of the parts", columns, [deflections, *rows], "budget.csv"),
    ]
    file = csv_file(
        "budget.csv",
        "share of every part in the tool's deflection along a force",
        ("part", "share_x", "share_y", "share_z"),
        [
            ["deflection_m_per_N", *(float(b.deflection) for b in budgets)],
            *([part, *(float(v) / 100 for v in shares[:, i])] for i, part in enumerate(parts)),
        ],
    )
    return Chapter("budget", "Compliance budget", tuple(blocks), (file,))


def _finite(values: Array) -> list[float | None]:
    return [float(v) if np.isfinite(v) else None for v in values]


def _matrix(title: str, matrix: Array) -> Table:
    rows = [
        [direction, *(significant(float(v), 4) for v in row)]
        for direction, row in zip(DIRECTIONS, matrix_without_rounding(matrix), strict=True)
    ]
    return Table(
        title, (Column("", "", False), *(Column(d) for d in DIRECTIONS)), rows, "tool.json"
    )
