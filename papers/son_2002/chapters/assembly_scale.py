"""Assembly forces of Table 2's structure against the length of its struts."""

from __future__ import annotations

import numpy as np

from strutwork.papers.son_2002.assembly_scale import WIDTH_RATIO
from strutwork.papers.son_2002.assembly_table import COLUMNS
from strutwork.papers.son_2002.mit_ss1_study import MitSS1Study
from strutwork.papers.son_2002.published import TABLE_2
from strutwork.papers.son_2002.strut_assembly import CASES, strut_width
from strutwork.papers.son_2002.tolerances import STATIC_RATING
from strutwork.papers.tables import numbers, texts
from strutwork.reports.content import Block, Cell, Column, Figure, Row, Table, Text
from strutwork.reports.data_files import DataFile, csv_file, netcdf_file
from strutwork.reports.figures.curves import Curve, curves
from strutwork.reports.figures.theme import PALETTE
from strutwork.reports.numbers import micro, significant

#: Thickness of the strut for which eq. 64 is shown, m. Our choice.
THICKNESS = 0.030


def scale_blocks(study: MitSS1Study) -> tuple[list[Block], list[DataFile]]:
    """Forces against the length of the struts."""
    scale = study.scale
    lengths = scale.lengths
    file = "assembly-scale.csv"
    colours = (PALETTE[0], PALETTE[1], PALETTE[2])
    figures = []
    published = {
        (case, n, q): 1e3 * TABLE_2.value(f"case {case} joint {n}", q)
        for case in CASES
        for n in range(1, 7)
        for q in COLUMNS
    }
    for quantity, index in (("Fr", 0), ("Fa", 1)):
        some, marks = [], []
        for n in range(1, 7):
            if quantity == "Fa" and n % 2 == 0:
                # both joints of a pair carry the same axial force
                continue
            colour, far = colours[(n - 1) // 2], n % 2 == 1
            name = f"joints {n}, {n + 1}" if quantity == "Fa" else f"joint {n}"
            if quantity == "Fr":
                name += ", far" if far else ", near"
            dash = "solid" if far else "dash"
            some += [Curve(name, 1e-3 * scale.forces[:, index, n - 1], colour, dash)]
            marks.append(
                (
                    f"Table 2, joint {n}",
                    [CASES[c][0] for c in CASES],
                    [1e-3 * published[c, n, quantity] for c in CASES],
                    colour,
                )
            )
        if quantity == "Fa":
            some.append(Curve("(4/3) k_y τ l", 1e-3 * scale.axial_limit, "#000000", "dot"))
        limits = {f"static rating {significant(STATIC_RATING / 1e3)} kN": STATIC_RATING / 1e3}
        words = COLUMNS[quantity]
        figure = curves(
            lengths,
            some,
            ("length of the struts (m)", f"worst-case {words} (kN)"),
            marks,
            limits,
            from_zero=True,
        )
        for trace in figure["data"]:
            if trace["mode"] == "markers":
                trace["showlegend"] = False
        figures.append(
            Figure(
                f"scale-{quantity.lower()}",
                f"Worst-case {words} of each joint against the length of the struts; diamonds are "
                "Table 2, the dashed line the assumed static rating.",
                figure,
                f"Lines of the worst-case {words} of the joints over strut lengths of 0.1 to 3 m.",
                file,
                480,
            )
        )
    at = scale.length_at()
    k_y = scale.assembly.axial_stiffness
    thickness = 4 * k_y / (200e9 * WIDTH_RATIO**3)
    ratio = strut_width(1.0, THICKNESS, k_y)
    blocks: list[Block] = [
        Text(
            "The structure of Table 2 with struts of 0.1 to 3 m and the stiffnesses of the fit to "
            f"all cases; w = {WIDTH_RATIO:g} l, as in the three cases. Over the three cases the "
            "radial forces of the far joints 1 and 3 are proportional to the length within 1 %; "
            "those of the near joints 2 and 4 are affine, and a line through the origin misses "
            "them by up to 17 %: what the thesis calls linear. The axial forces tend to "
            "(4/3) k_y τ l. The largest radial force reaches the assumed static rating of "
            f"{significant(STATIC_RATING / 1e3)} kN at l = {significant(at)} m: small machines of "
            "this kind can be assembled, large ones with such bearings cannot, which is the "
            "thesis's conclusion."
        ),
        Row(tuple(figures), 420),
        _lines_table(study),
        _scale_table(study, file),
        Text(
            "Eq. 64 gives the width, read as w = l (4 K_y / (E t))^(1/3), a cantilever of the "
            "section t x w bent along y with the tip stiffness K_y = E t w³ / (4 l³): width and "
            "length grow together and K_y is constant, which is why the stiffnesses can be "
            f"constant here. With K_y = k_y = {micro(k_y, 4)} N/µm and steel, w = {WIDTH_RATIO:g} "
            f"l requires t = {significant(1e3 * thickness)} mm; a strut of "
            f"{significant(1e3 * THICKNESS)} mm would have w = {significant(ratio)} l. Thickness "
            "and K_y are not published, so the cases' ratio is used."
        ),
    ]
    rows = [
        [float(a), float(w), *map(float, f[0]), *map(float, f[1]), float(limit)]
        for a, w, f, limit in zip(
            lengths, scale.widths, scale.forces, scale.axial_limit, strict=True
        )
    ]
    heads = ["length_m", "width_m"]
    heads += [f"{kind}_joint{n}_N" for kind in ("radial", "axial") for n in range(1, 7)]
    files = [
        csv_file(
            file, "worst-case forces against the struts' length", [*heads, "axial_limit_N"], rows
        ),
        netcdf_file("assembly-scale.nc", "the same as a dataset", scale.to_dataset()),
    ]
    return blocks, files


def _lines_table(study: MitSS1Study) -> Table:
    rows = []
    for (kind, n), line in study.scale.affine.items():
        straight = study.scale.proportional[kind, n]
        if kind == "axial force" and n % 2 == 0:
            continue
        name = f"joints {n}, {n + 1}" if kind == "axial force" else f"joint {n}"
        rows.append(
            [
                f"{kind}, {name}",
                significant(line.slope / 1e3),
                significant(line.intercept / 1e3),
                f"{100 * line.error:.1f} %",
                significant(straight.slope / 1e3),
                f"{100 * straight.error:.1f} %",
            ]
        )
    return Table(
        "Straight lines fitted over the three cases of Table 2 (l = 0.5, 1.0 and 1.5 m)",
        (
            *texts("force"),
            *numbers("slope", unit="kN/m", group="affine"),
            *numbers("at l = 0", unit="kN", group="affine"),
            *numbers("largest error", group="affine"),
            *numbers("slope", unit="kN/m", group="proportional"),
            *numbers("largest error", group="proportional"),
        ),
        rows,
        "report.json",
    )


def _scale_table(study: MitSS1Study, file: str) -> Table:
    scale = study.scale
    wanted = (0.1, 0.3, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0)
    rows: list[list[str | Cell]] = []
    for value in wanted:
        i = int(np.abs(scale.lengths - value).argmin())
        row: list[str | Cell] = [significant(float(scale.lengths[i]), 2)]
        row.append(significant(float(scale.widths[i]), 2))
        row += [
            Cell(significant(force / 1e3), "poor" if force > STATIC_RATING else "plain")
            for force in scale.forces[i, 0]
        ]
        row += [significant(f / 1e3) for f in scale.forces[i, 1, ::2]]
        rows.append(row)
    columns = [Column("l", "m"), Column("w", "m")]
    columns += [Column(f"joint {n}", "kN", True, "radial force") for n in range(1, 7)]
    columns += [Column(f"joints {n}, {n + 1}", "kN", True, "axial force") for n in (1, 3, 5)]
    return Table(
        "Worst-case forces against the length of the struts (red: above the static rating)",
        columns,
        rows,
        file,
    )
