"""Mesh files read and written: .msh, .vtu, .inp, .bdf and .med."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshes import format_abaqus, format_gmsh, format_med, format_nastran, format_vtu
from meshes.groups import Group, from_groups, to_groups
from meshes.mesh import Mesh
from meshes.quality import check_quality
from strutwork.errors import ModelError, StrutworkError
from strutwork.files import write_whole

Array = NDArray[Any]
#: Metres per unit.
UNITS = {"m": 1.0, "mm": 1e-3}
#: Larger files are refused: reading takes some twenty times their size in memory.
LARGEST_FILE = 2 * 1024**3
MOST_POINTS = 50_000_000


@dataclass(frozen=True)
class Format:
    """How one kind of file is read and written, and whether its lines can be counted."""

    read: Callable[[Path], tuple[Array, list[Group]]]
    write: Callable[[Path, Mesh, list[Group]], object]
    kinds: frozenset[str]
    is_text: bool = False


_COMMON = frozenset({
    *("tetra", "tetra10", "hexahedron", "hexahedron20"),
    *("triangle", "triangle6", "quad", "quad8", "vertex"),
})  # fmt: skip
_ALL = _COMMON | {"hexahedron27", "quad9"}
FORMATS = {
    ".msh": Format(format_gmsh.read, format_gmsh.write, _ALL),
    ".vtu": Format(format_vtu.read, format_vtu.write, _ALL),
    ".inp": Format(format_abaqus.read, format_abaqus.write, _COMMON, is_text=True),
    ".bdf": Format(format_nastran.read, format_nastran.write, _COMMON, is_text=True),
    ".med": Format(format_med.read, format_med.write, _COMMON),
}


def read_mesh(path: Path | str, unit: str = "m", *, check: bool = True) -> Mesh:
    """Read a solid mesh.

    What each format keeps: .msh and .vtu everything; .med everything, with names in ASCII;
    .inp everything, with spaces in names turned into underscores; .bdf regions and patches,
    no node sets.

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
        A file that is missing, empty, cut short, too large or of another format; cells that
        cannot be used; inverted cells, with their count and place.
    """
    path = Path(path)
    scale = _scale(path, unit)
    chosen = _format(path)
    _check_file(path)
    try:
        # meshio prints warnings; what matters becomes an error here
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            points, groups = chosen.read(path)
    except StrutworkError:
        raise
    except Exception as error:
        raise _unreadable(path, chosen, error) from error
    if len(points) > MOST_POINTS:
        raise ModelError(
            str(path), f"has {len(points)} points; {MOST_POINTS} is the limit.", "Mesh coarser."
        )
    if not len(points):
        raise ModelError(str(path), "holds no points.", "Export the mesh again.")
    try:
        mesh = from_groups(np.asarray(points, dtype=float) * scale, groups, path.name)
    except ModelError as error:
        raise ModelError(str(path), f"{error.part}: {error.problem}", error.remedy) from error
    if check:
        check_quality(mesh)
    return mesh


def write_mesh(mesh: Mesh, path: Path | str, unit: str = "m") -> Path:
    """Write a mesh; `read_mesh` says what each format keeps.

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
    if suffix not in FORMATS:
        raise ModelError(
            str(path),
            f"the suffix {suffix!r} is none of a mesh file.",
            f"Use {', '.join(FORMATS)}; STL, OBJ and glTF are surfaces (`meshes.surfaces`).",
        )
    return FORMATS[suffix]


def _check_file(path: Path) -> None:
    if not path.is_file():
        raise ModelError(str(path), "there is no such file.", "Check the path.")
    size = path.stat().st_size
    if size == 0:
        raise ModelError(str(path), "the file is empty.", "Export the mesh again.")
    if size > LARGEST_FILE:
        raise ModelError(
            str(path),
            f"the file has {size / 1024**3:.1f} GiB; {LARGEST_FILE / 1024**3:g} GiB is the limit.",
            "Mesh coarser, or export one body at a time.",
        )


def _unreadable(path: Path, chosen: Format, error: Exception) -> ModelError:
    why = " ".join(str(error).split()) or type(error).__name__
    where = ""
    if chosen.is_text:
        with path.open(encoding="utf-8", errors="replace") as file:
            count, last = 0, ""
            for line in file:
                count, last = count + 1, line.strip() or last
        where = f" The file ends at line {count} with {last[:60]!r}."
    return ModelError(
        str(path),
        f"cannot be read as {path.suffix.lower()}: {why[:200]}.{where}",
        "The file is cut short or damaged, or of another format: export it again.",
    )


def _check_kinds(path: Path, groups: Sequence[Group], chosen: Format) -> None:
    unknown = sorted({g.kind for g in groups} - chosen.kinds)
    if unknown:
        raise ModelError(
            str(path),
            f"{path.suffix} files cannot hold cells of type {', '.join(unknown)}.",
            "Write .msh or .vtu, or use serendipity cells (`quadratic(mesh, serendipity=True)`).",
        )
