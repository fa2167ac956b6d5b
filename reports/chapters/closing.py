"""Versions, settings, and the list of files."""

from __future__ import annotations

import json
import os
import re
import shlex
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from typing import Any

from plotly import __version__ as plotly_version

from strutwork.names import listed
from strutwork.reports.content import Chapter, Links, Text
from strutwork.reports.data_files import json_file
from strutwork.studies.description import versions


def closing_chapter(
    target: str,
    settings: Mapping[str, Any],
    content: Mapping[str, Any],
    chapters: Sequence[Chapter],
    command: str | None = None,
) -> Chapter:
    """What made the report and what lies beside it.

    Parameters
    ----------
    target : str
        What the report was asked for.
    settings : mapping
        Plain values; one sentence lists them.
    content : mapping
        Plain values that the tables show rounded; goes to `report.json` with the rest.
    chapters : sequence of Chapter
        Those before, whose files are listed.
    command : str, optional
        What makes the page again; empty for nothing that is known, that of a report else.
    """
    made_with = versions() | {"plotly": plotly_version}
    file = json_file(
        "report.json",
        "numbers of the tables unrounded, settings and versions, SI",
        {"target": target, "settings": settings, "versions": made_with, **content},
    )
    rows = {
        name: value if isinstance(value, str) else json.dumps(value)
        for name, value in settings.items()
        if value != target
    }
    files = [f for chapter in chapters for f in chapter.files] + [file]
    again = _command(target) if command is None else f"by `{command}` " if command else ""
    return Chapter(
        "files",
        "Versions, settings and data files",
        (
            Text(f"Made on {_today()} {again}with {_versions(made_with)}."),
            *((Text(_settings(rows)),) if rows else ()),
            Text("Files beside this page; they contain every plotted number, unrounded."),
            Links(tuple((f.name, f.what) for f in files)),
        ),
        (file,),
    )


def _today() -> str:
    """The day, or that of SOURCE_DATE_EPOCH, by which two runs write the same page."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    now = datetime.now(UTC)
    at = datetime.fromtimestamp(int(epoch), UTC) if re.fullmatch(r"\d{1,11}", epoch) else now
    return f"{at.day} {at:%B %Y}"


def _command(target: str) -> str:
    """The command that makes the report again; none where several words ask for it."""
    if any(space in target for space in " \n\t") and not target.endswith(".toml"):
        return ""
    return f"by `strutwork report {shlex.quote(target)}` "


def _versions(made_with: Mapping[str, str]) -> str:
    return listed([f"{name} {version}" for name, version in made_with.items()])


def _settings(rows: Mapping[str, str]) -> str:
    return f"Settings: {'; '.join(f'{name} {value}' for name, value in rows.items())}."
