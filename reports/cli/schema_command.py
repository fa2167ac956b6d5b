"""`strutwork schema`: the JSON schemas of model and study files, for editors."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def schema(
    out: Annotated[
        str | None,
        typer.Option(
            "--out", "-o", metavar="FILE", help="Write it to this file; by default it is printed."
        ),
    ] = None,
    study: Annotated[
        bool, typer.Option("--study", help="That of study files; by default of model files.")
    ] = False,
) -> None:
    """Print the JSON schema of model or study files, with which editors complete and check them."""
    from strutwork.files import write_text
    from strutwork.names import visible
    from strutwork.reports.cli.output import console

    if study:
        from strutwork.studies.study_schema_file import schema_text
    else:
        from strutwork.machines.schema_file import schema_text
    text = schema_text()
    if out is None:
        typer.echo(text, nl=False)
        return
    write_text(Path(out), text)
    console().print(f"Written: {visible(out)}", markup=False, soft_wrap=True)
