"""Check points of a map: where the tool stands and along which normal."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import SphericalVoronoi

from strutwork.errors import ModelError
from strutwork.kinematics import Poses, tangent_rotation
from strutwork.machines import Machine, hemisphere_normals

Array = NDArray[Any]


@dataclass(frozen=True)
class CheckPoints:
    """Points with a normal; the tool's z axis is put along it, the roll about it is free.

    Parameters
    ----------
    position : (n, 3)
        m.
    normal : (n, 3)
        Unit vectors.

    Raises
    ------
    ModelError
        No points, shapes that do not match, or normals that are not of unit length.
    """

    position: Array
    normal: Array

    def __post_init__(self) -> None:
        if self.position.shape != self.normal.shape or self.position.shape[1:] != (3,):
            raise ModelError(
                "check points",
                f"have shapes {self.position.shape} and {self.normal.shape}.",
                "Give positions (n, 3) and normals (n, 3).",
            )
        if not len(self):
            raise ModelError("check points", "are none.", "Give at least one.")
        length = np.linalg.norm(self.normal, axis=-1)
        if not (np.all(np.isfinite(self.position)) and np.all(np.abs(length - 1.0) < 1e-9)):
            raise ModelError(
                "check points",
                "hold a position that is not finite or a normal that is not of unit length.",
                "Divide the normals by their lengths.",
            )

    def __len__(self) -> int:
        return len(self.position)

    def __repr__(self) -> str:
        return f"<CheckPoints: {len(self)} points, positions in m>"

    def poses(self, items: slice | NDArray[np.intp], rolls: Array) -> Poses:
        """Poses of some points at every roll, flat, roll fastest.

        Parameters
        ----------
        items : slice or (k,)
            Of the points.
        rolls : (r,)
            About the normal, rad.
        """
        rotation = tangent_rotation(self.normal[items, None], rolls)
        position = np.broadcast_to(self.position[items, None], rotation.shape[:-1])
        return Poses(position.reshape(-1, 3), rotation.reshape(-1, 3, 3))


def hemisphere(machine: Machine, radius: float = 4e-3, lattice: int = 10) -> CheckPoints:
    """Check points of Azulay et al. 2014 (section 3): a hemisphere with its pole at home.

    Parameters
    ----------
    machine : Machine
        Its home position is the pole.
    radius : float
        m.
    lattice : int
        As `strutwork.machines.hemisphere_normals`: 317 points for 10.

    Returns
    -------
    CheckPoints

    Raises
    ------
    ModelError
        The radius is not positive.
    """
    if not (np.isfinite(radius) and radius > 0):
        raise ModelError("hemisphere", f"radius is {radius}.", "Give a positive length, m.")
    normal = hemisphere_normals(lattice)
    pole = np.asarray(machine.home().position, dtype=float).reshape(3)
    return CheckPoints(pole + radius * (normal - [0.0, 0.0, 1.0]), normal)


def area_weights(normal: Array) -> Array:
    """Area of the unit hemisphere that belongs to each normal, (n,), with the sum 2π.

    The cells of the spherical Voronoi diagram of the normals and their mirror images below
    the equator. Points of a lattice projected up crowd at the pole and are sparse at the
    equator; their areas undo that.

    Parameters
    ----------
    normal : (n, 3)
        Distinct unit vectors with z ≥ 0, three or more that span the hemisphere.

    Raises
    ------
    ModelError
        A normal that points down, or normals without a diagram.
    """
    if np.any(normal[:, 2] < -1e-12):
        raise ModelError(
            "area weights", "a normal points below the equator.", "Give a hemisphere's normals."
        )
    above = normal[:, 2] > 1e-12
    mirrored = normal[above] * [1.0, 1.0, -1.0]
    try:
        cells = SphericalVoronoi(np.concatenate([normal, mirrored]), threshold=1e-9)
        areas = cells.calculate_areas()[: len(normal)]
    except ValueError as error:
        raise ModelError(
            "area weights", f"cannot be made: {error}.", "Give distinct normals, more than three."
        ) from error
    return np.asarray(np.where(above, areas, areas / 2.0))
