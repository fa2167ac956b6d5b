"""Compliance by the radii of links and columns (Figs 14 and 15)."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.papers.kim_2001.comparison import at_plate, position_compliance

Array = NDArray[Any]

#: Radii that are looked at, m: the document draws its own without numbers on the axes that are
#: legible, and chose 33 mm.
LINKS = np.arange(0.012, 0.0501, 0.002)
COLUMNS = np.arange(0.010, 0.0301, 0.001)


@dataclass(frozen=True)
class RadiusStudy:
    """Norm of the compliance of the tool's position at a tilt, over that with all as built.

    Parameters
    ----------
    tilt : float
        deg.
    single : (3, n)
        By the radius of one link, the others as built; legs 1 to 3.
    both : (n, m)
        By the radius of all links and of all columns.
    """

    tilt: float
    single: Array
    both: Array


def radius_study_of(tilt: float) -> RadiusStudy:
    """Both figures at a tilt, deg.

    Six drives leave the forces in the rods to statics alone, so that the compliance is a sum over
    the rods: what one radius changes is found once, and the changes add up exactly.
    """
    machine = at_plate()
    built = position_compliance(machine, tilt)
    size = np.linalg.norm(built)
    single = [
        [np.linalg.norm(position_compliance(machine, tilt, (leg, r))) for r in LINKS]
        for leg in (1, 2, 3)
    ]
    links = [position_compliance(replace(machine, link_radius=r), tilt) for r in LINKS]
    columns = [
        position_compliance(replace(machine, column_radius=r), tilt) - built for r in COLUMNS
    ]
    both = np.linalg.norm(np.array(links)[:, None] + np.array(columns), axis=(-2, -1))
    return RadiusStudy(tilt, np.array(single) / size, both / size)
