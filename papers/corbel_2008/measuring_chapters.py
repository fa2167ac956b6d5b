"""Chapter on the measuring platform: what its encoders' resolution leaves open at the tool."""

from __future__ import annotations

from itertools import product

import numpy as np

from strutwork.papers.corbel_2008.measuring import BOX, Array, MeasuringStudy, heights
from strutwork.reports.content import Chapter, Fact, Facts, Figure, Note, Row, Text
from strutwork.reports.data_files import DataFile, csv_file
from strutwork.reports.figures.curves import Curve, curves, heat
from strutwork.reports.figures.theme import PALETTE

AHEAD, PLATE, BASE = "platform-ahead.csv", "platform-plate.csv", "platform-base.csv"

BOX_TEXT = (
    f"{1e3 * BOX[0][1]:g} mm to either side along x and y and {1e3 * BOX[2][0]:g} to "
    f"{1e3 * BOX[2][1]:g} mm ahead"
)


def resolution_chapter(study: MeasuringStudy) -> Chapter:
    """Amplification of encoder errors: where the tool is, and by four dimensions."""
    machine = study.machine
    least = int(study.by_ahead.argmin())
    low, high = heights(machine)
    return Chapter(
        "resolution",
        "How accurately does the platform measure the tool?",
        (
            Facts(
                (
                    Fact("At the plate's centre", f"{study.by_ahead[0]:.2f}", "", "times ε"),
                    Fact(
                        "Best tool point",
                        f"{study.by_ahead[least]:.2f}",
                        "",
                        f"times ε, {1e3 * study.ahead[least]:.0f} mm ahead of the plate",
                    ),
                    Fact("In the box of tools", f"{study.box:.2f}", "", "times ε"),
                    Fact(
                        "Widest base",
                        f"{1e3 * study.widest:.0f}",
                        "mm",
                        f"{study.at_widest:.2f} times ε, with the legs' range fully used",
                    ),
                )
            ),
            Text(
                "Each of six encoders may have an error of ±ε. The worst error of a tool point "
                "over all signs and over the workspace, divided by ε, is the document's "
                "criterion. It is found at vertices: the error is linear in the encoders' "
                "errors, and linear in the tool point, and the length of a vector is convex, so "
                "nothing inside is worse. Half of the 64 combinations of signs suffice, since "
                "the others are their negatives."
            ),
            Note(
                "The document's box of tool points, the resolution that it prints and the height "
                f"of the plate are not legible. The box here, {BOX_TEXT} of the plate's "
                "centre, is assumed. Legs of the printed range leave the plate's height at home "
                f"between {1e3 * low:.1f} and {1e3 * high:.1f} mm; nearer to the base is better."
            ),
            Figure(
                "platform-ahead",
                "Worst error of a tool point on the axis, for encoder errors of one.",
                curves(
                    1e3 * study.ahead,
                    [Curve("largest over the workspace", study.by_ahead, PALETTE[0])],
                    ("tool ahead of the plate (mm)", "amplification"),
                    [
                        (
                            "least",
                            [1e3 * study.ahead[least]],
                            [study.by_ahead[least]],
                            "#000000",
                        )
                    ],
                    from_zero=True,
                ),
                "Line of the amplification over the distance of the tool from the plate: it falls "
                "to a least value and rises again",
                AHEAD,
            ),
            Row(
                (
                    _map(
                        (
                            "platform-plate",
                            "The plate's radius and pairs; marked as printed.",
                        ),
                        (study.radii, study.pairs, study.by_plate),
                        ("r_TP (mm)", "α_TP (deg)"),
                        (machine.plate_radius, machine.plate_pair),
                        PLATE,
                    ),
                    _map(
                        (
                            "platform-base",
                            "The base's; blank beyond the legs' range.",
                        ),
                        (study.base_radii, study.base_pairs, study.by_base),
                        ("r_b (mm)", "α_b (deg)"),
                        (machine.base_radius, machine.base_pair),
                        BASE,
                    ),
                ),
                420,
            ),
            Text(
                "Each geometry of the maps is as low as its legs allow, with tool points in the "
                "box. As the document says, small angles and large radii are better. Neither has "
                "an optimum before parts collide or the legs' range ends: with its other "
                f"dimensions as printed the base could be {1e3 * study.widest:.0f} mm in radius."
            ),
        ),
        (
            csv_file(
                AHEAD,
                "amplification of encoder errors by the distance of the tool point, SI",
                ["ahead_m", "amplification"],
                np.stack([study.ahead, study.by_ahead], axis=-1).tolist(),
            ),
            _file(PLATE, "plate", (study.pairs, study.radii, study.by_plate)),
            _file(BASE, "base", (study.base_pairs, study.base_radii, study.by_base)),
        ),
    )


def _map(
    words: tuple[str, str],
    found: tuple[Array, Array, Array],
    titles: tuple[str, str],
    printed: tuple[float, float],
    file: str,
) -> Figure:
    radii, pairs, values = found
    return Figure(
        words[0],
        words[1],
        heat(
            1e3 * radii,
            np.degrees(pairs),
            values.T,
            (*titles, "amplification"),
            {"as printed": (1e3 * printed[0], float(np.degrees(printed[1])))},
        ),
        f"Map of the amplification over {titles[0]} and {titles[1]}: least at the largest radius "
        "and the smallest angle",
        file,
    )


def _file(name: str, part: str, found: tuple[Array, Array, Array]) -> DataFile:
    pairs, radii, values = found
    return csv_file(
        name,
        f"amplification in the box of tools by the {part}'s pair angle and radius, SI",
        ["pair_rad", "radius_m", "amplification"],
        [
            [pairs[k], radii[n], values[k, n]]
            for k, n in product(range(len(pairs)), range(len(radii)))
            if np.isfinite(values[k, n])
        ],
    )
