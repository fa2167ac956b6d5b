"""Cones of directions on a surface in which no drive turns back.

A drive whose coordinate has the gradient C there turns back where C·a changes its sign along a.
The lines C_k·a = 0 of all drives divide the directions at a point into cones; within one of them
every drive keeps the sign of its speed (Son 2002, chapter 4).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[Any]


def cone(gradient: ArrayLike, signs: ArrayLike) -> Array:
    """Directions in which every drive has the sign that is asked for.

    Parameters
    ----------
    gradient : (..., n, 2)
        Of the drives' coordinates over the surface's two parameters. A drive that does not move
        there (zero) asks for nothing.
    signs : (..., n)
        1 or −1, no unit: of the drives' speeds.

    Returns
    -------
    (..., 2)
        First and last angle of the cone, rad, counter-clockwise from the first parameter's axis;
        the first is between −π and π. NaN, NaN where no direction has these signs; where nothing
        moves, the whole circle from −π to π.
    """
    c = np.asarray(signs, dtype=float)[..., None] * np.asarray(gradient, dtype=float)
    c = np.broadcast_arrays(c, np.asarray(gradient, dtype=float))[0]
    moves = np.any(c != 0.0, axis=-1)
    angle = np.arctan2(c[..., 1], c[..., 0])
    first = np.take_along_axis(angle, moves.argmax(axis=-1)[..., None], axis=-1)
    # counted from one of the normals, all others of a cone lie within half a turn of it
    apart = np.where(moves, _wrapped(angle - first), 0.0)
    low = first[..., 0] + apart.max(axis=-1, initial=0.0) - np.pi / 2
    high = first[..., 0] + apart.min(axis=-1, initial=0.0) + np.pi / 2
    width = high - low
    start = _wrapped(low)
    found = np.stack([start, start + width], axis=-1)
    found = np.where((width > 0.0)[..., None], found, np.nan)
    return np.where(moves.any(axis=-1)[..., None], found, np.array([-np.pi, np.pi]))


def sectors(gradient: ArrayLike) -> tuple[Array, NDArray[np.int8]]:
    """All cones at a point, those of no extent left out, counter-clockwise.

    Parameters
    ----------
    gradient : (n, 2)
        Of the drives' coordinates over the two parameters, units as these give them.

    Returns
    -------
    angles : (c, 2)
        First and last angle, rad; c ≤ 2n.
    signs : (c, n) of int
        Of the drives' speeds in it, 0 for a drive that does not move.
    """
    c = np.asarray(gradient, dtype=float)
    moves = np.any(c != 0.0, axis=-1)
    if not moves.any():
        return np.array([[-np.pi, np.pi]]), np.zeros((1, len(c)), dtype=np.int8)
    normal = np.arctan2(c[moves, 1], c[moves, 0])
    lines = np.sort(_wrapped(np.concatenate([normal - np.pi / 2, normal + np.pi / 2])))
    ends = np.append(lines[1:], lines[0] + 2 * np.pi)
    wide = ends - lines > 1e-12
    angles = np.stack([lines, ends], axis=-1)[wide]
    middle = angles.mean(axis=-1)
    along = np.stack([np.cos(middle), np.sin(middle)], axis=-1) @ c.T
    return angles, np.where(moves, np.sign(along), 0).astype(np.int8)


def _wrapped(angle: Array) -> Array:
    return np.asarray((angle + np.pi) % (2 * np.pi) - np.pi)
