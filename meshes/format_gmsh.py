"""Gmsh files: regions, patches and node sets are physical groups."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes.cells import CELL_TYPES
from strutwork.meshes.file_mesh import Block, FileMesh, remedy_for, unusable
from strutwork.meshes.gmsh_file import NODE_ORDER, Cells, GmshFile, read_file
from strutwork.meshes.groups import Group, with_cell_sets
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.numbered import Numbered
from strutwork.meshes.rows import row_groups

Array = NDArray[Any]
Ints = NDArray[np.int64]
LINES = ("line", "line3", "line4", "line5", "line6")
WORDS = {3: "region", 2: "patch", 0: "nodes"}


def read(path: Path) -> FileMesh:
    """What a .msh file holds. An element of several groups is in each of them.

    Parameters
    ----------
    path : Path
        .msh of version 2 or 4.
    """
    found = read_file(path)
    index = Numbered(found.numbers)
    twice = index.twice()
    if len(twice):
        raise ModelError(
            str(path), f"has the node {found.numbers[twice[0, 0]]} twice.", "Export the mesh again."
        )
    solids: list[Block] = []
    sets: dict[str, list[Ints]] = {}
    faces: dict[str, list[Block]] = {}
    node_sets: dict[str, list[Ints]] = {}
    first = 0
    for cells in _together(found):
        if cells.kind in LINES or not len(cells.nodes):
            continue
        if cells.kind not in CELL_TYPES and cells.kind != "vertex":
            raise ModelError(
                str(path),
                f"element {cells.numbers[0]} is {unusable(cells.kind)}, which cannot be used "
                f"({len(cells.numbers)} elements or more).",
                remedy_for(cells.kind),
            )
        nodes = _nodes(found, index, cells)
        dimension = 0 if cells.kind == "vertex" else CELL_TYPES[cells.kind].dimension
        groups = _groups(found, cells, dimension)
        if dimension == 3:
            nodes, groups = _once(nodes, groups)
            solids.append((cells.kind, nodes))
            for name, own in groups.items():
                sets.setdefault(name, []).append(first + own)
            first += len(nodes)
        for name, own in groups.items():
            if dimension == 2:
                faces.setdefault(name, []).append((cells.kind, nodes[own]))
            elif dimension == 0:
                node_sets.setdefault(name, []).append(nodes[own, 0])
    return FileMesh(
        found.points,
        solids,
        cell_sets={name: np.concatenate(own) for name, own in sets.items()},
        faces=faces,
        node_sets={name: np.concatenate(own) for name, own in node_sets.items()},
    )


def _together(found: GmshFile) -> list[Cells]:
    """The elements of version 2 by kind: a file may change its kind with every element."""
    if any(c.physical is None for c in found.cells):
        return found.cells
    kinds = dict.fromkeys(c.kind for c in found.cells)
    same = {kind: [c for c in found.cells if c.kind == kind] for kind in kinds}
    return [
        Cells(
            kind,
            np.concatenate([c.numbers for c in own]),
            np.concatenate([c.nodes for c in own]),
            physical=np.concatenate([c.physical for c in own if c.physical is not None]),
        )
        for kind, own in same.items()
    ]


def _nodes(found: GmshFile, index: Numbered, cells: Cells) -> Ints:
    """The nodes of elements by place, in our order."""
    at, known = index.find(cells.nodes)
    if not known.all():
        row = int(np.argmin(known.all(axis=1)))
        raise ModelError(
            str(found.path),
            f"element {cells.numbers[row]} has the node {cells.nodes[row][~known[row]][0]}, which "
            "the file does not give.",
            "Export the entire mesh again.",
        )
    return at[:, list(NODE_ORDER[cells.kind])] if cells.kind in NODE_ORDER else at


def _groups(found: GmshFile, cells: Cells, dimension: int) -> dict[str, Ints]:
    """Elements of each physical group."""
    if cells.physical is None:
        if cells.entity not in found.entities and found.entities:
            raise ModelError(
                str(found.path),
                f"has elements of the entity {cells.entity[1]} of dimension {cells.entity[0]}, "
                "which $Entities does not give.",
                "Export the mesh again.",
            )
        every = np.arange(len(cells.nodes))
        numbers = dict.fromkeys(found.entities.get(cells.entity, ()), every)
    else:
        numbers = {
            group: np.flatnonzero(cells.physical == group)
            for group in np.unique(cells.physical).tolist()
        }
    return {
        found.names.get((dimension, group), f"{WORDS[dimension]} {group}"): own
        for group, own in numbers.items()
        if group
    }


def _once(nodes: Ints, groups: dict[str, Ints]) -> tuple[Ints, dict[str, Ints]]:
    """Each cell once: version 2 writes a cell of two groups twice.

    A cell that one group has twice stays doubled.
    """
    group_of = row_groups(nodes)[1]
    if int(group_of.max()) + 1 == len(nodes):
        return nodes, groups
    # how often the cell came before in its own group
    turn = np.zeros(len(nodes), dtype=np.int64)
    for own in groups.values():
        order = np.argsort(group_of[own], kind="stable")
        ordered = group_of[own][order]
        start = np.flatnonzero(np.append(True, ordered[1:] != ordered[:-1]))
        turn[own[order]] = np.arange(len(own)) - np.repeat(
            start, np.diff(np.append(start, len(own)))
        )
    keys = np.stack([group_of, turn], axis=1)
    _, first, cell = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    rank = np.empty(len(first), dtype=np.int64)
    rank[np.argsort(first)] = np.arange(len(first))
    cell = rank[cell.reshape(-1)]
    return nodes[np.sort(first)], {name: np.unique(cell[own]) for name, own in groups.items()}


def write(path: Path, mesh: Mesh, groups: list[Group]) -> None:
    """Write version 2.2, binary, which every Gmsh reads; a cell of two groups stands twice.

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
        if '"' in group.name or "\n" in group.name:
            raise ModelError(
                f"mesh {mesh.name}", f"Gmsh cannot store the name {group.name!r}.", "Rename it."
            )
    keys = list(dict.fromkeys((g.dimension, g.name) for g in groups))
    number = {key: i + 1 for i, key in enumerate(keys)}
    cells, tags = [], []
    # one block a kind: meshio numbers the tags by kind
    for kind in dict.fromkeys(g.kind for g in groups):
        same = [g for g in groups if g.kind == kind]
        cells.append((kind, np.concatenate([g.nodes for g in same])))
        tags.append(
            np.concatenate([np.full(len(g.nodes), number[g.dimension, g.name]) for g in same])
        )
    names = _unique_names(keys, number)
    made = meshio.Mesh(
        mesh.points,
        cells,
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": [t.copy() for t in tags]},
        field_data=names,
    )
    meshio.gmsh.write(str(path), made, "2.2", binary=True)


def _unique_names(
    keys: list[tuple[int, str]], number: dict[tuple[int, str], int]
) -> dict[str, Array]:
    """Number and dimension by name; ModelError where a region and a patch share one."""
    names = {name: np.array([number[dim, name], dim]) for dim, name in keys}
    if len(names) < len(keys):
        twice = sorted({n for _, n in keys if [m for _, m in keys].count(n) > 1})
        raise ModelError(
            "mesh file",
            f"the names {twice} are used by two of a region, a patch and a node set.",
            "Rename one of them, or write .vtu.",
        )
    return names
