"""Plates of a surface, and what can be reached on it without a reversal.

The order in which the lines C_k·a = 0 of the drives stand round a point changes where two of them
coincide, det(C_i, C_j) = 0. Within a plate, a region without such a place, the same combinations
of drive directions have cones (Son 2002, chapter 4).
"""

from __future__ import annotations

from itertools import combinations, product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import label
from scipy.sparse import coo_array
from scipy.sparse.csgraph import breadth_first_order

from strutwork.kinematics.drive_fields import DriveField
from strutwork.kinematics.reversal_cones import sectors
from strutwork.kinematics.reversal_points import Patch
from strutwork.kinematics.zero_lines import zero_lines

Array = NDArray[Any]

#: Two drives whose gradients are parallel everywhere to this share divide nothing.
PARALLEL = 1e-10

#: Steps between grid points, not through another: 80 directions, since cones may be narrow.
FAR = 5
WAYS = tuple(
    (i, j)
    for i in range(-FAR, FAR + 1)
    for j in range(-FAR, FAR + 1)
    if (i, j) != (0, 0) and np.gcd(abs(i), abs(j)) == 1
)


def determinants(gradient: Array, moving: NDArray[np.intp]) -> tuple[list[tuple[int, int]], Array]:
    """det(C_i, C_j) of pairs of drives that are not parallel everywhere.

    Parameters
    ----------
    gradient : (k, l, n, 2)
        On the grid, by the patch's own size.
    moving : (a,) of int
        Drives that move.

    Returns
    -------
    pairs : list of (i, j)
    values : (k, l, p)
        As a share of the two gradients' sizes at their largest.
    """
    pairs, values = [], []
    sizes = np.nanmax(np.linalg.norm(gradient, axis=-1), axis=(0, 1), initial=0.0)
    for i, j in combinations(moving.tolist(), 2):
        a, b = gradient[..., i, :] / sizes[i], gradient[..., j, :] / sizes[j]
        value = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
        if np.nanmax(np.abs(value), initial=0.0) > PARALLEL:
            pairs.append((i, j))
            values.append(value)
    shape = gradient.shape[:2]
    return pairs, np.stack(values, axis=-1) if values else np.zeros((*shape, 0))


def plates(gradient: Array, moving: NDArray[np.intp]) -> NDArray[np.intp]:
    """Number of the plate at each grid point, from 1; 0 out of reach or on a border, (k, l).

    Two points of one plate are joined by sides of cells without a border between them; what is
    narrower than a cell is not distinguished.

    Parameters
    ----------
    gradient : (k, l, n, 2)
        As for `determinants`: m or rad, by the patch's own size.
    moving : (a,) of int
        Drives that move.
    """
    _, values = determinants(gradient, moving)
    signs = np.where(np.abs(values) <= PARALLEL, 0, np.sign(values))
    good = ~np.isnan(gradient[..., 0, 0]) & np.all(signs != 0, axis=-1)
    found = np.zeros(good.shape, dtype=np.intp)
    patterns, index = np.unique(signs[good], axis=0, return_inverse=True)
    which = np.full(good.shape, -1)
    which[good] = np.ravel(index)
    count = 0
    for number in range(len(patterns)):
        parts, some = label(which == number)
        found = np.where(parts > 0, parts + count, found)
        count += int(some)
    return found


def plate_borders(
    field: DriveField, patch: Patch, gradient: Array, moving: NDArray[np.intp]
) -> dict[tuple[str, str], list[Array]]:
    """Lines det(C_i, C_j) = 0 by the two drives' names, (c, 2) each.

    Parameters
    ----------
    field : DriveField
        Of the gradients.
    patch : Patch
        The grid.
    gradient : (k, l, n, 2)
        As for `determinants`: m or rad, by the patch's own size.
    moving : (a,) of int
        Drives that move.
    """
    pairs, values = determinants(gradient, moving)
    first, second = (np.array([p[n] for p in pairs], dtype=np.intp) for n in (0, 1))

    def together(points: Array, which: NDArray[np.intp]) -> Array:
        g, m = field.gradient(points), np.arange(len(points))
        a, b = g[m, first[which]], g[m, second[which]]
        return np.asarray(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])

    found = zero_lines(together, values, patch.u, patch.v)
    names = [(field.drives[i], field.drives[j]) for i, j in pairs]
    return dict(zip(names, found, strict=True))


