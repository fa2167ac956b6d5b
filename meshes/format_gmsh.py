"""Gmsh files: regions, patches and node sets are physical groups."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshes.groups import Group, split_by_tag
from meshes.mesh import Mesh
from strutwork.errors import ModelError

Array = NDArray[Any]


def read(path: Path) -> tuple[Array, list[Group]]:
    """Points and groups of a .msh file, version 2 or 4."""
    import meshio  # noqa: PLC0415 - half a second that most commands never need

    content = path.read_bytes()
    # meshio reads a file without its last section as if it were complete
    if content.lstrip().startswith(b"$MeshFormat") and b"$EndElements" not in content:
        raise ModelError(
            str(path), "ends before $EndElements: it is cut short.", "Export the mesh again."
        )
    found = meshio.gmsh.read(str(path))
    names = {(int(dim), int(tag)): name for name, (tag, dim) in found.field_data.items()}
    tags = found.cell_data.get("gmsh:physical")
    groups = []
    for i, block in enumerate(found.cells):
        own = np.zeros(len(block.data), np.int64) if tags is None else np.asarray(tags[i])
        groups += split_by_tag(block.type, np.asarray(block.data, dtype=np.int64), own, names)
    return np.asarray(found.points), groups


def write(path: Path, mesh: Mesh, groups: list[Group]) -> None:
    """Write version 2.2, binary, which every Gmsh reads."""
    import meshio  # noqa: PLC0415 - see read

    for group in groups:
        if '"' in group.name or "\n" in group.name:
            raise ModelError(
                f"mesh {mesh.name}", f"Gmsh cannot hold the name {group.name!r}.", "Rename it."
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
