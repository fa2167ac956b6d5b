"""Nastran bulk data: regions and patches are properties; their names stand in comments.

Read and written here, not by meshio, which drops coordinate systems, continuations without a
mark and cards that it does not know. pyNastran reads decks well, but knows hundreds of cards where
a mesh needs a dozen, and what it passes over it does not count.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from strutwork.errors import ModelError
from strutwork.meshes.cells import CELL_TYPES
from strutwork.meshes.file_mesh import Block, FileMesh
from strutwork.meshes.groups import Group
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.middle_nodes import filled
from strutwork.meshes.nastran_deck import ELEMENTS, BulkData

COMMENT = re.compile(r"^\$ property (\d+) (region|patch) (.*)$")
COUNTS = re.compile(r"^\$ strutwork mesh: (\d+) nodes, (\d+) elements$")
CARDS = {
    "tetra": "CTETRA", "tetra10": "CTETRA", "hexahedron": "CHEXA", "hexahedron20": "CHEXA",
    "triangle": "CTRIA3", "triangle6": "CTRIA6", "quad": "CQUAD4", "quad8": "CQUAD8",
}  # fmt: skip


def read(path: Path) -> FileMesh:
    """What a .bdf file holds.

    Parameters
    ----------
    path : Path
        .bdf; what it includes lies in its folder.
    """
    bulk = BulkData(path)
    tables = bulk.tables()
    _check_counts(path, bulk, sum(len(p) for _, p, _ in tables))
    names = {
        (3 if match[2] == "region" else 2, int(match[1])): match[3]
        for match in map(COMMENT.match, bulk.comments)
        if match
    }
    points, made = filled(bulk.points, [(kind, nodes) for kind, _, nodes in tables])
    solids: list[Block] = []
    sections: dict[str, list[np.ndarray]] = {}
    faces: dict[str, list[Block]] = {}
    first = 0
    for (kind, properties, _), nodes in zip(tables, made, strict=True):
        dimension = CELL_TYPES[kind].dimension
        word = "region" if dimension == 3 else "patch"
        for number in np.unique(properties).tolist():
            name = names.get((dimension, number), f"{word} {number}")
            own = np.flatnonzero(properties == number)
            if dimension == 3:
                sections.setdefault(name, []).append(first + own)
            else:
                faces.setdefault(name, []).append((kind, nodes[own]))
        if dimension == 3:
            solids.append((kind, nodes))
            first += len(nodes)
    regions = {name: np.concatenate(own) for name, own in sections.items()}
    return FileMesh(points, solids, sections=regions, faces=faces)


def write(path: Path, mesh: Mesh, groups: list[Group]) -> None:
    """Write regions and patches; names stand in comments, node sets are left out.

    Parameters
    ----------
    path : Path
        Overwritten.
    mesh : Mesh
        Points, m, are written as they are.
    groups : list of Group
        As `to_groups` makes them.
    """
    kept = [g for g in groups if g.dimension > 0]
    keys = list(dict.fromkeys((g.dimension, g.name) for g in kept))
    number = {key: i + 1 for i, key in enumerate(keys)}
    what = {3: "region", 2: "patch"}
    count = sum(len(g.nodes) for g in kept)
    if max(len(mesh.points), count) > 99_999_999:
        raise ModelError(f"mesh {mesh.name}", "has more than 99999999 nodes.", "Mesh coarser.")
    with path.open("w", encoding="utf-8") as file:
        file.write(f"$ strutwork mesh: {len(mesh.points)} nodes, {count} elements\n")
        for key in keys:
            name = " ".join(key[1].split())
            file.write(f"$ property {number[key]} {what[key[0]]} {name}\n")
        file.write("BEGIN BULK\n")
        for i, point in enumerate(mesh.points.tolist(), start=1):
            x, y, z = map(sixteen, point)
            file.write(f"GRID*   {i:>16}{'':16}{x:>16}{y:>16}\n*       {z:>16}\n")
        first = 1
        for group in kept:
            card = CARDS[group.kind]
            order = ELEMENTS[card][2][: group.nodes.shape[1]]
            # where Nastran has its middle nodes: the order of a hexahedron's is its own inverse
            nodes = group.nodes[:, list(order)] + 1
            owner = number[group.dimension, group.name]
            for i, row in enumerate(nodes.tolist(), start=first):
                cells = [i, owner, *row]
                lines = [cells[k : k + 8] for k in range(0, len(cells), 8)]
                body = "\n+       ".join("".join(f"{v:>8}" for v in line) for line in lines)
                file.write(f"{card:<8}{body}\n")
            first += len(nodes)
        file.write("ENDDATA\n")


def sixteen(value: float) -> str:
    """A number in at most 16 characters, with as many digits as these hold.

    Parameters
    ----------
    value : float
        Finite, in any unit.
    """
    plain = repr(value)
    if len(plain) <= 16:
        return plain.replace("e", "E") if "." in plain else plain.replace("e", ".E")
    tries = (f"{value:.{digits}E}".split("E") for digits in range(14, 7, -1))
    return next(s for m, e in tries if len(s := f"{m}{int(e):+d}") <= 16)


def _check_counts(path: Path, bulk: BulkData, elements: int) -> None:
    """ModelError where a file of this package lacks what its first line counts."""
    for match in filter(None, map(COUNTS.match, bulk.comments)):
        if (int(match[1]), int(match[2])) != (len(bulk.points), elements):
            raise ModelError(
                str(path),
                f"ends after {bulk.last or bulk.lines.where} with {len(bulk.points)} nodes and "
                f"{elements} elements; its first line counts {match[1]} and {match[2]}.",
                "The file is cut short: export it again.",
            )
