"""Reports of the two Eclipse machines and of their document."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from strutwork.machines.catalogue import get
from strutwork.machines.literature import KIM_2001
from strutwork.papers.kim_2001.chapters.drives import barriers_chapter
from strutwork.papers.kim_2001.chapters.places import places_chapter
from strutwork.papers.kim_2001.chapters.published import measured_chapter, published_chapter
from strutwork.papers.kim_2001.chapters.radii import radius_chapter
from strutwork.papers.kim_2001.comparison import table_2_rows
from strutwork.papers.kim_2001.statements import statements
from strutwork.papers.statement_tables import statements_chapter
from strutwork.papers.statements import count_text, statements_file
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.content import Chapter
from strutwork.studies.description import parameters, plain
from strutwork.studies.progress import Teller

Contents = tuple[str, str, tuple[Chapter, ...]]


def machine_chapters(name: str, _progress: Teller | None = None) -> Contents:
    """Title, subtitle and chapters that the document adds to a machine's report."""
    entry = get(name)
    machine = entry.factory()
    chapters = [measured_chapter()]
    if name == "eclipse-prototype":
        chapters = [published_chapter(), barriers_chapter(), radius_chapter(), *chapters]
    content = {"parameters": parameters(machine)}
    chapters.append(closing_chapter(name, {"machine": name}, content, chapters))
    return entry.title, KIM_2001.citation, tuple(chapters)


def paper_chapters(_progress: Teller | None = None) -> Contents:
    """Title, subtitle and chapters of the document's own page."""
    chapters = [
        published_chapter(),
        barriers_chapter(),
        places_chapter(),
        radius_chapter(),
        measured_chapter(),
        _statements(),
    ]
    content: dict[str, Any] = {"rows": plain([r.to_dict() for r in (*table_2_rows(),)])}
    chapters.append(closing_chapter(KIM_2001.key, {"document": KIM_2001.key}, content, chapters))
    return (
        "A redundantly actuated machine on a circular guide: published and computed",
        KIM_2001.citation,
        tuple(chapters),
    )


def _statements() -> Chapter:
    """Every result of the document, with its file."""
    said = statements()
    file = statements_file(KIM_2001.key, said)
    chapter = statements_chapter("statements", "Every statement", said, file.name)
    return replace(chapter, blocks=(count_text(said), *chapter.blocks), files=(file,))
