"""MED files (Salome, code_aster): regions, patches and node sets are groups of families."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes.cells import CELL_TYPES, CellType
from strutwork.meshes.file_mesh import Block, FileMesh, remedy_for, unusable
from strutwork.meshes.groups import Group, with_cell_sets
from strutwork.meshes.med_file import read_file
from strutwork.meshes.mesh import CellBlock, Mesh
from strutwork.meshes.quality import cell_volumes
from strutwork.meshes.rows import row_groups

Array = NDArray[Any]
Ints = NDArray[np.int64]
#: Corners of a solid in MED's order: its faces point inwards.
CORNERS = {"tetra": (0, 2, 1, 3), "hexahedron": (0, 3, 2, 1, 4, 7, 6, 5)}
LONGEST_NAME = 80


def read(path: Path) -> FileMesh:
    """What a .med file holds. A cell of several groups is in each of them.

    Parameters
    ----------
    path : Path
        .med.
    """
    found = read_file(path)
    solids: list[Block] = []
    sets: dict[str, list[Ints]] = {}
    faces: dict[str, list[Block]] = {}
    first = 0
    for kind, nodes, families in found.cells:
        if kind not in CELL_TYPES:
            raise ModelError(
                str(path),
                f"holds {len(nodes)} cells of which each is {unusable(kind)}, which cannot be "
                "used.",
                remedy_for(kind),
            )
        dimension = CELL_TYPES[kind].dimension
        ordered = _outwards(found.points, kind, nodes) if dimension == 3 else nodes
        for name, own in found.members(families).items():
            if dimension == 3:
                sets.setdefault(name, []).append(first + own)
            else:
                faces.setdefault(name, []).append((kind, ordered[own]))
        if dimension == 3:
            solids.append((kind, ordered))
            first += len(nodes)
    return FileMesh(
        found.points,
        solids,
        cell_sets={name: np.concatenate(own) for name, own in sets.items()},
        faces=faces,
        node_sets=found.members(found.node_families),
    )


def write(path: Path, mesh: Mesh, groups: list[Group]) -> None:
    """Write each face once, in a family of the patches that hold it; nodes likewise.

    Parameters
    ----------
    path : Path
        Overwritten.
    mesh : Mesh
        Points, m, are written as they are.
    groups : list of Group
        As `to_groups` makes them.
    """
    import meshio  # noqa: PLC0415 - half a second that most commands never need

    groups = with_cell_sets(mesh, groups)
    for group in groups:
        if not group.name.isascii() or "/" in group.name or len(group.name) > LONGEST_NAME:
            raise ModelError(
                f"mesh {mesh.name}",
                f"MED cannot store the name {group.name!r}.",
                f"Use at most {LONGEST_NAME} ASCII characters without '/'.",
            )
    cells, tags = [], []
    families: dict[tuple[str, ...], int] = {}
    for kind in dict.fromkeys(g.kind for g in groups if g.dimension > 0):
        same = [g for g in groups if g.kind == kind]
        type_ = CELL_TYPES[kind]
        nodes = np.concatenate([g.nodes for g in same])
        first, row = row_groups(nodes[:, : type_.corners], cyclic=type_.dimension == 2)
        holder = np.repeat(np.arange(len(same)), [len(g.nodes) for g in same])
        member = np.zeros((len(first), len(same)), dtype=bool)
        member[row, holder] = True
        ordered = nodes[first]
        cells.append((kind, ordered[:, _order(type_)] if type_.dimension == 3 else ordered))
        tags.append(-_families(member, [g.name for g in same], families))
    sets = [g for g in groups if g.dimension == 0]
    member = np.zeros((len(mesh.points), len(sets)), dtype=bool)
    for column, group in enumerate(sets):
        member[group.nodes[:, 0], column] = True
    node_families: dict[tuple[str, ...], int] = {}
    node_tags = _families(member, [g.name for g in sets], node_families)
    made = meshio.Mesh(
        mesh.points, cells, point_data={"point_tags": node_tags}, cell_data={"cell_tags": tags}
    )
    made.point_tags = {number: list(names) for names, number in node_families.items()}
    made.cell_tags = {-number: list(names) for names, number in families.items()}
    meshio.med.write(str(path), made)


def _families(member: Array, names: list[str], known: dict[tuple[str, ...], int]) -> Ints:
    """The family of each row of a table of members, 0 for none; `known` gains the new ones."""
    if not names:
        return np.zeros(len(member), dtype=np.int64)
    rows, index = np.unique(member, axis=0, return_inverse=True)
    numbers = []
    for row in rows:
        key = tuple(dict.fromkeys(name for name, own in zip(names, row, strict=True) if own))
        numbers.append(known.setdefault(key, len(known) + 1) if key else 0)
    return np.array(numbers, dtype=np.int64)[index.reshape(-1)]


def _order(type_: CellType) -> list[int]:
    """Nodes of a solid in MED's order; the order is its own inverse."""
    corners = CORNERS[type_.linear_kind]
    index = {frozenset(p): i for i, p in enumerate(type_.parents)}
    return [index[frozenset(corners[c] for c in p)] for p in type_.parents]


def _outwards(points: Array, kind: str, nodes: Ints) -> Ints:
    """The cells in our order, from MED's or, as meshio writes them, from VTK's."""
    if not len(nodes):
        return nodes
    block = CellBlock(kind, nodes, np.zeros(len(nodes), np.int64))
    if cell_volumes(Mesh(points, (block,))).sum() >= 0:
        return nodes
    return nodes[:, _order(CELL_TYPES[kind])]
