"""Where the tool can be, and how far it yields there: Figs 8, 9 and 13."""

from __future__ import annotations

from typing import get_args

import numpy as np

from strutwork.papers.kim_2001.comparison import HORIZONTAL
from strutwork.papers.kim_2001.places import ACROSS, Across, Socket, across, positioning_radius
from strutwork.reports.content import Chapter, Figure, Row, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.curves import Curve, curves, heat
from strutwork.reports.figures.theme import PALETTE

RADIUS, NORM = "positioning-workspace.csv", "compliance-across.csv"

#: deg.
TILTS = np.arange(0.0, 90.1, 15.0)

WORDS = {
    "home": "range counted from the link's direction at home",
    "midway": "range counted from halfway between tilts of 0 and 90 deg",
}

#: Radius of the cylinder that section VI names as the prototype's workspace, mm.
PRINTED = 50.0


def places_chapter() -> Chapter:
    """Radius of the positioning workspace by tilt, and the compliance over a plane."""
    radii = {
        s: np.array([positioning_radius(float(t), s) for t in TILTS]) for s in get_args(Socket)
    }
    maps = {name: across(tilt) for name, tilt in (("0", 0.0), ("90", HORIZONTAL))}
    rows = [
        [float(t), *(float(r[i]) if r[i] >= 0 else None for r in radii.values())]
        for i, t in enumerate(TILTS)
    ]
    file = csv_file(
        RADIUS,
        "radius of the positioning workspace by tilt, for two choices of the sockets' axes",
        ("tilt_deg", *(f"radius_{s}_m" for s in radii)),
        rows,
    )
    lines = [
        Curve(WORDS[s], np.where(r >= 0, 1e3 * r, np.nan), PALETTE[i])
        for i, (s, r) in enumerate(radii.items())
    ]
    return Chapter(
        "places",
        "Workspace, and compliance over it",
        (
            Text(
                "Positioning workspace: the points at which the tilted spindle can be rotated "
                "all the way round the vertical while its own rotation is free, with balls of "
                "±55°. On a complete guide the joints limit only its radius; heights follow from "
                "strokes, which are not printed. Nor are the axes of the sockets: counted from "
                "the links at home they leave nothing at 90°, since the link of leg 1 rotates by "
                "87° in the platform. Singular poses on the path are not checked."
            ),
            Figure(
                "positioning",
                "Radius of the positioning workspace by tilt (the document's Figs 8 and 9); the "
                "search ends at 150 mm.",
                curves(
                    TILTS,
                    lines,
                    ("tilt (deg)", "radius (mm)"),
                    limits={"printed: a cylinder of 100 mm in diameter": PRINTED},
                    from_zero=True,
                ),
                "Two lines of the radius over the tilt, one for each choice of the sockets' axes.",
                RADIUS,
                340,
            ),
            Text(
                "Norm of the compliance over places of the tool in the plane of the guide, as "
                "the document's Fig. 13 draws it without numbers; tool at the platform's centre, "
                "six drives. That of the joints alone is relative, as in the document: here all "
                "drives are equally stiff along their paths, and the value in the middle is one."
            ),
            *(Row(_maps(name, found), 380) for name, found in maps.items()),
        ),
        (file, _norm_file(maps)),
    )


def _maps(name: str, found: Across) -> tuple[Figure, Figure]:
    titles = ("x (mm)", "y (mm)")
    some = (
        ("structural", "of links and columns", 1e6 * found.structural, "log₁₀ of µm/N"),
        ("joint", "of the drives", found.joint, "log₁₀ of the middle's"),
    )
    structural, joint = (
        Figure(
            f"{key}-across-{name}",
            f"Norm of the compliance {words} at tilt {name} deg.",
            heat(1e3 * ACROSS, 1e3 * ACROSS, np.log10(values), (*titles, unit)),
            f"Map of the norm of the compliance {words} over x and y at tilt {name} degrees.",
            NORM,
        )
        for key, words, values, unit in some
    )
    return structural, joint


def _norm_file(maps: dict[str, Across]) -> DataFile:
    rows = [
        [name, float(x), float(y), float(found.structural[i, k]), float(found.joint[i, k])]
        for name, found in maps.items()
        for i, x in enumerate(ACROSS)
        for k, y in enumerate(ACROSS)
    ]
    return csv_file(
        NORM,
        "norm of the compliance of the tool's position over the plane of the guide",
        ("tilt_deg", "x_m", "y_m", "structural_m_per_N", "joint_over_middle"),
        rows,
    )
