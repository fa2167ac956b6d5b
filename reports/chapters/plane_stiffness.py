"""Stiffness over x and one tilt: maps and how fast it falls."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import degrees

import numpy as np
import xarray as xr

from strutwork.reports.content import Column, Figure, Row, Table
from strutwork.reports.figures.curves import heat
from strutwork.reports.numbers import fixed, micro, significant
from strutwork.studies import Fall, on_plane


def plane_figures(
    found: xr.Dataset, key: str, name: str, data: str, directions: Sequence[str] = ("x", "y", "z")
) -> Row:
    """Maps of 1/C_ii over x and tilt, N/µm, softest and stiffest pose marked.

    Parameters
    ----------
    found : xarray.Dataset
        Of `strutwork.studies.plane_map`.
    key : str
        Begins the figures' keys.
    name : str
        The machine's, for captions.
    data : str
        File beside the report that holds the numbers.
    directions : sequence of str
    """
    tilt = str(found.attrs["tilt"])
    figures = []
    for direction in directions:
        stiffness = found["stiffness_free"].sel(direction=direction).to_numpy() / 1e6
        x, tilts, values = on_plane(found, stiffness)
        marks = {}
        for word, pick in (("softest", np.nanargmin), ("stiffest", np.nanargmax)):
            i, j = np.unravel_index(int(pick(values)), values.shape)
            marks[f"{word}, {significant(float(values[i, j]))}"] = (1e3 * x[i], degrees(tilts[j]))
        quantity = f"K{direction * 2}"
        figures.append(
            Figure(
                f"{key}-{direction}",
                f"{name}: {quantity} = 1/C_{direction * 2} at the tool tip.",
                heat(
                    1e3 * x,
                    np.degrees(tilts),
                    values,
                    ("x (mm)", f"tilt {tilt} (deg)", f"{quantity} (N/µm)"),
                    marks,
                ),
                f"Map of {quantity} of {name} over x and tilt, softest and stiffest pose marked.",
                data,
                400,
            )
        )
    return Row(tuple(figures), 320)


def falls_table(falls: Mapping[str, Sequence[Fall]], data: str) -> Table:
    """How much the stiffness of machines changes over their maps.

    Parameters
    ----------
    falls : mapping of name to sequence of Fall
    data : str
    """
    rows = [
        [
            f"{name}, K{fall.direction * 2}",
            micro(fall.centre),
            fixed(fall.middle, 2),
            significant(fall.whole),
            f"{fixed(1e3 * fall.least[0], 0)} mm, {fixed(degrees(fall.least[1]), 0)}°",
        ]
        for name, some in falls.items()
        for fall in some
    ]
    columns = (
        Column("", "", False),
        Column("centre of the map", "N/µm"),
        Column("largest / smallest, middle"),
        Column("largest / smallest, entire map"),
        Column("softest at x, tilt", "", False),
    )
    return Table(
        "Variation of 1/C_ii; the middle is half of the map's range to either side",
        columns,
        rows,
        data,
    )
