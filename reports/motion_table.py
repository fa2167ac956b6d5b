"""Targets and coordinates of a motion as words on a command line and as CSV."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Mapping, Sequence
from io import StringIO
from math import degrees, radians
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.csv_rows import RowWriter, csv_name
from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Poses
from strutwork.kinematics.motion import Motion, Moved
from strutwork.units import ANGLE, LENGTH, quantity

Array = NDArray[Any]
Coordinate = tuple[str, str]

#: Largest file of targets, bytes.
LARGEST_FILE = 200_000_000

#: Units of a column, and what one of them is in SI.
_COLUMN = re.compile(r"(?P<name>.+?)(?:, (?P<unit>mm|m|deg|rad))?")
_SI = {"mm": 1e-3, "m": 1.0, "deg": radians(1.0), "rad": 1.0}
REACHED = "reached"

#: Coordinates below this, m and rad, are what rounding leaves of joints closed to 1e-11.
NOTHING = 1e-11


def coordinate(text: str, part: str) -> tuple[str, str]:
    """`x` or `JOINT:z`: the joint, empty for the tool, and the direction.

    Raises
    ------
    ModelError
        No such direction.
    """
    joint, _, direction = text.strip().rpartition(":")
    if direction not in DIRECTIONS:
        raise ModelError(
            part,
            f'names the unknown direction "{direction}".',
            f"Name one of {', '.join(DIRECTIONS)}, alone for the tool or as JOINT:DIRECTION.",
        )
    return joint, direction


def targets_of_words(words: Iterable[str], part: str) -> dict[Coordinate, float]:
    """`x=20mm`, `rz=5deg` or `ram1:z=310mm`, several separated by commas, in SI.

    Raises
    ------
    ModelError
        A word without a value, a direction that does not exist, one given twice.
    UnitError
        A value that is no length, or for a rotation no angle.
    """
    found: dict[Coordinate, float] = {}
    for word in (w for text in words for w in text.split(",")):
        name, equals, value = word.partition("=")
        if not equals:
            raise ModelError(part, f'"{word}" gives no value.', "Write it as in x=20mm or rz=5deg.")
        key = coordinate(name, part)
        if key in found:
            raise ModelError(part, f"gives {name.strip()} twice.", "Give it once.")
        kind = ANGLE if key[1].startswith("r") else LENGTH
        text = value.strip()
        try:
            given: object = float(text)
        except ValueError:
            given = text
        found[key] = quantity(given, kind, f"{part} {name.strip()}")
    return found


def read_targets(path: Path) -> dict[Coordinate, Array]:
    """Columns of a CSV file that name coordinates, in SI; others are left out.

    A column is `x, mm` or `ram1:z, mm`; without a unit it is in m or rad. The result of `move`
    is such a file.

    Raises
    ------
    ModelError
        A file that cannot be read or is too large, rows of other lengths, no coordinate, cells
        that are no finite numbers.
    """
    part = f"targets {path.name}"
    head, rows = read_rows(path, part)
    found: dict[Coordinate, Array] = {}
    for column, name in enumerate(head):
        match = _COLUMN.fullmatch(name)
        if match is None or match["name"].rpartition(":")[2] not in DIRECTIONS:
            continue
        key = coordinate(match["name"], part)
        factor = _SI[match["unit"]] if match["unit"] else 1.0
        found[key] = factor * column_numbers(rows, column, name, part)
    if not found:
        raise ModelError(
            part,
            "has no column that names a coordinate.",
            "Name columns as in: x, mm; rz, deg; or ram1:z, mm.",
        )
    return found


def read_rows(path: Path, part: str) -> tuple[list[str], list[list[str]]]:
    """Head and rows of a CSV file, empty lines left out.

    Raises
    ------
    ModelError
        A file that cannot be read or is too large, or without a row beside its head.
    """
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise ModelError(part, "is larger than 200 MB.", "Split it.")
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise ModelError(part, f"cannot be read: {error}.", "Give a CSV file in UTF-8.") from error
    rows = [row for row in csv.reader(StringIO(text)) if row]
    if len(rows) < 2:
        raise ModelError(part, "has no row of numbers.", "Give a header and one row per target.")
    return [csv_name(cell.strip()) for cell in rows[0]], rows[1:]


def column_numbers(rows: Sequence[Sequence[str]], column: int, name: str, part: str) -> Array:
    """Numbers of a column.

    Raises
    ------
    ModelError
        A cell that is no number; names its line.
    """
    values = []
    for number, row in enumerate(rows, 2):
        try:
            values.append(float(row[column]))
        except (IndexError, ValueError):
            raise ModelError(
                part, f"has no number in line {number} under {name}.", "Correct it."
            ) from None
    return np.array(values)


def moved_columns(motion: Motion, moved: Moved) -> dict[str, Array]:
    """Columns of a table: tool, joints and whether reached, mm and deg, (p,) each."""
    columns: dict[str, Array] = {}
    if moved.tool is not None:
        task = motion.task_of(moved.tool)
        for k, direction in enumerate(DIRECTIONS):
            columns[f"{direction}, {_unit(direction)}"] = _shown(direction, task[..., k])
    for k, (joint, direction) in enumerate(moved.placement.names):
        values = moved.placement.values[..., k]
        columns[f"{joint}:{direction}, {_unit(direction)}"] = _shown(direction, values)
    return columns


def way_columns(
    motion: Motion, tool: Poses | None, joints: Mapping[Coordinate, Array]
) -> dict[str, Array]:
    """Columns as `moved_columns` for ways to put a machine together, (m,) each.

    Joint coordinates that are not given are not numbers.
    """
    columns: dict[str, Array] = {}
    if tool is not None:
        task = motion.task_of(tool)
        for k, direction in enumerate(DIRECTIONS):
            columns[f"{direction}, {_unit(direction)}"] = _shown(direction, task[..., k])
    for joint, direction in motion.joints.names:
        values = joints.get((joint, direction), np.full(len(next(iter(columns.values()))), np.nan))
        columns[f"{joint}:{direction}, {_unit(direction)}"] = _shown(direction, values)
    return columns


def moved_csv(
    columns: Mapping[str, Array],
    reasons: Sequence[str],
    ways: Mapping[str, Mapping[str, Array]] | None = None,
) -> str:
    """CSV text; the last column says what became of each target.

    Below them stand `ways` of each kind, numbered there; a coordinate that is not known is empty.
    """
    text = StringIO(newline="")
    writer = RowWriter(text)
    writer.writerow([*columns, "status"])
    # repr keeps every digit: the file leads back to the same place
    for row, reason in zip(zip(*columns.values(), strict=True), reasons, strict=True):
        writer.writerow([*(repr(float(v)) for v in row), reason or REACHED])
    for kind, found in (ways or {}).items():
        for k, row in enumerate(zip(*(found[name] for name in columns), strict=True), start=1):
            cells = ["" if np.isnan(v) else repr(float(v)) for v in row]
            writer.writerow([*cells, f"{kind} {k}"])
    return text.getvalue()


def _unit(direction: str) -> str:
    return "deg" if direction.startswith("r") else "mm"


def _shown(direction: str, values: Array) -> Array:
    factor = degrees(1.0) if direction.startswith("r") else 1e3
    found = np.atleast_1d(np.asarray(values))
    return np.where(np.abs(found) < NOTHING, 0.0, found * factor)
