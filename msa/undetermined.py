"""Which joint forces rigid parts alone leave open.

The multipliers of constraint rows that depend on one another are determined up to the left null
space of the rows: states of self-stress of locked directions, with no elastic part in their path.
A direction that no such state loads has one force, whatever the scale, order and frame.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.mobility import RANK_TOLERANCE
from strutwork.msa.assembly import System, system_of
from strutwork.msa.constraints import of_lone, orthonormal_rows, scales
from strutwork.msa.row_groups import row_groups, unit_rows
from strutwork.msa.sparse import SPARSE_FROM
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]

#: A joint direction takes part when its share of the unit states of self-stress exceeds this.
SHARE = 1e-9


def undetermined(placed: PlacedStructure) -> NDArray[np.bool_]:
    """Locked directions that share their force with other rigid ones, (..., j, 6).

    Solvers give the least forces in balance there: how they divide is not a matter of statics.

    Parameters
    ----------
    placed : PlacedStructure
        With j joints.
    """
    system = system_of(placed)
    sparse = system.poses == 1 and system.topology.size > SPARSE_FROM
    share = _sparse_share(system) if sparse else _dense_share(system)
    joints = len(placed.structure.linkage.joints)
    result = np.zeros((system.poses, joints, 6), dtype=bool)
    joint, direction = system.row_owner
    result[:, joint, direction] = share > SHARE
    return result.reshape(*placed.batch, joints, 6)


def _dense_share(system: System) -> Array:
    one = of_lone(system, "_share", _dense_share)
    if one is not None:
        return np.repeat(one, system.poses, axis=0)
    rows = orthonormal_rows(system)
    return outside(rows.left, rows.values > 0)


def _sparse_share(system: System) -> Array:
    a = unit_rows(system, scales(system)[0])
    share = np.zeros((1, len(a)))
    for rows, block, _ in row_groups(a):
        if not block.shape[1]:
            share[0, rows] = 1.0
            continue
        left, values, _ = np.linalg.svd(block, full_matrices=False)
        share[0, rows] = outside(left, values > RANK_TOLERANCE * values.max())
    return share


def outside(left: Array, held: NDArray[np.bool_]) -> Array:
    """Share of each row outside the range of the left vectors that are held, (..., r).

    Parameters
    ----------
    left : (..., r, k)
        Left singular vectors of the rows as columns, no unit.
    held : (..., k)
        True for the vectors that span the range.
    """
    # what a unit force on a row leaves, by its difference: a square root of 1 − |·|² would keep
    # only half the digits
    inside = left * held[..., None, :]
    rest = np.eye(left.shape[-2]) - inside @ np.swapaxes(left, -1, -2)
    return np.asarray(np.sqrt((rest**2).sum(axis=-1)))
