"""Meshes of the solids of a model file: read, filled with tetrahedra, or generated."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from math import ceil, pi, prod
from pathlib import Path
from typing import TypeVar

import numpy as np

from strutwork.errors import ModelError, ModelWarning, StrutworkError
from strutwork.machines.model_solid_schema import SolidTable
from strutwork.machines.part_files import part_file
from strutwork.meshes.curves import is_straight
from strutwork.meshes.gmsh_volumes import VOLUME_ERROR, tetrahedra
from strutwork.meshes.grading import lines_through
from strutwork.meshes.grids import grid
from strutwork.meshes.l_frame import l_frame
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.mesh_files import read_mesh
from strutwork.meshes.order import linear
from strutwork.meshes.quality import cell_volumes, check_quality
from strutwork.meshes.selection import Box, patches
from strutwork.meshes.surfaces import read_surface
from strutwork.meshes.tube import tube

Value = TypeVar("Value")

#: Generated meshes of more cells are refused.
MAX_CELLS = 200_000

#: Cells around a tube, by the order: of straight ones the section is a polygon, 0.8 % short of
#: the ring with these.
LEAST_AROUND = {1: 28, 2: 24}

#: How far a face may stand out of a box, as a share of the mesh's diagonal.
BOX_SLACK = 1e-6

SOURCES = ("mesh", "step", "surface", "shape")

#: What each source needs, and what it may have.
KEYS: dict[str, tuple[tuple[str, ...], tuple[str, ...]]] = {
    "mesh": ((), ("unit",)),
    "step": (("cell",), ()),
    "surface": (("cell",), ("unit",)),
    "block": (("size", "cell"), ()),
    "l_frame": (("envelope", "plate", "base", "cell"), ()),
    "tube": (("inner_diameter", "outer_diameter", "length", "cell"), ()),
}


def field_of(table: SolidTable) -> str:
    """Path of a solid's table in messages.

    Parameters
    ----------
    table : SolidTable
    """
    return f"solids.{table.name}"


@contextmanager
def at_field(field: str) -> Iterator[None]:
    """Errors of lower packages, raised as errors of a field of the file.

    Parameters
    ----------
    field : str
        Its path in the file, as in `solids.frame.mesh`.
    """
    try:
        yield
    except StrutworkError as error:
        raise type(error)(field, f"{error.part}: {error.problem}", error.remedy) from error


def check_source(table: SolidTable) -> str:
    """The source of a solid's mesh: mesh, step, surface, or the name of its shape.

    Parameters
    ----------
    table : SolidTable

    Raises
    ------
    ModelError
        None or several of them, a key that is missing, or one of another source.
    """
    field = field_of(table)
    given = [name for name in SOURCES if getattr(table, name) is not None]
    if len(given) != 1:
        raise ModelError(
            field,
            f"has {' and '.join(given) or 'no mesh'}.",
            f"Give exactly one of {', '.join(SOURCES)}.",
        )
    source = table.shape or given[0]
    needed, allowed = KEYS[source]
    for key in needed:
        if getattr(table, key) is None:
            raise ModelError(f"{field}.{key}", "is missing.", f"A {source} needs it.")
    others = {key for keys in KEYS.values() for group in keys for key in group}
    for key in sorted(others - {*needed, *allowed}):
        if getattr(table, key) is not None:
            raise ModelError(
                f"{field}.{key}",
                f"is not a key of a {source}.",
                f"A {source} has: {', '.join((*needed, *allowed)) or 'no further keys'}.",
            )
    return source


def solid_mesh(table: SolidTable, folder: Path) -> Mesh:
    """The mesh of a solid in its own frame, with a patch for every interface.

    Mesh lines of a block and of an l_frame fall on the edges of the interfaces' boxes. Curved
    cells stay so where the order is 2; else their corners are kept. A patch found by a box is
    named as `patch_name` says.

    Parameters
    ----------
    table : SolidTable
    folder : Path
        Where relative names of files begin.

    Returns
    -------
    Mesh

    Raises
    ------
    ModelError
        A file that is missing, too large, damaged or outside the folder, inverted cells, an
        unknown patch, a box without a face; names the field.

    Warns
    -----
    ModelWarning
        Straight edges, of order 1, take more than 1 % of the volume of curved cells; with the
        size that reaches it.
    UserWarning
        Of a STEP file, as `tetrahedra`.
    """
    source = check_source(table)
    field = field_of(table)
    if source == "mesh" and table.mesh is not None:
        path = part_file(table.mesh, folder, f"{field}.mesh")
        with at_field(f"{field}.mesh"):
            # of order 1 curves are dropped, and inverted cells that they make with them
            mesh = read_mesh(path, table.unit or "m", check=table.order == 2)
    elif source == "step" and table.step is not None:
        path = part_file(table.step, folder, f"{field}.step")
        with at_field(f"{field}.step"):
            mesh = tetrahedra(path, _given(table.cell))
    elif source == "surface" and table.surface is not None:
        path = part_file(table.surface, folder, f"{field}.surface")
        with at_field(f"{field}.surface"):
            mesh = tetrahedra(read_surface(path, table.unit or "m"), _given(table.cell))
    else:
        with at_field(field):
            mesh = _generated(table)
    with at_field(field):
        if any(b.type.order > 1 for b in mesh.blocks):
            mesh = _of_order(table, mesh)
    return _with_patches(table, mesh)


def _of_order(table: SolidTable, mesh: Mesh) -> Mesh:
    """Quadratic cells where they are curved and the order is 2, else those of their corners."""
    if table.order == 2:
        return linear(mesh) if is_straight(mesh) else mesh
    corners = linear(mesh)
    check_quality(corners)
    _warn_of_lost_volume(table, *(float(cell_volumes(m).sum()) for m in (mesh, corners)))
    return corners


def _warn_of_lost_volume(table: SolidTable, curved: float, straight: float) -> None:
    """Warn where straight cells hold another volume than the curved ones they come from."""
    error = straight / curved - 1.0
    if abs(error) <= VOLUME_ERROR:
        return
    # chords err by the square of their length
    finer = 0.9 * (VOLUME_ERROR / abs(error)) ** 0.5
    size = (
        f"Mesh it {1.0 / finer:.2g} times finer to reach 1 %"
        if table.cell is None
        else f"Cells of {finer * table.cell:.2g} m should reach 1 %"
    )
    warnings.warn(
        f"{field_of(table)}: the edges of its cells are straight, and its volume {straight:.5g} m³ "
        f"is {100 * error:+.1f} % off the {curved:.5g} m³ of its curved faces; mass, stiffness and "
        f"frequencies are of that order. {size}; order = 2 keeps the curves.",
        ModelWarning,
        stacklevel=3,
    )


def patch_name(table: SolidTable, index: int) -> str:
    """Name of the patch of an interface: the file's, or that of its box.

    Parameters
    ----------
    table : SolidTable
    index : int
        Of the interface in the table, counted from zero.
    """
    named = table.interfaces[index].patch
    return f"interface {index + 1}" if named is None else named


def _generated(table: SolidTable) -> Mesh:
    cell, name = _given(table.cell), table.name
    if table.shape == "block":
        size = _given(table.size)
        _check_count(size, cell)
        x, y, z = (
            lines_through((0.0, length, *inner), cell)
            for length, inner in zip(size, _box_stops(table, size), strict=True)
        )
        return grid(x, y, z, name=name)
    if table.shape == "l_frame":
        envelope = _given(table.envelope)
        _check_count(envelope, cell)
        further = dict(zip("xyz", _box_stops(table, envelope), strict=True))
        plate, base = _given(table.plate), _given(table.base)
        return l_frame(envelope, plate, base, size=cell, stops=further, name=name)
    inner, outer = _given(table.inner_diameter) / 2.0, _given(table.outer_diameter) / 2.0
    around = max(LEAST_AROUND[table.order] * cell, 2.0 * pi * outer)
    lengths = (outer - inner, around, _given(table.length))
    _check_count(lengths, cell)
    # a length that is a whole number of cells must not gain one by rounding
    divisions = [max(1, ceil(length / cell * (1.0 - 1e-9))) for length in lengths]
    return tube(inner, outer, lengths[2], divisions, order=table.order, name=name)


def _given(value: Value | None) -> Value:
    """A value that `check_source` has asked for."""
    if value is None:
        raise ModelError("shape", "lacks a size.", "Give all sizes of the shape.")
    return value


def _check_count(lengths: Sequence[float], cell: float) -> None:
    count = prod(max(1.0, length / cell) for length in lengths)
    if count > MAX_CELLS:
        raise ModelError(
            "cell",
            f"{cell:g} m makes about {count:.2g} cells; {MAX_CELLS} is the limit.",
            "Choose larger cells, or check the unit.",
        )


def _box_stops(table: SolidTable, lengths: Sequence[float]) -> list[list[float]]:
    """Coordinates inside the envelope at which boxes of interfaces begin and end, by axis."""
    boxes = [i.box for i in table.interfaces if i.box is not None]
    return [
        sorted({corner[axis] for box in boxes for corner in box if 0.0 < corner[axis] < length})
        for axis, length in enumerate(lengths)
    ]


def _with_patches(table: SolidTable, mesh: Mesh) -> Mesh:
    # an STL has single precision, and so may a mesh file's author
    slack = BOX_SLACK * float(np.linalg.norm(mesh.extent))
    for i, interface in enumerate(table.interfaces):
        field = f"{field_of(table)}.interfaces[{i}]"
        if interface.patch is not None:
            with at_field(f"{field}.patch"):
                mesh.patch(interface.patch)
        elif interface.box is not None:
            low, high = interface.box
            if any(a > b for a, b in zip(low, high, strict=True)):
                raise ModelError(
                    f"{field}.box",
                    f"begins at {list(low)} m and ends at {list(high)} m, below it.",
                    "Give the lowest corner first.",
                )
            box: Box = (
                [v - slack for v in low],
                [v + slack for v in high],
                interface.normal,
            )
            with at_field(f"{field}.box"):
                mesh = patches(mesh, {patch_name(table, i): box})
    return mesh
