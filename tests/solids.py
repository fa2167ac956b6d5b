"""Solids of equal brick elements with one assembled element: quick matrices for solver tests."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

Array = NDArray[Any]


@dataclass(frozen=True)
class Bricks:
    """A solid of equal cubes.

    Parameters
    ----------
    points : (n, 3)
    cells : (e, 8)
        Nodes in the usual order, bottom then top, counterclockwise.
    stiffness, mass : (3n, 3n) sparse
        Dof = 3 x node + component.
    """

    points: Array
    cells: NDArray[np.intp]
    stiffness: sp.csc_array
    mass: sp.csc_array

    def held(self, axis: int = 0) -> tuple[sp.csc_array, sp.csc_array, NDArray[np.intp]]:
        """Stiffness, mass and remaining dofs with the lowest face along an axis clamped."""
        low = self.points[:, axis] < self.points[:, axis].min() + 1e-12
        free = np.flatnonzero(np.repeat(~low, 3))
        return self.stiffness[free][:, free], self.mass[free][:, free], free


def element(size: float, youngs: float, poisson: float, density: float) -> tuple[Array, Array]:
    """Stiffness and mass (24, 24) of a trilinear cube, 2 x 2 x 2 Gauss points."""
    corner = np.array(
        [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1],
         [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]], dtype=float
    )  # fmt: skip
    lam = youngs * poisson / ((1 + poisson) * (1 - 2 * poisson))
    shear = youngs / (2 * (1 + poisson))
    law = np.diag([2 * shear] * 3 + [shear] * 3)
    law[:3, :3] += lam
    stiffness, mass = np.zeros((24, 24)), np.zeros((24, 24))
    for place in itertools.product((-1 / np.sqrt(3), 1 / np.sqrt(3)), repeat=3):
        factors = 1 + corner * np.array(place)
        shape = factors.prod(axis=1) / 8
        slope = np.stack(
            [corner[:, i] * np.delete(factors, i, axis=1).prod(axis=1) / 8 for i in range(3)]
        ) * (2 / size)
        strain = np.zeros((6, 8, 3))
        for i in range(3):
            strain[i, :, i] = slope[i]
        for row, (i, j) in enumerate(((1, 2), (0, 2), (0, 1)), start=3):
            strain[row, :, i], strain[row, :, j] = slope[j], slope[i]
        flat = strain.reshape(6, 24)
        volume = (size / 2) ** 3
        stiffness += volume * flat.T @ law @ flat
        mass += density * volume * np.kron(np.outer(shape, shape), np.eye(3))
    return stiffness, mass


def bricks(
    full: NDArray[np.bool_],
    size: float = 0.02,
    youngs: float = 50e9,
    poisson: float = 0.25,
    density: float = 2900.0,
) -> Bricks:
    """The cells of a grid (nx, ny, nz) that are full; granite unless said."""
    shape = np.array(full.shape) + 1
    cell = np.argwhere(full)
    corner = np.array(
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
    )
    at = cell[:, None, :] + corner
    number = np.ravel_multi_index(tuple(np.moveaxis(at, -1, 0)), tuple(shape))
    used, cells = np.unique(number, return_inverse=True)
    cells = cells.reshape(number.shape)
    points = size * np.stack(np.unravel_index(used, tuple(shape)), axis=1).astype(float)
    dofs = (3 * cells[:, :, None] + np.arange(3)).reshape(len(cells), 24)
    rows, columns = np.repeat(dofs, 24, axis=1).ravel(), np.tile(dofs, (1, 24)).ravel()
    n = 3 * len(points)
    k, m = (
        sp.csc_array(sp.coo_array((np.tile(x.ravel(), len(cells)), (rows, columns)), shape=(n, n)))
        for x in element(size, youngs, poisson, density)
    )
    return Bricks(points, cells, k, m)


def frame(length: int, thickness: int, depth: int, size: float = 0.02) -> Bricks:
    """An L of two arms, `length` cells long and `thickness` thick."""
    full = np.zeros((length, depth, length), dtype=bool)
    full[:, :, :thickness] = True
    full[-thickness:, :, :] = True
    return bricks(full, size)


def tip_loads(n: int) -> Array:
    """Loads in x, y, z, spread over the last ten nodes, (n, 3)."""
    loads = np.zeros((n, 3))
    for i in range(3):
        loads[n - 30 + i :: 3, i] = 0.1
    return loads


def resonator(
    solid: Bricks, share: float, frequency: float
) -> tuple[sp.csc_array, sp.csc_array, Array]:
    """Stiffness, mass and `tip_loads` of a held solid with a small mass on a spring.

    The mass is a share of the solid's, acts at a dof in the middle, and is the last dof.
    """
    stiffness, mass, _ = solid.held()
    n = stiffness.shape[0]
    light = share * mass.sum() / 3.0
    spring = sp.csc_array(np.array([[1.0, -1.0], [-1.0, 1.0]]) * light)
    spread = sp.csc_array(([1.0, 1.0], ([n // 2, n], [0, 1])), shape=(n + 1, 2))
    stiffness, mass = (
        sp.csc_array(sp.block_diag([x, sp.csc_array([[extra]])]))
        for x, extra in ((stiffness, 0.0), (mass, light))
    )
    stiffness = stiffness + (2.0 * np.pi * frequency) ** 2 * (spread @ spring @ spread.T)
    return sp.csc_array(stiffness), mass, np.concatenate([tip_loads(n), np.zeros((1, 3))])
