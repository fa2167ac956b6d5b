"""Loads on solids as consistent nodal forces: gravity, acceleration, traction, pressure, force."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.fea.solid_matrices import SolidMatrices
from strutwork.meshes.surface_integrals import nodal_area_vectors

Array = NDArray[Any]


def gravity_load(matrices: SolidMatrices, acceleration: ArrayLike = (0.0, 0.0, -9.80665)) -> Array:
    """Weight of the solid.

    Parameters
    ----------
    matrices : SolidMatrices
    acceleration : (3,) or (m, 3)
        Of free fall, m/s², one row for each load case.

    Returns
    -------
    (3n, m)
        N.

    Raises
    ------
    ModelError
        A region's material has no density; numbers that are not finite.
    """
    rows = _rows(matrices, "acceleration of gravity", acceleration, 3)
    return np.asarray(matrices.mass @ (matrices.rigid_modes()[:, :3] @ rows.T))


def acceleration_load(
    matrices: SolidMatrices, acceleration: ArrayLike, about: ArrayLike = (0.0, 0.0, 0.0)
) -> Array:
    """Inertial forces in a frame that accelerates with the solid, at rest at this moment: −M a.

    Parameters
    ----------
    matrices : SolidMatrices
    acceleration : (6,) or (m, 6)
        Of the point `about`, m/s² and rad/s².
    about : (3,)
        m.

    Returns
    -------
    (3n, m)
        N.

    Raises
    ------
    ModelError
        A region's material has no density; numbers that are not finite.
    """
    rows = _rows(matrices, "acceleration", acceleration, 6)
    point = np.asarray(about, dtype=float)
    return np.asarray(-(matrices.mass @ (matrices.rigid_modes(point) @ rows.T)))


def traction_load(matrices: SolidMatrices, patch: str, traction: ArrayLike) -> Array:
    """A constant force per area on a patch.

    Parameters
    ----------
    matrices : SolidMatrices
    patch : str
        Name of the patch.
    traction : (3,) or (m, 3)
        Pa, in global axes.

    Returns
    -------
    (3n, m)
        N.

    Raises
    ------
    ModelError
        No patch of that name; numbers that are not finite.
    """
    rows = _rows(matrices, f"traction on {patch!r}", traction, 3)
    nodes, areas = matrices.patch(patch)
    return _scatter(matrices, nodes, areas[:, None, None] * rows.T)


def force_load(matrices: SolidMatrices, patch: str, force: ArrayLike) -> Array:
    """A force spread evenly over the area of a patch: a traction with that resultant.

    Parameters
    ----------
    matrices : SolidMatrices
    patch : str
        Name of the patch.
    force : (3,) or (m, 3)
        N, in global axes; it acts at the centre of the area.

    Returns
    -------
    (3n, m)
        N.

    Raises
    ------
    ModelError
        No patch of that name; numbers that are not finite.
    """
    rows = _rows(matrices, f"force on {patch!r}", force, 3)
    nodes, areas = matrices.patch(patch)
    return _scatter(matrices, nodes, (areas / areas.sum())[:, None, None] * rows.T)


def pressure_load(matrices: SolidMatrices, patch: str, pressure: ArrayLike) -> Array:
    """A constant pressure on a patch, positive into the solid.

    Parameters
    ----------
    matrices : SolidMatrices
    patch : str
        Name of the patch.
    pressure : float or (m,)
        Pa.

    Returns
    -------
    (3n, m)
        N.

    Raises
    ------
    ModelError
        No patch of that name; numbers that are not finite.
    """
    rows = _rows(matrices, f"pressure on {patch!r}", np.reshape(pressure, (-1, 1)), 1)
    nodes, vectors = nodal_area_vectors(matrices.mesh, matrices.mesh.patch(patch))
    return _scatter(matrices, nodes, -vectors[:, :, None] * rows.T)


def load_resultant(
    matrices: SolidMatrices, loads: Array, about: ArrayLike = (0.0, 0.0, 0.0)
) -> Array:
    """Force and moment about a point of each load case, N and N m, (6, m).

    Parameters
    ----------
    matrices : SolidMatrices
    loads : (3n, m)
        N.
    about : (3,)
        m.
    """
    return np.asarray(matrices.rigid_modes(np.asarray(about, dtype=float)).T @ loads)


def _rows(matrices: SolidMatrices, what: str, values: ArrayLike, width: int) -> Array:
    rows = np.atleast_2d(np.asarray(values, dtype=float))
    if rows.ndim != 2 or rows.shape[1] != width or not np.isfinite(rows).all():
        raise ModelError(
            f"solid {matrices.solid.name}",
            f"its {what} is {np.asarray(values).tolist()!r}.",
            f"Give {width} finite numbers for each load case.",
        )
    return rows


def _scatter(matrices: SolidMatrices, nodes: NDArray[np.int64], forces: Array) -> Array:
    """Nodal forces (k, 3, m) of some nodes as loads on all degrees of freedom."""
    loads = np.zeros((len(matrices.points), 3, forces.shape[-1]))
    loads[nodes] = forces
    return loads.reshape(matrices.size, -1)
