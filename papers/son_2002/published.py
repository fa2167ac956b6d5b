"""Numbers of Son 2002: assembly forces, stiffness, modes, manipulability."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType

from strutwork.machines.literature import SON_2002
from strutwork.papers.published_table import PublishedTable, PublishedValue, rows_of

#: Row of the machine itself in tables that have no other rows.
MACHINE = "mit-ss1"

DIMENSIONS = PublishedTable(
    "son-2002-appendix-b",
    SON_2002,
    "Dimensions of the MIT-SS-1",
    tuple(
        PublishedValue(MACHINE, name, "m", value)
        for name, value in (
            ("w1", 0.2975),
            ("w2", 0.3075),
            ("w3", 0.1575),
            ("l1", 0.4),
            ("l2", 0.4),
            ("l3", 0.475),
            ("h1", 0.1),
            ("h2", 0.1),
            ("t", 0.15),
            ("r", 0.095),
            ("p", 0.095),
        )
    ),
    "Appendix B. w1 is counted towards negative x; the scan has lost its sign in eq. 40.",
)

#: Cases of Table 2: length and width of the three equal struts, m.
TABLE_2_CASES: Mapping[str, tuple[float, float]] = MappingProxyType(
    {"I": (0.5, 0.1), "II": (1.0, 0.2), "III": (1.5, 0.3)}
)


def table_2_row(case: str, joint: int) -> str:
    """Row of Table 2: a case by its numeral, a joint from 1 to 6."""
    return f"case {case} joint {joint}"


def _forces(case: str, quantity: str, *numbers: float) -> Iterable[PublishedValue]:
    rows = [table_2_row(case, joint) for joint in range(1, 7)]
    return rows_of(quantity, "kN", rows, *numbers)


TABLE_2 = PublishedTable(
    "son-2002-table-2",
    SON_2002,
    "Assembly forces at each joint, worst case: radial Fr and axial Fa",
    (
        *_forces("I", "Fr", 9.7, 4.7, 10.0, 4.1, 10.2, 2.9),
        *_forces("I", "Fa", 1.9, 1.9, 1.8, 1.8, 1.7, 1.7),
        *_forces("II", "Fr", 19.6, 7.7, 19.8, 6.9, 18.7, 5.8),
        *_forces("II", "Fa", 3.9, 3.9, 3.7, 3.7, 3.6, 3.6),
        *_forces("III", "Fr", 29.4, 10.6, 29.5, 9.8, 27.3, 9.2),
        *_forces("III", "Fa", 5.7, 5.7, 5.6, 5.6, 5.5, 5.5),
    ),
    "Section 6.6, page 85. Three equal struts, parallelism of the axes 300 µm/m. The structure "
    "is in figures 40 and 42, of which only the text is available.",
)


def table_6_row(x: int, b: int) -> str:
    """Row of Table 6: x in mm, tilt in degrees."""
    return f"x = {x} mm, b = {b} deg"


_SWAPPED = (
    "the text of section 9.2.1 suggests that the two rows at x = -50 mm changed places; not proven"
)


def _stiffness(x: int, b: int, *numbers: float, note: str = "") -> Iterable[PublishedValue]:
    row = table_6_row(x, b)
    for quantity, number in zip(("Kx", "Ky", "Kz"), numbers, strict=True):
        yield PublishedValue(row, quantity, "N/um", number, note)


TABLE_6 = PublishedTable(
    "son-2002-table-6",
    SON_2002,
    "Static stiffness test results",
    (
        *_stiffness(0, 0, 52.6, 40.0, 83.3),
        *_stiffness(50, 30, 24.4, 47.6, 25.0),
        *_stiffness(50, -30, 71.4, 90.9, 32.3),
        *_stiffness(-50, 30, 17.5, 52.6, 23.3, note=_SWAPPED),
        *_stiffness(-50, -30, 90.9, 76.9, 76.9, note=_SWAPPED),
    ),
    "Section 9.2.1, page 102. Measured at the spindle housing without spindle, 100 N by a spring "
    "scale, dial indicator of 2 µm, after a dead zone of 2 to 4 µm.",
)

_TILT, _STRUTS, _SCREW = "spindle housing tilt", "strut assembly bending", "ball screw"
_BEND, _TWIST = "granite bending", "granite twisting"

MODES = PublishedTable(
    "son-2002-modes",
    SON_2002,
    "Frequencies of the structure, numerical and measured",
    (
        PublishedValue(_TILT, "numerical", "Hz", 111.2, "113.24 Hz in section 9.2.2"),
        PublishedValue(_STRUTS, "numerical", "Hz", 182.3, "182.38 Hz in section 9.2.2"),
        PublishedValue(_BEND, "numerical", "Hz", 269.4),
        PublishedValue(_TWIST, "numerical", "Hz", 320.9),
        PublishedValue(_TILT, "measured", "Hz", 79.2),
        PublishedValue(_STRUTS, "measured", "Hz", 154.12),
        PublishedValue(_SCREW, "measured", "Hz", 238.64),
        PublishedValue(_BEND, "measured", "Hz", 268.25),
        PublishedValue(_TWIST, "measured", "Hz", 319.95),
    ),
    "Numerical: section 6.2, Fig. 30; measured without spindle: section 9.2.2.",
)

MOUNT_MODES = PublishedTable(
    "son-2002-mount-modes",
    SON_2002,
    "Rigid-body frequencies on the four mounts, measured",
    (
        PublishedValue("rigid body 1", "measured", "Hz", 22.6),
        PublishedValue("rigid body 3", "measured", "Hz", 39.3),
        PublishedValue("rigid body 4", "measured", "Hz", 62.0),
    ),
    "Section 9.2.2, Fig. 57, page 107. Four modes; the second is illegible.",
)

STIFFNESS = PublishedTable(
    "son-2002-section-6-2",
    SON_2002,
    "Computed stiffness of the MIT-SS-1",
    (PublishedValue(MACHINE, "Ky", "N/um", 35.0),),
    "Section 6.2. The thesis's J⁻ᵀ K J⁻¹ puts the struts' axial stiffness along z.",
)

#: Highest tick of the vertical axis of Fig. 29-(a), N/m. No value of Kx is printed; that the flat
#: part of the map lies there is an assumption.
FIGURE_29_TICK = 150e6


def _range(row: str, quantity: str, low: float, high: float) -> Iterable[PublishedValue]:
    yield PublishedValue(row, f"{quantity}, least", "", low)
    yield PublishedValue(row, f"{quantity}, most", "", high)


MANIPULABILITY = PublishedTable(
    "son-2002-manipulability",
    SON_2002,
    "Velocity ellipsoids of the MIT-SS-1 and of the Hexel hexapod",
    (
        *_range(MACHINE, "position condition number", 1.74, 2.71),
        *_range("hexapod", "position condition number", 2.76, 3.10),
        *_range("hexapod", "position smallest axis", 0.46, 0.47),
        *_range("hexapod", "position volume", 0.66, 0.71),
        *_range("hexapod", "rotation condition number", 1.45, 7.89),
        *_range("hexapod", "rotation smallest axis", 2.57, 7.04),
        *_range("hexapod", "rotation volume", 137.9, 508.4),
    ),
    "Section 6.4 and section 2.2. Volume is the product of the three semi-axes.",
)

#: The thesis's numbers by their key.
TABLES: Mapping[str, PublishedTable] = MappingProxyType(
    {
        t.key: t
        for t in (
            DIMENSIONS,
            TABLE_2,
            TABLE_6,
            MODES,
            MOUNT_MODES,
            STIFFNESS,
            MANIPULABILITY,
        )
    }
)
