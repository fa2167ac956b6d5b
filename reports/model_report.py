"""The report of a structure from a model file."""

from __future__ import annotations

from pathlib import Path

from strutwork.machines.model_file import read_model
from strutwork.names import visible
from strutwork.reports.composed import report_of
from strutwork.reports.content import Chapter
from strutwork.reports.subject import Teller


def model_chapters(
    path: Path, progress: Teller | None = None
) -> tuple[str, str, tuple[Chapter, ...]]:
    """Title, subtitle and chapters of a model file's report.

    Raises
    ------
    StrutworkError
        The file is wrong, or its structure moves freely under its loads.
    """
    file = visible(path.name)
    subtitle = f"Analysis of the model file {file}"
    return report_of(read_model(path), file, visible(path.stem), subtitle, progress)
