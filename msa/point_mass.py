"""Where a point mass stands in every pose, and its weight."""

from __future__ import annotations

from collections.abc import Iterator
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


def mass_numbers(placed: PlacedStructure) -> Iterator[tuple[Array, Array, Array]]:
    """Mass (...), inertia (..., 3, 3) and offset (..., 3) of each point mass, its own axes.

    In kg, kg·m² and m; with an axis of poses where each is another structure.

    Parameters
    ----------
    placed : PlacedStructure
    """
    numbers = placed.numbers.masses
    for i in range(numbers.shape[-2]):
        row = numbers[..., i, :]
        yield row[..., 0], row[..., 1:10].reshape(*row.shape[:-1], 3, 3), row[..., 10:]


def mass_forces(placed: PlacedStructure, gravity: ArrayLike) -> Iterator[tuple[str, Array, Array]]:
    """Node, weight (p, 3) in N and arm from the node (p, 3) in m of each point mass, global axes.

    Parameters
    ----------
    placed : PlacedStructure
        With one batch axis of p poses.
    gravity : (3,)
        m/s².
    """
    pull = np.asarray(gravity, dtype=float)
    for mass, (amount, _, offset) in zip(
        placed.structure.masses, mass_numbers(placed), strict=True
    ):
        arm = (mass_axes(mass, placed) @ offset[..., None])[..., 0]
        yield mass.node, np.broadcast_to(amount[..., None] * pull, arm.shape), np.asarray(arm)


def mass_weights(placed: PlacedStructure, gravity: ArrayLike) -> Iterator[tuple[str, Array]]:
    """Node and wrench of the weight there, (p, 6) in N and N·m, of each point mass.

    Parameters
    ----------
    placed : PlacedStructure
        With one batch axis of p poses.
    gravity : (3,)
        m/s².
    """
    for node, force, arm in mass_forces(placed, gravity):
        yield node, np.concatenate([force, np.cross(arm, force)], axis=-1)
