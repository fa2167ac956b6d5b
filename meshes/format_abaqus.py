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

from meshes.cells import CELL_TYPES
from meshes.groups import Group, dimension_of
from meshes.mesh import Mesh
from meshes.rows import row_groups
from strutwork.errors import ModelError

Array = NDArray[Any]
Ints = NDArray[np.int64]
ELEMENTS = {"hexahedron": "C3D8", "hexahedron20": "C3D20", "tetra": "C3D4", "tetra10": "C3D10"}
#: Our faces in the order of Abaqus' S1, S2, …
FACE_ORDER = {"hexahedron": (4, 5, 2, 1, 3, 0), "tetra": (0, 1, 2, 3)}
HEADER = re.compile(r"^\*\* strutwork mesh: (\d+) nodes, (\d+) cells$", re.MULTILINE)
PER_LINE = 8
#: An element, or a set of them, and the number of the side.
Side = tuple[str, int]


def read(path: Path) -> tuple[Array, list[Group]]:
    """Points and groups of an .inp file. A cell of several sets belongs to the smallest."""
    import meshio  # noqa: PLC0415 - half a second that most commands never need

    found = meshio.abaqus.read(str(path))
    text = path.read_text(encoding="utf-8", errors="replace")
    blocks = [(b.type, np.asarray(b.data, dtype=np.int64)) for b in found.cells]
    _check_counts(path, text, len(found.points), sum(len(n) for _, n in blocks))
    groups: list[Group] = []
    for i, (kind, nodes) in enumerate(blocks):
        dimension = dimension_of(kind)
        if dimension == 1:
            continue
        sets = {name: np.asarray(own[i], dtype=np.int64) for name, own in found.cell_sets.items()}
        if dimension == 2:
            groups += [Group(n, 2, kind, nodes[own]) for n, own in sets.items() if len(own)]
            continue
        label = np.full(len(nodes), -1)
        names = list(sets)
        # the smallest set last, so that it has the last word
        for name in sorted(names, key=lambda n: -sum(len(s) for s in found.cell_sets[n])):
            label[sets[name]] = names.index(name)
        for index in np.unique(label):
            name = names[index] if index >= 0 else "solid"
            groups.append(Group(name, 3, kind, nodes[label == index]))
    groups += [
        Group(name, 0, "vertex", np.asarray(nodes, dtype=np.int64)[:, None])
        for name, nodes in found.point_sets.items()
    ]
    return np.asarray(found.points), groups + _surfaces(text, blocks)


def write(path: Path, mesh: Mesh, groups: list[Group]) -> None:
    """Write nodes, elements by region, node sets and surfaces; no material, no step."""
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
    """Names without spaces and commas; ModelError where two become one."""
    labels = {(g.dimension, g.name): re.sub(r"[\s,=*]+", "_", g.name) for g in groups}
    for dimension in (0, 2, 3):
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


def _surfaces(text: str, blocks: list[tuple[str, Ints]]) -> list[Group]:
    """The patches that the deck's element surfaces make."""
    numbers, surfaces, sets = _scan(text)
    places = {}
    for b, ((_, nodes), found) in enumerate(zip(blocks, numbers, strict=False)):
        width = nodes.shape[1] + 1
        places.update({number: (b, row) for row, number in enumerate(found[::width])})
    groups = []
    for name, rows in surfaces.items():
        chosen: dict[tuple[int, int], list[int]] = {}
        for owner, side in rows:
            elements = [int(owner)] if owner.isdigit() else sets.get(owner.upper(), [])
            for element in elements:
                block, row = places[element]
                chosen.setdefault((block, side), []).append(row)
        for (block, side), cells in chosen.items():
            kind, nodes = blocks[block]
            type_ = CELL_TYPES[kind]
            face = FACE_ORDER[type_.linear_kind][side - 1]
            groups.append(Group(name, 2, type_.face_kind, nodes[cells][:, type_.faces[face]]))
    return groups


def _scan(
    text: str,
) -> tuple[list[list[int]], dict[str, list[tuple[str, int]]], dict[str, list[int]]]:
    """Integers of each element block, rows of each surface, elements of each set."""
    numbers: list[list[int]] = []
    surfaces: dict[str, list[Side]] = {}
    sets: dict[str, list[int]] = {}
    keyword, name = "", ""
    for line in text.splitlines():
        if line.startswith("**") or not line.strip():
            continue
        fields = [field.strip() for field in line.split(",")]
        if line.startswith("*"):
            keyword = fields[0].upper()
            given = dict(f.split("=", 1) for f in fields[1:] if "=" in f)
            options = {k.strip().upper(): v.strip() for k, v in given.items()}
            name = options.get("NAME", options.get("ELSET", ""))
            if keyword == "*ELEMENT":
                numbers.append([])
            elif keyword == "*SURFACE" and options.get("TYPE", "ELEMENT").upper() == "ELEMENT":
                surfaces[name] = []
            elif keyword == "*SURFACE":
                keyword = ""
        elif keyword == "*ELEMENT":
            numbers[-1] += [int(field) for field in fields if field]
        elif keyword == "*ELSET":
            sets.setdefault(name.upper(), []).extend(int(f) for f in fields if f.isdigit())
        elif keyword == "*SURFACE" and fields[1][:1].upper() == "S" and fields[1][1:].isdigit():
            surfaces[name].append((fields[0], int(fields[1][1:])))
    return numbers, surfaces, sets


def _check_counts(path: Path, text: str, points: int, cells: int) -> None:
    """ModelError where a deck of ours lacks what its first line counts."""
    match = HEADER.search(text)
    if match and (int(match[1]), int(match[2])) != (points, cells):
        raise ModelError(
            str(path),
            f"ends at line {len(text.splitlines())} with {points} nodes and {cells} cells; its "
            f"first line counts {match[1]} and {match[2]}.",
            "The file is cut short: export it again.",
        )
