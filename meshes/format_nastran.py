"""Nastran bulk data: regions and patches are properties; their names stand in comments."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshes.groups import Group, split_by_tag
from meshes.mesh import Mesh

Array = NDArray[Any]
COMMENT = re.compile(r"^\$ property (\d+) (region|patch) (.*)$")


def read(path: Path) -> tuple[Array, list[Group]]:
    """Points and groups of a .bdf file."""
    import meshio  # noqa: PLC0415 - half a second that most commands never need

    names = {}
    with path.open(encoding="utf-8", errors="replace") as file:
        for line in file:
            if line.startswith("BEGIN BULK"):
                break
            if match := COMMENT.match(line.rstrip("\n")):
                names[3 if match[2] == "region" else 2, int(match[1])] = match[3]
    found = meshio.nastran.read(str(path))
    references = found.cell_data.get("nastran:ref")
    groups = []
    for i, block in enumerate(found.cells):
        own = np.zeros(len(block.data), np.int64) if references is None else references[i]
        nodes = np.asarray(block.data, dtype=np.int64)
        groups += split_by_tag(block.type, nodes, np.asarray(own), names)
    return np.asarray(found.points), groups


def write(path: Path, mesh: Mesh, groups: list[Group]) -> None:
    """Write regions and patches; the format has no names and meshio no node sets."""
    import meshio  # noqa: PLC0415 - see read

    kept = [g for g in groups if g.dimension > 0]
    keys = list(dict.fromkeys((g.dimension, g.name) for g in kept))
    number = {key: i + 1 for i, key in enumerate(keys)}
    made = meshio.Mesh(
        mesh.points,
        [(g.kind, g.nodes) for g in kept],
        cell_data={
            "nastran:ref": [np.full(len(g.nodes), number[g.dimension, g.name]) for g in kept]
        },
    )
    meshio.nastran.write(str(path), made)
    what = {3: "region", 2: "patch"}
    comments = [
        f"$ property {number[key]} {what[key[0]]} {' '.join(key[1].split())}" for key in keys
    ]
    text = path.read_text(encoding="utf-8")
    path.write_text("\n".join([*comments, text]), encoding="utf-8")
