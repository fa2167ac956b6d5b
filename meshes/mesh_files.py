"""Mesh files read and written: .msh, .vtu, .inp, .bdf and .med."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from strutwork.errors import ModelError
from strutwork.files import write_whole
from strutwork.meshes import (
    format_abaqus,
    format_gmsh,
    format_med,
    format_nastran,
    format_vtu,
    limits,
)
from strutwork.meshes.file_mesh import FileMesh
from strutwork.meshes.groups import Group, to_groups
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.quality import check_quality

#: Metres per unit.
UNITS = {"m": 1.0, "mm": 1e-3}


@dataclass(frozen=True)
class Format:
    """How one kind of file is read and written, and the kinds of cells that it holds.

    Parameters
    ----------
    read : callable
        From the path to what the file holds.
    write : callable
        Given the path, the mesh and its groups.
    kinds : frozenset of str
        Kinds of cells that it holds.
    """

    read: Callable[[Path], FileMesh]
    write: Callable[[Path, Mesh, list[Group]], object]
    kinds: frozenset[str]


_COMMON = frozenset({
    *("tetra", "tetra10", "hexahedron", "hexahedron20"),
    *("triangle", "triangle6", "quad", "quad8", "vertex"),
})  # fmt: skip
_ALL = _COMMON | {"hexahedron27", "quad9"}
FORMATS = {
    ".msh": Format(format_gmsh.read, format_gmsh.write, _ALL),
    ".vtu": Format(format_vtu.read, format_vtu.write, _ALL),
    ".inp": Format(format_abaqus.read, format_abaqus.write, _COMMON),
    ".bdf": Format(format_nastran.read, format_nastran.write, _COMMON),
    ".med": Format(format_med.read, format_med.write, _COMMON),
}
#: Formats that are known and refused: why, and what to do.
OTHERS = {
    ".vtk": (
        "is a legacy file of VTK, which is not read: it may name neither regions nor patches.",
        "Save it as .vtu, in ParaView by File, Save Data.",
    ),
}


def read_mesh(path: Path | str, unit: str = "m", *, check: bool = True) -> Mesh:
    """Read a solid mesh.

    What the file holds is counted against what was read; what is not understood is an error
    that names it, with its line where the file has lines. What each format keeps: .msh and .vtu
    everything; .med everything, with names in ASCII; .inp everything, with spaces in names
    turned into underscores; .bdf regions and patches, no node sets and no cell sets. Points that
    no cell uses are dropped, and faces of patches turned outwards.

    Parameters
    ----------
    path : Path or str
    unit : str
        Of the coordinates: `m` or `mm`. Mesh files carry none.
    check : bool
        Refuse inverted cells; False only to look at their quality.

    Returns
    -------
    Mesh
        In m, named after the file.

    Raises
    ------
    ModelError
        A file that is missing, empty, cut short, of another format, or larger than the limits
        of `strutwork.meshes.limits`; what is not understood; cells that cannot be used; inverted
        cells, with their count and place.
    """
    path = Path(path)
    scale = _scale(path, unit)
    chosen = _format(path)
    try:
        found = chosen.read(path)
        limits.check_counts(path, len(found.points), sum(len(nodes) for _, nodes in found.solids))
        mesh = found.to_mesh(path.name, scale)
    except ModelError as error:
        if error.part == str(path):
            raise
        raise ModelError(str(path), f"{error.part}: {error.problem}", error.remedy) from error
    except Exception as error:
        why = " ".join(str(error).split()) or type(error).__name__
        raise ModelError(
            str(path),
            f"cannot be read as {path.suffix.lower()}: {why[:200]}.",
            "The file is damaged or of another format: export it again.",
        ) from error
    if check:
        check_quality(mesh)
    return mesh


def write_mesh(mesh: Mesh, path: Path | str, unit: str = "m") -> Path:
    """Write a mesh; `read_mesh` lists what each format stores.

    Parameters
    ----------
    mesh : Mesh
    path : Path or str
        Its suffix chooses the format.
    unit : str
        Unit to write the coordinates in: `m` or `mm`.

    Raises
    ------
    ModelError
        An unknown suffix or unit, cells or names that the format cannot hold, a folder that
        cannot be written. Nothing is left behind.
    """
    path = Path(path)
    scale = _scale(path, unit)
    chosen = _format(path)
    groups = to_groups(mesh)
    _check_kinds(path, groups, chosen)
    scaled = replace(mesh, points=mesh.points / scale)

    def write(temporary: Path) -> None:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            chosen.write(temporary, scaled, groups)

    return write_whole(path, write)


def _scale(path: Path, unit: str) -> float:
    if unit not in UNITS:
        raise ModelError(
            str(path), f"its unit is given as {unit!r}.", f"Choose {' or '.join(UNITS)}."
        )
    return UNITS[unit]


def _format(path: Path) -> Format:
    suffix = path.suffix.lower()
    if suffix in OTHERS:
        raise ModelError(str(path), *OTHERS[suffix])
    if suffix not in FORMATS:
        raise ModelError(
            str(path),
            f"the suffix {suffix!r} is not that of a supported mesh file.",
            f"Use {', '.join(FORMATS)} (ParaView and Gmsh save other formats as these); "
            "STL, OBJ and glTF are surfaces (`strutwork.meshes.surfaces`).",
        )
    return FORMATS[suffix]


def _check_kinds(path: Path, groups: Sequence[Group], chosen: Format) -> None:
    unknown = sorted({g.kind for g in groups} - chosen.kinds)
    if unknown:
        raise ModelError(
            str(path),
            f"{path.suffix} files cannot hold cells of type {', '.join(unknown)}.",
            "Write .msh or .vtu, or use serendipity cells (`quadratic(mesh, serendipity=True)`).",
        )
