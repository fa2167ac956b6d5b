"""What a worst case looks like: mechanisms at rest and with their misfits exaggerated."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS
from strutwork.msa import LoadCase, StaticSolution, solve
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]
Misfits = Mapping[tuple[str, str], float]

#: The largest misfit is drawn as this share of the mechanism's size.
SHOWN = 0.09

#: The longest force arrow as a share of the mechanism's size.
ARROW = 0.22


@dataclass(frozen=True)
class AssembledShape:
    """A structure that is assembled with given misfits.

    Parameters
    ----------
    at, moved : mapping of node to (3,)
        Positions and displacements, m.
    misfits : mapping of joint to (3,)
        Of its second side against the first, global axes, m.
    forces : mapping of joint to (3,)
        On its second node, global axes, N.
    factor : float
        By which displacements and misfits are drawn larger.
    size : float
        Of the structure, m.
    solution : StaticSolution
        One case.
    """

    at: Mapping[str, Array]
    moved: Mapping[str, Array]
    misfits: Mapping[str, Array]
    forces: Mapping[str, Array]
    factor: float
    size: float
    solution: StaticSolution

    def drawn(self, node: str) -> Array:
        """Where a node is drawn, m."""
        return np.asarray(self.at[node] + self.factor * self.moved[node])

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers, SI, not exaggerated."""
        return {
            "units": {"positions": "m", "displacements": "m", "misfits": "m", "forces": "N"},
            "exaggeration": self.factor,
            "positions": {n: v.tolist() for n, v in self.at.items()},
            "displacements": {n: v.tolist() for n, v in self.moved.items()},
            "misfits": {n: v.tolist() for n, v in self.misfits.items()},
            "forces_on_second_side": {n: v.tolist() for n, v in self.forces.items()},
        }


def assembled(placed: PlacedStructure, misfits: Misfits) -> AssembledShape:
    """Displacements and forces of a structure at one pose, assembled with misfits.

    Parameters
    ----------
    placed : PlacedStructure
        A single pose.
    misfits : mapping of (joint, direction) to float
        m and rad.
    """
    linkage = placed.structure.linkage
    solution = solve(placed, [LoadCase("worst case", gaps=dict(misfits))])
    positions = placed.placement.positions
    at = dict(zip(linkage.nodes, positions, strict=True))
    index = linkage.node_index
    moved = {n: solution.displacements[index[n], :3, 0] for n in linkage.nodes}
    gaps = {j.name: np.zeros(3) for j in linkage.joints}
    for (joint, direction), value in misfits.items():
        if not direction.startswith("r"):
            frame = placed.placement.frames[linkage.joint_index[joint]]
            gaps[joint] = gaps[joint] + value * frame[:, DIRECTIONS.index(direction)]
    forces = {
        j.name: placed.placement.frames[i] @ solution.joint_forces[i, :3, 0]
        for i, j in enumerate(linkage.joints)
    }
    size = float(np.linalg.norm(np.ptp(positions, axis=0)))
    largest = max(
        *(float(np.linalg.norm(g)) for g in gaps.values()),
        *(float(np.linalg.norm(u)) for u in moved.values()),
    )
    factor = SHOWN * size / max(largest, 1e-300)
    return AssembledShape(at, moved, gaps, forces, factor, size, solution)
