"""The proposed machine with links of three lengths (Table 2)."""

from __future__ import annotations

import numpy as np

from strutwork.papers.azulay_2014.chapters.published import published_table
from strutwork.papers.azulay_2014.machine_study import MODEL_NAMES, MachineStudy
from strutwork.papers.azulay_2014.published import TABLE_2
from strutwork.reports.chapters.stiffness import AXES
from strutwork.reports.content import Block, Chapter, Figure, Row, Text
from strutwork.reports.figures.charts import Bars, lines
from strutwork.reports.figures.theme import AXIS_COLOURS


def lengths_chapter(study: MachineStudy) -> Chapter:
    """Mean stiffness against link length, both models beside Table 2."""
    labels = list(dict.fromkeys(row for row, _ in study.lengths))
    lengths = [float(row.split("L=")[1].split()[0]) for row in labels]
    published = {a: [TABLE_2.value(row, f"K{a * 2} mean") for row in labels] for a in AXES}
    figures = []
    for model, name in MODEL_NAMES.items():
        ours = {
            a: [study.lengths[row, model].axis(a).statistics.mean / 1e6 for row in labels]
            for a in AXES
        }
        series = [Bars(f"K{a * 2}", np.array(ours[a]), AXIS_COLOURS[a]) for a in AXES]
        series += [
            Bars(f"K{a * 2} published", np.array(published[a]), AXIS_COLOURS[a]) for a in AXES
        ]
        figures.append(
            Figure(
                f"lengths-{model}",
                f"{name[0].upper()}{name[1:]}: mean stiffness over the hemisphere; dashed with "
                "open marks, Table 2.",
                lines(lengths, series, "link length L (mm)", "mean stiffness (N/µm)", dashed=3),
                f"Lines of mean Kxx, Kyy and Kzz against link length, {name}, beside Table 2.",
                "published-azulay-2014-table-2.csv",
                height=420,
            )
        )
    rows = {model: study.rows[TABLE_2.key, model] for model in MODEL_NAMES}
    table, file = published_table(TABLE_2, rows)
    blocks: list[Block] = [
        Text(
            "Longer links make the machine softer along every axis, most of all along z. Only "
            "the links change; guide, platform and workpiece stay the same."
        ),
        Row(tuple(figures), 360),
        *table,
    ]
    return Chapter("lengths", "Link length", tuple(blocks), (file,))
