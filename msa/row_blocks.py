"""Constraint rows on the rigid clusters that they join."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import ConstraintRows
from strutwork.msa.structure import PlacedStructure, rigid_map

Array = NDArray[Any]


def row_blocks(rows: ConstraintRows, placed: PlacedStructure) -> tuple[NDArray[np.intp], Array]:
    """Rows in blocks: cluster (r, k), −1 for ground, and values (p, r, k, 6).

    k is two, and four where a joint coordinate follows another.

    Parameters
    ----------
    rows : ConstraintRows
        At p poses.
    placed : PlacedStructure
        With one batch axis.
    """
    nodes = rows.nodes
    vertex = placed.structure.vertex_of_node[nodes]
    values = np.einsum("pri,prkij->prkj", rows.axes, rigid_map(placed.arms[:, nodes]))
    values[:, :, 0] *= -1.0
    # both sides on one cluster: only the rounding of its coordinates would be left
    values[:, vertex[:, 0] == vertex[:, 1]] = 0.0
    if rows.tied is None:
        return vertex, values
    more, others = row_blocks(rows.tied.others, placed)
    vertex = np.concatenate([vertex, np.full_like(vertex, -1)], axis=1)
    values = np.concatenate([values, np.zeros_like(values)], axis=2)
    vertex[rows.tied.rows, 2:] = more
    values[:, rows.tied.rows, 2:] = -rows.tied.ratio[:, None, None] * others
    return vertex, values
