"""Versions, settings, and the list of files."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from plotly import __version__ as plotly_version

from strutwork.reports.content import Chapter, Column, Links, Table, Text
from strutwork.reports.data_files import json_file
from strutwork.studies.description import versions


def closing_chapter(
    target: str,
    settings: Mapping[str, Any],
    content: Mapping[str, Any],
    chapters: Sequence[Chapter],
) -> Chapter:
    """What made the report and what lies beside it.

    Parameters
    ----------
    target : str
        What the report was asked for.
    settings : mapping
        Plain values; the table shows them.
    content : mapping
        Plain values that the tables show rounded; goes to `report.json` with the rest.
    chapters : sequence of Chapter
        Those before, whose files are listed.
    """
    made_with = versions() | {"plotly": plotly_version}
    file = json_file(
        "report.json",
        "numbers of the tables unrounded, settings and versions, SI",
        {"target": target, "settings": settings, "versions": made_with, **content},
    )
    rows = [
        [name, value if isinstance(value, str) else json.dumps(value)]
        for name, value in settings.items()
    ]
    files = [f for chapter in chapters for f in chapter.files] + [file]
    return Chapter(
        "files",
        "Versions, settings and data files",
        (
            Table(
                "Versions",
                (Column("", "", False), Column("version", "", False)),
                list(made_with.items()),
            ),
            Table("Settings", (Column("", "", False), Column("value", "", False)), rows),
            Text("Files beside this page; they hold every plotted number, unrounded."),
            Links(tuple((f.name, f.what) for f in files)),
        ),
        (file,),
    )
