"""`strutwork schema`: the JSON schemas of the package's files, for editors."""

from __future__ import annotations

from enum import StrEnum
from pathlib import Path
from typing import Annotated

import typer


class FileKind(StrEnum):
    """Files that an editor completes."""

    MODEL = "model"
    STUDY = "study"
    DESIGN = "design"
    CALIBRATION = "calibration"
    ERRORS = "errors"
    PROCESS = "process"
    SERVO = "servo"


def schema(
    out: Annotated[
        str | None,
        typer.Option(
            "--out", "-o", metavar="FILE", help="Write it to this file; by default it is printed."
        ),
    ] = None,
    of: Annotated[
        FileKind, typer.Option("--of", help="Kind of file that the schema describes.")
    ] = FileKind.MODEL,
    study: Annotated[
        bool, typer.Option("--study", hidden=True, help="The same as --of study.")
    ] = False,
) -> None:
    """Print the JSON schema of a kind of file, with which editors complete and check such files."""
    from strutwork.files import write_text
    from strutwork.names import visible
    from strutwork.reports.cli.output import console

    kind = FileKind.STUDY if study else of
    if kind is FileKind.MODEL:
        from strutwork.machines.schema_file import schema_text

        text = schema_text()
    else:
        from strutwork.studies.schema_kinds import schema_text as text_of

        text = text_of(kind.value)
    if out is None:
        typer.echo(text, nl=False)
        return
    write_text(Path(out), text)
    console().print(f"Written: {visible(out)}", markup=False, soft_wrap=True)
