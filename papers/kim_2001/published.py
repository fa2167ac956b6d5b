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

TABLE_1 = PublishedTable(
    "kim-2001-table-1",
    KIM_2001,
    "Cost of the forward kinematics by two methods",
    (
        *rows_of("computation time", "ms", ("numerical, 0.1 pi", "numerical, pi"), 0.064, 0.117),
        *rows_of("convergence rate", "%", ("numerical, 0.1 pi", "numerical, pi"), 99.29, 97.04),
        *rows_of("average iterations", "", ("numerical, 0.1 pi", "numerical, pi"), 7.33, 10.96),
        PublishedValue("algebraic", "computation time", "ms", 1.623),
        PublishedValue("algebraic", "share of the resultant's coefficients", "%", 18.47),
        PublishedValue("algebraic", "share of its roots", "%", 71.29),
        PublishedValue("algebraic", "share of leaving out complex ones", "%", 10.24),
    ),
)

TABLE_2_JOINT = PublishedTable(
    "kim-2001-table-2-joint",
    KIM_2001,
    "Magnitudes of the joint compliance ellipsoids",
    tuple(
        PublishedValue(PROTOTYPE, f"{axis} at tilt {tilt} deg", "", value)
        for tilt, values in ((0, (3.7185, 0.8833, 0.0906)), (90, (8.4256, 1.8359, 0.7431)))
        for axis, value in zip(AXES, values, strict=True)
    ),
    "To be interpreted as relative values (section V).",
)

#: Directions of force with Table II's largest and smallest axes: kind, axis, tilt.
DIRECTIONS: Mapping[tuple[str, str, int], tuple[float, float, float]] = MappingProxyType(
    {
        ("structural", "largest", 0): (0.8688, 0.0, 0.4962),
        ("structural", "smallest", 0): (0.4952, 0.0, 0.8688),
        ("structural", "largest", 90): (0.0, 1.0, 0.0),
        ("structural", "smallest", 90): (-0.1739, 0.0, 0.9848),
        ("joint", "largest", 0): (0.6338, 0.538, 0.5557),
        ("joint", "smallest", 0): (-0.7734, 0.4333, 0.4627),
        ("joint", "largest", 90): (0.9409, -0.0454, 0.3357),
        ("joint", "smallest", 90): (-0.3241, -0.4088, 0.8531),
    }
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
    "Sections VI and VII. They include the compliance of joints, drives and bearings, about "
    "which nothing is printed: they are given here as data, without a computed number.",
)

#: The paper's tables by their key.
TABLES: Mapping[str, PublishedTable] = MappingProxyType(
    {t.key: t for t in (TABLE_1, TABLE_2, TABLE_2_JOINT, BARRIERS, MEASURED)}
)
