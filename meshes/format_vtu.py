"""VTK's unstructured grids: regions, patches and node sets are masks that ParaView shows."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshes.groups import Group, dimension_of, split_by_tag
from meshes.mesh import Mesh

Array = NDArray[Any]
PREFIXES = {3: "region:", 2: "patch:"}
NODES = "nodes:"


def read(path: Path) -> tuple[Array, list[Group]]:
    """Points and groups of a .vtu file."""
    import meshio  # noqa: PLC0415 - half a second that most commands never need

    found = meshio.vtu.read(str(path))
    groups: list[Group] = []
    for i, block in enumerate(found.cells):
        dimension = dimension_of(block.type)
        prefix = PREFIXES.get(dimension, "")
        nodes = np.asarray(block.data, dtype=np.int64)
        masks = {
            name.removeprefix(prefix): np.asarray(values[i], dtype=bool)
            for name, values in found.cell_data.items()
            if prefix and name.startswith(prefix)
        }
        groups += [
            Group(name, dimension, block.type, nodes[m]) for name, m in masks.items() if m.any()
        ]
        if not masks or dimension not in PREFIXES:
            groups += split_by_tag(block.type, nodes, _plain_tags(found, i, len(nodes)), {})
    groups += [
        Group(name.removeprefix(NODES), 0, "vertex", np.flatnonzero(values)[:, None])
        for name, values in found.point_data.items()
        if name.startswith(NODES)
    ]
    return np.asarray(found.points), groups


def _plain_tags(found: Any, index: int, count: int) -> NDArray[np.int64]:
    """Numbers of regions as other programs write them."""
    for name in ("region", "gmsh:physical", "mat_id", "MaterialIds"):
        if name in found.cell_data:
            return np.asarray(found.cell_data[name][index]).astype(np.int64).reshape(-1)
    return np.zeros(count, dtype=np.int64)


def write(path: Path, mesh: Mesh, groups: list[Group]) -> None:
    """Write the cells of each group once, with a mask for each name."""
    import meshio  # noqa: PLC0415 - see read

    solid = [g for g in groups if g.dimension > 0]
    cell_data = {
        PREFIXES[g.dimension] + g.name: [
            np.full(len(h.nodes), (h.name, h.dimension) == (g.name, g.dimension), dtype=np.uint8)
            for h in solid
        ]
        for g in solid
    }
    masks = {NODES + name: np.zeros(len(mesh.points), np.uint8) for name in mesh.node_sets}
    for name, nodes in mesh.node_sets.items():
        masks[NODES + name][nodes] = 1
    cells = [(g.kind, g.nodes) for g in solid]
    made = meshio.Mesh(mesh.points, cells, point_data=masks, cell_data=cell_data)
    meshio.vtu.write(str(path), made)
