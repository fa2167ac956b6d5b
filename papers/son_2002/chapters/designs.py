"""Designs (a), (b), (c) of Fig. 39 of Son 2002, as read here, them."""

from __future__ import annotations

from strutwork.papers.son_2002.assembly_map import FORCES
from strutwork.papers.son_2002.designs import DATUM_ZONE, MARGIN, RAIL_LENGTH
from strutwork.papers.son_2002.mit_ss1_study import MitSS1Study
from strutwork.papers.son_2002.tolerances import RAIL_HEIGHT, STATIC_RATING
from strutwork.papers.tables import numbers, texts
from strutwork.reports.content import Block, Figure, Table, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.force_bars import ForceBars, force_bars
from strutwork.reports.figures.theme import PALETTE
from strutwork.reports.numbers import significant


def design_blocks(study: MitSS1Study) -> tuple[list[Block], list[DataFile]]:
    """Designs (a), (b), (c) of Fig. 39."""
    file = "designs.csv"
    names = [f"({d.design.letter}) {d.design.title}" for d in study.designs]
    short = [f"design ({d.design.letter})" for d in study.designs]
    bars = [
        ForceBars(
            f"rails alone, {FORCES[0]}",
            [1e-3 * d.rails[FORCES[0]] for d in study.designs],
            PALETTE[0],
        ),
        ForceBars(
            f"rails and pins, {FORCES[0]}",
            [1e-3 * d.everything[FORCES[0]] for d in study.designs],
            PALETTE[5],
        ),
        ForceBars(
            f"rails alone, {FORCES[1]}",
            [1e-3 * d.rails[FORCES[1]] for d in study.designs],
            PALETTE[1],
            "/",
        ),
        ForceBars(
            f"rails and pins, {FORCES[1]}",
            [1e-3 * d.everything[FORCES[1]] for d in study.designs],
            PALETTE[4],
            "/",
        ),
    ]
    rows = []
    for name, d in zip(names, study.designs, strict=True):
        cells = [name]
        for some in (d.rails, d.everything):
            cells += [significant(some[kind] / 1e3) for kind in FORCES]
        cells.append(significant(1e6 * float(d.tool[1])))
        rows.append(cells)
    first, last = study.designs[0], study.designs[-1]
    rating = significant(STATIC_RATING / 1e3)
    gain = first.rails[FORCES[0]] / last.rails[FORCES[0]]
    blocks: list[Block] = [
        Text(
            "The thesis shows three designs in Fig. 39: rails on separate datum surfaces, two on "
            "one, all on one ground surface. Its dimensions are not published. It is interpreted "
            f"here with assumed sizes: every datum surface lies within {1e6 * DATUM_ZONE:g} µm of "
            "its place (height along y and two tilts, its corners within the zone); every rail "
            f"lies on its datum within {1e6 * RAIL_HEIGHT:g} µm (the parallelism of section 8.6) "
            f"over {1e3 * RAIL_LENGTH:g} mm of length; surfaces are {1e3 * MARGIN:g} mm wider "
            "than the spacing of their rails. In (b) rails 1 and 2 share, those of the equal "
            "struts. A deviation of a common datum, equal for all its rails, locks in no force: "
            "from (a) to (c) the rails' share of the largest radial force falls "
            f"{significant(gain, 2)}-fold, and the parallelism of the pins is what remains. All "
            "are the same machine at home."
        ),
        Figure(
            "design-forces",
            "Largest worst-case force in any of the twelve bearings.",
            force_bars(
                short,
                bars,
                "force (kN)",
                {f"assumed static rating {rating} kN": STATIC_RATING / 1e3},
            ),
            "Bars of the largest radial and axial worst-case force of the three designs, from the "
            "rails alone and with the pins.",
            file,
            440,
        ),
        Table(
            "The three designs: largest worst-case force in any bearing",
            (
                *texts("design, as interpreted here"),
                *numbers("radial", "axial", unit="kN", group="rails alone"),
                *numbers("radial", "axial", unit="kN", group="rails and pins"),
                *numbers("tool along y, rails alone", unit="µm"),
            ),
            rows,
            file,
        ),
    ]
    content = [
        [
            d.design.letter,
            d.design.title,
            *(float(some[kind]) for some in (d.rails, d.everything) for kind in FORCES),
            *map(float, d.tool),
        ]
        for d in study.designs
    ]
    heads = ["design", "title"]
    heads += [f"{of}_{kind.split()[0]}_N" for of in ("rails", "rails_and_pins") for kind in FORCES]
    heads += [f"tool_{d}" for d in ("x_m", "y_m", "z_m", "rx_rad", "ry_rad", "rz_rad")]
    what = "worst-case forces of the designs of Fig. 39, as interpreted here"
    return blocks, [csv_file(file, what, heads, content)]
