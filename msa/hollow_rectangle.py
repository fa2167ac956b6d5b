"""Torsion and shear of a hollow rectangle with walls of any thickness.

Saint-Venant's problem on a quarter of the section, by finite elements of order four on a grid that
is graded towards the re-entrant corner, where the stresses are infinite; their error falls
exponentially with the layers (Babuška and Guo 1986). Torsion: Prandtl's stress function, ∇²φ = −2,
zero outside and one constant along the hole; J = ∫|∇φ|², from below. Shear along y: Cowper's
flexure function χ (Cowper 1966, eqs 15 to 17), for which he gives thin walls and the solid alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import ceil, log
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

Array = NDArray[Any]

#: Order of the elements.
ORDER = 4

#: Size of a layer of elements by that of the next farther from the corner.
GRADING = 0.2

#: The layer at the corner by the smallest size nearby, and by the whole section: flatter elements
#: would drown in rounding.
FINEST, FLATTEST = 1e-3, 1e-5


@dataclass(frozen=True)
class HollowRectangle:
    """What Saint-Venant's theory says of a hollow rectangle.

    Parameters
    ----------
    torsion_constant : float
        J, m⁴.
    shear_y, shear_z : (float, float)
        a and b of Cowper's coefficient (1 + ν)/(a + b ν) along y and z, no unit.
    """

    torsion_constant: float
    shear_y: tuple[float, float]
    shear_z: tuple[float, float]

    def coefficients(self, nu: float) -> tuple[float, float]:
        """Shear coefficients along y and z.

        Parameters
        ----------
        nu : float
            Poisson's ratio, no unit.
        """
        y, z = self.shear_y, self.shear_z
        return (1.0 + nu) / (y[0] + y[1] * nu), (1.0 + nu) / (z[0] + z[1] * nu)


@lru_cache(maxsize=1024)
def hollow_rectangle(width_y: float, height_z: float, thickness: float) -> HollowRectangle:
    """Torsion constant and shear coefficients, good to 1e-4 of themselves.

    Parameters
    ----------
    width_y, height_z, thickness : float
        Outer sizes and wall, m; the wall less than half of either.
    """
    size = max(width_y, height_z)
    y, z, t = width_y / size, height_z / size, thickness / size
    grid = _Grid.of(y / 2, z / 2, t)
    other = _Grid.of(z / 2, y / 2, t)
    return HollowRectangle(grid.torsion_constant() * size**4, grid.shear(), other.shear())


@dataclass(frozen=True)
class _Grid:
    """Elements on the quarter x, y ≥ 0 of a section, sizes by its larger side."""

    stiffness: sp.csc_array
    places: Array  # (n, 2) of the nodes
    points: Array  # (e, g, 2) of the Gauss points
    weights: Array  # (e, g)
    nodes: NDArray[np.intp]  # (e, k)
    values: Array  # (g, k) shape functions at Gauss points
    slopes: Array  # (e, g, k, 2)
    hole: tuple[float, float]
    outer: tuple[float, float]

    @classmethod
    def of(cls, half_x: float, half_y: float, wall: float) -> _Grid:
        hole = (half_x - wall, half_y - wall)
        least = max(FINEST * min(*hole, wall), FLATTEST * max(half_x, half_y))
        lines = [_lines(h, wall, least) for h in hole]
        inside = [len(line) - len(_layers(wall, least)) - 1 for line in lines]
        nodes_1d = _lobatto()
        points, weights = np.polynomial.legendre.leggauss(ORDER + 2)
        shape, slope = _lagrange(nodes_1d, points)
        # every cell of the grid but those of the hole
        i, j = np.meshgrid(*(np.arange(len(line) - 1) for line in lines), indexing="ij")
        kept = (i >= inside[0]) | (j >= inside[1])
        i, j = i[kept], j[kept]
        low = np.stack([lines[0][i], lines[1][j]], axis=-1)
        span = np.stack([lines[0][i + 1], lines[1][j + 1]], axis=-1) - low
        wide = ORDER * (len(lines[1]) - 1) + 1
        step = np.arange(ORDER + 1)
        numbers = (
            (ORDER * i[:, None, None] + step[:, None]) * wide + ORDER * j[:, None, None] + step
        ).reshape(len(i), -1)
        used, nodes = np.unique(numbers, return_inverse=True)
        nodes = nodes.reshape(numbers.shape)
        square = np.stack(np.meshgrid(nodes_1d, nodes_1d, indexing="ij"), axis=-1).reshape(-1, 2)
        places = np.zeros((len(used), 2))
        places[nodes] = low[:, None] + (square + 1) / 2 * span[:, None]
        gauss = np.stack(np.meshgrid(points, points, indexing="ij"), axis=-1).reshape(-1, 2)
        at = low[:, None] + (gauss + 1) / 2 * span[:, None]
        area = np.outer(weights, weights).ravel() * (span.prod(axis=-1) / 4)[:, None]
        values = np.einsum("ga,hb->ghab", shape, shape).reshape(len(gauss), -1)
        by_x = np.einsum("ga,hb->ghab", slope, shape).reshape(len(gauss), -1)
        by_y = np.einsum("ga,hb->ghab", shape, slope).reshape(len(gauss), -1)
        slopes = np.stack([by_x, by_y], axis=-1) * (2 / span)[:, None, None, :]
        blocks = np.einsum("eg,egad,egbd->eab", area, slopes, slopes, optimize=True)
        k = nodes.shape[1]
        rows, columns = np.repeat(nodes, k, axis=1).ravel(), np.tile(nodes, (1, k)).ravel()
        matrix = sp.coo_array((blocks.ravel(), (rows, columns)), shape=(len(used),) * 2).tocsc()
        return cls(matrix, places, at, area, nodes, values, slopes, hole, (half_x, half_y))

    def load(self, source: Array) -> Array:
        """∫ source v for every shape function v, source (e, g) at the Gauss points."""
        parts = np.einsum("eg,eg,gk->ek", self.weights, source, self.values)
        return np.bincount(self.nodes.ravel(), parts.ravel(), len(self.places))

    def torsion_constant(self) -> float:
        x, y = self.places.T
        held = (x >= self.outer[0]) | (y >= self.outer[1])
        edge = (x <= self.hole[0]) & (y <= self.hole[1])
        free = np.flatnonzero(~held & ~edge)
        # one unknown for the whole edge of the hole, last
        pick = sp.csc_array(
            (
                np.ones(len(free) + edge.sum()),
                (
                    np.concatenate([free, np.flatnonzero(edge)]),
                    np.concatenate([np.arange(len(free)), np.full(edge.sum(), len(free))]),
                ),
            ),
            shape=(len(x), len(free) + 1),
        )
        right = pick.T @ self.load(np.full(self.weights.shape, 2.0))
        right[-1] += 2.0 * self.hole[0] * self.hole[1]
        found = splu(sp.csc_array(pick.T @ self.stiffness @ pick)).solve(right)
        return float(4.0 * right @ found)

    def shear(self) -> tuple[float, float]:
        """A and b of Cowper's coefficient for a force along x."""
        x, y = self.points[..., 0], self.points[..., 1]
        free = np.flatnonzero(self.places[:, 0] > 0)
        inner = sp.csc_array(self.stiffness[free][:, free])
        # ∂χ/∂n = n·g, g = −(ν x²/2 + (1 − ν/2) y², (2 + ν) x y), its parts without and with ν
        fluxes = (
            (np.stack([-(y**2), -2 * x * y], axis=-1), -2 * x),
            (np.stack([(y**2 - x**2) / 2, -x * y], axis=-1), -2 * x),
        )
        factor = splu(inner)
        area = 4.0 * self.weights.sum()
        about = 4.0 * (self.weights * x**2).sum()
        across = 4.0 * (self.weights * y**2).sum()
        moment = self.load(x)
        terms = []
        for flux, source in fluxes:
            parts = np.einsum("eg,egd,egkd->ek", self.weights, flux, self.slopes, optimize=True)
            right = np.bincount(self.nodes.ravel(), parts.ravel(), len(self.places))
            right = right + self.load(source)
            terms.append(-area / about * 4.0 * float(moment[free] @ factor.solve(right[free])))
        terms[0] -= area / about * 4.0 * float((self.weights * x**2 * y**2).sum())
        terms[1] += (across - about) / 2.0
        return terms[0] / (2.0 * about), terms[1] / (2.0 * about)


