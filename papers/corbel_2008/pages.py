"""Reports of the linear Delta and the measuring platform, and of their document."""

from __future__ import annotations

from dataclasses import replace

from strutwork.machines.catalogue import get
from strutwork.machines.literature import CORBEL_2008
from strutwork.papers.corbel_2008.actuation import ActuationStudy, study_actuation
from strutwork.papers.corbel_2008.actuation_chapters import condition_chapter, rods_chapter
from strutwork.papers.corbel_2008.machine_chapters import (
    assumptions_chapter,
    drawings_chapter,
    published_chapter,
)
from strutwork.papers.corbel_2008.measuring import MeasuringStudy, study_measuring
from strutwork.papers.corbel_2008.measuring_chapters import resolution_chapter
from strutwork.papers.corbel_2008.published import DELTA
from strutwork.papers.corbel_2008.statements import statements
from strutwork.papers.statement_tables import statements_chapter
from strutwork.papers.statements import count_text, statements_file
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.content import Chapter
from strutwork.studies.description import parameters
from strutwork.studies.progress import Teller

Contents = tuple[str, str, tuple[Chapter, ...]]


def machine_chapters(name: str, _progress: Teller | None = None) -> Contents:
    """Title, subtitle and chapters that the document adds to a machine's report."""
    entry = get(name)
    if name == DELTA:
        study = study_actuation()
        chapters = [condition_chapter(study), rods_chapter(study)]
    else:
        chapters = [resolution_chapter(study_measuring())]
    chapters.append(assumptions_chapter((name,)))
    content = {"parameters": parameters(entry.factory())}
    chapters.append(closing_chapter(name, {"machine": name}, content, chapters))
    return entry.title, CORBEL_2008.citation, tuple(chapters)


def paper_chapters(_progress: Teller | None = None) -> Contents:
    """Title, subtitle and chapters of the document's own page."""
    actuation, measuring = study_actuation(), study_measuring()
    chapters = [
        drawings_chapter(),
        published_chapter(),
        condition_chapter(actuation),
        rods_chapter(actuation),
        resolution_chapter(measuring),
        _statements(actuation, measuring),
        assumptions_chapter(),
    ]
    settings = {"document": CORBEL_2008.key}
    content = {
        "machines": {
            "linear-delta": parameters(actuation.machine),
            "gough-platform": parameters(measuring.machine),
        }
    }
    chapters.append(closing_chapter(CORBEL_2008.key, settings, content, chapters))
    return (
        "A machine tool that measures where its tool is: published and computed",
        CORBEL_2008.citation,
        tuple(chapters),
    )


def _statements(actuation: ActuationStudy, measuring: MeasuringStudy) -> Chapter:
    """Every result of the document, with its file."""
    said = statements(actuation, measuring)
    file = statements_file(CORBEL_2008.key, said)
    chapter = statements_chapter("statements", "Every statement", said, file.name)
    return replace(chapter, blocks=(count_text(said), *chapter.blocks), files=(file,))
