"""Velocity ellipsoids: how well a mechanism moves in each direction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]

#: A singular value below this share of the largest is rounding: the drives do not hold the tool.
FLAT = 1e-14


@dataclass(frozen=True)
class VelocityEllipsoid:
    """Tool velocities for drive rates of unit norm.

    Parameters
    ----------
    semi_axes : (..., k)
        Largest first, tool velocity per drive rate, units as in the inverse of `inverse`; infinite
        where the drives cannot hold the tool, zero where they cannot move it: at a parallel and at
        a serial singularity.
    directions : (..., k, k)
        Unit vectors of the semi-axes as columns.
    """

    semi_axes: Array
    directions: Array

    def __repr__(self) -> str:
        batch = self.semi_axes.shape[:-1]
        return f"<VelocityEllipsoid: {self.semi_axes.shape[-1]} axes, batch {batch}>"

    @property
    def condition(self) -> Array:
        """Largest over smallest semi-axis, (...); infinite at every singularity."""
        first, last = self.semi_axes[..., 0], self.semi_axes[..., -1]
        endless = np.isinf(first) | (last == 0.0)
        return np.where(endless, np.inf, np.where(endless, 1.0, first) / np.where(endless, 1, last))

    @property
    def smallest(self) -> Array:
        """Smallest semi-axis, (...)."""
        return np.asarray(self.semi_axes[..., -1])

    @property
    def volume(self) -> Array:
        """Product of the semi-axes, (...): the volume in units of a unit ball's.

        Zero where an axis is, whatever the others.
        """
        flat = (self.semi_axes == 0.0).any(axis=-1)
        return np.where(flat, 0.0, np.where(flat[..., None], 1.0, self.semi_axes).prod(axis=-1))


def velocity_ellipsoid(inverse: ArrayLike) -> VelocityEllipsoid:
    """Velocity ellipsoid of some tool directions, the others held (Son 2002, eqs 11-13).

    With drive rates C v for a tool velocity v the ellipsoid is vᵀ Cᵀ C v = 1; its semi-axes are
    the inverse singular values of C.

    Parameters
    ----------
    inverse : (..., a, k)
        C, the columns of the inverse Jacobian of k freedoms of one unit; a ≥ k. A freedom with an
        infinite rate is one in which the drives cannot move the tool.

    Returns
    -------
    VelocityEllipsoid

    Raises
    ------
    ModelError
        Less drives than freedoms, or an entry that is not a number.
    """
    matrix = np.asarray(inverse, dtype=float)
    if matrix.ndim < 2 or matrix.shape[-2] < matrix.shape[-1]:
        raise ModelError(
            "velocity ellipsoid",
            f"got an inverse Jacobian of shape {matrix.shape}.",
            "Give one row per drive and one column per freedom, with at least as many rows.",
        )
    if np.any(np.isnan(matrix)):
        raise ModelError(
            "velocity ellipsoid",
            "got an inverse Jacobian with entries that are not numbers.",
            "Omit poses that the machine cannot reach.",
        )
    freedoms = matrix.shape[-1]
    stuck = np.isinf(matrix).any(axis=-2)
    safe = np.where(stuck[..., None, :], 0.0, matrix)
    # a stuck freedom gets a drive of its own, faster than all others: its singular value is the
    # largest, and its direction its own
    largest = 1.0 + 2.0 * np.linalg.norm(safe, axis=(-2, -1))[..., None, None]
    own = np.eye(freedoms) * stuck[..., None, :] * largest
    _, values, right = np.linalg.svd(np.concatenate([safe, own], axis=-2), full_matrices=False)
    count = stuck.sum(axis=-1)[..., None]
    order = np.arange(freedoms)
    true = np.take_along_axis(values, np.minimum(count, freedoms - 1), axis=-1)
    values = np.where(values <= FLAT * true, 0.0, values)
    with np.errstate(divide="ignore"):
        axes = np.where(order < count, 0.0, 1.0 / values)[..., ::-1]
    return VelocityEllipsoid(axes, np.swapaxes(right, -1, -2)[..., ::-1])
