"""The options of `strutwork trajectory`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import Json, Target
from strutwork.reports.cli.usage import typed


def trajectory(
    target: Target,
    file: Annotated[
        str,
        typer.Argument(
            metavar="CSV",
            help="Columns such as “t, s”, “x, mm” or “ram1:z, mm”; speeds and accelerations, "
            "“x speed, mm/s” and “x acceleration, mm/s^2”, where they are known.",
        ),
    ],
    gravity: Annotated[
        str | None,
        typer.Option(
            metavar="X,Y,Z",
            help="In m/s²; by default the model's own, or 9.80665 along −z.",
        ),
    ] = None,
    limit: Annotated[
        list[str] | None,
        typer.Option(
            callback=typed,
            metavar="[JOINT:DIR:]KIND=VALUE",
            help="Limits of the drives in addition to the model's: speed, acceleration, force "
            "or power, as in --limit speed=0.5m/s. Repeatable.",
        ),
    ] = None,
    reactions: Annotated[
        bool,
        typer.Option(
            "--reactions", help="Also compute joint reactions, where they are determined."
        ),
    ] = False,
    out: Annotated[
        str | None,
        typer.Option(
            "--out",
            "-o",
            metavar="DIR",
            help="Write all quantities over time to this folder as CSV.",
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Find speeds, forces and powers of the drives along a trajectory: rigid-body dynamics."""
    from strutwork.reports.cli import trajectory as work

    work.run(target, file, gravity, limit or (), out, reactions=reactions, json=json)
