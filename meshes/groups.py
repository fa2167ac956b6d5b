"""A mesh as named groups of cells, faces and nodes: what every mesh file can hold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from strutwork.meshes.mesh import Mesh

Ints = NDArray[np.int64]


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
    """The groups of a mesh: regions first, then patches, then node sets.

    Parameters
    ----------
    mesh : Mesh
        Its cell sets are left to `with_cell_sets`.
    """
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


def with_cell_sets(mesh: Mesh, groups: list[Group]) -> list[Group]:
    """The groups with those of the mesh's cell sets; cells of several sets stand in each.

    A set takes the place of a region of its name, which it holds.

    Parameters
    ----------
    mesh : Mesh
        Whose groups they are.
    groups : list of Group
        As `to_groups` makes them.
    """
    ends = np.cumsum([len(b.nodes) for b in mesh.blocks])[:-1]
    found = [g for g in groups if g.dimension == 3 and g.name not in mesh.cell_sets]
    for name, cells in mesh.cell_sets.items():
        mask = np.zeros(mesh.cell_count, dtype=bool)
        mask[cells] = True
        found += [
            Group(name, 3, block.kind, block.nodes[own])
            for block, own in zip(mesh.blocks, np.split(mask, ends), strict=True)
            if own.any()
        ]
    return found + [g for g in groups if g.dimension != 3]
