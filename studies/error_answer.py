"""The error sheet over a workspace, and along an axis as machine tools are tested (ISO 230-1)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model import Model
from strutwork.machines.model_poses import moved
from strutwork.msa import PlacedStructure
from strutwork.outcome import Outcome, solve_poses
from strutwork.studies.answers import Column
from strutwork.studies.error_causes import error_causes, error_sheet
from strutwork.studies.error_inputs import ErrorInputs
from strutwork.studies.error_sheet import ErrorSheet

Array = NDArray[Any]

#: Draws of the distribution at each pose of a workspace.
SAMPLES = 4096

UNIT = "m for x y z; rad for rx ry rz"

#: What the errors are called in ISO 230-1, as in EYX: along or about, and of which axis.
LETTERS = ("X", "Y", "Z", "A", "B", "C")


@dataclass(frozen=True)
class ErrorSheets:
    """Displacement of the tool by all causes at every pose.

    Parameters
    ----------
    model : Model
    inputs : ErrorInputs
    """

    model: Model
    inputs: ErrorInputs

    @property
    def columns(self) -> tuple[Column, ...]:
        """What is known, at worst, its distribution, and each cause."""
        dims = ("direction",)
        return (
            Column("known", UNIT, "sum of the known displacements", dims),
            Column("worst_case", UNIT, "largest displacement to either side", dims, "largest"),
            Column("standard_deviation", UNIT, "standard deviation", dims, "largest"),
            Column(
                "within_95_percent",
                UNIT,
                "what the displacement stays within with a probability of 95 %",
                dims,
                "largest",
            ),
            Column("largest_displacement", "m", "largest in any direction of space", (), "largest"),
            Column(
                "cause_worst_case",
                UNIT,
                "largest displacement by one cause",
                ("cause", "direction"),
                "largest",
            ),
        )

    @cached_property
    def causes(self) -> tuple[str, ...]:
        """Those that the machine has where it stands."""
        return error_sheet(self.model, self.inputs).causes

    @property
    def coordinates(self) -> Mapping[str, tuple[Any, ...]]:
        """Directions of the tool, and the causes."""
        return {"direction": DIRECTIONS, "cause": self.causes}

    def __call__(self, placed: PlacedStructure) -> tuple[dict[str, Array], Outcome]:
        """Of a flat batch."""
        poses = placed.batch[0]
        widths = {d: len(v) for d, v in self.coordinates.items()}
        arrays = {
            c.name: np.full((poses, *(widths[d] for d in c.dims)), np.nan) for c in self.columns
        }

        inputs = self.inputs.computed(self.model)

        def some(index: NDArray[np.intp]) -> None:
            for i in index:
                causes = error_causes(self.model, inputs, placed[int(i)])
                sheet = causes.sheet(forces=False)
                arrays["known"][i] = sheet.mean
                arrays["worst_case"][i] = sheet.worst
                arrays["standard_deviation"][i] = sheet.deviation
                arrays["within_95_percent"][i] = sheet.within(samples=SAMPLES)
                arrays["largest_displacement"][i] = np.linalg.norm(sheet.largest())
                arrays["cause_worst_case"][i] = [sheet.of(c).worst for c in self.causes]

        return arrays, solve_poses(some, poses)


@dataclass(frozen=True)
class AxisErrors:
    """Errors of the tool while it moves along one axis.

    Parameters
    ----------
    axis : str
        A direction of the tool.
    positions : (n,)
        m or rad.
    errors : (n, 6)
        The known part, m and rad. Along and about the axis and of rotations what differs from the
        first position; straightness about the straight line of least squares.
    half_range : (n, 6)
        ± at each position, m and rad.
    """

    axis: str
    positions: Array
    errors: Array
    half_range: Array

    def __repr__(self) -> str:
        return f"<AxisErrors along {self.axis}: {len(self.positions)} positions>"

    @property
    def names(self) -> tuple[str, ...]:
        """As in EXX, EYX, EZX, EAX, EBX, ECX (ISO 230-1)."""
        own = LETTERS[DIRECTIONS.index(self.axis)]
        return tuple(f"E{letter}{own}" for letter in LETTERS)

    @property
    def deviation(self) -> Array:
        """Largest less least of the known part of each error, (6,), m and rad."""
        return np.asarray(np.ptp(self.errors, axis=0))

    def to_dict(self) -> dict[str, Any]:
        """Lists by the names of the errors, SI."""
        return {
            "axis": self.axis,
            "positions": self.positions.tolist(),
            "errors": {n: self.errors[:, i].tolist() for i, n in enumerate(self.names)},
            "half_range": {n: self.half_range[:, i].tolist() for i, n in enumerate(self.names)},
            "deviation": dict(zip(self.names, self.deviation.tolist(), strict=True)),
        }


def axis_errors(model: Model, inputs: ErrorInputs, axis: str, positions: Array) -> AxisErrors:
    """Linear and angular errors along a line of poses.

    Parameters
    ----------
    model : Model
        With a tool; other directions stay as at home, where they can.
    inputs : ErrorInputs
    axis : str
        A direction of the tool.
    positions : (n,)
        m or rad, two or more.

    Raises
    ------
    ModelError
        Fewer than two positions, or one that cannot be taken.
    StrutworkError
        As `error_sheet`.
    """
    values = np.asarray(positions, dtype=float)
    if len(values) < 2:
        raise ModelError(
            f"axis {axis}", "has fewer than two positions.", "Write x=-100mm..100mm:9."
        )
    task = TaskGrid({axis: values}).task()
    _, placement = moved(model, task)
    out = np.flatnonzero(~placement.reachable)
    if out.size:
        raise ModelError(
            f"axis {axis}",
            f"cannot be followed: {placement.reason((int(out[0]),))}.",
            "Give a range within the workspace.",
        )
    placed = model.structure.at(placement)
    inputs = inputs.computed(model)
    sheets: list[ErrorSheet] = [
        error_causes(model, inputs, placed[i]).sheet(forces=False) for i in range(len(values))
    ]
    known = np.array([sheet.mean for sheet in sheets])
    errors = known - known[0]
    for i in range(3):
        if DIRECTIONS[i] != axis and not axis.startswith("r"):
            line = np.polynomial.Polynomial.fit(values, known[:, i], 1)
            errors[:, i] = known[:, i] - line(values)
    return AxisErrors(axis, values, errors, np.array([sheet.half_range for sheet in sheets]))
