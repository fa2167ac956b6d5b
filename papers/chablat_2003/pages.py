"""Reports of the two biglides and of their document."""

from __future__ import annotations

from typing import Any

from strutwork.machines.literature import CHABLAT_2003
from strutwork.machines.variants import named_machine
from strutwork.reports.chapters.closing import closing_chapter
from strutwork.reports.content import Chapter
from strutwork.studies.description import parameters
from strutwork.studies.progress import Teller

Contents = tuple[str, str, tuple[Chapter, ...]]


def machine_chapters(name: str, _progress: Teller | None = None) -> Contents:
    """Title, subtitle and chapters that the document adds to a machine's report."""
    found = named_machine(name)
    content = {"parameters": parameters(found.machine)}
    closing = closing_chapter(name, {"machine": found.name}, content, ())
    return found.title, CHABLAT_2003.citation, (closing,)


def paper_chapters(_progress: Teller | None = None) -> Contents:
    """Title, subtitle and chapters of the document's own page."""
    content: dict[str, Any] = {}
    closing = closing_chapter(CHABLAT_2003.key, {"document": CHABLAT_2003.key}, content, ())
    return "Two biglides: published and ours", CHABLAT_2003.citation, (closing,)
