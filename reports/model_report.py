"""The report of a structure from a model file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from strutwork.machines.model_file import read_model
from strutwork.names import visible
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.chapters.model import check_chapter, structure_chapter, summary_chapter
from strutwork.reports.chapters.model_loads import forces_chapter, loads_chapter
from strutwork.reports.chapters.model_tool import budget_chapter, tool_chapter
from strutwork.reports.chapters.overconstraint_model import (
    study_model_tolerances,
    tolerance_chapter,
)
from strutwork.reports.chapters.vibration import vibration_chapter
from strutwork.reports.content import Chapter
from strutwork.reports.model_check import check_model
from strutwork.reports.model_solution import solve_model
from strutwork.reports.vibration_study import has_mass, study_model_vibration


def model_chapters(path: Path) -> tuple[str, str, tuple[Chapter, ...]]:
    """Title, subtitle and chapters of a model file's report.

    Raises
    ------
    StrutworkError
        The file is wrong, or its structure moves freely under its loads.
    """
    model = read_model(path)
    check = check_model(model)
    solution = solve_model(model) if model.cases or model.tool is not None else None
    chapters = [summary_chapter(model, check, solution), structure_chapter(model)]
    chapters.append(check_chapter(check))
    content: dict[str, Any] = {"title": model.title}
    file, stem = visible(path.name), visible(path.stem)
    settings = {"model file": file}
    if solution is not None:
        settings["solver"] = solution.statics.method
        if model.cases:
            chapters += [loads_chapter(solution), forces_chapter(solution)]
        if model.tool is not None:
            chapters.append(tool_chapter(solution))
        if solution.compliance is not None:
            chapters.append(budget_chapter(model))
    if model.tolerances:
        found = study_model_tolerances(model)
        chapters.append(tolerance_chapter(model, found))
        content["tolerances"] = found.to_dict()
    if model.damping is not None and has_mass(model):
        study = study_model_vibration(model, "vibration")
        chapters.append(vibration_chapter(study))
        content["vibration"] = study.to_dict()
    chapters.append(closing_chapter(file, settings, content, chapters))
    return (
        visible(model.title or stem, lines=True),
        f"Analysis of the model file {file}",
        tuple(chapters),
    )
