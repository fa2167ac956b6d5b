"""A mesh as named groups of cells, faces and nodes: what every mesh file can hold."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshes.cells import CELL_TYPES, cell_type
from meshes.mesh import CellBlock, Faces, Mesh, Patch
from strutwork.errors import ModelError

Array = NDArray[Any]
Ints = NDArray[np.int64]
#: Kinds that a solid mesh may leave unread: points and edges of the geometry.
IGNORED = {"line", "line3"}


@dataclass(frozen=True)
class Group:
    """Cells of one kind under one name.

    Parameters
    ----------
    name : str
        A region, a patch or a node set.
    dimension : int
        3, 2 or 0 accordingly.
    kind : str
        meshio's name of the cell type; `vertex` for nodes.
    nodes : (m, k) int
    """

    name: str
    dimension: int
    kind: str
    nodes: Ints


def to_groups(mesh: Mesh) -> list[Group]:
    """The groups of a mesh: regions first, then patches, then node sets."""
    found = [
        Group(name, 3, block.kind, block.nodes[block.region == index])
        for index, name in enumerate(mesh.regions)
        for block in mesh.blocks
        if (block.region == index).any()
    ]
    found += [
        Group(name, 2, faces.kind, faces.nodes)
        for name, patch in mesh.patches.items()
        for faces in patch.faces
        if len(faces.nodes)
    ]
    return found + [
        Group(name, 0, "vertex", nodes[:, None]) for name, nodes in mesh.node_sets.items()
    ]


def from_groups(points: Array, groups: Sequence[Group], name: str) -> Mesh:
    """The mesh that the groups make.

    Raises
    ------
    ModelError
        No solid cells, cells of a kind that cannot be used.
    """
    unknown = {g.kind for g in groups} - set(CELL_TYPES) - IGNORED - {"vertex"}
    for kind in sorted(unknown):
        cell_type(kind, f"mesh {name}")
    regions = tuple(dict.fromkeys(g.name for g in groups if g.dimension == 3))
    solids = [g for g in groups if g.dimension == 3]
    blocks = []
    for kind in dict.fromkeys(g.kind for g in solids):
        same = [g for g in solids if g.kind == kind]
        index = [np.full(len(g.nodes), regions.index(g.name), dtype=np.int64) for g in same]
        blocks.append(
            CellBlock(kind, np.concatenate([g.nodes for g in same]), np.concatenate(index))
        )
    patches: dict[str, Patch] = {}
    sets: dict[str, Ints] = {}
    for patch in dict.fromkeys(g.name for g in groups if g.dimension == 2):
        faces: dict[str, list[Ints]] = {}
        for group in groups:
            if group.dimension == 2 and group.name == patch:
                faces.setdefault(group.kind, []).append(group.nodes)
        patches[patch] = Patch(tuple(Faces(k, np.concatenate(n)) for k, n in faces.items()))
    for group in groups:
        if group.dimension == 0:
            sets[group.name] = np.append(sets.get(group.name, []), group.nodes).astype(np.int64)
    if not blocks:
        raise ModelError(
            f"mesh {name}",
            "holds no solid cells.",
            "Export hexahedra or tetrahedra; a closed surface is meshed by "
            "`meshes.gmsh_volumes.tetrahedra`.",
        )
    return Mesh(points, tuple(blocks), regions, sets, patches, name)


def dimension_of(kind: str) -> int:
    """2 for faces, 3 for solids and kinds that are not known, 0 for vertices, 1 for lines."""
    if kind in CELL_TYPES:
        return CELL_TYPES[kind].dimension
    return {"vertex": 0}.get(kind, 1 if kind in IGNORED else 3)


def split_by_tag(
    kind: str, nodes: Ints, tags: Ints, names: dict[tuple[int, int], str]
) -> list[Group]:
    """Groups of one block whose cells carry a number each.

    `names` gives the name by (dimension, number). Solids without a name are called
    "region 1" and so on, or "solid" for number 0; faces and nodes of number 0 are dropped.
    """
    dimension = dimension_of(kind)
    found = []
    for tag in np.unique(tags):
        number = int(tag)
        if dimension == 1 or (dimension < 3 and number == 0):
            continue
        what = {3: "region", 2: "patch", 0: "nodes"}[dimension]
        plain = "solid" if number == 0 else f"{what} {number}"
        name = names.get((dimension, number), plain)
        found.append(Group(name, dimension, kind, nodes[tags == tag]))
    return found
