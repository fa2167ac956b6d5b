"""Free expansion of a solid of one material whose temperature is linear in the coordinates.

Such a temperature leaves a free solid without stress, and its displacement is a polynomial
(Boley and Weiner 1960, section 9.4): for the strain ε + g·d at the distance d from a point,
u = ε d + (g·d) d − |d|² g / 2. A uniform temperature is the case g = 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.fea.interface import Interface, TiedPatch, tie
from strutwork.fea.solid import Solid
from strutwork.fea.superelement import Superelement
from strutwork.meshes.order import quadratic
from strutwork.meshes.surface_integrals import nodal_areas

Array = NDArray[Any]


def free_displacements(
    points: Array, strain: float, gradient: ArrayLike, about: ArrayLike
) -> Array:
    """Displacements of a free solid against one of its points, (n, 3), m.

    Parameters
    ----------
    points : (n, 3)
        m.
    strain : float
        α ΔT at `about`, no unit.
    gradient : (3,)
        Of α ΔT, 1/m.
    about : (3,)
        The point that neither moves nor turns, m.
    """
    g = np.asarray(gradient, dtype=float)
    arms = np.asarray(points) - np.asarray(about, dtype=float)
    return np.asarray(
        (strain + arms @ g)[:, None] * arms - 0.5 * (arms**2).sum(axis=1)[:, None] * g
    )


def free_motion(
    patches: Sequence[TiedPatch], points: Array, strain: float, gradient: ArrayLike, about: Array
) -> Array:
    """Motions of the interface nodes of a free solid, (k, 6), m and rad.

    The node of a rigid patch, which expands with the solid, moves with the material at its
    place; that of an average one with the mean of its patch.

    Parameters
    ----------
    patches : sequence of k TiedPatch
    points : (n, 3)
        Of the mesh of the patches, m.
    strain : float
        α ΔT at `about`, no unit.
    gradient : (3,)
        Of α ΔT, 1/m.
    about : (3,)
        The point that neither moves nor turns, m.
    """
    g = np.asarray(gradient, dtype=float)
    found = np.zeros((len(patches), 6))
    for motion, patch in zip(found, patches, strict=True):
        if patch.interface.kind == "rigid":
            motion[:3] = free_displacements(patch.position[None], strain, g, about)[0]
            motion[3:] = np.cross(g, patch.position - about)
        else:
            moved = free_displacements(points[patch.nodes], strain, g, about)
            motion[:] = patch.average @ moved.ravel()
    return found


def linear_load(
    solid: Solid,
    interfaces: Sequence[Interface],
    reduced: Superelement,
    strain: float,
    gradient: ArrayLike,
    about: ArrayLike,
) -> Array:
    """Load on the nodes of a reduced solid, mesh's frame, N and N·m, (6 k,).

    The stiffness times the free motion: exact in statics, whatever the mesh.

    Parameters
    ----------
    solid : Solid
    interfaces : sequence of Interface
    reduced : Superelement
        Of the solid and the interfaces.
    strain : float
        α ΔT at `about`, no unit.
    gradient : (3,)
        Of α ΔT, 1/m, in the mesh's frame.
    about : (3,)
        m, in the mesh's frame.
    """
    # as many nodes as the field has, in another order
    straight = solid.order == 2 and not solid.keeps_curves
    mesh = quadratic(solid.mesh) if straight else solid.mesh
    patches = [tie(i, mesh.points, *nodal_areas(mesh, mesh.patch(i.patch))) for i in interfaces]
    free = np.zeros((len(reduced.nodes), 6))
    point = np.asarray(about, dtype=float)
    free[: len(patches)] = free_motion(patches, mesh.points, strain, gradient, point)
    return np.asarray(reduced.local_stiffness @ free.ravel())
