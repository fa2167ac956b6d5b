"""Spectral elements in time: nodes, and a mode's response to a load between them.

On an element the load is a polynomial through Gauss-Legendre nodes; what a mode makes of it until
each node, and until the end, is integrated with its own exponential.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


@lru_cache(maxsize=256)
def gauss(order: int) -> tuple[Array, Array]:
    """Nodes and weights (p,) of Gauss and Legendre on −1 to 1, no unit.

    Parameters
    ----------
    order : int
        Number of nodes p.
    """
    return np.polynomial.legendre.leggauss(order)


@lru_cache(maxsize=256)
def _barycentric(order: int) -> Array:
    nodes, weights = gauss(order)
    # closed form for Gauss-Legendre nodes, Wang and Xiang (2012)
    return np.asarray((-1.0) ** np.arange(order) * np.sqrt((1.0 - nodes**2) * weights))


def lagrange(order: int, at: Array) -> Array:
    """Lagrange polynomials of the nodes at points, (..., p), no unit.

    Parameters
    ----------
    order : int
    at : (...)
        Between −1 and 1, no unit.
    """
    nodes, _ = gauss(order)
    gap = at[..., None] - nodes
    hit = gap == 0
    terms = _barycentric(order) / np.where(hit, 1.0, gap)
    found = terms / terms.sum(axis=-1, keepdims=True)
    return np.asarray(np.where(hit.any(axis=-1, keepdims=True), hit.astype(float), found))


@lru_cache(maxsize=128)
def _tables(order: int, points: int) -> tuple[Array, Array]:
    """Time left (p + 1, q) and weighted polynomials (p + 1, q, p) of integrals to each node."""
    ends = np.append(gauss(order)[0], 1.0)
    at, weights = gauss(points)
    half = 0.5 * (ends + 1.0)
    inner = -1.0 + half[:, None] * (at + 1.0)
    weighted = lagrange(order, inner) * (half[:, None] * weights)[..., None]
    return ends[:, None] - inner, weighted


def response_weights(poles: Array, order: int, length: float) -> Array:
    """What unit loads at the nodes leave in a mode, (n, p + 1, p), s.

    ∫ exp(s (t − t′)) L(t′) dt′ from the beginning of the element to each node, and in the last row
    to its end.

    Parameters
    ----------
    poles : (n,)
        s, rad/s.
    order : int
    length : float
        s.
    """
    swing = float(np.abs(poles).max()) * length
    # as many as integrate polynomial and exponential to rounding, rounded up to have few tables
    points = int(np.ceil((0.5 * order + 0.35 * swing + min(12.0, 8.0 + 0.1 * swing)) / 4.0)) * 4
    left, weighted = _tables(order, points)
    scaled = 0.5 * length * poles
    growth = np.exp(scaled[:, None, None] * left)
    found = np.swapaxes(growth, 0, 1) @ weighted
    return np.asarray(0.5 * length * np.swapaxes(found, 0, 1))
