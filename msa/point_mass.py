"""Where a point mass stands in every pose, and its weight."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.kinematics import axes_frame
from strutwork.msa.springs import PointMass
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]


def mass_axes(mass: PointMass, placed: PlacedStructure) -> Array:
    """Axes of inertia and offset as columns, (p, 3, 3).

    Parameters
    ----------
    mass : PointMass
    placed : PlacedStructure
        With one batch axis of p poses.
    """
    positions, index = placed.positions, placed.structure.mesh_index
    if mass.axes is None:
        return np.broadcast_to(placed.turn_of(mass.node), (len(positions), 3, 3))
    corner, along, side = (positions[:, index[node]] for node in mass.axes)
    up = np.cross(along - corner, side - corner)
    return axes_frame(up, along - corner, mass.node)


def mass_arm(mass: PointMass, placed: PlacedStructure) -> Array:
    """From its node to its centre, global axes, (p, 3), m.

    Parameters
    ----------
    mass : PointMass
    placed : PlacedStructure
        With one batch axis of p poses.
    """
    return np.asarray(mass_axes(mass, placed) @ np.asarray(mass.offset, dtype=float))


def mass_weight(mass: PointMass, gravity: ArrayLike, placed: PlacedStructure) -> Array:
    """Wrench of its weight at its node, (p, 6), N and N·m.

    Parameters
    ----------
    mass : PointMass
    gravity : (3,)
        m/s².
    placed : PlacedStructure
        With one batch axis of p poses.
    """
    arm = mass_arm(mass, placed)
    force = np.broadcast_to(mass.mass * np.asarray(gravity, dtype=float), arm.shape)
    return np.concatenate([force, np.cross(arm, force)], axis=-1)
