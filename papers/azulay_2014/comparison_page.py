"""The report that compares the four machines of Azulay et al. 2014."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from strutwork.machines.literature import AZULAY_2014
from strutwork.papers.azulay_2014.chapters.barrier import regions_chapter
from strutwork.papers.azulay_2014.chapters.comparison import (
    SHORT,
    assumptions_chapter,
    budget_chapter,
    drawings_chapter,
    poses_chapter,
    published_chapter,
    rankings_chapter,
    reasons_chapter,
    summary_chapter,
)
from strutwork.papers.azulay_2014.chapters.comparison_maps import maps_chapter
from strutwork.papers.azulay_2014.chapters.tilts import tilts_chapter
from strutwork.papers.azulay_2014.chapters.vibration import comparison_vibration
from strutwork.papers.azulay_2014.machine_study import (
    FILTERS,
    MODEL_NAMES,
    Comparison,
    study_comparison,
)
from strutwork.papers.azulay_2014.statements import statements
from strutwork.papers.azulay_2014.tilt_study import tilt_study
from strutwork.papers.statement_tables import statements_chapter
from strutwork.papers.statements import count_text, statements_file
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.content import Chapter
from strutwork.studies.description import parameters, plain
from strutwork.studies.progress import Teller


def comparison_chapters(progress: Teller | None = None) -> tuple[str, str, tuple[Chapter, ...]]:
    """Title, subtitle and chapters of the comparison."""
    study = study_comparison(progress)
    chapters = [
        summary_chapter(study),
        drawings_chapter(study),
        rankings_chapter(study),
        published_chapter(study),
        reasons_chapter(study),
        maps_chapter(study),
        regions_chapter(
            {SHORT[name]: study.barred[name, "spherical"] for name in study.names}, "machine"
        ),
        tilts_chapter(tilt_study()),
        budget_chapter(study),
        poses_chapter(study),
        comparison_vibration(study.names),
        _statements(study),
        assumptions_chapter(study),
    ]
    chapters.append(closing_chapter("azulay-2014", _settings(), _content(study), chapters))
    return (
        "Four parallel machines on a circular guide: static stiffness and vibration",
        AZULAY_2014.citation,
        tuple(chapters),
    )


def _statements(study: Comparison) -> Chapter:
    """Every result of the document, with its file."""
    said = statements(study)
    file = statements_file(AZULAY_2014.key, said)
    chapter = statements_chapter("statements", "Every statement", said, file.name)
    return replace(chapter, blocks=(count_text(said), *chapter.blocks), files=(file,))


def _settings() -> dict[str, Any]:
    kinds = "all" if FILTERS.joint_kinds is None else ", ".join(FILTERS.joint_kinds)
    return {
        "check points": "317 on a hemisphere of 4 mm",
        "rolls": "24 over 120 deg",
        "joint ranges kept": kinds,
        "condition limit": f"{FILTERS.condition_limit:g}",
        "drives": "held by their stiffness",
    }


def _content(study: Comparison) -> dict[str, Any]:
    return {
        "filters": plain(FILTERS),
        "parameters": {
            f"{name}, {MODEL_NAMES[model]}": parameters(machine)
            for (name, model), machine in study.machines.items()
        },
        **study.azulay.to_dict(),
    }
