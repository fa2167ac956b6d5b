"""How far the four machines tilt, and which of the three types of singular poses lie on the way."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from strutwork.papers.azulay_2014.chapters.comparison import SHORT
from strutwork.papers.azulay_2014.published import TABLE_3
from strutwork.papers.azulay_2014.singular_types import SingularTilts
from strutwork.papers.azulay_2014.tilt_study import RADII, TiltStudy
from strutwork.papers.azulay_2014.tilts import TiltPlane
from strutwork.papers.tables import numbers, texts
from strutwork.reports.content import Chapter, Figure, Row, Table, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.curves import Curve, curves, heat
from strutwork.reports.figures.theme import PALETTE

PLANES, LENGTHS, TYPES = "tilt-planes.csv", "tilt-by-radius.csv", "singular-tilts.csv"

#: What a pose is, from worst to best, and its colour.
KINDS: Mapping[str, str] = {
    "out of reach": "#f2f4f6",
    "outside a joint's range": "#c9ced6",
    "within ranges, cut off from the pole": "#e6b36a",
    "connected, across the ring": "#8fbbe0",
    "connected, before the ring": "#1f6fa8",
}

TILT_NAME = "platform tilt angle"


def tilts_chapter(study: TiltStudy) -> Chapter:
    """Tilts beside Table 3 and Fig. 3, and singular poses by type."""
    return Chapter(
        "tilts",
        "How far it tilts, and singular poses by type",
        (
            Text(
                "Table 3 prints one tilt angle for each machine, and does not say at which roll, "
                "from where a joint's range is counted, nor whether the path there leads through "
                "a singular pose. The computed tilts are given beside it for the 4 mm "
                "hemisphere: within the joint ranges at any roll, whatever the path; by poses "
                "within the ranges that are connected with the pole; and the same before the "
                "singular ring, which is as far as six drives reach. Collisions of bodies are "
                "not checked. Neutral directions of the spherical joints, middles of strokes and "
                "heights of the pole are assumed: none of these tilts is a prediction, and none "
                "meets the paper's."
            ),
            _tilts_table(study),
            Row(tuple(_plane(name, found) for name, found in study.planes.items()), 380),
            Text(
                "Fig. 3 draws the tilt of the proposed machine by the radius of the sphere for "
                "several link lengths, and the paper finds 196 mm better than 216 mm. With the "
                "assumed heights and neutral directions it is the opposite on small spheres: "
                "links of 196 mm bring the sliders to the inner end of their stroke, and with "
                "216 mm a spherical joint limits the tilt."
            ),
            _by_radius(study),
            Text(
                "Singular poses by the paper's eq. 35. Type 2, det J⁻¹ = 0: the platform can "
                "move although the drives are held. Type 1, det J⁻¹ = ±∞: a drive can move "
                "although the platform stands still; that is where a joint of the platform "
                "reaches the guide's axis, at a tilt whose tangent is R_p over the radius of the "
                "sphere (and at 180° less that, half a turn of roll away), whatever the machine, "
                "and where a leg is straight at the end of reach. Type 3: both at once. The "
                "paper shows only type 2; type 1 on the axis also occurs below 90°, at single "
                "rolls, which a path can avoid."
            ),
            _types_table(study),
        ),
        (_planes_file(study), _lengths_file(study), _types_file(study)),
    )


def _deg(value: float) -> str:
    return f"{np.degrees(value):.1f}"


def _span(span: tuple[float, float] | None) -> str:
    return "none" if span is None else f"{_deg(span[0])} to {_deg(span[1])}"


def _tilts_table(study: TiltStudy) -> Table:
    rows = [
        [
            SHORT[name],
            f"{TABLE_3.value(name, TILT_NAME):g}",
            _deg(plane.largest.reached),
            _deg(plane.largest.connected),
            _deg(plane.largest.before_the_ring),
        ]
        for name, plane in study.planes.items()
    ]
    columns = (
        *texts("machine"),
        *numbers("Table 3", unit="deg", group="published"),
        *numbers(
            "within joint ranges",
            "connected with the pole",
            "before the ring",
            unit="deg",
            group="computed, not reproducible",
        ),
    )
    return Table("Largest tilt from the pole, 4 mm hemisphere", columns, rows, PLANES)


def _types_table(study: TiltStudy) -> Table:
    rows = [[SHORT[name], *_types(found)] for name, found in study.singular.items()]
    columns = texts(
        "machine",
        "type 2, first ring",
        "type 2, second ring",
        "type 1, joint on the axis",
        "type 1, end of reach",
        "type 3",
    )
    return Table("Singular tilts over all rolls, deg; 4 mm hemisphere", columns, rows, TYPES)


def _types(found: SingularTilts) -> list[str]:
    rings = [_span(one) for one in found.parallel]
    axis = "out of reach" if found.on_axis is None else _deg(found.on_axis)
    return [
        *(rings + ["none"] * 2)[:2],
        axis,
        _span(found.end_of_reach),
        "none" if found.both > 0 else "where the end of reach meets a ring",
    ]


def _kinds(plane: TiltPlane) -> Any:
    """Index into `KINDS`, (tilts, rolls)."""
    some = (plane.reached, plane.inside, plane.connected, plane.before_the_ring)
    return np.sum([mask.astype(int) for mask in some], axis=0)


def _plane(name: str, plane: TiltPlane) -> Figure:
    kinds = _kinds(plane)
    spec = heat(
        np.degrees(plane.tilt),
        np.degrees(plane.roll),
        kinds,
        ("tilt (deg)", "roll (deg)", ""),
    )
    colours = list(KINDS.values())
    steps = [(i + k) / len(colours) for i in range(len(colours)) for k in (0, 1)]
    spec["data"][0] |= {
        "zmin": -0.5,
        "zmax": len(colours) - 0.5,
        "colorscale": [[at, colours[i // 2]] for i, at in enumerate(steps)],
        "showscale": False,
        "hovertemplate": "tilt %{x:.3g}°, roll %{y:.3g}°<extra></extra>",
    }
    spec["data"] += [
        {
            "type": "scatter",
            "mode": "markers",
            "x": [None],
            "y": [None],
            "name": word,
            "marker": {"symbol": "square", "size": 12, "color": colour},
        }
        for word, colour in KINDS.items()
    ]
    return Figure(
        f"tilt-plane-{name}",
        f"{SHORT[name]}: poses over tilt and roll, which repeats every 120°.",
        spec,
        f"Map over tilt and roll of {SHORT[name]}: what is reached, within joint ranges, connected "
        "with the pole, and on its side of the singular ring.",
        PLANES,
        400,
    )


def _by_radius(study: TiltStudy) -> Figure:
    lines = [
        Curve(
            f"L = {1e3 * length:g} mm, {word}",
            [np.degrees(getattr(t, field)) for t in found],
            PALETTE[i],
            dash,
        )
        for i, (length, found) in enumerate(study.by_radius.items())
        for field, word, dash in (
            ("connected", "connected with the pole", "solid"),
            ("before_the_ring", "before the ring", "dot"),
        )
    ]
    return Figure(
        "tilt-by-radius",
        "Largest tilt of the proposed machine by the radius of the sphere (Fig. 3).",
        curves(1e3 * RADII, lines, ("radius of the sphere (mm)", "tilt (deg)"), from_zero=True),
        "Lines of the tilt over the radius of the sphere for three link lengths, those before the "
        "ring near 35 degrees.",
        LENGTHS,
        380,
    )


def _planes_file(study: TiltStudy) -> DataFile:
    words = list(KINDS)
    rows = [
        [name, float(np.degrees(t)), float(np.degrees(r)), words[kind]]
        for name, plane in study.planes.items()
        for t, line in zip(plane.tilt, _kinds(plane), strict=True)
        for r, kind in zip(plane.roll, line, strict=True)
    ]
    return csv_file(
        PLANES,
        "poses over tilt and roll of the four machines, by type",
        ("machine", "tilt_deg", "roll_deg", "kind"),
        rows,
    )


def _lengths_file(study: TiltStudy) -> DataFile:
    rows = [
        [
            length,
            float(r),
            *(float(np.degrees(v)) for v in (t.reached, t.connected, t.before_the_ring)),
        ]
        for length, found in study.by_radius.items()
        for r, t in zip(RADII, found, strict=True)
    ]
    return csv_file(
        LENGTHS,
        "largest tilts of the proposed machine by link length and radius of the sphere",
        ("link_length_m", "radius_m", "reached_deg", "connected_deg", "before_the_ring_deg"),
        rows,
    )


def _types_file(study: TiltStudy) -> DataFile:
    rows: list[list[Any]] = []
    for name, found in study.singular.items():
        rows += [[name, "2", *map(float, np.degrees(span))] for span in found.parallel]
        if found.on_axis is not None:
            rows.append([name, "1, joint on the axis", *[float(np.degrees(found.on_axis))] * 2])
        if found.end_of_reach is not None:
            rows.append([name, "1, end of reach", *map(float, np.degrees(found.end_of_reach))])
    return csv_file(
        TYPES,
        "singular tilts of the four machines by type, least and largest over the rolls",
        ("machine", "type", "least_deg", "largest_deg"),
        rows,
    )
