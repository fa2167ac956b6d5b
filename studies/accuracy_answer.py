"""Volumetric accuracy: how far a machine's errors may carry its tool, pose by pose."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model import Model
from strutwork.msa import PlacedStructure
from strutwork.outcome import Outcome, solve_poses
from strutwork.overconstraint import Tolerance
from strutwork.overconstraint.accuracy import Accuracy, accuracy
from strutwork.overconstraint.joint_errors import JointError
from strutwork.studies.answers import Column

Array = NDArray[Any]

#: Poses solved at once.
STACK = 64

UNIT = "m for x y z; rad for rx ry rz"


def drive_errors(
    model: Model, length: float | None = None, angle: float | None = None
) -> tuple[JointError, ...]:
    """Errors of a machine's drives, to either side.

    Parameters
    ----------
    model : Model
    length, angle : float, optional
        Of every drive that slides, m, and that turns, rad. Default: half of the resolution of
        those that state one.
    """
    known = {(d.joint, d.direction): d.resolution for d in model.drives}
    found = []
    for joint, direction in model.structure.linkage.driven:
        given = angle if direction.startswith("r") else length
        step = known.get((joint, direction))
        size = given if given is not None else None if step is None else step / 2
        if size is not None:
            found.append(JointError("drive error", joint, direction, size))
    return tuple(found)


@dataclass(frozen=True)
class VolumetricAccuracy:
    """Displacement of the tool by tolerances, drive errors and play.

    Parameters
    ----------
    tolerances : tuple of Tolerance
    errors : tuple of JointError
    """

    tolerances: tuple[Tolerance, ...]
    errors: tuple[JointError, ...] = ()

    @property
    def columns(self) -> tuple[Column, ...]:
        """At worst, as a root of the sum of squares, its deviation, and who contributes."""
        return (
            Column(
                "worst_case",
                UNIT,
                "largest displacement to either side",
                ("direction",),
                "largest",
            ),
            Column(
                "root_sum_square",
                UNIT,
                "root of the sum of the squares of the worst effects of the sources",
                ("direction",),
                "largest",
            ),
            Column(
                "standard_deviation",
                UNIT,
                "standard deviation by the distributions of the sources",
                ("direction",),
                "largest",
            ),
            Column("largest_displacement", "m", "largest in any direction of space", (), "largest"),
            Column(
                "contribution",
                "m",
                "contribution of a source to the largest displacement",
                ("source",),
            ),
        )

    @property
    def coordinates(self) -> Mapping[str, tuple[Any, ...]]:
        """Directions of the tool, and the sources by their names."""
        names = (*(t.name for t in self.tolerances), *(e.name for e in self.errors))
        return {"direction": DIRECTIONS, "source": names}

    def at(self, placed: PlacedStructure) -> Accuracy:
        """The accuracy at a batch of poses or at one.

        Parameters
        ----------
        placed : PlacedStructure
            With a tool.

        Raises
        ------
        StrutworkError
            As `accuracy`.
        """
        return accuracy(placed, self.tolerances, self.errors)

    def __call__(self, placed: PlacedStructure) -> tuple[dict[str, Array], Outcome]:
        """Of a flat batch."""
        widths = {d: len(v) for d, v in self.coordinates.items()}
        poses = placed.batch[0]
        arrays = {
            c.name: np.full((poses, *(widths[d] for d in c.dims)), np.nan) for c in self.columns
        }

        def some(index: NDArray[np.intp]) -> None:
            for part in np.array_split(index, max(1, -(-len(index) // STACK))):
                found = self.at(placed[part])
                place, parts = found.largest()
                values = {
                    "worst_case": found.worst,
                    "root_sum_square": found.root_sum_square,
                    "standard_deviation": found.deviation,
                    "largest_displacement": np.linalg.norm(place, axis=-1),
                    "contribution": parts,
                }
                for name, value in values.items():
                    arrays[name][part] = value

        return arrays, solve_poses(some, poses)


def top_sources(names: Sequence[str], parts: Array, count: int = 8) -> list[tuple[str, float]]:
    """Sources that contribute most, with what they contribute, largest first.

    Parameters
    ----------
    names : sequence of s str
    parts : (s,)
        What each source contributes, m or rad.
    count : int
        As many at most.
    """
    order = np.argsort(-np.abs(parts), kind="stable")[:count]
    return [(names[int(k)], float(parts[int(k)])) for k in order if parts[int(k)] != 0.0]
