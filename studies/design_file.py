"""Reading a design file: a machine, parameters, objectives, constraints."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.beside_model import tables_beside_model
from strutwork.studies.design import Design
from strutwork.studies.design_schema import CostTable, DesignTable
from strutwork.studies.design_terms import Constraint, Cost, CostOf, Objective, Search
from strutwork.studies.parametric import Parametric
from strutwork.studies.pose_sets import PoseSet, TaskList, hemisphere_poses
from strutwork.studies.question import Asked
from strutwork.studies.study_file import machine_beside, parameter_of, poses_of

#: Where the file is described.
PAGE = "docs/how-to/design.md"


def read_design(path: str | Path) -> Design:
    """Read a design file.

    Parameters
    ----------
    path : str or Path
        TOML; its tables are those of docs/how-to/design.md. The model file that it names lies
        beside it or below it, or has a full path.

    Raises
    ------
    ModelError, UnitError
        The file or the model cannot be read, a key is unknown or wrong, or as `Design`.
    """
    place = Path(path)
    tables = tables_beside_model(place, "design", DesignTable, PAGE)
    machine = machine_beside(place, tables.machine)
    search, vibration = tables.search, tables.vibration
    return Design(
        machine,
        tuple(parameter_of(i, table) for i, table in enumerate(tables.parameters)),
        tuple(Objective.of(t.quantity, t.goal) for t in tables.objectives),
        tuple(Constraint.of(t.quantity, t.at_least, t.at_most) for t in tables.constraints),
        Search(**search.model_dump()),
        _poses(tables, machine),
        _cost(tables.cost),
        Asked("vibration", vibration.band, vibration.count),
    )


def _poses(tables: DesignTable, machine: Parametric) -> PoseSet | None:
    """The poses that a file names in one of three ways; the machine's own where it names none."""
    named = [k for k in ("workspace", "poses", "hemisphere") if k in tables.model_fields_set]
    if len(named) > 1:
        raise ModelError(
            "poses",
            f"are named by {named[0]} and by {named[1]}.",
            "Name them in one of the two.",
        )
    if tables.hemisphere is not None:
        one = tables.hemisphere
        ranges = one.joint_ranges
        return hemisphere_poses(
            machine, one.radius, one.lattice, one.rolls, ranges, one.condition_limit
        )
    if named == ["poses"]:
        rows = [
            {d: v for d in DIRECTIONS if (v := getattr(t, d)) is not None} for t in tables.poses
        ]
        if any(row.keys() != rows[0].keys() for row in rows):
            raise ModelError(
                "poses", "do not all name the same directions.", "Give each pose the same ones."
            )
        return TaskList({d: np.array([r[d] for r in rows]) for d in rows[0]} if rows else {})
    return poses_of(tables.workspace, machine)


def _cost(table: CostTable) -> Cost:
    parts = tuple(CostOf(t.name, float(t.amount), t.per) for t in table.parameters)
    return Cost(float(table.fixed), float(table.per_kg), parts, table.currency)
