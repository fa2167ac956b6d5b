"""Chapters on the Delta: its condition, and the spacing of its rods."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from strutwork.papers.corbel_2008.actuation import (
    ActuationStudy,
    Array,
    square,
    turn_by_difference,
    worst_deviation,
    worst_turn,
)
from strutwork.papers.tables import numbers
from strutwork.reports.content import Chapter, Column, Fact, Facts, Figure, Table, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.curves import Curve, curves, heat
from strutwork.reports.figures.theme import PALETTE

#: Spacings of a parallelogram's rods that are compared, m, the document's among them, and the
#: fewer ones that a table shows.
SPACINGS = tuple(round(0.0125 * n, 4) for n in range(2, 13))
SHOWN = (0.025, 0.050, 0.075, 0.100, 0.150)
#: Error of a rod's length, m, and how far ahead of the plate a tool point lies, m. Ours.
ERROR, AHEAD = 10e-6, 0.2

CONDITION, LINES = "delta-condition.csv", "delta-lines.csv"
BEST, RODS = "delta-best.csv", "delta-rods.csv"


def condition_chapter(study: ActuationStudy) -> Chapter:
    """Largest condition number over ΔR and L (Fig. 6)."""
    best = study.best_of(study.machine.rod_length)
    reaches = 1e3 * study.reaches
    lines = [
        Curve(f"L = {1e3 * b.rod:g} mm", line, PALETTE[k])
        for k, (b, line) in enumerate(zip(study.best, study.lines, strict=True))
    ]
    marks = [
        ("least", [1e3 * b.reach for b in study.best], [b.worst for b in study.best], "#000000"),
        ("as printed", [1e3 * study.machine.reach], [study.corner], "#a02c2c"),
    ]
    return Chapter(
        "condition",
        "How evenly does the Delta move?",
        (
            Facts(
                (
                    Fact("Largest condition number", f"{study.corner:.3f}", "", "at two corners"),
                    Fact("In the middle", f"{study.centre:.3f}"),
                    Fact(
                        "Best ΔR",
                        f"{1e3 * best.reach:.0f}",
                        "mm",
                        f"{best.worst:.3f}; the document has {1e3 * study.machine.reach:.0f} mm",
                    ),
                    Fact(
                        "Tool speed by carriage speed",
                        f"{study.gains[0]:.3f} to {study.gains[1]:.3f}",
                    ),
                )
            ),
            Text(
                "The position along the rails does not matter, so a square of "
                f"{1e3 * study.machine.workspace_side:.0f} mm represents the cube. In its middle "
                "the Delta is isotropic at ΔR = √(2/3) L, with all singular values of its "
                "Jacobian √(1/3): isotropic is not one to one. Over the square the least of the "
                "largest condition numbers lies far below that ΔR, and it is flat: for rods of "
                f"{1e3 * best.rod:.0f} mm any ΔR of {1e3 * best.low:.0f} to {1e3 * best.high:.0f} "
                "mm is within 1 %. Longer rods are better."
            ),
            Figure(
                "delta-map",
                "Largest condition number over the workspace (Fig. 6 of the document, whose "
                "numbers are not legible). Blank: rods too short.",
                heat(
                    reaches,
                    1e3 * study.rods,
                    study.worst.T,
                    ("ΔR (mm)", "L (mm)", "largest condition number"),
                    {
                        "as printed": (1e3 * study.machine.reach, 1e3 * best.rod),
                        "best for these rods": (1e3 * best.reach, 1e3 * best.rod),
                    },
                ),
                "Map of the largest condition number over the difference of the radii and the "
                "length of the rods: a valley that falls as both grow",
                CONDITION,
            ),
            Figure(
                "delta-lines",
                "The same for four lengths of the rods, with the least of each.",
                curves(1e3 * study.fine, lines, ("ΔR (mm)", "largest condition number"), marks),
                "Lines of the largest condition number over the difference of the radii, each "
                "with a flat minimum",
                LINES,
            ),
            Table(
                "Best ΔR by the length of the rods",
                (
                    Column("L", "mm"),
                    Column("best ΔR", "mm"),
                    Column("largest condition number"),
                    Column("within 1 %: from", "mm"),
                    Column("to", "mm"),
                ),
                [
                    [
                        f"{1e3 * b.rod:.0f}",
                        f"{1e3 * b.reach:.1f}",
                        f"{b.worst:.4f}",
                        f"{1e3 * b.low:.0f}",
                        f"{1e3 * b.high:.0f}",
                    ]
                    for b in study.best
                ],
                BEST,
            ),
        ),
        (
            _file(CONDITION, study.rods, study.reaches, study.worst),
            _file(LINES, np.array([b.rod for b in study.best]), study.fine, study.lines),
            csv_file(
                BEST,
                "best difference of the radii by the length of the rods, SI",
                ["rod_length_m", "delta_r_m", "largest_condition", "from_m", "to_m"],
                [[b.rod, b.reach, b.worst, b.low, b.high] for b in study.best],
            ),
        ),
    )


def _file(name: str, rods: Array, reaches: Array, worst: Array) -> DataFile:
    return csv_file(
        name,
        "largest condition number of the Delta over its workspace, SI",
        ["rod_length_m", "delta_r_m", "largest_condition"],
        [
            [rods[k], reaches[n], worst[k, n]]
            for k, n in np.ndindex(worst.shape)
            if np.isfinite(worst[k, n])
        ],
    )


def rods_chapter(study: ActuationStudy) -> Chapter:
    """What the spacing d of the rods is for."""
    machine = study.machine
    places = square(machine)
    rows = []
    for spacing in SPACINGS:
        made = replace(machine, rod_spacing=spacing)
        rows.append(
            [
                spacing,
                ERROR * float(worst_turn(made, places).max()),
                ERROR * float(worst_deviation(made, places, 0.0).max()),
                ERROR * float(worst_deviation(made, places, AHEAD).max()),
            ]
        )
    factors = turn_by_difference(machine, places)
    middle = float(turn_by_difference(machine, [0.0, 0.0, 0.0]).max())
    return Chapter(
        "spacing",
        "Why are the rods of a parallelogram far apart?",
        (
            Text(
                "The spacing d of the rods does not affect the motion: it is not in the "
                "Jacobian. It matters where the two rods of a parallelogram differ in length by "
                f"δ, which rotates the platform by about δ/d: {middle:.4f} δ/d in the middle of "
                f"the workspace, {factors.min():.4f} to {factors.max():.4f} over it. This follows "
                "from the constraint rows alone, since nothing is constrained twice. The "
                "document makes d as large as possible for this reason."
            ),
            Figure(
                "delta-spacing",
                "Largest rotation of the platform over the workspace by six rods that each have "
                f"an error of up to {1e6 * ERROR:g} µm.",
                curves(
                    [1e3 * r[0] for r in rows],
                    [Curve("rotation", [1e6 * r[1] for r in rows], PALETTE[0])],
                    ("spacing d (mm)", "rotation (µrad)"),
                    [
                        (
                            "as printed",
                            [1e3 * machine.rod_spacing],
                            [1e6 * r[1] for r in rows if r[0] == machine.rod_spacing],
                            "#a02c2c",
                        )
                    ],
                    from_zero=True,
                ),
                "Line of the largest rotation over the spacing of the rods, falling as one over "
                "the spacing",
                RODS,
            ),
            Table(
                f"Worst case of six rods, each with an error of up to {1e6 * ERROR:g} µm",
                (
                    *numbers("spacing d", unit="mm"),
                    *numbers("rotation", unit="µrad"),
                    *numbers("plate's centre", f"{1e3 * AHEAD:g} mm ahead", unit="µm"),
                ),
                [
                    [f"{1e3 * d:g}", f"{1e6 * turn:.0f}", f"{1e6 * at:.1f}", f"{1e6 * far:.1f}"]
                    for d, turn, at, far in rows
                    if d in SHOWN
                ],
                RODS,
            ),
        ),
        (
            csv_file(
                RODS,
                "worst rotation and displacement by errors of the rods, SI",
                ["spacing_m", "rotation_rad", "centre_m", f"ahead_{1e3 * AHEAD:g}_mm_m"],
                rows,
            ),
        ),
    )
