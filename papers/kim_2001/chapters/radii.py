"""Compliance by the radii of links and columns: Figs 14 and 15 as studies of two parameters."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from strutwork.papers.kim_2001.comparison import HORIZONTAL, one_link_thin, radius_study
from strutwork.papers.kim_2001.radii import COLUMNS, LINKS, RadiusStudy, radius_study_of
from strutwork.papers.tables import numbers, texts
from strutwork.reports.content import Chapter, Figure, Row, Table, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.curves import Curve, curves, heat
from strutwork.reports.figures.theme import PALETTE

SINGLE, BOTH = "link-radius.csv", "link-and-column-radius.csv"


def radius_chapter() -> Chapter:
    """Compliance by the radius of each link, of all links and of the columns."""
    upright, lying = radius_study(0.0), radius_study(HORIZONTAL)
    thin = zip(one_link_thin(0.0), one_link_thin(HORIZONTAL), strict=True)
    studies = (radius_study_of(0.0), radius_study_of(HORIZONTAL))
    return Chapter(
        "radius",
        "Radius of the links and columns",
        (
            Text(
                "Norm of the compliance of the tool's position. The document finds it flat from "
                "35 mm on and chooses 33 mm; the model with its calibrated dimensions agrees."
            ),
            Table(
                "All links, relative to rigid ones; calibrated",
                numbers("radius, mm", "tilt 0", "tilt 90 deg"),
                [
                    [f"{1e3 * r:g}", f"{a:.3f}", f"{b:.3f}"]
                    for (r, a), (_, b) in zip(upright, lying, strict=True)
                ],
            ),
            Table(
                "One link of 15 mm, relative to all of 33 mm; calibrated",
                (*texts("thin link"), *numbers("tilt 0", "tilt 90 deg")),
                [[f"leg {i}", f"{a:.3f}", f"{b:.3f}"] for i, (a, b) in enumerate(thin, 1)],
            ),
            Text(
                "The document draws the norm over the radius of each link (Fig. 14) and over "
                "those of all links and all columns (Fig. 15). The computed one is relative to "
                "the machine as built. At tilt 0 links 2 and 3 matter most and at tilt 90 link "
                "1; the document states the opposite. With six drives the forces in the rods do "
                "not depend on their radii, and the compliance is a sum over the rods."
            ),
            Row(tuple(_single(study) for study in studies), 380),
            Row(tuple(_both(study) for study in studies), 380),
        ),
        _files(studies),
    )


def _name(study: RadiusStudy) -> str:
    return "0" if study.tilt == 0.0 else "90"


def _single(study: RadiusStudy) -> Figure:
    name = _name(study)
    lines = [
        Curve(
            f"link {leg}",
            values,
            PALETTE[leg - 1],
            {1: "solid", 2: "solid", 3: "dash"}[leg],
            {1: 2.0, 2: 4.0, 3: 2.0}[leg],
        )
        for leg, values in enumerate(study.single, 1)
    ]
    same = " Links 2 and 3 are mirror images: their lines coincide."
    return Figure(
        f"single-link-{name}",
        f"Compliance at tilt {name} deg by the radius of one link, the others of 33 mm.{same}",
        curves(1e3 * LINKS, lines, ("radius of the link (mm)", "norm over that as built")),
        f"Three falling lines at tilt {name} degrees, one for each link.",
        SINGLE,
        340,
    )


def _both(study: RadiusStudy) -> Figure:
    name = _name(study)
    return Figure(
        f"links-columns-{name}",
        f"Compliance at tilt {name} deg by the radii of all links and all columns.",
        heat(
            1e3 * LINKS,
            1e3 * COLUMNS,
            np.log10(study.both),
            ("radius of the links (mm)", "radius of the columns (mm)", "log₁₀ of norm over built"),
            {"as built": (33.0, 15.7)},
        ),
        f"Map of the compliance at tilt {name} degrees over the radii of links and columns: the "
        "columns matter more.",
        BOTH,
    )


def _files(studies: Sequence[RadiusStudy]) -> tuple[DataFile, DataFile]:
    single = [
        [_name(s), leg, float(r), float(value)]
        for s in studies
        for leg, values in enumerate(s.single, 1)
        for r, value in zip(LINKS, values, strict=True)
    ]
    both = [
        [_name(s), float(r), float(c), float(s.both[i, k])]
        for s in studies
        for i, r in enumerate(LINKS)
        for k, c in enumerate(COLUMNS)
    ]
    return (
        csv_file(
            SINGLE,
            "norm of the compliance by the radius of one link, over that as built",
            ("tilt_deg", "link", "radius_m", "norm_over_built"),
            single,
        ),
        csv_file(
            BOTH,
            "norm of the compliance by the radii of all links and columns, over that as built",
            ("tilt_deg", "link_radius_m", "column_radius_m", "norm_over_built"),
            both,
        ),
    )
