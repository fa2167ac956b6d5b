"""`strutwork schema`: the JSON schema of the model file, for editors."""

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
) -> None:
    """Print the JSON schema of the model file, with which editors complete and check it."""
    from strutwork.files import write_text
    from strutwork.machines.schema_file import schema_text
    from strutwork.names import visible
    from strutwork.reports.cli.output import console

    if out is None:
        typer.echo(schema_text(), nl=False)
        return
    write_text(Path(out), schema_text())
    console().print(f"Written: {visible(out)}", markup=False, soft_wrap=True)
