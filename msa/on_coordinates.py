"""Matrices of a stack of structures on the coordinates that their one placement decides."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.msa.assembly import System
from strutwork.msa.null_space import independent_basis
from strutwork.msa.structure import rigid_map

Array = NDArray[Any]


def on_coordinates(system: System, parts: Iterable[tuple[str, NDArray[np.intp], Array]]) -> Array:
    """Sum of parts' matrices on the independent coordinates, symmetric, (p, c, c).

    Part by part on the few coordinates that move it: no matrix of all unknowns is made.

    Parameters
    ----------
    system : System
        All of whose poses are the same one (`System.lone`).
    parts : iterable of (name, nodes (k,), matrix (p, 6k, 6k))
        As `System.contributions` gives them: N/m, N, N·m/rad, or kg, kg·m, kg·m².
    """
    lone = system.lone or system
    size = independent_basis(lone).shape[-1]
    result = np.zeros((system.poses, size, size))
    for _, nodes, part in parts:
        moved, columns = _moved(lone, nodes)
        if columns.size:
            result[:, columns[:, None], columns] += moved.T @ part @ moved
    return np.asarray((result + np.swapaxes(result, -1, -2)) / 2.0)


def _moved(lone: System, nodes: NDArray[np.intp]) -> tuple[Array, NDArray[np.intp]]:
    """Displacements at nodes per unit coordinate, (6k, q), and the q coordinates that move them."""
    # a frozen dataclass keeps derived data in its __dict__, as cached_property does
    kept = lone.__dict__.setdefault("_moved", {})
    key = tuple(nodes.tolist())
    if key not in kept:
        basis = independent_basis(lone)[0]
        rows = []
        for node in key:
            vertex = lone.placed.structure.vertex_of_node[node]
            here = basis[6 * vertex : 6 * vertex + 6] if vertex >= 0 else np.zeros_like(basis[:6])
            rows.append(rigid_map(lone.placed.arms[0, node]) @ here)
        whole = np.concatenate(rows)
        columns = np.flatnonzero(np.any(whole, axis=0))
        kept[key] = np.ascontiguousarray(whole[:, columns]), columns
    found: tuple[Array, NDArray[np.intp]] = kept[key]
    return found
