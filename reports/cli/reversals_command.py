"""The options of `strutwork reversals`."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from strutwork.reports.cli.choices import Json, Target
from strutwork.reports.cli.usage import typed


class Orientation(StrEnum):
    """How the tool stands on a surface."""

    VERTICAL = "vertical"
    NORMAL = "normal"


def reversals(
    target: Target,
    over: Annotated[
        list[str],
        typer.Option(
            callback=typed,
            metavar="DIR=LOW..HIGH:N,...",
            help="Two directions of the tool, as in --over x=-100mm..100mm,y=-100mm..100mm; 21 "
            "points along each by default.",
        ),
    ],
    surface: Annotated[
        str,
        typer.Option(
            callback=typed,
            metavar="plane|sphere:r=R|paraboloid:r=R",
            help="Surface over the two directions; a sphere or a paraboloid has its apex at "
            "the tool's home position, and R is its radius of curvature there.",
        ),
    ] = "plane",
    orientation: Annotated[
        Orientation, typer.Option(help="Orientation of the tool on a sphere or a paraboloid.")
    ] = Orientation.VERTICAL,
    feed: Annotated[
        str | None,
        typer.Option(
            metavar="DIR", help="Direction of the feed, one of the two, for lines of reversals."
        ),
    ] = None,
    out: Annotated[
        str | None,
        typer.Option(
            "--out", "-o", metavar="DIR", help="Write grid, points and lines to this folder as CSV."
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Find where the drives of a machine reverse as its tool moves over a surface."""
    from strutwork.reports.cli import reversals as work

    work.run(target, over, (surface, orientation.value), feed, out, json=json)
