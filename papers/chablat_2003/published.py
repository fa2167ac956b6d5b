"""Numbers of Chablat, Wenger and Majou 2003 that this package can be asked for."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from strutwork.machines.literature import CHABLAT_2003
from strutwork.papers.published_table import PublishedTable, PublishedValue

PLANE, THIRD_LEG = "biglide", "biglide:third-leg"

#: Bounds of the velocity amplification factors (section 3.3).
LOW, HIGH = 1.0 / 3.0, 3.0
#: Bound of eqs 4a and 4b of section 3.4.
THRESHOLD = 0.2

SQUARES = PublishedTable(
    "chablat-2003-squares",
    CHABLAT_2003,
    "Largest square useful workspaces, legs of length one (section 3.3)",
    (
        PublishedValue(PLANE, "area, sides at 45 deg to the rails", "m^2", 0.89, "solution (a)"),
        PublishedValue(PLANE, "area, sides along the rails", "m^2", 0.62, "solution (b)"),
    ),
    "The text gives solution (a) horizontal and vertical sides, and says of (b) first that its "
    "size is higher, and then that it is smaller; in Fig. 5a the rails are oblique.",
)

THIRD = PublishedTable(
    "chablat-2003-third-leg",
    CHABLAT_2003,
    "Lengths of the third leg, and its bounds (section 3.4)",
    (
        PublishedValue(THIRD_LEG, "L2/L1 of the largest range of beta", "", 1.8),
        PublishedValue(THIRD_LEG, "bound of the angle gamma", "deg", 11.5, "from there to 168.5"),
        PublishedValue(THIRD_LEG, "bound of the angle sigma", "deg", 78.5, "to either side"),
    ),
)

#: The paper's tables by their key.
TABLES: Mapping[str, PublishedTable] = MappingProxyType({t.key: t for t in (SQUARES, THIRD)})
