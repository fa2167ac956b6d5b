"""Reading universal files, with every fault and everything left out named.

pyuff writes the files (`uff_write`). They are read here: it loses coordinate systems of nodes and
names of components, takes a record that ends in -1 for the end of a data set and reports every
fault with the same words.
"""

from __future__ import annotations

import stat
from collections.abc import Mapping
from pathlib import Path

from strutwork.errors import ModelError
from strutwork.fea.uff import UniversalFile
from strutwork.fea.uff_functions import RawFunction, named_functions, raw_function
from strutwork.fea.uff_geometry import Geometry
from strutwork.fea.uff_sets import DataSet, data_sets
from strutwork.fea.uff_shapes import RawMode, global_modes, raw_mode
from strutwork.fea.uff_units import FileUnits, file_units

#: A larger file is refused, bytes.
MAX_BYTES = 200_000_000

_SYSTEMS = (18, 2420)
_NODES = (15, 2411)
_GROUPS = (2467, 2477)
_SHAPES = (55, 2414)

#: Data sets that hold nothing to use: the header, and units of drawing.
_SILENT = (151,)

_SEE = "Export functions (58) or modes (55, 2414) as a universal file."


def read_universal(path: str | Path, units: Mapping[str, str] | None = None) -> UniversalFile:
    """Read frequency response functions, modes and nodes of a universal file.

    Parameters
    ----------
    path : str or Path
        200 MB at most.
    units : mapping of str to str
        Units of axis labels that are not known, as in `{"EU": "mm/s^2"}`.

    Returns
    -------
    UniversalFile
        In SI units and global directions. Units are those of data set 164, and those of axis
        labels that name others; shapes and functions in coordinate systems of their nodes (2420,
        18) and in negative directions are turned. Nodes bear the names of groups of one node
        (2467), else their numbers, with the component before it where several have that number.

    Raises
    ------
    ModelError
        The file cannot be read, is no universal file, is cut short, holds a number that is not
        finite, a label whose unit is not known, or neither a function nor a mode.
    """
    path = Path(path)
    data = _content(path)
    sets, outside = data_sets(data, str(path))
    if not sets:
        what = "binary data" if b"\0" in data[:4096] else "text"
        raise ModelError(
            str(path), f"is not a universal file: it is {what} without a line of    -1.", _SEE
        )
    scales, notes = _units(sets)
    notes += outside
    geometry = _geometry(sets, scales)
    ignored: list[str] = []
    functions: list[RawFunction] = []
    modes: list[RawMode] = []
    given = {label.strip(): unit for label, unit in (units or {}).items()}
    for source, scale in zip(sets, scales, strict=True):
        if source.kind == 58:
            function = raw_function(source, scale, given)
            if isinstance(function, str):
                ignored.append(function)
            else:
                functions.append(function)
        elif source.kind in _SHAPES:
            mode = raw_mode(source)
            if isinstance(mode, str):
                ignored.append(mode)
            else:
                modes.append(mode)
        elif source.kind not in (*_SYSTEMS, *_NODES, *_GROUPS, *_SILENT, 82, 164, 2412):
            ignored.append(f"data set {source.kind}")
    records, left = named_functions(functions, geometry)
    shapes, said = global_modes(modes, geometry)
    ignored += left
    if not records and not shapes:
        held = ", ".join(dict.fromkeys(ignored)) or "nodes and units"
        raise ModelError(str(path), f"contains no function and no mode, only {held}.", _SEE)
    return UniversalFile(
        tuple(records),
        tuple(shapes),
        {geometry.name(number): place for number, place in geometry.places.items()},
        tuple((geometry.name(a), geometry.name(b)) for a, b in geometry.lines),
        tuple(ignored),
        tuple(dict.fromkeys([*notes, *geometry.notes, *said])),
    )


def _units(sets: tuple[DataSet, ...]) -> tuple[list[FileUnits], list[str]]:
    """Units in force for each data set: those of the last 164 before it, else of the first."""
    read = {i: file_units(s) for i, s in enumerate(sets) if s.kind == 164}
    notes = [note for _, note in read.values() if note]
    if not read:
        notes.append("no units (164): lengths are assumed in m, forces in N")
    elif len({(u.length, u.force) for u, _ in read.values()}) > 1:
        notes.append("several units (164): each applies to the data that follow it")
    now = next((units for units, _ in read.values()), FileUnits())
    scales = []
    for i in range(len(sets)):
        now = read[i][0] if i in read else now
        scales.append(now)
    return scales, notes


def _geometry(sets: tuple[DataSet, ...], scales: list[FileUnits]) -> Geometry:
    geometry = Geometry()
    # places of data set 15 stand in systems that may follow
    for source, units in zip(sets, scales, strict=True):
        if source.kind in _SYSTEMS:
            geometry.add_systems(source, units.length)
    for source, units in zip(sets, scales, strict=True):
        if source.kind in _NODES:
            geometry.add_nodes(source, units.length)
        elif source.kind == 2412:
            geometry.add_elements(source)
        elif source.kind == 82:
            geometry.add_trace(source)
        elif source.kind in _GROUPS:
            geometry.add_groups(source)
    return geometry


def _content(path: Path) -> bytes:
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise ModelError(str(path), "is not an ordinary file.", "Name a universal file.")
        if status.st_size > MAX_BYTES:
            raise ModelError(
                str(path),
                f"has {status.st_size / 1e6:.0f} MB, more than the {MAX_BYTES / 1e6:.0f} MB that "
                "are read.",
                "Export fewer functions or lines.",
            )
        data = path.read_bytes()
    except FileNotFoundError:
        raise ModelError(str(path), "does not exist.", "Check the path.") from None
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise ModelError(str(path), f"cannot be read ({reason}).", "Check the path.") from None
    if not data.strip():
        raise ModelError(str(path), "is empty.", _SEE)
    return data
