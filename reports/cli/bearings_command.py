"""The options of `strutwork bearings`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import Json, targets


def bearings(
    target: Annotated[
        str | None,
        typer.Argument(
            metavar="FILE_OR_MACHINE",
            help="A model file, or a machine: NAME or NAME:VARIANT; the package's catalogue by "
            "default.",
            autocompletion=targets,
        ),
    ] = None,
    json: Json = False,
) -> None:
    """List bearings and guides with stiffness, preload and source."""
    from strutwork.machines.load import load
    from strutwork.reports.cli import bearings as work

    work.run(None if target is None else load(target), json)
