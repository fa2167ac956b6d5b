"""Tables 1 to 5 of Azulay et al. 2014."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from strutwork.machines.literature import AZULAY_2014
from strutwork.papers.published_table import PublishedTable, PublishedValue, rows_of

_STIFFNESS, _VARIANCE = "N/um", "N^2/um^2"
_PROPOSED, _ECLIPSE, _ALIZADE, _GLOZMAN = (
    "proposed-3pprs",
    "eclipse-3pprs",
    "alizade-3prps",
    "glozman-3prrs",
)
_MACHINES = (_PROPOSED, _ECLIPSE, _ALIZADE, _GLOZMAN)
_LENGTHS = tuple(f"{_PROPOSED} L={length} mm" for length in (196, 216, 236))

_STROKE_NOTE = "printed under the radial prismatic joint for every machine"

TABLE_1 = PublishedTable(
    "azulay-2014-table-1",
    AZULAY_2014,
    "Dimensions of the proposed PKM",
    (
        PublishedValue(_PROPOSED, "base radius", "mm", 162.0),
        PublishedValue(_PROPOSED, "platform radius", "mm", 18.0),
        PublishedValue(_PROPOSED, "link length", "mm", 216.0),
        PublishedValue(_PROPOSED, "curvilinear prismatic range", "deg", 360.0, "continuous"),
        PublishedValue(_PROPOSED, "radial prismatic minimum", "mm", 0.0),
        PublishedValue(_PROPOSED, "radial prismatic maximum", "mm", 65.0),
        PublishedValue(_PROPOSED, "revolute minimum", "deg", 5.0),
        PublishedValue(_PROPOSED, "revolute maximum", "deg", 70.0),
        PublishedValue(_PROPOSED, "spherical range to each side", "deg", 70.0),
    ),
)

TABLE_2 = PublishedTable(
    "azulay-2014-table-2",
    AZULAY_2014,
    "Mean and variance of the static stiffness for three link lengths",
    (
        *rows_of("Kxx mean", _STIFFNESS, _LENGTHS, 5.74, 5.69, 5.28),
        *rows_of("Kxx variance", _VARIANCE, _LENGTHS, 0.24, 0.38, 0.39),
        *rows_of("Kyy mean", _STIFFNESS, _LENGTHS, 5.49, 4.73, 4.21),
        *rows_of("Kyy variance", _VARIANCE, _LENGTHS, 0.22, 0.33, 0.33),
        *rows_of("Kzz mean", _STIFFNESS, _LENGTHS, 8.77, 5.43, 3.92),
        *rows_of("Kzz variance", _VARIANCE, _LENGTHS, 1.18, 0.21, 0.10),
    ),
    "The column for 216 mm and Table 4 describe the same machine and differ by up to 5 % in the "
    "means.",
)

TABLE_3 = PublishedTable(
    "azulay-2014-table-3",
    AZULAY_2014,
    "Dimensions of the PKMs",
    (
        *rows_of("base radius", "mm", _MACHINES, 162.0, 162.0, 162.0, 162.0),
        *rows_of("platform radius", "mm", _MACHINES, 18.0, 18.0, 18.0, 18.0),
        *rows_of("link length", "mm", _MACHINES, 216.0, 216.0, 216.0, 130.0),
        *rows_of("curvilinear prismatic range", "deg", _MACHINES, 360.0, 360.0, 360.0, 360.0),
        *rows_of(
            "second prismatic range", "mm", _MACHINES[:3], 65.0, 65.0, 65.0, note=_STROKE_NOTE
        ),
        *rows_of("revolute minimum", "deg", _MACHINES, 5.0, 5.0, 5.0, 5.0),
        *rows_of("revolute maximum", "deg", _MACHINES, 70.0, 70.0, 70.0, 70.0),
        *rows_of("spherical range to each side", "deg", _MACHINES, 70.0, 70.0, 70.0, 70.0),
        *rows_of("platform tilt angle", "deg", _MACHINES, 94.0, 98.0, 96.0, 96.0),
    ),
    "The Alizade link length is at the middle of its stroke; the Glozman machine has two links "
    "of 130 mm (section 4).",
)

TABLE_4 = PublishedTable(
    "azulay-2014-table-4",
    AZULAY_2014,
    "Mean and variance of the PKMs' static stiffness",
    (
        *rows_of("Kxx mean", _STIFFNESS, _MACHINES, 5.691, 4.450, 3.686, 2.433),
        *rows_of("Kxx variance", _VARIANCE, _MACHINES, 0.349, 0.237, 0.028, 0.020),
        *rows_of("Kyy mean", _STIFFNESS, _MACHINES, 4.710, 3.986, 3.247, 2.038),
        *rows_of("Kyy variance", _VARIANCE, _MACHINES, 0.316, 0.100, 0.103, 0.053),
        *rows_of("Kzz mean", _STIFFNESS, _MACHINES, 5.690, 7.360, 3.601, 5.487),
        *rows_of("Kzz variance", _VARIANCE, _MACHINES, 0.228, 0.004, 0.108, 0.292),
    ),
    "The proposed machine appears in Table 2 (216 mm) with means that differ by up to 5 %.",
)

TABLE_5 = PublishedTable(
    "azulay-2014-table-5",
    AZULAY_2014,
    "Minimum dynamic stiffness at the home configuration",
    (
        *rows_of("Kxx minimum", _STIFFNESS, _MACHINES, 0.178, 0.044, 0.047, 0.015),
        *rows_of("Kyy minimum", _STIFFNESS, _MACHINES, 0.161, 0.041, 0.071, 0.021),
        *rows_of("Kzz minimum", _STIFFNESS, _MACHINES, 0.066, 0.567, 2.08, 0.005),
    ),
    "Three equal legs at 120° force Kxx = Kyy at home; the table's differ. It does not include "
    "joint compliance; damping 1 %.",
)

#: The paper's tables by their key.
TABLES: Mapping[str, PublishedTable] = MappingProxyType(
    {t.key: t for t in (TABLE_1, TABLE_2, TABLE_3, TABLE_4, TABLE_5)}
)
