"""Lines between signs on a grid, and one sense for the spaces of its poses."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import contourpy
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import (
    breadth_first_order,
    connected_components,
    minimum_spanning_tree,
)

Array = NDArray[Any]
Indices = NDArray[np.intp]


def grid_edges(shape: tuple[int, int]) -> Indices:
    """Pairs of neighbours on a grid whose poses are counted row by row, (e, 2).

    Parameters
    ----------
    shape : (int, int)
        Poses along both axes of the grid.
    """
    number = np.arange(shape[0] * shape[1]).reshape(shape)
    pairs = ((number[:-1], number[1:]), (number[:, :-1], number[:, 1:]))
    return np.concatenate([np.stack([a.ravel(), b.ravel()], axis=1) for a, b in pairs])


def sign_lines(field: Array) -> list[tuple[Indices, Indices]]:
    """Edges of a grid that the lines between signs cross, in their order, (v, 2) each.

    Parameters
    ----------
    field : (m, n)
        In any unit, of which the signs alone count; not finite where nothing is known.
    """
    known = np.isfinite(field)
    # by its signs alone, so that every vertex is the middle of its edge and tells which it is
    signs = np.where(np.where(known, field, 1.0) >= 0.0, 1.0, -1.0)
    lines = contourpy.contour_generator(z=np.ma.array(signs.T, mask=~known.T)).lines(0.0)
    result = []
    for line in lines:
        middle = np.asarray(line)
        low = np.floor(middle + 0.25).astype(np.intp)
        result.append((low, low + (middle - low > 0.25)))
    return result


def grid_places(axes: tuple[Array, Array], index: Indices) -> Array:
    """Coordinates of grid points (v, 2), m and rad.

    Parameters
    ----------
    axes : two of (n,)
        Values along each, m or rad.
    index : (v, 2) of int
        Of grid points along both.
    """
    return np.stack([axes[0][index[:, 0]], axes[1][index[:, 1]]], axis=1)


def runs(names: list[str | None]) -> list[Indices]:
    """Indices of neighbours of one name, (k,) each, those without a name left out.

    Parameters
    ----------
    names : list of str or None
        What each point of a line is called; None for nothing.
    """
    cuts = [0, *(k for k in range(1, len(names)) if names[k] != names[k - 1]), len(names)]
    return [np.arange(a, b) for a, b in pairwise(cuts) if b > a and names[a] is not None]


def one_sense(count: int, edges: Indices, senses: Array) -> tuple[Array, int]:
    """Sense of every pose's basis against the first of its region, ±1, (p,).

    It is handed on between poses whose spaces are nearest to each other. Also returned: the number
    of edges whose ends then disagree.

    Parameters
    ----------
    count : int
        Number of poses.
    edges : (e, 2) of int
        Pairs of neighbours.
    senses : (e,)
        Of the second's basis against the first's, −1 to 1, as of `edge_senses`; no unit.
    """
    sense = np.ones(count)
    if not len(edges):
        return sense, 0
    apart = 2.0 - np.abs(senses)
    graph = coo_array((apart, edges.T), shape=(count, count)).tocsr()
    tree = minimum_spanning_tree(graph)
    regions, label = connected_components(tree, directed=False)
    first = np.unique(label, return_index=True)[1]
    before = np.arange(count)
    for start in first[np.bincount(label, minlength=regions) > 1]:
        order, found = breadth_first_order(tree, start, directed=False)
        before[order[1:]] = found[order[1:]]
    both = np.concatenate([edges, edges[:, ::-1]])
    key = both[:, 0] * count + both[:, 1]
    order = np.argsort(key)
    at = np.flatnonzero(before != np.arange(count))
    place = order[np.searchsorted(key[order], before[at] * count + at)]
    sign = np.where(senses < 0.0, -1.0, 1.0)
    sense[at] = np.tile(sign, 2)[place]
    sense = _gathered(sense, before)
    agree = sense[edges[:, 0]] * sense[edges[:, 1]] * sign
    return sense, int(np.count_nonzero(agree < 0.0))


def _gathered(sense: Array, before: Indices) -> Array:
    """Product of signs from each pose back to its region's first, which has 1."""
    while True:
        further = before[before]
        if np.array_equal(further, before):
            return sense
        sense, before = sense * sense[before], further
