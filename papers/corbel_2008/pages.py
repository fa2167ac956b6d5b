"""Reports of the linear Delta and the measuring platform, and of their document."""

from __future__ import annotations

from strutwork.machines.catalogue import get
from strutwork.machines.literature import CORBEL_2008
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.content import Chapter
from strutwork.studies.description import parameters
from strutwork.studies.progress import Teller

Contents = tuple[str, str, tuple[Chapter, ...]]


def machine_chapters(name: str, _progress: Teller | None = None) -> Contents:
    """Title, subtitle and chapters that the document adds to a machine's report."""
    entry = get(name)
    chapters: list[Chapter] = []
    content = {"parameters": parameters(entry.factory())}
    chapters.append(closing_chapter(name, {"machine": name}, content, chapters))
    return entry.title, CORBEL_2008.citation, tuple(chapters)


def paper_chapters(_progress: Teller | None = None) -> Contents:
    """Title, subtitle and chapters of the document's own page."""
    chapters: list[Chapter] = []
    settings = {"document": CORBEL_2008.key}
    chapters.append(closing_chapter(CORBEL_2008.key, settings, {}, chapters))
    return (
        "A machine tool that measures its tool: published and ours",
        CORBEL_2008.citation,
        tuple(chapters),
    )
