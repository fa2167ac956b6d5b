"""Solids of flexures between rigid ends, for comparison with their formulas."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.fea.factorize import factorize
from strutwork.fea.solid import Solid
from strutwork.fea.solid_matrices import SolidMatrices, solid_matrices
from strutwork.fea.solid_stress import nodal_stresses, von_mises
from strutwork.flexures.notch import Notch
from strutwork.meshes.grids import grid
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.order import quadratic
from strutwork.meshes.transform import mapped
from strutwork.msa.materials import Material

Array = NDArray[Any]


def notch_mesh(notch: Notch, along: int = 20, across: int = 2, wide: int = 6) -> Mesh:
    """Quadratic bricks, curved as the notch, finest where it is thinnest; cut to the middle."""
    t, a, b = notch.thickness, notch.half_length, notch.half_height
    scale = np.sqrt(t / (4.0 * b))
    end = np.arcsinh(1.0 / scale)
    half = notch.width / 2.0
    lines = [
        np.linspace(-end, end, along + 1),
        np.linspace(-0.5, 0.5, across + 1),
        np.linspace(-half, half, wide + 1),
    ]

    def place(points: Array) -> Array:
        s = scale * np.sinh(points[:, 0])
        square = 1.0 + s**2
        thick = t + 4.0 * b * s**2 / square
        return np.column_stack([2.0 * a * s / square, points[:, 1] * thick, points[:, 2]])

    return mapped(quadratic(grid(*lines)), place)


def leaf_mesh(
    length: float, thickness: float, width: float, along: int = 16, wide: int = 8
) -> Mesh:
    """Quadratic bricks, one through the thickness, about the middle."""
    return quadratic(
        grid(
            length * np.linspace(-0.5, 0.5, along + 1),
            thickness * np.array([-0.5, 0.5]),
            width * np.linspace(-0.5, 0.5, wide + 1),
        )
    )


def between_rigid_ends(mesh: Mesh, material: Material) -> tuple[SolidMatrices, Array, Array]:
    """Matrices, stiffness (6, 6) and motions (n, 3, 6) of a solid whose ends are rigid.

    The end `-x` is held, `+x` moves about the origin by each of six units.
    """
    matrices = solid_matrices(Solid(mesh, dict.fromkeys(mesh.regions, material), 2))
    whole = matrices.stiffness.tocsr()
    held, moved = (
        (3 * matrices.nodes_of_set(name)[:, None] + np.arange(3)).ravel() for name in ("-x", "+x")
    )
    free = np.ones(matrices.size, dtype=bool)
    free[held] = free[moved] = False
    motions = np.zeros((matrices.size, 6))
    motions[moved] = matrices.rigid_modes(np.zeros(3))[moved]
    inner = factorize(sp.csc_array(whole[free][:, free]))
    motions[free] = inner.solve(-(whole[free][:, moved] @ motions[moved]))
    return matrices, motions.T @ (whole @ motions), motions.reshape(-1, 3, 6)


def largest_stress(
    matrices: SolidMatrices, stiffness: Array, motions: Array, wrench: Array
) -> tuple[float, float]:
    """Largest stress along x and largest equivalent stress under a wrench at the origin, Pa.

    In the middle half of the length: away from the rigid ends, whose edges are singular.
    """
    moved = motions @ np.linalg.solve(stiffness, wrench)
    stress = nodal_stresses(matrices, moved.ravel()).at_nodes()
    x = np.abs(matrices.points[:, 0])
    inner = stress[x < 0.5 * x.max()]
    return float(np.abs(inner[:, 0]).max()), float(von_mises(inner).max())
