"""Abaqus and CalculiX decks: regions are element sets, patches are surfaces.

The deck is written here, not by meshio, which names eight-node hexahedra C3D8RH: CalculiX
refuses that.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes.abaqus_deck import Deck
from strutwork.meshes.abaqus_model import DeckModel
from strutwork.meshes.abaqus_types import FACE_ORDER
from strutwork.meshes.cells import CELL_TYPES
from strutwork.meshes.file_mesh import FileMesh
from strutwork.meshes.groups import Group
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.rows import row_groups

Array = NDArray[Any]
Ints = NDArray[np.int64]
ELEMENTS = {"hexahedron": "C3D8", "hexahedron20": "C3D20", "tetra": "C3D4", "tetra10": "C3D10"}
HEADER = re.compile(r"\*\* strutwork mesh: (\d+) nodes, (\d+) cells$")
PER_LINE = 8


def read(path: Path) -> FileMesh:
    """What an .inp file holds.

    Parameters
    ----------
    path : Path
        .inp; what it includes lies in its folder.
    """
    deck = Deck(path)
    model = DeckModel(deck)
    found = model.file_mesh()
    _check_counts(path, deck, len(model.points), sum(len(nodes) for _, nodes in found.solids))
    return found


def write(path: Path, mesh: Mesh, groups: list[Group]) -> None:
    """Write nodes, elements by region, node sets and surfaces; no material, no step.

    Parameters
    ----------
    path : Path
        Overwritten.
    mesh : Mesh
        Points, m, are written as they are.
    groups : list of Group
        As `to_groups` makes them.
    """
    solids = [g for g in groups if g.dimension == 3]
    labels = _labels(mesh, groups)
    cells = sum(len(g.nodes) for g in solids)
    with path.open("w", encoding="utf-8") as file:
        file.write(f"** strutwork mesh: {len(mesh.points)} nodes, {cells} cells\n*NODE\n")
        for i, point in enumerate(mesh.points.tolist(), start=1):
            file.write(f"{i}, " + ", ".join(f"{v:.17g}" for v in point) + "\n")
        first = 1
        for group in solids:
            label = labels[3, group.name]
            file.write(f"*ELEMENT, TYPE={ELEMENTS[group.kind]}, ELSET={label}\n")
            for i, nodes in enumerate((group.nodes + 1).tolist(), start=first):
                file.write("".join(_lines([i, *nodes], ",\n")))
            first += len(group.nodes)
        # elements are numbered region by region
        number = np.argsort(np.argsort(mesh.cell_regions, kind="stable"))
        for name, chosen in mesh.cell_sets.items():
            file.write(f"*ELSET, ELSET={labels[4, name]}\n")
            file.write("".join(_lines(np.sort(number[chosen] + 1).tolist(), "\n")))
        for group in groups:
            if group.dimension == 0:
                file.write(f"*NSET, NSET={labels[0, group.name]}\n")
                file.write("".join(_lines((group.nodes[:, 0] + 1).tolist(), "\n")))
        for name in mesh.patches:
            file.write(f"*SURFACE, NAME={labels[2, name]}, TYPE=ELEMENT\n")
            faces = [g for g in groups if g.dimension == 2 and g.name == name]
            for element, side in _sides(mesh, name, solids, faces):
                file.write(f"{element}, S{side}\n")


def _lines(values: list[int], end: str) -> Iterator[str]:
    """The numbers in lines of eight; a line that goes on ends with `end`, the last plainly."""
    for start in range(0, len(values), PER_LINE):
        last = start + PER_LINE >= len(values)
        row = ", ".join(map(str, values[start : start + PER_LINE]))
        yield row + ("\n" if last else end)


def _labels(mesh: Mesh, groups: list[Group]) -> dict[tuple[int, str], str]:
    """Names without spaces and commas, those of cell sets under 4.

    ModelError where two become one.
    """
    names = [*((g.dimension, g.name) for g in groups), *((4, name) for name in mesh.cell_sets)]
    labels = {(kind, name): re.sub(r"[\s,=*]+", "_", name) for kind, name in names}
    for dimension in (0, 2, 3, 4):
        own = [v.upper() for (d, _), v in labels.items() if d == dimension]
        if len(set(own)) < len(own):
            raise ModelError(
                f"mesh {mesh.name}",
                "two names become one when spaces turn into underscores and case is dropped.",
                "Rename one of them.",
            )
    return labels


def _sides(
    mesh: Mesh, name: str, solids: list[Group], faces: list[Group]
) -> Iterator[tuple[int, int]]:
    """Element number and Abaqus' side of each face of a patch."""
    first = 1
    rows, owners = [], []
    for group in solids:
        type_ = CELL_TYPES[group.kind]
        order = FACE_ORDER[type_.linear_kind]
        corners = np.array(type_.corner_faces)[list(order)]
        rows.append(group.nodes[:, corners].reshape(-1, corners.shape[1]))
        element = first + np.repeat(np.arange(len(group.nodes)), len(order))
        owners.append(np.stack([element, np.tile(np.arange(1, len(order) + 1), len(group.nodes))]))
        first += len(group.nodes)
    for wanted in faces:
        width = CELL_TYPES[wanted.kind].corners
        same = [i for i, r in enumerate(rows) if r.shape[1] == width]
        sides = [rows[i] for i in same]
        count = sum(len(s) for s in sides)
        everything = np.concatenate([*sides, wanted.nodes[:, :width]])
        first_row, group_of = row_groups(everything, cyclic=True)
        match = first_row[group_of[count:]]
        if (match >= count).any():
            raise ModelError(
                f"mesh {mesh.name}, patch {name!r}",
                "has faces that are the outer side of no cell.",
                "Select the patch from the boundary of this mesh.",
            )
        for element, side in np.concatenate([owners[i] for i in same], axis=1)[:, match].T:
            yield int(element), int(side)


def _check_counts(path: Path, deck: Deck, points: int, cells: int) -> None:
    """ModelError where a deck of this package lacks what its first line counts."""
    match = HEADER.match(deck.first_line)
    if match and (int(match[1]), int(match[2])) != (points, cells):
        raise ModelError(
            str(path),
            f"ends at {deck.lines.where} with {points} nodes and {cells} cells; its "
            f"first line counts {match[1]} and {match[2]}.",
            "The file is cut short: export it again.",
        )
