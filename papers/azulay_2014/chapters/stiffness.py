"""Stiffness over the hemisphere with both joint models: maps, distributions, extreme poses."""

from __future__ import annotations

import json

import numpy as np

from strutwork.papers.azulay_2014.chapters.barrier import ring_text
from strutwork.papers.azulay_2014.machine_study import MODEL_NAMES, MachineStudy
from strutwork.papers.tables import numbers, texts
from strutwork.reports.chapters.stiffness import (
    AXES,
    VIEW,
    axis_values,
    dropped_table,
    map_figure,
    map_files,
    of_total,
    pose_columns,
    pose_rows,
    statistics_table,
)
from strutwork.reports.content import Block, Chapter, Figure, Row, Table, Text
from strutwork.reports.data_files import DataFile
from strutwork.reports.figures.charts import distributions


def map_chapter(study: MachineStudy) -> Chapter:
    """A disc for each axis and joint model."""
    named = {label: study.barred[model] for model, label in MODEL_NAMES.items()}
    blocks: list[Block] = [Text(VIEW), ring_text(named)]
    files: list[DataFile] = []
    for model, label in MODEL_NAMES.items():
        name = f"stiffness-map-{model}"
        blocks.append(
            Row(
                tuple(
                    map_figure(
                        study.maps[model],
                        axis,
                        f"map-{model}-{axis}",
                        label,
                        f"{name}.csv",
                        ring=study.barred[model].ring.extent,
                    )
                    for axis in AXES
                )
            )
        )
        files += map_files(study.maps[model], name, f"stiffness map, {label}")
    return Chapter("maps", "Stiffness over the hemisphere", tuple(blocks), tuple(files))


def distribution_chapter(study: MachineStudy) -> Chapter:
    """Boxes and statistics of both joint models, and both meanings of stiffness."""
    every = np.concatenate([axis_values(d, a) for d in study.maps.values() for a in AXES])
    top = float(every[np.isfinite(every)].max(initial=0.0)) or 1.0
    figures = []
    for model, label in MODEL_NAMES.items():
        values = {f"K{a * 2}": axis_values(study.maps[model], a) for a in AXES}
        spec = distributions(
            {k: v[np.isfinite(v)] for k, v in values.items()}, "stiffness (N/µm)", top=1.05 * top
        )
        figures.append(
            Figure(
                f"distribution-{model}",
                f"{label[0].upper()}{label[1:]}: every check point; box at the quartiles, "
                "line at the median, dashed at the mean, whiskers to 1.5 times the box's height.",
                spec,
                f"Boxes of Kxx, Kyy and Kzz over the check points, {label}.",
                f"stiffness-map-{model}.csv",
                height=380,
            )
        )
    blocks: list[Block] = [
        Text("(C⁻¹)_ii, other directions blocked; every check point counts once."),
        Row(tuple(figures), 340),
        statistics_table(
            "Other directions blocked, (C⁻¹)_ii",
            {label: study.summaries[m] for m, label in MODEL_NAMES.items()},
        ),
        statistics_table(
            "Other directions free to follow, 1/C_ii: the softer definition, at the same poses",
            {label: study.free[m] for m, label in MODEL_NAMES.items()},
        ),
    ]
    return Chapter("distributions", "Distributions", tuple(blocks))


def poses_chapter(study: MachineStudy) -> Chapter:
    """The extreme poses of each axis, and what was dropped."""
    rows = [
        row
        for model, label in MODEL_NAMES.items()
        for row in pose_rows(label, study.maps[model], study.summaries[model])
    ]
    table = Table(
        "Worst and best poses, stiffness blocked", pose_columns("model"), rows, "report.json"
    )
    dropped = dropped_table({label: study.maps[m] for m, label in MODEL_NAMES.items()}, "model")
    return Chapter(
        "poses",
        "Worst poses and dropped poses",
        (
            table,
            Text(
                "At every check point each roll is a candidate; those out of reach, outside the "
                "joint ranges respected or near a singularity are dropped. A point is lost only "
                "when no candidate is left."
            ),
            dropped,
            ranges_table(study),
        ),
    )


def ranges_table(study: MachineStudy) -> Table:
    """How many candidates each kind of joint range would drop, kept or not."""
    rows = []
    for model, label in MODEL_NAMES.items():
        dataset = study.maps[model]
        total = int(dataset.attrs["candidates"])
        kept = json.loads(dataset.attrs["joint_ranges_kept"])
        for kind, number in zip(
            dataset["joint_kind"].to_numpy(),
            dataset["outside_range"].to_numpy().sum(axis=0),
            strict=True,
        ):
            word = "kept" if kept == "all" or kind in kept else "not kept"
            rows.append([label, f"{kind} joints", word, *of_total(int(number), total)])
    columns = (
        *texts("model", "ranges of the", ""),
        *numbers("candidates outside", "share"),
    )
    return Table("Candidates outside the joint ranges of Table 3", columns, rows, "report.json")
