"""What a structure can do before any load: its freedoms, redundant constraints and mass."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from strutwork.kinematics import (
    DIRECTIONS,
    FreeMotion,
    Mobility,
    NearMechanism,
    SelfStress,
    mobility,
    near_motions,
)
from strutwork.kinematics.mobility import RANK_TOLERANCE
from strutwork.machines.model import Model, ModelWarning
from strutwork.msa import PlacedStructure, system_of
from strutwork.msa.constraints import scales
from strutwork.msa.mass import mass_properties, total_mass
from strutwork.msa.row_groups import row_groups, unit_rows
from strutwork.reports.near_mechanisms import near_mechanisms, warn_of_near
from strutwork.stages import stage


@dataclass(frozen=True)
class MassProperties:
    """Total mass and its centre.

    Parameters
    ----------
    total : float
        kg.
    center : (3,) or None
        m, global axes; None where there is no mass.
    """

    total: float
    center: tuple[float, float, float] | None


@dataclass(frozen=True)
class ModelCheck:
    """What `check_model` found.

    Parameters
    ----------
    model : Model
    degrees_of_freedom : int
        Independent displacements of the flexible structure: unknowns less the rank of the
        locked directions.
    mobility : Mobility
        Of the rigidified linkage.
    mass : MassProperties or None
        None where a density is missing.
    near : tuple of NearMechanism
        Motions that coordinates of few digits hold.
    """

    model: Model
    degrees_of_freedom: int
    mobility: Mobility
    mass: MassProperties | None
    near: tuple[NearMechanism, ...] = ()

    def __repr__(self) -> str:
        return f"<ModelCheck: {self.degrees_of_freedom} dof, {self.mobility!r}>"

    @property
    def drives(self) -> int:
        """Number of driven directions."""
        return len(self.model.structure.linkage.driven)

    @property
    def surplus_drives(self) -> int:
        """Drives beyond the freedoms that they move: they work against one another."""
        return self.drives - (self.mobility.mobility - self.mobility.mobility_locked)

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers and strings in SI, by the names of the model file."""
        found = self.mobility
        return {
            "degrees_of_freedom": self.degrees_of_freedom,
            "mobility": found.mobility,
            "mobility_locked": found.mobility_locked,
            "redundant_constraints": found.redundant,
            "drives": self.drives,
            "surplus_drives": self.surplus_drives,
            "mechanisms": self._motions(found.motions),
            "driven_motions": self._motions(found.driven_motions),
            "self_stress_states": [
                {"joints": list(state.joints), "forces": _by_joint(state)}
                for state in found.self_stress
            ],
            "near_mechanisms": near_mechanisms(self.model, self.near),
            "mass": None
            if self.mass is None
            else {"total": self.mass.total, "center": self.mass.center},
            "solids": {
                s.name: {
                    "mass": s.weighed[0],
                    "degrees_of_freedom": s.reduced.shapes.shape[0],
                    "kept": 6 * len(s.nodes),
                    "accurate_to": s.accurate_to,
                }
                for s in self.model.solids
            },
        }

    def _motions(self, motions: Sequence[FreeMotion]) -> list[dict[str, Any]]:
        index = self.model.structure.linkage.node_index
        return [
            {
                "description": motion.description,
                "motion": {n: motion.nodes[index[n]].tolist() for n in self.model.nodes},
            }
            for motion in motions
        ]


def check_model(model: Model) -> ModelCheck:
    """Count and name freedoms and redundant constraints, and add up the mass.

    Parameters
    ----------
    model : Model

    Returns
    -------
    ModelCheck

    Warns
    -----
    ModelWarning
        A density is missing, so that there is no mass; a motion that coordinates of few digits
        hold.
    """
    with stage(f"counts freedoms of {len(model.structure.linkage.joints):,} joints and supports"):
        near = near_motions(model.structure.linkage, model.placement)
        warn_of_near(near)
        return ModelCheck(
            model,
            degrees_of_freedom(model.placed),
            mobility(model.structure.linkage, model.placement),
            check_mass(model.placed),
            near,
        )


def degrees_of_freedom(placed: PlacedStructure) -> int:
    """Unknowns of the structure less the rank of its locked directions; single pose."""
    system = system_of(placed)
    rows = unit_rows(system, scales(system)[0])
    rank = 0
    for _, block, _ in row_groups(rows):
        values = np.linalg.svd(block, compute_uv=False)
        rank += int(np.count_nonzero(values > RANK_TOLERANCE * values.max(initial=0.0)))
    return system.topology.size - rank


def check_mass(placed: PlacedStructure) -> MassProperties | None:
    """Mass and centre of one pose, as `strutwork.msa.mass`; None and a warning without density."""
    without = {b.material.name for b in placed.structure.beams if b.material.density is None}
    if without:
        warnings.warn(
            f"material {', '.join(sorted(without))}: has no density, so the mass is not known.",
            ModelWarning,
            stacklevel=2,
        )
        return None
    if float(total_mass(placed)) == 0.0:
        return MassProperties(0.0, None)
    found = mass_properties(placed)
    x, y, z = found.centre.tolist()
    return MassProperties(float(found.total), (x, y, z))


def _by_joint(state: SelfStress) -> dict[str, list[float]]:
    """Forces of a state of self-stress in joint axes, (6,) for each joint."""
    return {
        joint: [state.forces.get((joint, direction), 0.0) for direction in DIRECTIONS]
        for joint in state.joints
    }
