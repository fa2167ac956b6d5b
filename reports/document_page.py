"""What a document adds to a report, as one question that a later run need not ask again."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from strutwork.machines.paper_reference import resolve
from strutwork.reports.answer_store import key_of
from strutwork.reports.answers import Source
from strutwork.reports.content import Chapter
from strutwork.reports.data_files import held
from strutwork.studies.progress import Teller


@dataclass(frozen=True)
class DocumentPage:
    """Title, subtitle and chapters that a function of a document writes.

    Parameters
    ----------
    reference : str
        The function, as `strutwork.machines.paper_reference.resolve` reads it.
    arguments : tuple of str
        What it is given before its progress.
    """

    reference: str
    arguments: tuple[str, ...] = ()

    @cached_property
    def key(self) -> str:
        """Hash of all that it depends on."""
        return key_of({"document": self.reference, "arguments": list(self.arguments)})

    @property
    def name(self) -> str:
        """Of the question; another one for each function and argument."""
        text = "\0".join((self.reference, *self.arguments))
        return f"document-{hashlib.sha256(text.encode()).hexdigest()[:16]}"

    def write(self, progress: Teller | None = None) -> tuple[str, str, tuple[Chapter, ...]]:
        """Title, subtitle and chapters, their files with their content.

        Raises
        ------
        StrutworkError
            As the function.
        """
        title, subtitle, chapters = resolve(self.reference)(*self.arguments, progress)
        return title, subtitle, tuple(replace(c, files=tuple(map(held, c.files))) for c in chapters)

    def of(
        self, source: Source | None, progress: Teller | None
    ) -> tuple[str, str, tuple[Chapter, ...]]:
        """The same from a source of answers, where there is one.

        Raises
        ------
        StrutworkError
            As the function.
        """

        def find() -> Any:
            return self.write(progress)

        if source is None:
            return self.write(progress)
        found: tuple[str, str, tuple[Chapter, ...]] = source.ask(self.name, find).get()
        return found
