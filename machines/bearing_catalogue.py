"""Bearings and guides by name: of the model file, of a catalogue beside it, of the package."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

from pydantic import ValidationError

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.joint import JOINT_TYPES
from strutwork.machines.bearing_entry import BearingEntry, entry_of
from strutwork.machines.model_bearing_schema import BearingTable, CatalogueTable
from strutwork.machines.model_errors import model_error
from strutwork.machines.model_file import file_text, toml_of
from strutwork.machines.model_parts import Borne, by_direction
from strutwork.machines.model_schema import JointTable, ModelTable
from strutwork.machines.part_files import part_file
from strutwork.names import choices

#: Generic entries, each with its source.
LIBRARY = Path(__file__).with_name("data") / "bearings.toml"

PAGE = "docs/how-to/bearings.md"

#: What the package's own catalogue is called.
PACKAGE = "the package"


def read_catalogue(path: str | Path) -> dict[str, BearingTable]:
    """The tables of a catalogue file, `[bearings.NAME]` each.

    Parameters
    ----------
    path : str or Path
        TOML.

    Raises
    ------
    ModelError
        The file cannot be read, a key is unknown, or an entry has no source.
    UnitError
        A quantity of another dimension than its field.
    """
    data = toml_of(file_text(Path(path), "catalogue of bearings"), str(path), PAGE)
    try:
        return CatalogueTable.model_validate(data).bearings
    except ValidationError as error:
        raise model_error(error, data, str(path), CatalogueTable, PAGE) from None


@lru_cache(maxsize=1)
def package_catalogue() -> dict[str, BearingEntry]:
    """The entries of the package by name."""
    tables = read_catalogue(LIBRARY)
    return {name: entry_of(name, table, PACKAGE) for name, table in tables.items()}


def joint_bearings(tables: ModelTable, folder: Path = Path()) -> dict[str, BearingEntry]:
    """The entry of every joint that names one.

    An entry of the model file goes before one of its catalogue, and that before the package's.

    Parameters
    ----------
    tables : ModelTable
    folder : Path
        Of the model file: where the name of its catalogue begins.

    Returns
    -------
    dict of joint to BearingEntry

    Raises
    ------
    ModelError
        An unknown name; a catalogue outside the folder or wrong; an entry that cannot be.
    """
    known: dict[str, BearingEntry] = dict(package_catalogue())
    if tables.catalogue is not None:
        path = part_file(tables.catalogue, folder, "catalogue")
        for name, table in read_catalogue(path).items():
            known[name] = entry_of(name, table, tables.catalogue)
    for name, table in tables.bearings.items():
        known[name] = entry_of(name, table, "the model file")
    found = {}
    for joint in tables.joints:
        if joint.bearing is None:
            continue
        if joint.bearing not in known:
            raise ModelError(
                f"joint {joint.name}",
                f'names the unknown bearing "{joint.bearing}".',
                choices("Known", joint.bearing, known, 8),
            )
        found[joint.name] = known[joint.bearing]
    return found


def borne_stiffness(table: JointTable, entry: BearingEntry) -> Borne:
    """What a bearing at its preload makes of a joint.

    Parameters
    ----------
    table : JointTable
    entry : BearingEntry

    Raises
    ------
    ModelError
        The bearing resists where the joint is free or driven, or where the table gives a stiffness;
        the joint has a matrix or a flexure.
    """
    part = f"joint {table.name}"
    own = by_direction(table.stiffness)
    for other in ("matrix", "flexure"):
        if getattr(table, other) is not None:
            raise ModelError(part, f"has a bearing and a {other}.", "Keep one of the two.")
    twice = [d for d in entry.held if d in own]
    if twice:
        raise ModelError(
            part,
            f"has a stiffness in {', '.join(twice)} beside that of its bearing {entry.name}.",
            "Leave it out, or the bearing.",
        )
    moved = [d for d in entry.held if d in table.driven]
    if moved:
        raise ModelError(
            part,
            f"drives {', '.join(moved)}, where its bearing {entry.name} resists.",
            "Drive a direction in which it is free.",
        )
    held = DIRECTIONS if table.type == "bushing" else JOINT_TYPES[table.type]
    free = [d for d in entry.held if d not in held]
    if free:
        fits = [t for t, locked in JOINT_TYPES.items() if locked and set(entry.held) <= set(locked)]
        raise ModelError(
            part,
            f"is {table.type} and free in {', '.join(free)}, where its bearing {entry.name} "
            "resists.",
            f"The bearing fits joints of the type {' or '.join(fits)}.",
        )
    if entry.bearing is None:
        return Borne(entry.name, own | dict(entry.given), None)
    matrix = entry.stiffness.copy()
    for direction, value in own.items():
        i = DIRECTIONS.index(direction)
        matrix[i, i] += value
    return Borne(entry.name, {}, tuple(tuple(row) for row in matrix.tolist()))
