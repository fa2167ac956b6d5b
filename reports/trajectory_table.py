"""Trajectories as CSV: samples that are read, and what is written of drives along them."""

from __future__ import annotations

import re
from math import degrees, radians
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.motion_table import Coordinate, column_numbers, coordinate, read_rows
from strutwork.studies.trajectory import Samples, TrajectoryStudy

Array = NDArray[Any]

_COLUMN = re.compile(r"(?P<name>.+?)(?: (?P<kind>speed|acceleration))?(?:, (?P<unit>[^,]+))?")
_TIME = {None: 1.0, "s": 1.0, "ms": 1e-3, "min": 60.0}
_SI = {"mm": 1e-3, "m": 1.0, "deg": radians(1.0), "rad": 1.0}
#: What stands after a length or an angle, by the kind of column.
_PER = {None: ("",), "speed": ("/s",), "acceleration": ("/s^2", "/s2", "/s²")}


def read_samples(path: Path) -> Samples:
    """Read a trajectory: a column `t, s`, and a column or more such as `x, mm` or `ram1:z, mm`.

    `x speed, mm/s` and `x acceleration, mm/s^2` may stand beside every one of them. Columns
    that name no direction are left out.

    Raises
    ------
    ModelError
        A file that cannot be read, without times or coordinates, with a unit that does not fit,
        a column given twice, derivatives of some coordinates only, or cells that are no numbers.
    """
    part = f"trajectory {path.name}"
    head, rows = read_rows(path, part)
    times: Array | None = None
    found: dict[str | None, dict[Coordinate, Array]] = {kind: {} for kind in _PER}
    for column, name in enumerate(head):
        match = _COLUMN.fullmatch(name)
        if match is None:
            continue
        if match["name"] in ("t", "time") and match["kind"] is None:
            if match["unit"] not in _TIME:
                raise ModelError(part, f'has times in "{match["unit"]}".', "Use s, ms or min.")
            if times is not None:
                raise ModelError(part, "has two columns of times.", "Remove one.")
            times = _TIME[match["unit"]] * column_numbers(rows, column, name, part)
            continue
        if match["name"].rpartition(":")[2] not in DIRECTIONS:
            continue
        key = coordinate(match["name"], part)
        kind = found[match["kind"]]
        if key in kind:
            raise ModelError(part, f'gives "{name}" twice.', "Remove one.")
        kind[key] = _factor(match, part) * column_numbers(rows, column, name, part)
    values, rates, changes = found[None], found["speed"], found["acceleration"]
    if times is None or not values:
        raise ModelError(
            part,
            f"has no column of {'times' if times is None else 'coordinates'}.",
            "Name columns as in: t, s; x, mm; rz, deg; or ram1:z, mm.",
        )
    if (rates or changes) and not (set(rates) == set(changes) == set(values)):
        raise ModelError(
            part,
            "has speeds or accelerations of some coordinates only.",
            "Give both for every coordinate, or leave them out.",
        )
    return Samples(times, values, rates, changes)


def _factor(match: re.Match[str], part: str) -> float:
    """What one of a column's unit is in SI."""
    unit, per = match["unit"], _PER[match["kind"]]
    if unit is None:
        return 1.0
    turning = match["name"].rpartition(":")[2].startswith("r")
    for base in ("deg", "rad") if turning else ("mm", "m"):
        if unit in [base + end for end in per]:
            return _SI[base]
    example = ("deg" if turning else "mm") + per[0]
    raise ModelError(
        part, f"has {match[0]}, a unit that does not fit.", f'Write "{example}", or none for SI.'
    )


def trajectory_files(study: TrajectoryStudy) -> tuple[DataFile, ...]:
    """Coordinates and drives over time, and joint reactions where they were asked for."""
    followed = study.followed
    columns = ["t, s"]
    numbers = [followed.times]

    def add(label: str, turning: bool, values: Array, end: str = "") -> None:
        columns.append(f"{label}, {'deg' if turning else 'mm'}{end}")
        numbers.append(values * (degrees(1.0) if turning else 1e3))

    for k, (joint, d) in enumerate(study.trajectory.coordinates.names):
        add(f"{joint}:{d}" if joint else d, d.startswith("r"), followed.values[:, k])
    for k, one in enumerate(study.demands):
        turning = one.direction.startswith("r")
        add(f"{one.label} drive", turning, followed.drives[:, k])
        add(f"{one.label} drive speed", turning, followed.speeds[:, k], "/s")
        add(f"{one.label} drive acceleration", turning, followed.accelerations[:, k], "/s^2")
        columns.append(f"{one.label} drive force, {'N*m' if turning else 'N'}")
        numbers.append(followed.forces[:, k])
        columns.append(f"{one.label} drive power, W")
        numbers.append(followed.powers[:, k])
    columns += ["kinetic energy, J", "potential energy, J"]
    numbers += [followed.kinetic, followed.potential]
    table = np.stack(numbers, axis=1).tolist()
    files = [csv_file("trajectory.csv", "drives along the trajectory", columns, table)]
    if followed.reactions is not None:
        units = [
            "N*m" if label.rpartition(":")[2].startswith("r") else "N"
            for label in followed.reaction_labels
        ]
        head = [
            "t, s",
            *(f"{n}, {u}" for n, u in zip(followed.reaction_labels, units, strict=True)),
        ]
        rows = np.column_stack([followed.times, followed.reactions]).tolist()
        files.append(csv_file("reactions.csv", "joint reactions", head, rows))
    return tuple(files)
