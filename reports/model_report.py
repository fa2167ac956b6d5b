"""The report of a structure from a model file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from strutwork.machines.described_process import DescribedProcess
from strutwork.machines.model import Model
from strutwork.machines.model_file import read_model
from strutwork.names import visible
from strutwork.reports.answering import answering
from strutwork.reports.composed import report_of
from strutwork.reports.content import Chapter
from strutwork.reports.subject import Subject, Teller


def model_report(
    path: Path,
    progress: Teller | None = None,
    put: Callable[[Model], Model] | None = None,
    *,
    fresh: bool = False,
    errors: Path | None = None,
    process: DescribedProcess | None = None,
) -> tuple[str, str, tuple[Chapter, ...], Subject]:
    """Title, subtitle, chapters and subject of a model file's report.

    Raises
    ------
    StrutworkError
        The file is wrong, or its structure moves freely under its loads.
    """
    file = visible(path.name)
    subtitle = f"Analysis of the model file {file}"
    model = read_model(path) if put is None else put(read_model(path))
    model = model if process is None else replace(model, process=process)
    about = Subject(model, file, visible(path.stem), progress, file=path, errors=errors)
    with answering(about, fresh=fresh) as subject:
        return subject.title, subtitle, report_of(subject), subject
