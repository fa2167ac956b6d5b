"""Which forces are nothing but rounding beside what they were made from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS, characteristic_lengths
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]

#: What is left of terms that cancel is rounding below this share of them. Solutions are good to
#: about this share where stiffnesses differ by five orders of magnitude.
ROUNDING = 1e-11


def without_rounding(
    placed: PlacedStructure, columns: Sequence[tuple[str, str]], forces: Array, tool: Array
) -> tuple[Array, Array]:
    """Forces and tool displacements per unit misfit, exactly zero where only rounding is left.

    A unit misfit first loads its own joint by the joint's stiffness; what the structure then
    leaves of that is the force. Beside the larger of the two a force counts. Moments are
    compared at the pose's characteristic length.

    Parameters
    ----------
    placed : PlacedStructure
    columns : sequence of (joint, direction)
        The g misfits.
    forces : (..., j, 6, g)
        N/m, N·m/m, N/rad and N·m/rad.
    tool : (..., 6, g)
        m/m, rad/m, m/rad and rad/rad.

    Returns
    -------
    forces : (..., j, 6, g)
    tool : (..., 6, g)
    """
    linkage = placed.structure.linkage
    turns = np.arange(6) >= 3
    length = characteristic_lengths(placed.placement).reshape(placed.batch)[..., None, None]
    arm = np.where(turns[:, None], length, 1.0)
    # N per unit misfit, turns in units of displacement at that length
    own = np.zeros((*placed.batch, len(columns)))
    for g, (joint, direction) in enumerate(columns):
        d = DIRECTIONS.index(direction)
        matrix = linkage.joints[linkage.joint_index[joint]].stiffness_matrix
        own[..., g] = (np.abs(matrix[:, d, None]) / arm).max(axis=(-1, -2))
    as_forces = np.abs(forces) / arm[..., None, :, :]
    scale = np.maximum(own, as_forces.max(axis=(-2, -3), initial=0.0))
    forces = np.where(as_forces > ROUNDING * scale[..., None, None, :], forces, 0.0)
    moved = np.abs(tool) * arm
    # a unit misfit moves the parts that it joins by one
    unit = np.where([d.startswith("r") for _, d in columns], length[..., 0], 1.0)
    largest = np.maximum(moved.max(axis=-2, initial=0.0), unit)
    return forces, np.where(moved > ROUNDING * largest[..., None, :], tool, 0.0)


def product_without_rounding(left: Array, right: Array, scale: Array) -> Array:
    """Left @ right, exactly zero where the terms of a sum cancel but for rounding.

    Parameters
    ----------
    left : (..., a, g)
        Any unit.
    right : (..., g, k)
        Any unit.
    scale : (..., a, g)
        What the entries of `left` were made from, in the same unit.

    Returns
    -------
    product : (..., a, k)
    """
    product = left @ right
    return np.asarray(np.where(np.abs(product) > ROUNDING * (scale @ np.abs(right)), product, 0.0))


def row_scale(table: Array) -> Array:
    """Largest entry of each column among rows of one kind, (..., 6, g).

    Translations and rotations, or forces and moments, are not compared with one another.

    Parameters
    ----------
    table : (..., 6, g)
        Any unit.
    """
    size = np.abs(table)
    halves = [size[..., :3, :], size[..., 3:, :]]
    return np.concatenate(
        [np.broadcast_to(h.max(axis=-2, keepdims=True), h.shape) for h in halves], axis=-2
    )
