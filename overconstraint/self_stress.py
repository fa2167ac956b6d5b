"""Which joint directions can carry a force without any load, at a batch of poses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import State
from strutwork.kinematics.mobility import RANK_TOLERANCE
from strutwork.msa.assembly import system_of
from strutwork.msa.constraints import rigid_rows
from strutwork.msa.structure import PlacedStructure
from strutwork.msa.undetermined import SHARE, outside

Array = NDArray[Any]


@dataclass(frozen=True)
class Redundancy:
    """Redundant constraints of a structure.

    Parameters
    ----------
    count : (...) of int
        States of self-stress: rows of joints and springs beyond their rank, drives held.
    takes_part : (..., j, 6) of bool
        Joint directions that a state of self-stress loads. The others carry no assembly force
        whatever the misfits are, and their misfits cause none.
    """

    count: NDArray[np.intp]
    takes_part: NDArray[np.bool_]

    def __repr__(self) -> str:
        return (
            f"<Redundancy: {int(self.count.max(initial=0))} states of self-stress, "
            f"batch {self.count.shape}>"
        )


def redundancy(placed: PlacedStructure) -> Redundancy:
    """States of self-stress of the rigidified structure, by rank, at every pose.

    The left null space of the constraint rows (Pellegrino 1993); beams, elastic joints and
    bodies count as rigid, springs as rows.

    Parameters
    ----------
    placed : PlacedStructure

    Returns
    -------
    Redundancy
    """
    system = system_of(placed)
    linkage = placed.structure.linkage
    joint, direction = np.nonzero(linkage.states() != State.FREE)
    takes_part = np.zeros((system.poses, len(linkage.joints), 6), dtype=bool)
    matrix = rigid_rows(system)
    if 0 in matrix.shape:
        share, rank = np.ones(matrix.shape[:2]), np.zeros(system.poses, dtype=np.intp)
    else:
        left, values, _ = np.linalg.svd(matrix, full_matrices=False)
        held = values > RANK_TOLERANCE * values[:, :1]
        rank = held.sum(axis=-1)
        share = outside(left, held)
    takes_part[:, joint, direction] = share[:, : len(joint)] > SHARE
    batch = placed.batch
    return Redundancy(
        (matrix.shape[1] - rank).reshape(batch), takes_part.reshape(*batch, len(linkage.joints), 6)
    )
