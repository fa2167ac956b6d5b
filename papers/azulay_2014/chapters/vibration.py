"""Vibration of the machines of Azulay et al. 2014: Table 5, link lengths, sensitivities."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from strutwork.machines import DYNAMIC_SETS, dynamic_machine, get
from strutwork.papers.azulay_2014.chapters.comparison import SHORT, in_order
from strutwork.papers.azulay_2014.chapters.sensitivity import (
    DASHES,
    link_length_blocks,
    sensitivity_blocks,
)
from strutwork.papers.azulay_2014.comparison import PROPOSED
from strutwork.papers.azulay_2014.dynamic import (
    AzulayDynamics,
    azulay_table_5,
    published_dynamic_ranking,
)
from strutwork.papers.azulay_2014.published import TABLE_5
from strutwork.papers.published_rows import file_name
from strutwork.papers.tables import difference, numbers, ours, rows_file, texts
from strutwork.reports.chapters.cover import vibration_answers
from strutwork.reports.chapters.vibration import (
    GRID_TEXT,
    SWING_TEXT,
    minima_table,
    mode_figure,
    modes_table,
    vibration_chapter,
    vibration_files,
)
from strutwork.reports.content import Block, Cell, Chapter, Column, Figure, Points, Row, Table, Text
from strutwork.reports.data_files import DataFile, csv_file, json_file
from strutwork.reports.figures.theme import PALETTE
from strutwork.reports.figures.vibration import responses
from strutwork.reports.numbers import significant
from strutwork.reports.vibration_study import AXES, study_machine_vibration

#: Both sets of Table 5 with frequencies and rankings.
VIBRATION_DATA = "vibration-table-5.json"

INTRODUCTION = (
    "The machine at home, roots clamped on the guide, drives locked, links with their mass and a "
    "rigid heavy platform, as in section 3.3.2 of the paper. Its Table 5 omits numbers that "
    "decide the results, so two sets of the missing numbers are shown side by side. All figures "
    "here are of the calibrated set."
)

#: What the sentences of the cover hold for.
GIVEN = "With a model calibrated to Table 5"

ASSUMPTIONS = (
    (
        "Damping: 1 % of critical in every mode, viscous; the paper prints “equivalent damping "
        "ratio of 1 %”. Read as a loss factor it would be half as much."
    ),
    (
        "Roots of the links clamped to the guide, drives rigid: no stiffness of guide, carriage or "
        "drive enters."
    ),
    "Spherical and revolute joints rotate freely and are rigid otherwise; the platform is rigid.",
    "Links are beams with shear and rotary inertia, eight elements each, of AISI 1018.",
    *(f"Set “{name}”: {meaning}." for name, meaning in DYNAMIC_SETS.items()),
    "No preload, no gravity, no cutting process: free vibration about the home pose.",
)


def machine_vibration(name: str) -> Chapter:
    """The vibration chapter of one machine."""
    study = study_machine_vibration(f"vibration-{name}", get(name).title, dynamic_machine(name))
    dynamics = azulay_table_5()
    table, files = table_5(dynamics, (name,))
    after: list[Block] = [*table, *_frequencies(dynamics, (name,))]
    if name == PROPOSED:
        blocks, some = link_length_blocks()
        after += blocks
        files += some
    blocks, some = sensitivity_blocks((name,))
    chapter = vibration_chapter(
        study, (Text(INTRODUCTION),), (*after, *blocks), (*files, *some), ASSUMPTIONS
    )
    return replace(chapter, cover=vibration_answers(study, given=GIVEN))


def comparison_vibration(names: Sequence[str]) -> Chapter:
    """The vibration chapter of the four machines side by side."""
    dynamics = azulay_table_5()
    studies = {
        n: study_machine_vibration(f"vibration-{n}", get(n).title, dynamic_machine(n))
        for n in names
    }
    table, files = table_5(dynamics, names)
    blocks: list[Block] = [Text(INTRODUCTION), *table, _rankings(dynamics)]
    figures = []
    for i, a in enumerate(AXES):
        curves, marks = {}, []
        for k, (n, study) in enumerate(studies.items()):
            label, response = SHORT[n], study.response
            if response is None:
                continue
            curves[label] = (
                response.frequencies,
                np.abs(response.receptance[:, i, i]),
                PALETTE[k],
                DASHES[k],
            )
            least = study.least[i]
            marks.append((f"{label}, least along {a}", least.frequency, least.value, PALETTE[k]))
        figures.append(
            Figure(
                f"frf-{a}",
                f"Displacement of the tool along {a} per force along {a} (content of Fig. 10). "
                "Diamonds: exact least dynamic stiffness.",
                responses(curves, marks),
                f"Lines of the receptance along {a} of the four machines.",
                "vibration-frf.csv",
                440,
            )
        )
    blocks += [Row(tuple(figures), 420)]
    blocks += [
        minima_table([(SHORT[n], s) for n, s in studies.items()], "vibration-minima.csv"),
        Text(GRID_TEXT),
        *_frequencies(dynamics, names),
    ]
    blocks += [modes_table(s, f"{s.title}: natural frequencies") for s in studies.values()]
    blocks += [
        Text(SWING_TEXT),
        Row(tuple(mode_figure(s, 470) for s in studies.values()), 380),
    ]
    lengths, some = link_length_blocks()
    sensitive, more = sensitivity_blocks(names)
    blocks += [*lengths, *sensitive, Points(ASSUMPTIONS)]
    minima = csv_file(
        "vibration-minima.csv",
        "exact least dynamic stiffness of the four machines and that of a frequency grid",
        ["machine", "axis", "static_N/m", "least_N/m", "frequency_Hz", "peak_m/N", "grid_N/m"],
        [
            [n, a, o.static, o.value, o.frequency, 1 / o.value, float(g)]
            for n, s in studies.items()
            for a, o, g in zip(AXES, s.least, s.grid, strict=True)
        ],
    )
    magnitudes = csv_file(
        "vibration-frf.csv",
        "receptances of the four machines as drawn; real and imaginary parts in their own files",
        ["machine", "frequency_Hz", *(f"receptance_{a}_m/N" for a in AXES)],
        [
            [n, float(f), *np.abs(np.diagonal(h)).tolist()]
            for n, s in studies.items()
            if s.response is not None
            for f, h in zip(s.response.frequencies, s.response.receptance, strict=True)
        ],
    )
    own = [f for s in studies.values() for f in vibration_files(s)]
    return Chapter(
        "vibration", "Vibration", tuple(blocks), (*files, minima, magnitudes, *own, *some, *more)
    )


def table_5(dynamics: AzulayDynamics, names: Sequence[str]) -> tuple[list[Block], list[DataFile]]:
    """Table 5 beside both sets, and its file."""
    columns = (*texts("machine", "quantity"), *numbers("published"), *ours(dynamics.rows))
    lines: list[list[str | Cell]] = []
    for rows in zip(*dynamics.rows.values(), strict=True):
        first = rows[0]
        if first.row not in names:
            continue
        line: list[str | Cell] = [first.row, first.quantity, significant(first.published)]
        for row in rows:
            line += [significant(row.computed), difference(row), row.status]
        lines.append(line)
    kept = [row for row in dynamics.table() if row.row.rsplit(",", 1)[0] in names]
    what = "Table 5 of the paper beside the computed values, both sets"
    file = rows_file(file_name(TABLE_5.key), what, kept)
    notes: dict[str, list[str]] = {}
    for row in kept:
        # the first remark says what the set is, which the assumptions say too
        for part in row.note.split("; ")[1:]:
            name, chosen = row.row.rsplit(", ", 1)
            about = SHORT[name] if "Kxx = Kyy" in part else f"{SHORT[name]} {row.quantity[:3]}"
            if "no platform mass" in part:
                about = f"set {chosen}"
            elif "Kxx = Kyy" not in part:
                about += f", {chosen}"
            notes.setdefault(part, []).append(about)
    remarks = tuple(f"{'; '.join(dict.fromkeys(about))}: {part}." for part, about in notes.items())
    blocks: list[Block] = [
        Table(f"Table 5 of the paper: {TABLE_5.title}, N/µm", columns, lines, file.name),
        Text(
            "“Calibrated”: what the paper omits was fitted to this table. “Not reproducible”: "
            "still farther than a factor of two from the printed value, or of the blind set, "
            "whose numbers are not predictions because the paper omits what decides them."
        ),
        Points(remarks),
    ]
    whole = json_file(
        VIBRATION_DATA,
        "both sets: frequencies, rankings, minima with a loss factor instead of a ratio",
        dynamics.to_dict(),
    )
    return blocks, [file, whole]


def _frequencies(dynamics: AzulayDynamics, names: Sequence[str]) -> list[Block]:
    """First frequencies with both sets."""
    rows = []
    for name in names:
        for which, study in dynamics.studies.items():
            values = study["natural_frequency"].sel(machine=name).to_numpy()
            rows.append([name, which, *(significant(float(v), 4) for v in values)])
    count = len(rows[0]) - 2
    heads = [Column("machine", "", False), Column("set", "", False)]
    heads += [Column(f"mode {i + 1}", "Hz") for i in range(count)]
    return [Table("Natural frequencies with both sets", heads, rows, VIBRATION_DATA)]


def _rankings(dynamics: AzulayDynamics) -> Table:
    rows: list[list[str | Cell]] = []
    for a in AXES:
        published = published_dynamic_ranking(a)
        rows.append([f"K{a * 2}", "published", in_order(published), ""])
        for which in dynamics.studies:
            found = dynamics.ranking(a, which)
            same = Cell("same order", "good") if found == published else Cell("another", "poor")
            rows.append([f"K{a * 2}", which, in_order(found), same])
    return Table(
        "Order of the machines by least dynamic stiffness",
        [Column(h, "", False) for h in ("axis", "", "the stiffest first", "")],
        rows,
        VIBRATION_DATA,
    )