def reach(
    patch: Patch, gradient: Array, moving: NDArray[np.intp], start: tuple[int, int]
) -> NDArray[np.bool_]:
    """Grid points to which a path leads on which no drive turns back.

    From each cone at the start on, the union over the cones. The paths go by straight steps of
    up to five cells, each in the cone of both of its ends; a finer grid finds more of them.

    Parameters
    ----------
    patch : Patch
    gradient : (k, l, n, 2)
        Derivatives by the patch's own parameters.
    moving : (a,) of int
    start : (int, int)
        Of the grid.

    Returns
    -------
    (k, l) of bool
        None from a point out of reach.
    """
    shape = gradient.shape[:2]
    seen = np.zeros(shape, dtype=bool)
    c = gradient[..., moving, :]
    if np.isnan(c[start]).any():
        return seen
    number = np.arange(seen.size).reshape(shape)
    first = int(number[start])
    for signs in map(np.array, _patterns(c[start])):
        heads, tails = [], []
        for i, j in WAYS:
            if abs(i) >= shape[0] or abs(j) >= shape[1]:
                # longer than the grid
                continue
            one = tuple(
                slice(max(0, -d), min(n, n - d)) for d, n in zip((i, j), shape, strict=True)
            )
            two = tuple(slice(max(0, d), min(n, n + d)) for d, n in zip((i, j), shape, strict=True))
            way = _way(patch, one, two)
            keeps = np.ones(number[one].shape, dtype=bool)
            for end in (one, two):
                along = np.einsum("klna,kla->kln", c[end], way)
                small = (
                    1e-9
                    * np.linalg.norm(c[end], axis=-1)
                    * np.linalg.norm(way, axis=-1, keepdims=True)
                )
                asked = signs * along
                keeps &= np.all(asked >= -small, axis=-1)
            tails.append(number[one][keeps])
            heads.append(number[two][keeps])
        row, column = np.concatenate(tails), np.concatenate(heads)
        graph = coo_array((np.ones(len(row), dtype=np.int8), (row, column)), (seen.size,) * 2)
        found = breadth_first_order(graph.tocsr(), first, return_predecessors=False)
        seen.ravel()[found] = True
    return seen


def _patterns(gradient: Array) -> list[tuple[int, ...]]:
    """Signs of the drives' speeds with which a path may leave a point, (n,) each.

    Those of the cones; and where drives stand still, at a singular point or along a line that
    several have in common, either sign of each: their cone opens beside the point only.
    """
    angles, signs = sectors(gradient)
    rays = np.stack([np.cos(angles[:, 0]), np.sin(angles[:, 0])], axis=-1)
    along = rays @ gradient.T
    still = np.abs(along) <= PARALLEL * np.linalg.norm(gradient, axis=-1)
    on_rays = np.where(still, 0, np.sign(along)).astype(int)
    found: dict[tuple[int, ...], None] = {}
    for pattern in (*signs.tolist(), *on_rays.tolist()):
        open_ = [k for k, sign in enumerate(pattern) if sign == 0]
        for chosen in product((1, -1), repeat=len(open_)):
            full = list(pattern)
            for k, sign in zip(open_, chosen, strict=True):
                full[k] = sign
            found[tuple(full)] = None
    return list(found)


def _way(patch: Patch, one: tuple[slice, ...], two: tuple[slice, ...]) -> Array:
    steps = [a[t] - a[o] for a, o, t in zip((patch.u, patch.v), one, two, strict=True)]
    return np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1)
