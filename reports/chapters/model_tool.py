"""Stiffness at the tool of a machine."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS
from strutwork.msa import (
    axis_stiffness_blocked,
    axis_stiffness_free,
    stiffness_ellipsoid,
)
from strutwork.reports.content import Block, Chapter, Column, Details, Note, Table, Text
from strutwork.reports.data_files import json_file
from strutwork.reports.model_solution import ModelSolution
from strutwork.reports.numbers import clean, matrix_without_rounding, significant

Array = NDArray[Any]

FREE = "other directions follow, 1/C_ii"
BLOCKED = "other directions blocked, (C⁻¹)_ii"


def tool_chapter(solution: ModelSolution) -> Chapter:
    """The 6 x 6 at the tool and the two meanings of stiffness along an axis."""
    compliance, stiffness = solution.compliance, solution.stiffness
    if compliance is None:
        note = Note("The tool moves freely under one of its six unit wrenches: no stiffness.")
        return Chapter("tool", "Stiffness at the tool", (note,))
    linkage = solution.model.structure.linkage
    free = axis_stiffness_free(compliance)
    blocked = axis_stiffness_blocked(compliance)
    rows = []
    for i, direction in enumerate(DIRECTIONS):
        scale, unit = (1e-6, "N/µm") if i < 3 else (1e-3, "kN·m/rad")
        values = (significant(scale * float(v[i]), 4) for v in (free, blocked))
        rows.append([direction, unit, *values])
    blocks: list[Block] = [
        Text(
            f"These values are for the tool centre point {solution.model.tool}"
            f"{solution.model.relative}, in global axes, with the drives held."
            f"{_workpiece(solution.model.relative)} Stiffness along an "
            "axis is the force divided by the "
            "displacement along it while the five other directions are free to follow; the "
            "stiffness with them blocked, which is never less, is shown beside it."
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
                "Infinite: rigid joints prevent this motion of the tool, alone or with the "
                "others following."
            )
        )
    matrices = [_matrix("Compliance matrix, m/N, 1/N and rad/(N·m)", compliance)]
    if stiffness is not None:
        title = "Stiffness matrix, N/m, N and N·m/rad (force then moment)"
        matrices.insert(0, _matrix(title, stiffness))
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
    blocks.append(Details("The complete stiffness and compliance matrices", tuple(matrices)))
    content = {
        "tool": solution.model.tool,
        **({"against": linkage.against} if linkage.against is not None else {}),
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


def _workpiece(relative: str) -> str:
    if not relative:
        return ""
    return (
        " A force on the tool acts with the opposite sign on the workpiece, and the displacement "
        "is that between both at the tool."
    )
