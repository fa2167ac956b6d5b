"""Singular tilts, what extra drives remove, and the condition of the document's G."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.machines.eclipse_prototype import Drives, EclipsePrototype
from strutwork.papers.kim_2001.comparison import barriers
from strutwork.papers.kim_2001.drive_rows import ROLLS, condition, least_singular_value
from strutwork.papers.tables import numbers, texts
from strutwork.reports.content import Chapter, Figure, Row, Table, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.curves import heat
from strutwork.reports.numbers import significant

Array = NDArray[Any]

FILE = "drive-condition.csv"

WORDS: Mapping[Drives, str] = {
    "6": "none",
    "7a": "hinge of leg 1",
    "7b": "hinge of leg 2",
    "8": "both hinges",
}

#: Tilts and spindle angles of the map, deg.
MAP_TILTS = np.arange(0.5, 89.0, 1.0)
MAP_ROLLS = np.arange(-180.0, 180.1, 4.0)
#: Powers of ten that the colours tell apart: beyond the higher all is a barrier.
COLOURS = (2.0, 7.0)


def barriers_chapter() -> Chapter:
    """Singular tilts by spindle angle, what extra drives remove, and Fig. 6."""
    angles = [
        [f"{roll:g}", ", ".join(f"{t:.1f}" for t in barriers(roll)) or "none"]
        for roll in (0.0, 10.0, 20.0, 30.0, 60.0, 90.0, 110.0, 120.0, 150.0, 180.0)
    ]
    machine = EclipsePrototype()
    length = machine.base_radius
    maps = {drives: condition(drives, MAP_TILTS, MAP_ROLLS, length) for drives in ("6", "8")}
    return Chapter(
        "barriers",
        "Singular tilts and extra drives",
        (
            Text(
                "With six drives and balls of ±55° the platform cannot be tilted from vertical "
                "to horizontal without passing poses in which the drives do not hold it. At "
                "spindle angle 0 each extra drive alone leaves one of them, that of leg 1 the "
                "lower and that of leg 2 the higher; both together leave none for spindle angles "
                "up to 30° to either side. The second barrier vanishes beyond spindle angles of "
                "29°. The first stays up to 113°; beyond, no singular tilt is left, but the "
                "balls with their ±55° do not allow such a tilt there, whether their sockets are "
                "counted from the links at home or from half way. So within the joint ranges the "
                "first barrier lies on every path, as the document states; the second does not."
            ),
            Table(
                "Singular tilts with six drives, by the calibrated dimensions",
                texts("spindle angle, deg", "singular tilts, deg"),
                angles,
            ),
            Text(
                "G = J⁻ᵀJ⁻¹ over the rows of the driven joints loses rank at a singular tilt. It "
                "adds metres to radians, so that its condition number and its least singular "
                "value need a length that counts as much as one radian, of the tool and of a "
                "rotary drive. The document states none: both are given for two lengths of the "
                "machine, and neither is the document's number. A least value and the tilt at "
                "which it occurs change with that length; whether it is zero does not."
            ),
            _margins(machine),
            Row(
                tuple(
                    _map(
                        f"condition-{drives}",
                        {"6": "six drives", "8": "eight drives"}[drives],
                        maps[drives],
                        length,
                    )
                    for drives in maps
                ),
                380,
            ),
        ),
        (_map_file(maps),),
    )


def _margins(machine: EclipsePrototype) -> Table:
    lengths = {"R_p": machine.platform_radius, "R_b": machine.base_radius}
    rows = []
    for drives, text in WORDS.items():
        for name, length in lengths.items():
            row = [text, f"{name}, {1e3 * length:g} mm"]
            for rolls in (np.array([0.0]), ROLLS):
                value, tilt, roll = least_singular_value(drives, rolls, length=length)
                row.append(significant(value, 3) if value > 1e-3 else "0")
                row.append(f"{tilt:g}°" + (f", {abs(roll):g}°" if len(rolls) > 1 else ""))
            rows.append(row)
    return Table(
        "Least singular value of the drives' rows, the root of G's least eigenvalue, over tilts of "
        "0.5 to 84.5 deg in half degrees; by the calibrated dimensions",
        (
            *texts("extra drives", "one radian counts as"),
            *numbers("spindle angle 0"),
            *texts("at tilt"),
            *numbers("up to 30° to either side"),
            *texts("at tilt, spindle angle"),
        ),
        rows,
    )


def _map(key: str, words: str, values: Array, length: float) -> Figure:
    low, high = COLOURS
    shown = np.clip(np.log10(values), low, high)
    spec = heat(MAP_TILTS, MAP_ROLLS, shown, ("tilt (deg)", "spindle angle (deg)", "log₁₀ cond G"))
    spec["data"][0] |= {"zmin": low, "zmax": high}
    return Figure(
        key,
        f"Condition number of G with {words}, one radian as much as {1e3 * length:g} mm (the "
        f"document's Fig. 6). Yellow is {10**high:.0e} and more.".replace("e+0", "e"),
        spec,
        f"Map of the logarithm of the condition number over tilt and spindle angle with {words}.",
        FILE,
    )


def _map_file(maps: Mapping[str, Array]) -> DataFile:
    rows = [
        [float(tilt), float(roll), *(float(maps[d][i, k]) for d in maps)]
        for i, tilt in enumerate(MAP_TILTS)
        for k, roll in enumerate(MAP_ROLLS)
    ]
    return csv_file(
        FILE,
        "condition number of G over tilt and spindle angle, with six and with eight drives",
        ("tilt_deg", "spindle_angle_deg", *(f"condition_{d}_drives" for d in maps)),
        rows,
    )
