"""VTK's unstructured grids: regions, patches and node sets are masks that ParaView shows.

Read here, not by meshio, which keeps the last of several pieces and unpacks what it is given.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.meshes import limits
from strutwork.meshes.cells import CELL_TYPES
from strutwork.meshes.file_mesh import Block, FileMesh, by_tag
from strutwork.meshes.groups import Group
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.vtk_cells import VtkBlock, blocks
from strutwork.meshes.vtu_arrays import VtuFile, open_vtu

Array = NDArray[Any]
Ints = NDArray[np.int64]
PREFIXES = {3: "region:", 2: "patch:"}
CELLS, NODES = "cells:", "nodes:"
#: Numbers of regions as other programs write them.
TAGS = ("region", "gmsh:physical", "mat_id", "MaterialIds", "CellEntityIds")


def read(path: Path) -> FileMesh:
    """What a .vtu file holds, all its pieces.

    Parameters
    ----------
    path : Path
        .vtu.
    """
    file = open_vtu(path)
    grid = file.root.find("UnstructuredGrid")
    pieces = [] if grid is None else grid.findall("Piece")
    if not pieces:
        raise file.error("holds no piece of a grid.")
    counts = [(_count(file, p, "NumberOfPoints"), _count(file, p, "NumberOfCells")) for p in pieces]
    limits.check_counts(path, sum(p for p, _ in counts), sum(c for _, c in counts))
    points: list[Array] = []
    solids: list[Block] = []
    regions: dict[str, list[Ints]] = {}
    sets: dict[str, list[Ints]] = {}
    faces: dict[str, list[Block]] = {}
    node_sets: dict[str, list[Ints]] = {}
    first_point = first_cell = 0
    for piece, (point_count, cell_count) in zip(pieces, counts, strict=True):
        points.append(_points(file, piece, point_count))
        found = _cells(file, piece, point_count, cell_count)
        data = _data(file, piece.find("CellData"), cell_count)
        for block in found:
            nodes = block.nodes + first_point
            dimension = CELL_TYPES[block.kind].dimension
            for name, own in _named(block, dimension, data).items():
                if dimension == 3:
                    regions.setdefault(name, []).append(first_cell + own)
                else:
                    faces.setdefault(name, []).append((block.kind, nodes[own]))
            if dimension == 3:
                for name, own in _masks(block, data, CELLS).items():
                    sets.setdefault(name, []).append(first_cell + own)
                solids.append((block.kind, nodes))
                first_cell += len(nodes)
        for name, values in _data(file, piece.find("PointData"), point_count).items():
            if name.startswith(NODES):
                node_sets.setdefault(name.removeprefix(NODES), []).append(
                    first_point + np.flatnonzero(values)
                )
        first_point += point_count
    return FileMesh(
        np.concatenate(points),
        solids,
        cell_sets={name: np.concatenate(own) for name, own in sets.items()},
        sections={name: np.concatenate(own) for name, own in regions.items()},
        faces=faces,
        node_sets={name: np.concatenate(own) for name, own in node_sets.items()},
    )


def _count(file: VtuFile, piece: ET.Element, key: str) -> int:
    value = (piece.get(key) or "").strip()
    if not value.isdigit() or len(value) > 18:
        raise file.error(f"has a piece with {key}={value!r}.")
    return int(value)


def _points(file: VtuFile, piece: ET.Element, count: int) -> Array:
    element = piece.find("Points/DataArray")
    if element is None:
        raise file.error("has a piece without points.")
    return file.values(element, 3 * count).reshape(count, 3).astype(float)


def _cells(file: VtuFile, piece: ET.Element, points: int, cells: int) -> list[VtkBlock]:
    arrays = {e.get("Name", ""): e for e in piece.findall("Cells/DataArray")}
    lacking = [n for n in ("connectivity", "offsets", "types") if n not in arrays]
    if lacking:
        raise file.error(f"has a piece without {' and '.join(lacking)} of its cells.")
    types = file.values(arrays["types"], cells).astype(np.int64)
    ends = file.values(arrays["offsets"], cells).astype(np.int64)
    nodes = file.values(arrays["connectivity"]).astype(np.int64)
    return blocks(file.path, nodes, ends, types, points)


def _data(file: VtuFile, parent: ET.Element | None, count: int) -> dict[str, Ints]:
    """Arrays that name regions, patches or node sets; fields are passed over."""
    found = {}
    for element in [] if parent is None else parent.findall("DataArray"):
        name = element.get("Name", "")
        if name in TAGS or name.startswith((*PREFIXES.values(), CELLS, NODES)):
            found[name] = file.values(element, count).astype(np.int64)
    return found


def _named(block: VtkBlock, dimension: int, data: dict[str, Ints]) -> dict[str, Ints]:
    """Cells of a block by the name of their region or patch; masks decide before numbers."""
    prefix = PREFIXES[dimension]
    if any(name.startswith(prefix) for name in data):
        return _masks(block, data, prefix)
    tags = [data[name] for name in TAGS if name in data]
    return by_tag(tags[0][block.cells], {}, prefix.rstrip(":")) if tags else {}


def _masks(block: VtkBlock, data: dict[str, Ints], prefix: str) -> dict[str, Ints]:
    """Cells of a block by the name of each mask that holds some."""
    found = {
        name.removeprefix(prefix): np.flatnonzero(values[block.cells])
        for name, values in data.items()
        if name.startswith(prefix)
    }
    return {name: own for name, own in found.items() if len(own)}


def write(path: Path, mesh: Mesh, groups: list[Group]) -> None:
    """Write each cell once, with a mask for each name; a cell of two sets has two masks.

    Parameters
    ----------
    path : Path
        Overwritten.
    mesh : Mesh
        Points, m, are written as they are.
    groups : list of Group
        As `to_groups` makes them; its faces are used.
    """
    import meshio  # noqa: PLC0415 - half a second that most commands never need

    faces = [g for g in groups if g.dimension == 2]
    cells = [(b.kind, b.nodes) for b in mesh.blocks] + [(g.kind, g.nodes) for g in faces]
    ends = np.cumsum([len(b.nodes) for b in mesh.blocks])[:-1]
    nowhere = [np.zeros(len(g.nodes), np.uint8) for g in faces]
    cell_data = {}
    named = {
        PREFIXES[3] + name: mesh.cell_regions == index for index, name in enumerate(mesh.regions)
    }
    for name, chosen in mesh.cell_sets.items():
        named[CELLS + name] = np.isin(np.arange(mesh.cell_count), chosen)
    for name, mask in named.items():
        cell_data[name] = [*np.split(mask.astype(np.uint8), ends), *nowhere]
    blank = [np.zeros(len(b.nodes), np.uint8) for b in mesh.blocks]
    for name in mesh.patches:
        own = [np.full(len(g.nodes), g.name == name, dtype=np.uint8) for g in faces]
        cell_data[PREFIXES[2] + name] = [*blank, *own]
    masks = {NODES + name: np.zeros(len(mesh.points), np.uint8) for name in mesh.node_sets}
    for name, nodes in mesh.node_sets.items():
        masks[NODES + name][nodes] = 1
    made = meshio.Mesh(mesh.points, cells, point_data=masks, cell_data=cell_data)
    meshio.vtu.write(str(path), made)
