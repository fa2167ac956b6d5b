"""How evenly a machine turns rates of its drives into motion of its tool, pose by pose."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.tool_drive_space import Freedoms, tool_drive_space
from strutwork.kinematics.transmission import velocity_ellipsoids
from strutwork.machines.model import Model
from strutwork.machines.singular_sections import pose_distance
from strutwork.msa import PlacedStructure
from strutwork.outcome import Outcome
from strutwork.studies.answers import Column

Array = NDArray[Any]


@dataclass(frozen=True)
class Transmission:
    """Condition number of the Jacobian from drives to tool, a length counting as one radian.

    Parameters
    ----------
    length : float
        m; stated with every number that is made with it.
    known : Freedoms
        Of the machine at poses that are not singular.
    columns : tuple of Column
        The condition number.
    """

    length: float
    known: Freedoms
    columns: tuple[Column, ...] = (
        Column(
            "condition",
            "1",
            "largest over smallest velocity of the tool for drive rates of size one",
            worst="largest",
        ),
    )

    @classmethod
    def of(cls, model: Model) -> Transmission:
        """With the machine's characteristic length at home.

        Parameters
        ----------
        model : Model
            With drives and a tool.

        Raises
        ------
        ModelError
            No drive, or no tool that moves.
        """
        here = pose_distance(model)
        return cls(here.distance.length, here.known)

    @property
    def coordinates(self) -> Mapping[str, tuple[Any, ...]]:
        """None."""
        return {}

    def __call__(self, placed: PlacedStructure) -> tuple[dict[str, Array], Outcome]:
        """Of a flat batch; infinite at singularities."""
        linkage = placed.structure.linkage
        space = tool_drive_space(linkage, placed.placement, self.length, self.known)
        isotropy = velocity_ellipsoids(space, "all").isotropy
        with np.errstate(divide="ignore"):
            condition = 1.0 / isotropy
        return {"condition": condition}, Outcome.good(condition.shape)
