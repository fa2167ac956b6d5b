"""Cells of VTK's unstructured grids: types, and blocks from connectivity and offsets."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes.cells import CELL_TYPES
from strutwork.meshes.file_mesh import remedy_for, unusable

Ints = NDArray[np.int64]
#: Kinds that are read, by VTK's number.
KINDS = {
    5: "triangle", 9: "quad", 10: "tetra", 12: "hexahedron", 22: "triangle6", 23: "quad8",
    24: "tetra10", 25: "hexahedron20", 28: "quad9", 29: "hexahedron27",
}  # fmt: skip
#: Points, lines and faces of other kinds: no part of a solid.
PASSED = {0, 1, 2, 3, 4, 6, 7, 8, 21, 30, 34, 35, 36, 68, 69, 70, 75, 76, 77}
#: Solids that cannot be analysed.
SOLIDS = {
    11: "voxel", 13: "wedge", 14: "pyramid", 15: "prism with five sides",
    16: "prism with six sides", 26: "wedge15", 27: "pyramid13", 31: "wedge12", 32: "wedge18",
    33: "hexahedron24", 37: "pyramid19", 41: "convex point set", 42: "polyhedron",
    71: "tetra of higher order", 72: "hexahedron of higher order", 73: "wedge of higher order",
    74: "pyramid of higher order", 78: "tetra of higher order", 79: "hexahedron of higher order",
    80: "wedge of higher order", 81: "pyramid of higher order",
}  # fmt: skip


@dataclass(frozen=True)
class VtkBlock:
    """Cells of one type.

    Parameters
    ----------
    kind : str
    cells : (m,)
        Their places among all cells of the file.
    nodes : (m, k)
        Their nodes.
    """

    kind: str
    cells: Ints
    nodes: Ints


def blocks(path: Path, connectivity: Ints, ends: Ints, types: Ints, points: int) -> list[VtkBlock]:
    """Cells by kind.

    Parameters
    ----------
    path : Path
        For messages.
    connectivity : (c,) int
        Nodes of all cells.
    ends : (m,) int
        Where each cell's nodes end.
    types : (m,) int
    points : int
        How many points there are.

    Raises
    ------
    ModelError
        Solids that cannot be used, counts that do not agree, nodes that do not exist.
    """
    damaged = "The file is cut short or damaged: export it again."
    sizes = np.diff(ends, prepend=0)
    if len(ends) != len(types) or (sizes < 0).any() or (ends[-1:] != len(connectivity)).any():
        raise ModelError(
            str(path),
            f"has offsets of {len(ends)} cells that do not fit {len(types)} types and "
            f"{len(connectivity)} nodes.",
            damaged,
        )
    found = []
    for number in np.unique(types).tolist():
        own = np.flatnonzero(types == number)
        if number in PASSED:
            continue
        if number not in KINDS:
            kind = SOLIDS.get(number, f"VTK type {number}")
            raise ModelError(
                str(path),
                f"cell {own[0]} is {unusable(kind)}, which cannot be used ({len(own)} such cells).",
                remedy_for(kind),
            )
        kind = KINDS[number]
        width = CELL_TYPES[kind].size
        wrong = own[sizes[own] != width]
        if len(wrong):
            raise ModelError(
                str(path),
                f"cell {wrong[0]} ({kind}) has {sizes[wrong[0]]} nodes, not {width}.",
                damaged,
            )
        nodes = connectivity[(ends[own] - width)[:, None] + np.arange(width)]
        if nodes.size and (nodes.min() < 0 or nodes.max() >= points):
            raise ModelError(
                str(path),
                f"has cells of type {kind} on point {nodes.max()}; there are {points}.",
                damaged,
            )
        found.append(VtkBlock(kind, own, nodes))
    return found
