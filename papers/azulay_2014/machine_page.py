"""The report of one machine of the literature."""

from __future__ import annotations

import json
from typing import Any

from strutwork.papers.azulay_2014.chapters.barrier import regions_chapter
from strutwork.papers.azulay_2014.chapters.budget import budget_chapter
from strutwork.papers.azulay_2014.chapters.lengths import lengths_chapter
from strutwork.papers.azulay_2014.chapters.machine import (
    assumptions_chapter,
    drawing_chapter,
    summary_chapter,
)
from strutwork.papers.azulay_2014.chapters.published import READING, published_table
from strutwork.papers.azulay_2014.chapters.stiffness import (
    distribution_chapter,
    map_chapter,
    poses_chapter,
)
from strutwork.papers.azulay_2014.chapters.vibration import machine_vibration
from strutwork.papers.azulay_2014.machine_study import MODEL_NAMES, MachineStudy, study_machine
from strutwork.papers.azulay_2014.published import TABLE_4
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.content import Chapter, Text
from strutwork.studies.description import parameters
from strutwork.studies.progress import Teller


def machine_chapters(
    name: str, progress: Teller | None = None
) -> tuple[str, str, tuple[Chapter, ...]]:
    """Title, subtitle and chapters of a machine's report.

    Parameters
    ----------
    name : str
        In the catalogue.
    progress : callable, optional
    """
    study = study_machine(name, progress)
    chapters = [
        summary_chapter(study),
        drawing_chapter(study),
        published_chapter(study),
        map_chapter(study),
        distribution_chapter(study),
        regions_chapter(
            {label: study.barred[model] for model, label in MODEL_NAMES.items()}, "model"
        ),
        budget_chapter(study),
        poses_chapter(study),
    ]
    if study.lengths:
        chapters.append(lengths_chapter(study))
    chapters.append(machine_vibration(name))
    chapters.append(assumptions_chapter(study))
    chapters.append(closing_chapter(name, settings(study), content(study), chapters))
    return (
        f"{study.entry.title}: static stiffness and vibration",
        f"{study.entry.topology} · {study.entry.paper.citation}",
        tuple(chapters),
    )


def published_chapter(study: MachineStudy) -> Chapter:
    """Table 4 beside the computed values; Table 2 stands with the link lengths."""
    rows = {model: study.rows[TABLE_4.key, model] for model in MODEL_NAMES}
    blocks, file = published_table(TABLE_4, rows)
    return Chapter("published", "Beside the published numbers", (Text(READING), *blocks), (file,))


def settings(study: MachineStudy) -> dict[str, Any]:
    """What the studies ran with."""
    attributes = study.maps["spherical"].attrs
    return {
        "machine": study.name,
        "check points": f"{study.summaries['spherical'].points}",
        "candidates": f"{attributes['candidates']}",
        "roll criterion": attributes["roll_criterion"],
        "joint ranges kept": ", ".join(json.loads(attributes["joint_ranges_kept"])),
        "condition limit": f"{attributes['condition_limit']:g}",
        "length of the condition number, mm": f"{1e3 * attributes['condition_length']:.4g}",
        "drives": "held by their stiffness",
    }


def content(study: MachineStudy) -> dict[str, Any]:
    """The tables' numbers, SI."""
    return {
        "models": {
            MODEL_NAMES[model]: {
                "parameters": parameters(study.machines[model]),
                "blocked": study.summaries[model].to_dict(),
                "free": study.free[model].to_dict(),
                "candidates": int(study.maps[model].attrs["candidates"]),
                "candidates_kept": int(study.maps[model].attrs["candidates_kept"]),
                "dropped_by_reason": json.loads(study.maps[model].attrs["dropped_by_reason"]),
                "outside_range": dict(
                    zip(
                        study.maps[model]["joint_kind"].to_numpy().tolist(),
                        study.maps[model]["outside_range"].to_numpy().sum(axis=0).tolist(),
                        strict=True,
                    )
                ),
            }
            for model in MODEL_NAMES
        },
        "link_lengths": {
            f"{row}, {MODEL_NAMES[model]}": found.to_dict()
            for (row, model), found in study.lengths.items()
        },
    }
