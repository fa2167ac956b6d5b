"""Numbers of Kim et al. 2001 that this package can be asked for."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from strutwork.machines.literature import KIM_2001
from strutwork.papers.published_table import PublishedTable, PublishedValue, rows_of

PROTOTYPE, MACHINE = "eclipse-prototype", "eclipse-machine"

#: Axes of the structural compliance ellipsoid, largest first.
AXES = ("largest", "middle", "smallest")

TABLE_2 = PublishedTable(
    "kim-2001-table-2",
    KIM_2001,
    "Magnitudes of the structural compliance ellipsoids",
    tuple(
        PublishedValue(PROTOTYPE, f"{axis} at tilt {tilt} deg", "m/N", value)
        for tilt, values in (
            (0, (0.1545e-5, 0.1198e-5, 0.0130e-5)),
            (90, (0.3489e-5, 0.0490e-5, 0.0244e-5)),
        )
        for axis, value in zip(AXES, values, strict=True)
    ),
    "The printed direction of the smallest axis at tilt 0, (0.4952, 0, 0.8688), is not "
    "perpendicular to that of the largest, (0.8688, 0, 0.4962): a sign is lost.",
)

BARRIERS = PublishedTable(
    "kim-2001-barriers",
    KIM_2001,
    "Tilt angles of the actuator singularities with six drives",
    (
        PublishedValue(PROTOTYPE, "first barrier", "deg", 30.0, "printed as approximate"),
        PublishedValue(PROTOTYPE, "second barrier", "deg", 60.0, "printed as approximate"),
    ),
)

MEASURED = PublishedTable(
    "kim-2001-measured",
    KIM_2001,
    "Stiffness measured on the machines that were built",
    (
        *rows_of("vertical, along the spindle", "N/um", (PROTOTYPE, MACHINE), 1.2, 18.2),
        *rows_of("vertical, radial", "N/um", (PROTOTYPE, MACHINE), 0.6, 13.8),
        *rows_of("horizontal, along the spindle", "N/um", (PROTOTYPE, MACHINE), 1.5, 1.1),
        *rows_of("horizontal, radial", "N/um", (PROTOTYPE, MACHINE), 3.0, 5.8),
    ),
    "Sections VI and VII. Joints, drives and bearings yield in them, and nothing about those is "
    "printed: they stand here as data, with no number of ours beside them.",
)

#: The paper's tables by their key.
TABLES: Mapping[str, PublishedTable] = MappingProxyType(
    {t.key: t for t in (TABLE_2, BARRIERS, MEASURED)}
)