def _layers(length: float, least: float) -> Array:
    """Distances of grid lines from a corner, (n,), the farthest at `length`."""
    count = max(2, min(14, ceil(log(least / length) / log(GRADING))))
    return np.asarray(length * GRADING ** np.arange(count)[::-1])


def _lines(hole: float, wall: float, least: float) -> Array:
    """Grid lines from the middle past the corner to the outside."""
    return np.concatenate([hole - _layers(hole, least)[::-1], [hole], hole + _layers(wall, least)])


def _lobatto() -> Array:
    """Nodes of an element, −1 to 1 (Gauss-Lobatto)."""
    inner = np.polynomial.legendre.Legendre.basis(ORDER).deriv().roots()
    return np.concatenate([[-1.0], np.sort(inner.real), [1.0]])


def _lagrange(nodes: Array, at: Array) -> tuple[Array, Array]:
    """Shape functions through the nodes and their slopes, (g, k) each."""
    vander = np.polynomial.legendre.legvander(nodes, ORDER)
    turn = np.linalg.inv(vander)
    values = np.polynomial.legendre.legvander(at, ORDER) @ turn
    deriv = np.stack(
        [np.polynomial.legendre.Legendre.basis(k).deriv()(at) for k in range(ORDER + 1)], axis=-1
    )
    return values, deriv @ turn
