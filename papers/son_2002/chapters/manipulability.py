"""Velocity ellipsoids of the Hexel hexapod beside section 2.2 of Son 2002."""

from __future__ import annotations

from math import degrees

import numpy as np
import xarray as xr

from strutwork.machines.hexel_hexapod import REACH, TILT
from strutwork.papers.published_rows import CLOSE, PublishedRow, file_name
from strutwork.papers.son_2002.chapters.plane import axes, extremes, plane_file
from strutwork.papers.son_2002.manipulability import IDENTITY, MEASURES, PARTS, manipulability_rows
from strutwork.papers.son_2002.published import MANIPULABILITY
from strutwork.papers.tables import numbers, rows_file, texts
from strutwork.reports.content import Block, Cell, Chapter, Figure, Points, Row, Table, Text
from strutwork.reports.data_files import netcdf_file
from strutwork.reports.figures.curves import heat
from strutwork.reports.numbers import percent, significant


def manipulability_chapter(found: xr.Dataset) -> Chapter:
    """Maps of both ellipsoids and the published ranges.

    Parameters
    ----------
    found : xarray.Dataset
        Of `hexapod_manipulability`.
    """
    x, a = axes(found, "a")
    file = "manipulability.csv"
    rows = []
    for part in PARTS:
        figures = []
        for words, name in MEASURES.items():
            values = found[f"{part}_{name}"].to_numpy()
            marks = extremes(x, a, values, {"least": np.nanargmin, "most": np.nanargmax})
            unit = found[f"{part}_{name}"].attrs["units"].replace("^3", "³")
            title = words if unit == "1" else f"{words} ({unit})"
            figures.append(
                Figure(
                    f"{part}-{name}",
                    f"{part.capitalize()}: {words} of the velocity ellipsoid.",
                    heat(x, a, values, ("x (mm)", "tilt a (deg)", title), marks),
                    f"Map of the {words} of the {part} ellipsoid over x and tilt, least and most "
                    "marked.",
                    file,
                    380,
                )
            )
        rows.append(Row(tuple(figures), 330))
    published = manipulability_rows(found)
    blocks: list[Block] = [
        Text(
            "Velocity ellipsoids for leg rates of size one (eqs 11 to 13): of the tool's "
            "velocity with its orientation held, and of its angular velocity with its position "
            f"held, over x = ±{1e3 * REACH:g} mm and a = ±{degrees(TILT):g}°."
        ),
        *rows,
        _published(published),
        Points(
            (
                (
                    f"{IDENTITY[0].upper()}{IDENTITY[1:]}. The computed ones add up to six within "
                    f"{_identity(found):.0e}."
                ),
                (
                    "Condition number, smallest axis and volume as printed do not contradict "
                    "this: with three different axes, 2.76 and 0.465 make a volume of 0.68. With "
                    "three-fold symmetry, as the drawing is interpreted here, two axes are equal "
                    "at home, and 2.76 makes 0.735 there or, with the smaller ones equal, 0.584: "
                    "outside the printed 0.66 to 0.71."
                ),
                (
                    "The drawing is missing. The arrangement of the joints and the reach of the "
                    "machine were chosen among many interpretations by the condition numbers of "
                    "the position; every row is therefore called calibrated, close or not."
                ),
            )
        ),
    ]
    maps = {str(n): v.to_numpy() for n, v in found.data_vars.items() if v.dims == ("x", "a")}
    files = (
        plane_file(
            file,
            "condition, smallest axis and volume of both ellipsoids over x and tilt",
            found,
            maps,
            "a",
        ),
        netcdf_file("manipulability.nc", "the same as a dataset, with all semi-axes", found),
        rows_file(
            file_name(MANIPULABILITY.key),
            "manipulability of the thesis beside the computed values",
            published,
        ),
    )
    return Chapter("manipulability", "Manipulability", tuple(blocks), files)


def _identity(found: xr.Dataset) -> float:
    """How far the inverse squares of the position's semi-axes add to something else than six."""
    sums = (found["position_semi_axes"].to_numpy() ** -2).sum(axis=-1)
    return float(np.nanmax(np.abs(sums - 6.0)))


def _published(rows: tuple[PublishedRow, ...]) -> Table:
    return Table(
        "Section 2.2 of the thesis beside the computed values",
        (*texts("quantity"), *numbers("published", "computed", "difference"), *texts("status")),
        [
            [
                r.quantity,
                significant(r.published, 4),
                significant(r.computed, 4),
                Cell(
                    percent(r.difference_percent),
                    "good" if abs(r.difference_percent) <= CLOSE else "poor",
                ),
                r.status,
            ]
            for r in rows
        ],
        file_name(MANIPULABILITY.key),
    )
