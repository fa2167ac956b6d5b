"""Curved quadratic cells: whether edges are straight, and straight ones in place of bad curves."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.meshes.mesh import CellBlock, Mesh
from strutwork.meshes.quality import quality

Array = NDArray[Any]
Ints = NDArray[np.int64]
#: Distance of a middle node from the middle, as a share of its edge, that rounding explains.
ROUNDED = 1e-6


def is_straight(mesh: Mesh) -> bool:
    """Whether every midside node is at the midpoint of its corners.

    Nodes off by a millionth of their edge, the rounding of a file, count as in the middle.

    Parameters
    ----------
    mesh : Mesh
        Of cells of any kind; linear ones are straight.
    """
    return not any(_bent(mesh.points, block).any() for block in mesh.blocks)


def straightened(mesh: Mesh, cells: Ints) -> Mesh:
    """The mesh with the midside nodes of some cells moved to the midpoints of their corners.

    Parameters
    ----------
    mesh : Mesh
    cells : (k,) int
        Index of each cell, blocks one after another.
    """
    points = mesh.points.copy()
    chosen = np.zeros(mesh.cell_count, dtype=bool)
    chosen[cells] = True
    ends = np.cumsum([len(b.nodes) for b in mesh.blocks])[:-1]
    for block, own in zip(mesh.blocks, np.split(chosen, ends), strict=True):
        for column in range(block.type.corners, block.type.size):
            nodes = block.nodes[own]
            corners = mesh.points[nodes[:, list(block.type.parents[column])]]
            points[nodes[:, column]] = corners.mean(axis=1)
    return replace(mesh, points=points)


def unbent(mesh: Mesh) -> tuple[Mesh, Ints]:
    """The mesh with straight edges where curved ones would invert cells.

    Parameters
    ----------
    mesh : Mesh
        Of cells of any kind.

    Returns
    -------
    mesh : Mesh
        Cells that are inside out with straight edges too stay so.
    cells : (k,) int
        Those whose edges are straight now, ascending.
    """
    # an edge that is made straight may turn a neighbour inside out
    cells = np.zeros(0, dtype=np.int64)
    while len(left := np.setdiff1d(quality(mesh).inverted, cells)):
        cells = np.union1d(cells, left)
        mesh = straightened(mesh, left)
    return mesh, cells


def _bent(points: Array, block: CellBlock) -> NDArray[np.bool_]:
    """Whether a middle node of each cell stands off the middle of its corners, (m,)."""
    bent = np.zeros(len(block.nodes), dtype=bool)
    for column in range(block.type.corners, block.type.size):
        ends = points[block.nodes[:, list(block.type.parents[column])]]
        off = np.linalg.norm(points[block.nodes[:, column]] - ends.mean(axis=1), axis=-1)
        bent |= off > ROUNDED * np.linalg.norm(np.ptp(ends, axis=1), axis=-1)
    return bent
