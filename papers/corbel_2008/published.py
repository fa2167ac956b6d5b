"""Numbers of Corbel et al. 2008 that this package can be asked for.

The copy that was read lacks its first lines, and with them title and authors, and most figures;
the document was told by its abstract, which has not been checked against the print. Where a digit
is lost the number does not stand here.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from strutwork.machines.literature import CORBEL_2008
from strutwork.papers.published_table import PublishedTable, PublishedValue

DELTA, PLATFORM = "linear-delta", "gough-platform"

TABLE_1 = PublishedTable(
    "corbel-2008-table-1",
    CORBEL_2008,
    "Optimised parameters of the Delta",
    (
        PublishedValue(DELTA, "R_b, radius of the rails", "mm", 540.0),
        PublishedValue(DELTA, "R_TP, radius of the plate", "mm", 60.0),
        PublishedValue(DELTA, "L, length of the rods", "mm", 800.0),
        PublishedValue(DELTA, "d, spacing of a parallelogram's rods", "mm", 75.0),
    ),
)

TABLE_2 = PublishedTable(
    "corbel-2008-table-2",
    CORBEL_2008,
    "Parameters of the measuring platform",
    (
        PublishedValue(PLATFORM, "r_b, radius of the base", "mm", 375.0),
        PublishedValue(PLATFORM, "alpha_b, angle of a pair on the base", "deg", 6.0),
        PublishedValue(PLATFORM, "r_TP, radius of the plate", "mm", 75.0),
        PublishedValue(PLATFORM, "alpha_TP, angle of a pair on the plate", "deg", 40.0),
    ),
    "Headings and numbers are garbled; the order here is the one that meets the leg range.",
)

TEXT = PublishedTable(
    "corbel-2008-text",
    CORBEL_2008,
    "Numbers of sections II-E, III-B and IV-C",
    (
        PublishedValue(DELTA, "side of the workspace", "mm", 300.0),
        PublishedValue(DELTA, "delta R for L = 800 mm", "mm", 480.0),
        PublishedValue(PLATFORM, "shortest leg", "mm", 634.0),
        PublishedValue(PLATFORM, "longest leg", "mm", 1080.0),
    ),
)

#: The document's tables by their key.
TABLES: Mapping[str, PublishedTable] = MappingProxyType(
    {t.key: t for t in (TABLE_1, TABLE_2, TEXT)}
)
