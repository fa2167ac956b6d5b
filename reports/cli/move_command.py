"""The options of `strutwork move`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import Json, Target
from strutwork.reports.cli.usage import typed


def move(
    target: Target,
    pose: Annotated[
        list[str] | None,
        typer.Option(
            callback=typed,
            metavar="DIR=VALUE,...",
            help="Where the tool goes, as in --pose x=20mm,rz=5deg: x, y, z of the tool centre "
            "point, and its rotation vector from home. What is not named stays, where it can.",
        ),
    ] = None,
    joint: Annotated[
        list[str] | None,
        typer.Option(
            callback=typed,
            metavar="JOINT:DIR=VALUE",
            help="A joint coordinate, driven or not, as in --joint ram1:z=310mm. Repeatable.",
        ),
    ] = None,
    targets: Annotated[
        str | None,
        typer.Option(metavar="CSV", help="Many targets: columns such as “x, mm” or “ram1:z, mm”."),
    ] = None,
    out: Annotated[
        str | None,
        typer.Option("--out", "-o", metavar="CSV", help="Write all coordinates there."),
    ] = None,
    json: Json = False,
) -> None:
    """Move a machine: from poses of the tool to joint coordinates, and back."""
    from strutwork.reports.cli import move as work

    work.run(target, pose or (), joint or (), targets, out, json=json)
