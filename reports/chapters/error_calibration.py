"""What a calibration takes away of the geometry in an error sheet, in words and tables."""

from __future__ import annotations

import numpy as np

from strutwork.kinematics import DIRECTIONS
from strutwork.reports.calibrated_words import AFTER, calibration_text, combination_words
from strutwork.reports.content import Block, Column, Details, Table, Text
from strutwork.reports.numbers import count, significant
from strutwork.studies.error_calibration import GeometryCalibration
from strutwork.studies.error_sheet import ErrorSheet

#: Combinations that are written out at most.
NAMED = 12


def calibration_blocks(sheet: ErrorSheet) -> list[Block]:
    """What was measured and is known by it, and the geometry before and after; else nothing."""
    found = sheet.calibrated
    if found is None:
        return []
    before, after = ErrorSheet(sheet.uncalibrated), sheet.of(AFTER)
    rows = [
        [
            direction,
            "µrad" if direction.startswith("r") else "µm",
            *(
                significant(1e6 * float(v[i]))
                for v in (before.worst, after.worst, before.within(), after.within())
            ),
        ]
        for i, direction in enumerate(DIRECTIONS)
    ]
    columns = (
        Column("tool", "", False),
        Column("unit", "", False),
        Column("before", group="at worst"),
        Column("after", group="at worst"),
        Column("before", group="within, 95 %"),
        Column("after", group="within, 95 %"),
    )
    blocks: list[Block] = [
        Text(calibration_text(sheet)),
        Table("Geometry before and after the calibration, at home", columns, rows),
        Details("Poses of the calibration", (_poses(found),)),
    ]
    left = found.undetermined
    if left:
        blocks.append(Details("Combinations that the calibration does not determine", _left(left)))
    return blocks


def _poses(found: GeometryCalibration) -> Table:
    axes = [Column(d, "deg" if d.startswith("r") else "mm") for d in found.task]
    factors = [np.degrees(1.0) if d.startswith("r") else 1e3 for d in found.task]
    rows = [
        [
            str(k + 1),
            *(
                significant(f * float(v[k]))
                for f, v in zip(factors, found.task.values(), strict=True)
            ),
        ]
        for k in range(found.poses)
    ]
    return Table("Measured poses", (Column("pose", "", False), *axes), rows)


def _left(left: tuple[dict[str, float], ...]) -> tuple[Text, Table]:
    rows = [[str(k + 1), combination_words(weights)] for k, weights in enumerate(left[:NAMED])]
    more = len(left) - NAMED
    text = (
        "Each of these combinations stays as it is; the numbers are in standard deviations of the "
        "parameters. One that no measured pose shows displaces the tool at none of them."
    )
    if more > 0:
        text += f" {count(more, 'more combination is', 'more combinations are')} left out here."
    columns = (Column("", "", False), Column("combination", "", False))
    return Text(text), Table("Undetermined combinations", columns, rows)
