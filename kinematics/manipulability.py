"""Velocity ellipsoids: how well a mechanism moves in each direction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]


@dataclass(frozen=True)
class VelocityEllipsoid:
    """Tool velocities that drive rates of size one can make.

    Parameters
    ----------
    semi_axes : (..., k)
        Largest first, in tool velocity per drive rate; infinite where the drives cannot hold
        the tool.
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
        """Largest over smallest semi-axis, (...)."""
        return np.asarray(self.semi_axes[..., 0] / self.semi_axes[..., -1])

    @property
    def smallest(self) -> Array:
        """Smallest semi-axis, (...)."""
        return np.asarray(self.semi_axes[..., -1])

    @property
    def volume(self) -> Array:
        """Product of the semi-axes, (...): the volume in units of a unit ball's."""
        return np.asarray(self.semi_axes.prod(axis=-1))


def velocity_ellipsoid(inverse: ArrayLike) -> VelocityEllipsoid:
    """Velocity ellipsoid of some of the tool's freedoms, the others held (Son 2002, eqs 11-13).

    With drive rates C v for a tool velocity v the ellipsoid is vᵀ Cᵀ C v = 1; its semi-axes are
    the inverse singular values of C.

    Parameters
    ----------
    inverse : (..., a, k)
        C, the columns of the inverse Jacobian of k freedoms of one unit; a ≥ k.

    Returns
    -------
    VelocityEllipsoid

    Raises
    ------
    ModelError
        Less drives than freedoms, or a matrix that is not finite.
    """
    matrix = np.asarray(inverse, dtype=float)
    if matrix.ndim < 2 or matrix.shape[-2] < matrix.shape[-1]:
        raise ModelError(
            "velocity ellipsoid",
            f"got an inverse Jacobian of shape {matrix.shape}.",
            "Give one row a drive and one column a freedom, with at least as many rows.",
        )
    if not np.all(np.isfinite(matrix)):
        raise ModelError(
            "velocity ellipsoid",
            "got an inverse Jacobian that is not finite: a serial singularity.",
            "Leave such poses out.",
        )
    _, values, right = np.linalg.svd(matrix, full_matrices=False)
    with np.errstate(divide="ignore"):
        axes = 1.0 / values[..., ::-1]
    return VelocityEllipsoid(axes, np.swapaxes(right, -1, -2)[..., ::-1])
