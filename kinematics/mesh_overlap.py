"""How deep closed triangle meshes overlap, and what is inside them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

#: Points times triangles that are looked at together, and normals of a hull that are tried.
TOGETHER, NORMALS = 4_000_000, 400
#: Triangles from which a point just inside is asked for.
ASKED = 200
#: How far inside, as a share of the least extent.
JUST_INSIDE = 1e-6


def inside(points: Array, corners: Array) -> NDArray[np.bool_]:
    """Whether points lie inside a closed surface, by its winding number.

    The solid angles of its triangles sum to 4 π inside and to 0 outside (van Oosterom and
    Strackee 1983, The solid angle of a plane triangle).

    Parameters
    ----------
    points : (p, 3)
        m.
    corners : (t, 3, 3)
        Of the triangles, m, counterclockwise seen from outside.

    Returns
    -------
    inside : (p,)
    """
    found = np.zeros(len(points), dtype=bool)
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    near = np.flatnonzero(((points >= low) & (points <= high)).all(axis=-1))
    piece = max(1, TOGETHER // len(corners))
    for first in range(0, len(near), piece):
        at = near[first : first + piece]
        a, b, c = np.moveaxis(corners[None] - points[at][:, None, None], 2, 0)
        la, lb, lc = (np.sqrt((v * v).sum(axis=-1)) for v in (a, b, c))
        over = (a * np.cross(b, c)).sum(axis=-1)
        under = (
            la * lb * lc
            + (a * b).sum(axis=-1) * lc
            + (b * c).sum(axis=-1) * la
            + (c * a).sum(axis=-1) * lb
        )
        # of 4 π, with the half angle that the formula gives
        found[at] = 2.0 * np.arctan2(over, under).sum(axis=-1) > 2.0 * np.pi
    return found


def crossing_depth(first: Array, second: Array) -> float:
    """How far the deepest pair of triangles that cross would have to be moved to part them, m.

    Two convex bodies are parted along a normal of either or across an edge of each (separating
    axes: Gottschalk, Lin and Manocha 1996, OBBTree).

    Parameters
    ----------
    first, second : (c, 3, 3)
        Corners of the two triangles of each pair, m.
    """
    if not len(first):
        return 0.0
    edges = [np.roll(t, -1, axis=1) - t for t in (first, second)]
    normals = [np.cross(e[:, 0], e[:, 1])[:, None] for e in edges]
    # in its plane a triangle is parted from another across its edges
    sides = [np.cross(n, e) for n, e in zip(normals, edges, strict=True)]
    across = np.cross(edges[0][:, :, None], edges[1][:, None]).reshape(len(first), 9, 3)
    axes = np.concatenate([*normals, *sides, across], axis=1)
    length = np.sqrt((axes * axes).sum(axis=-1, keepdims=True))
    scale = np.abs(np.concatenate(edges, axis=1)).max(axis=(1, 2))[:, None]
    real = length[..., 0] > 1e-9 * scale**2
    axes = axes / np.where(length > 0.0, length, 1.0)
    one, other = (np.einsum("cka,cna->ckn", axes, t) for t in (first, second))
    parted = np.minimum(
        one.max(axis=-1) - other.min(axis=-1), other.max(axis=-1) - one.min(axis=-1)
    )
    return float(max(np.where(real, parted, np.inf).min(axis=-1).max(), 0.0))


def hull_depth(first: Array, second: Array) -> float:
    """How far the hulls of two meshes would have to be moved along a normal of either, m.

    Parameters
    ----------
    first, second : (t, 3, 3)
        Corners of their triangles, m.
    """
    depth = np.inf
    for corners, other in ((first, second), (second, first)):
        normals = np.unique(np.round(_normals(corners), 9), axis=0)
        normals = normals[:: -(-len(normals) // NORMALS)]
        mine = (corners.reshape(-1, 3) @ normals.T).max(axis=0)
        depth = min(depth, float((mine - (other.reshape(-1, 3) @ normals.T).min(axis=0)).min()))
    return max(depth, 0.0)


def share_space(first: Array, second: Array, size: float) -> bool:
    """Whether meshes that touch have a point inside both, as where faces lie in one plane.

    Parameters
    ----------
    first, second : (t, 3, 3)
        Corners of their triangles, m.
    size : float
        Least extent, m.
    """
    for corners, other in ((first, second), (second, first)):
        some = corners[:: -(-len(corners) // ASKED)]
        just = some.mean(axis=1) - JUST_INSIDE * size * _normals(some)
        if inside(just, other).any():
            return True
    return False


def _normals(corners: Array) -> Array:
    """Outward unit normals, (t, 3)."""
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    return np.asarray(normal / np.where(length > 0.0, length, 1.0))
