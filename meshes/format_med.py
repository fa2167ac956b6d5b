"""MED files (Salome, code_aster): regions, patches and node sets are groups of families."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshes.cells import CELL_TYPES, CellType
from meshes.groups import Group, dimension_of
from meshes.mesh import CellBlock, Mesh
from meshes.quality import cell_volumes
from meshes.rows import row_groups
from strutwork.errors import ModelError

Array = NDArray[Any]
Ints = NDArray[np.int64]
#: Corners of a solid in MED's order: its faces point inwards.
CORNERS = {"tetra": (0, 2, 1, 3), "hexahedron": (0, 3, 2, 1, 4, 7, 6, 5)}
LONGEST_NAME = 80


def read(path: Path) -> tuple[Array, list[Group]]:
    """Points and groups of a .med file."""
    import meshio  # noqa: PLC0415 - half a second that most commands never need

    found = meshio.med.read(str(path))
    points = np.asarray(found.points)
    groups: list[Group] = []
    tags = found.cell_data.get("cell_tags")
    for i, block in enumerate(found.cells):
        dimension = dimension_of(block.type)
        nodes = np.asarray(block.data, dtype=np.int64)
        if dimension == 3:
            nodes = _outwards(points, block.type, nodes)
        own = np.zeros(len(nodes), np.int64) if tags is None else np.asarray(tags[i])
        for tag in np.unique(own):
            names = [n.rstrip("\x00") for n in found.cell_tags.get(int(tag), [])]
            # a solid has one region: the first of its groups
            names = (names or ["solid"])[:1] if dimension == 3 else names
            groups += [Group(n, dimension, block.type, nodes[own == tag]) for n in names]
    node_tags = np.asarray(found.point_data.get("point_tags", np.zeros(len(points))))
    for tag, names in found.point_tags.items():
        chosen = np.flatnonzero(node_tags == tag)[:, None]
        groups += [Group(name.rstrip("\x00"), 0, "vertex", chosen) for name in names]
    return points, [g for g in groups if g.dimension != 1]


def write(path: Path, mesh: Mesh, groups: list[Group]) -> None:
    """Write each face once, in a family of the patches that hold it; nodes likewise."""
    import meshio  # noqa: PLC0415 - see read

    for group in groups:
        if not group.name.isascii() or "/" in group.name or len(group.name) > LONGEST_NAME:
            raise ModelError(
                f"mesh {mesh.name}",
                f"MED cannot hold the name {group.name!r}.",
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
    if kind not in CELL_TYPES or not len(nodes):
        return nodes
    block = CellBlock(kind, nodes, np.zeros(len(nodes), np.int64))
    if cell_volumes(Mesh(points, (block,))).sum() >= 0:
        return nodes
    return nodes[:, _order(CELL_TYPES[kind])]
