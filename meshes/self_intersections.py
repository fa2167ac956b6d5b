"""Triangles of a surface that cross one another."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes.surfaces import Surface

Array = NDArray[Any]
Ints = NDArray[np.int64]

#: Pairs of boxes looked at together: keeps the work within some tens of megabytes.
TOGETHER = 400_000

#: Share of an edge or a triangle by which a crossing must be inside: beyond double precision's
#: rounding and far below the single precision of an STL.
INSIDE = 1e-9

#: Sides of a triangle.
EDGES = np.array([[0, 1], [1, 2], [2, 0]])


def check_simple(surface: Surface) -> None:
    """Pass a surface that does not cross itself.

    An edge that pierces a triangle with which it shares no point is a crossing. Surfaces that
    touch at a vertex, and triangles that overlap in one plane, are not looked for.

    Parameters
    ----------
    surface : Surface
        Closed or open.

    Raises
    ------
    ModelError
        The number of triangles that cross others, and where the first of them and all are.
    """
    found = [_crossings(surface, pairs) for pairs in _overlapping(surface)]
    pairs = np.concatenate([p for p, _ in found]) if found else np.zeros((0, 2), np.int64)
    if not len(pairs):
        return
    places = np.concatenate([x for _, x in found])
    low, high = places.min(axis=0), places.max(axis=0)
    raise ModelError(
        f"surface {surface.name}",
        f"crosses itself: {len(np.unique(pairs))} triangles cross others, two of them at "
        f"{_place(places[0])}, all between {_place(low)} and {_place(high)}.",
        "Unite the bodies or repair that place in CAD, and export it again.",
    )


def _overlapping(surface: Surface) -> Iterator[Ints]:
    """Pairs of triangles whose boxes overlap, (k, 2), piece by piece.

    A binary tree of boxes over the triangles in Morton's order, descended against itself.
    """
    corners = surface.points[surface.triangles]
    order = _morton(corners.mean(axis=1))
    depth = max(len(order) - 1, 1).bit_length()
    low = np.full((2**depth, 3), np.inf)
    high = np.full((2**depth, 3), -np.inf)
    low[: len(order)] = corners[order].min(axis=1)
    high[: len(order)] = corners[order].max(axis=1)
    levels = [(low, high)]
    while len(levels[-1][0]) > 1:
        low, high = levels[-1]
        levels.append((low.reshape(-1, 2, 3).min(axis=1), high.reshape(-1, 2, 3).max(axis=1)))
    waiting = [(depth, np.zeros((1, 2), dtype=np.int64))]
    while waiting:
        level, pairs = waiting.pop()
        if level == 0:
            pairs = pairs[pairs[:, 0] < pairs[:, 1]]
            if len(pairs):
                yield order[pairs]
            continue
        children = np.array([[0, 0], [0, 1], [1, 0], [1, 1]])
        pairs = (2 * pairs[:, None] + children).reshape(-1, 2)
        pairs = pairs[pairs[:, 0] <= pairs[:, 1]]
        low, high = levels[level - 1]
        first, second = pairs.T
        meets = (low[first] <= high[second]).all(axis=1) & (low[second] <= high[first]).all(axis=1)
        pairs = pairs[meets]
        pieces = np.array_split(pairs, len(pairs) // TOGETHER + 1)
        waiting += [(level - 1, piece) for piece in pieces if len(piece)]


def _morton(centres: Array) -> Ints:
    """Order in which neighbours in space are neighbours in the list."""
    low, size = centres.min(axis=0), np.ptp(centres, axis=0)
    grid = ((centres - low) / np.where(size > 0, size, 1.0) * 1023).astype(np.int64)
    code = np.zeros(len(centres), dtype=np.int64)
    for bit in range(10):
        for axis in range(3):
            code |= ((grid[:, axis] >> bit) & 1) << (3 * bit + axis)
    return np.argsort(code, kind="stable")


def _crossings(surface: Surface, pairs: Ints) -> tuple[Ints, Array]:
    """The pairs that cross, (k, 2), and where, (k, 3)."""
    a, b = surface.triangles[pairs[:, 0]], surface.triangles[pairs[:, 1]]
    apart = (a[:, :, None] != b[:, None, :]).all(axis=(1, 2))
    pairs, a, b = pairs[apart], a[apart], b[apart]
    crossed, places = [], []
    for own, other in ((a, b), (b, a)):
        for edge in EDGES:
            hit, at = _pierced(surface.points[own[:, edge]], surface.points[other])
            crossed.append(pairs[hit])
            places.append(at[hit])
    return np.concatenate(crossed), np.concatenate(places)


def _pierced(edge: Array, triangle: Array) -> tuple[NDArray[np.bool_], Array]:
    """Whether edges (k, 2, 3) pierce triangles (k, 3, 3), and where (Möller, Trumbore 1997)."""
    along = edge[:, 1] - edge[:, 0]
    u, v = triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0]
    arm = edge[:, 0] - triangle[:, 0]
    normal = np.cross(u, v)
    size = np.einsum("ki,ki->k", along, normal)
    steep = np.abs(size) > INSIDE * np.linalg.norm(along, axis=1) * np.linalg.norm(normal, axis=1)
    size = np.where(steep, size, 1.0)
    at = -np.einsum("ki,ki->k", arm, normal) / size
    turned = np.cross(arm, along)
    beside = -np.einsum("ki,ki->k", turned, v) / size
    above = np.einsum("ki,ki->k", turned, u) / size
    # a triangle's own sides count, for an edge may pierce where two triangles meet
    inside = (beside >= -INSIDE) & (above >= -INSIDE) & (beside + above <= 1.0 + INSIDE)
    hit = steep & inside & (at > INSIDE) & (at < 1.0 - INSIDE)
    return hit, edge[:, 0] + at[:, None] * along


def _place(point: Array) -> str:
    return f"({', '.join(f'{v:.4g}' for v in point)}) m"
