"""Distances between segments."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

#: Squared lengths below this share of the largest are points, and sines below its root parallel.
FLAT = 1e-24


def segment_distances(first: Array, second: Array) -> Array:
    """Distances between segments.

    The squared distance is a convex function of the two places: it is least inside both, or at
    the end of one of them (Ericson 2005, Real-Time Collision Detection, section 5.1.9).

    Parameters
    ----------
    first, second : (..., 2, 3)
        Ends, m.

    Returns
    -------
    distance : (...)
        m.
    """
    a, b = first[..., 0, :], second[..., 0, :]
    u, v = first[..., 1, :] - a, second[..., 1, :] - b
    found = np.minimum(
        np.minimum(_to_point(a, b, v), _to_point(a + u, b, v)),
        np.minimum(_to_point(b, a, u), _to_point(b + v, a, u)),
    )
    uu, vv, uv = (u * u).sum(axis=-1), (v * v).sum(axis=-1), (u * v).sum(axis=-1)
    across = uu * vv - uv**2
    skew = across > FLAT**0.5 * uu * vv
    safe = np.where(skew, across, 1.0)
    apart = a - b
    au, av = (apart * u).sum(axis=-1), (apart * v).sum(axis=-1)
    s, t = (uv * av - vv * au) / safe, (uu * av - uv * au) / safe
    inside = skew & (s > 0.0) & (s < 1.0) & (t > 0.0) & (t < 1.0)
    between = np.linalg.norm(apart + s[..., None] * u - t[..., None] * v, axis=-1)
    return np.asarray(np.where(inside, np.minimum(between, found), found))


def _to_point(point: Array, start: Array, along: Array) -> Array:
    """Distance of points from segments, (...)."""
    squared = (along * along).sum(axis=-1)
    share = ((point - start) * along).sum(axis=-1) / np.where(squared > 0.0, squared, 1.0)
    share = np.clip(share, 0.0, 1.0)
    return np.asarray(np.linalg.norm(point - start - share[..., None] * along, axis=-1))
