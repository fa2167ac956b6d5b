"""Check points of Azulay et al. 2014: a hemisphere to which the platform is tangent."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import Poses, tangent_rotation

Array = NDArray[Any]


def hemisphere_normals(lattice: int = 10) -> Array:
    """Outward normals of a unit hemisphere about z, (n, 3).

    The points of an integer lattice, i² + j² ≤ lattice², scaled to the unit disc and projected up:
    317 for 10, the number of the paper (section 3.3.1), whose own points are not printed.

    Parameters
    ----------
    lattice : int
        Steps of the lattice from the pole to the rim.
    """
    if lattice < 1:
        raise ModelError("hemisphere", f"lattice is {lattice}.", "Give at least one.")
    steps = np.arange(-lattice, lattice + 1)
    i, j = (g.ravel() for g in np.meshgrid(steps, steps, indexing="ij"))
    inside = i**2 + j**2 <= lattice**2
    x, y = i[inside] / lattice, j[inside] / lattice
    # integers decide what is inside, so the radicand cannot be negative but by rounding
    z = np.sqrt(np.maximum(0.0, 1.0 - x**2 - y**2))
    return np.stack([x, y, z], axis=-1)


def roll_angles(steps: int = 24) -> Array:
    """Rolls γ over the third of a turn after which the legs repeat, rad, (steps,).

    Parameters
    ----------
    steps : int
        At least one.
    """
    if steps < 1:
        raise ModelError("hemisphere", f"{steps} roll steps.", "Give at least one.")
    return np.arange(steps) * (2.0 * np.pi / 3.0 / steps)


def hemisphere_poses(
    pole_height: float, radius: float = 4e-3, lattice: int = 10, rolls: int = 24
) -> Poses:
    """Poses with the tool on the hemisphere and its z axis along the outward normal.

    Parameters
    ----------
    pole_height : float
        Height of the pole above the machine's origin, m.
    radius : float
        m (section 3.2: 4 mm).
    lattice : int
        As in `hemisphere_normals`.
    rolls : int
        Number of rolls γ about the normal over 120°.

    Returns
    -------
    Poses
        Batch (points, rolls): (317, 24) by default.
    """
    normals = hemisphere_normals(lattice)
    centre = np.array([0.0, 0.0, pole_height - radius])
    position = (centre + radius * normals)[:, None, :]
    rotation = tangent_rotation(normals[:, None, :], roll_angles(rolls))
    return Poses.of(position, rotation)
