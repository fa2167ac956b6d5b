"""Files of Gmsh, versions 2, 4.0 and 4.1, text and binary: nodes, elements, physical groups.

Read here, not by meshio, which keeps one physical group of an element, and not by Gmsh, which is
under the GPL and need not be installed to read a mesh.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.meshes import limits
from strutwork.meshes.deck_lines import encoding
from strutwork.meshes.gmsh_values import Values

Array = NDArray[Any]
Ints = NDArray[np.int64]
#: Kind and number of nodes by Gmsh's number of the type.
TYPES = {
    1: ("line", 2), 2: ("triangle", 3), 3: ("quad", 4), 4: ("tetra", 4), 5: ("hexahedron", 8),
    6: ("wedge", 6), 7: ("pyramid", 5), 8: ("line3", 3), 9: ("triangle6", 6), 10: ("quad9", 9),
    11: ("tetra10", 10), 12: ("hexahedron27", 27), 13: ("wedge18", 18), 14: ("pyramid14", 14),
    15: ("vertex", 1), 16: ("quad8", 8), 17: ("hexahedron20", 20), 18: ("wedge15", 15),
    19: ("pyramid13", 13), 26: ("line4", 4), 27: ("line5", 5), 28: ("line6", 6),
}  # fmt: skip
#: Gmsh's place of each node of ours, where it is another.
EDGES = (*range(8), 8, 11, 13, 9, 16, 18, 19, 17, 10, 12, 14, 15)
NODE_ORDER = {
    "tetra10": (*range(8), 9, 8),
    "hexahedron20": EDGES,
    "hexahedron27": (*EDGES, 22, 23, 21, 24, 20, 25, 26),
}
PHYSICAL = re.compile(r'^\s*(\d+)\s+(-?\d+)\s+"(.*)"\s*$')


@dataclass
class Cells:
    """Elements of one type: their nodes by number, the groups of the block or of each element.

    Parameters
    ----------
    kind : str
        Of the cells.
    numbers : (m,)
        Of the elements.
    nodes : (m, k)
        Numbers of their nodes.
    entity : (int, int)
        Dimension and tag of the geometric entity, whose groups the block has; version 4.
    physical : (m,) or None
        Group of each element; version 2.
    """

    kind: str
    numbers: Ints
    nodes: Ints
    entity: tuple[int, int] = (0, 0)
    physical: Ints | None = None


@dataclass
class GmshFile:
    """What a file holds.

    Parameters
    ----------
    path : Path
    names : dict of (dimension, number) to str
        Physical groups.
    entities : dict of (dimension, tag) to tuple of int
        Physical groups of each geometric entity, version 4.
    numbers : (n,)
        Of the nodes.
    points : (n, 3)
        In the file's own unit.
    cells : list of Cells
    """

    path: Path
    names: dict[tuple[int, int], str] = field(default_factory=dict)
    entities: dict[tuple[int, int], tuple[int, ...]] = field(default_factory=dict)
    numbers: Ints = field(default_factory=lambda: np.zeros(0, np.int64))
    points: Array = field(default_factory=lambda: np.zeros((0, 3)))
    cells: list[Cells] = field(default_factory=list)


def read_file(path: Path) -> GmshFile:
    """Read a file.

    Parameters
    ----------
    path : Path
        .msh, of ordinary size.

    Raises
    ------
    ModelError
        No file of Gmsh, a version that is not read, a section cut short or with counts that do
        not agree, a mesh in partitions.
    """
    content = limits.read_bytes(path)
    start = content.find(b"$MeshFormat")
    if start < 0:
        old = b"$NOD" in content[:200]
        raise ModelError(
            str(path),
            "is of version 1, which is not read." if old else "has no $MeshFormat.",
            "Export it from Gmsh in version 4.1 or 2.2.",
        )
    version, binary, order, size, position = _format(path, content, start)
    found = GmshFile(path)
    values = Values(path, content, position, binary=binary, order=order)
    seen = set()
    while (
        mark := re.compile(rb"^[ \t]*\$([A-Za-z]\w*)[ \t]*\r?\n", re.MULTILINE).search(
            content, values.position
        )
    ) is not None:
        name = mark[1].decode("ascii")
        values.position = mark.end()
        if name.startswith("End"):
            continue
        if name in {"PartitionedEntities", "Partitioned"}:
            raise ModelError(
                str(path),
                "is a mesh in partitions, which is not read.",
                "Unpartition the mesh in Gmsh, and export it again.",
            )
        if name == "PhysicalNames":
            _names(found, values)
        elif name in READERS:
            reader, what = READERS[name]
            if what in seen:
                raise ModelError(str(path), f"has ${what} twice.", "Export the mesh again.")
            seen.add(what)
            values.open_text(name)
            reader(found, values, version, size)
            values.close()
        else:
            end = content.find(b"$End" + mark[1], values.position)
            values.section = name
            if end < 0:
                raise values.cut()
            values.position = end
    for name in ("Nodes", "Elements"):
        if name not in seen:
            values.section = name
            raise values.cut()
    return found


def _format(path: Path, content: bytes, start: int) -> tuple[float, bool, str, str, int]:
    """Version, whether binary, byte order, kind of a size, where the header ends."""
    match = re.compile(rb"\$MeshFormat\s+([\d.]+)\s+(\d+)\s+(\d+)[ \t]*\r?\n?").match(
        content, start
    )
    if match is None:
        raise ModelError(
            str(path),
            "$MeshFormat is not followed by a version.",
            "The file is cut short or damaged: export it again.",
        )
    version = float(match[1])
    if not (2.0 <= version < 3.0 or version in {4.0, 4.1}):
        raise ModelError(
            str(path),
            f"is of version {match[1].decode()}, which is not read.",
            "Export it from Gmsh in version 4.1 or 2.2.",
        )
    order, position = "<", match.end()
    if match[2] == b"1":
        one = content[position : position + 4]
        if one not in {b"\x01\0\0\0", b"\0\0\0\x01"}:
            raise ModelError(
                str(path),
                "is binary without the number 1 after its version.",
                "The file is cut short or damaged: export it again.",
            )
        order = "<" if one[0] == 1 else ">"
        position += 4
    return version, match[2] == b"1", order, "U" if match[3] == b"4" else "u", position


def _names(found: GmshFile, values: Values) -> None:
    end = values.content.find(b"$EndPhysicalNames", values.position)
    values.section = "PhysicalNames"
    if end < 0:
        raise values.cut()
    body = values.content[values.position : end]
    values.position = end
    lines = [line for line in body.decode(encoding(body)).splitlines() if line.strip()]
    for line in lines[1:]:
        match = PHYSICAL.match(line)
        if match is None:
            raise ModelError(
                str(found.path),
                f"$PhysicalNames holds {line.strip()[:60]!r}.",
                'It should be dimension, number and "name".',
            )
        found.names[int(match[1]), int(match[2])] = match[3]
    if not lines or not lines[0].strip().isdigit() or int(lines[0]) != len(lines) - 1:
        raise values.cut()


def _entities(found: GmshFile, values: Values, version: float, size: str) -> None:
    counts = values.take(4, size)
    for dimension, count in enumerate(counts.tolist()):
        for _ in range(count):
            tag = int(values.take(1)[0])
            values.take(3 if dimension == 0 and version > 4.05 else 6, "d")
            groups = values.take(int(values.take(1, size)[0]))
            # a negative group is the same group, turned
            found.entities[dimension, tag] = tuple(abs(groups).tolist())
            if dimension:
                values.take(int(values.take(1, size)[0]))


def _nodes(found: GmshFile, values: Values, version: float, size: str) -> None:
    if version < 3:
        _nodes_2(found, values)
        return
    head = values.take(4 if version > 4.05 else 2, size)
    limits.check_counts(found.path, int(head[1]))
    numbers, points = [], []
    for _ in range(int(head[0])):
        entity = values.take(3)
        count = int(values.take(1, size)[0])
        # parametric nodes have as many parameters as their entity has dimensions
        dimension = int(entity[0] if version > 4.05 else entity[1])
        width = 3 + (dimension if entity[2] else 0)
        if version > 4.05:
            numbers.append(values.take(count, size))
            points.append(values.take(count * width, "d").reshape(count, width)[:, :3])
        elif values.binary:
            type_ = np.dtype([("n", f"{values.order}i4"), ("x", f"{values.order}f8", (width,))])
            rows = values.records(type_, count)
            numbers.append(rows["n"].astype(np.int64))
            points.append(rows["x"][:, :3].astype(float))
        else:
            table = values.take(count * (1 + width), "d").reshape(count, 1 + width)
            numbers.append(values.whole(table[:, 0]))
            points.append(table[:, 1:4])
    found.numbers = np.concatenate([*numbers, np.zeros(0, np.int64)])
    found.points = np.concatenate([*points, np.zeros((0, 3))])
    if len(found.numbers) != head[1]:
        raise _miscounted(found, "nodes", int(head[1]), len(found.numbers))


def _nodes_2(found: GmshFile, values: Values) -> None:
    count = _count_2(values)
    limits.check_counts(found.path, count)
    if values.binary:
        type_ = np.dtype([("n", f"{values.order}i4"), ("x", f"{values.order}f8", (3,))])
        rows = values.records(type_, count)
        found.numbers, found.points = rows["n"].astype(np.int64), rows["x"].astype(float)
        return
    left = values.left()
    if len(left) != 4 * count:
        raise _miscounted(found, "nodes", count, len(left) / 4)
    table = left.reshape(count, 4)
    found.numbers, found.points = values.whole(table[:, 0]), table[:, 1:]


def _parametric_2(found: GmshFile, values: Values, version: float, size: str) -> None:
    """Nodes with the entity that they lie on, and their parameters on a curve or a surface."""
    del version, size
    count = _count_2(values)
    limits.check_counts(found.path, count)
    numbers, points = [], []
    for _ in range(count):
        numbers.append(values.take(1))
        points.append(values.take(3, "d"))
        dimension = int(values.take(2)[0])
        values.take(dimension if dimension in {1, 2} else 0, "d")
    found.numbers = np.concatenate([*numbers, np.zeros(0, np.int64)])
    found.points = np.array(points, dtype=float).reshape(-1, 3)


def _count_2(values: Values) -> int:
    """The count of a section of version 2, which is text in binary files too."""
    if not values.binary:
        return int(values.take(1)[0])
    match = re.compile(rb"\s*(\d+)[ \t]*\r?\n").match(values.content, values.position)
    if match is None:
        raise values.cut()
    values.position = match.end()
    return int(match[1])


def _elements(found: GmshFile, values: Values, version: float, size: str) -> None:
    if version < 3:
        count = _count_2(values)
        limits.check_counts(found.path, 0, count)
        (_binary_2 if values.binary else _text_2)(found, values, count)
    else:
        head = values.take(4 if version > 4.05 else 2, size)
        count = int(head[1])
        limits.check_counts(found.path, 0, count)
        for _ in range(int(head[0])):
            first, second, type_ = values.take(3).tolist()
            entity = (first, second) if version > 4.05 else (second, first)
            kind, width = _type(found, type_)
            rows = int(values.take(1, size)[0])
            number = size if version > 4.05 else "i"
            table = values.take(rows * (1 + width), number).reshape(rows, 1 + width)
            found.cells.append(Cells(kind, table[:, 0], table[:, 1:], entity))
    read = sum(len(c.numbers) for c in found.cells)
    if read != count:
        raise _miscounted(found, "elements", count, read)


def _binary_2(found: GmshFile, values: Values, count: int) -> None:
    read = 0
    while read < count:
        type_, rows, tags = values.take(3).tolist()
        kind, width = _type(found, type_)
        if rows < 1 or tags < 0:
            raise values.cut()
        table = values.take(rows * (1 + tags + width)).reshape(rows, 1 + tags + width)
        physical = table[:, 1] if tags else np.zeros(rows, np.int64)
        found.cells.append(
            Cells(
                kind, table[:, 0], table[:, 1 + tags :], physical=np.abs(physical).astype(np.int64)
            )
        )
        read += rows


def _text_2(found: GmshFile, values: Values, count: int) -> None:
    flat = values.left()
    at = read = 0
    while read < count:
        if at + 3 > len(flat):
            raise values.cut()
        type_, tags = values.whole(flat[at + 1 : at + 3]).tolist()
        kind, nodes = _type(found, type_)
        width = 3 + tags + nodes
        if tags < 0 or at + width > len(flat):
            raise values.cut()
        rows, chunk = 1, 64
        # rows alike: look ahead in chunks that grow
        while read + rows < count:
            more = min(chunk, count - read - rows, (len(flat) - at) // width - rows)
            if more < 1:
                break
            begin = at + rows * width
            table = flat[begin : begin + more * width].reshape(more, width)
            alike = (table[:, 1] == type_) & (table[:, 2] == tags)
            same = more if alike.all() else int(np.argmin(alike))
            rows += same
            if same < more:
                break
            chunk *= 4
        table = values.whole(flat[at : at + rows * width].reshape(rows, width))
        physical = table[:, 3] if tags else np.zeros(rows, np.int64)
        found.cells.append(
            Cells(
                kind, table[:, 0], table[:, 3 + tags :], physical=np.abs(physical).astype(np.int64)
            )
        )
        at += rows * width
        read += rows
    if at != len(flat):
        raise _miscounted(found, "elements", count, "more")


#: What reads each section, and what the section gives.
READERS: dict[str, tuple[Callable[[GmshFile, Values, float, str], None], str]] = {
    "Entities": (_entities, "Entities"),
    "Nodes": (_nodes, "Nodes"),
    "ParametricNodes": (_parametric_2, "Nodes"),
    "Elements": (_elements, "Elements"),
}


def _type(found: GmshFile, number: int) -> tuple[str, int]:
    if number not in TYPES:
        raise ModelError(
            str(found.path),
            f"has elements of Gmsh's type {number}, which cannot be used.",
            "Mesh in first or second order, with hexahedra or tetrahedra.",
        )
    return TYPES[number]


def _miscounted(found: GmshFile, what: str, wanted: int, read: object) -> ModelError:
    return ModelError(
        str(found.path),
        f"counts {wanted} {what} and holds {read}.",
        "The file is cut short or damaged: export it again.",
    )
