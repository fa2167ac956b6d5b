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
            "points along each where none are said.",
        ),
    ],
    surface: Annotated[
        str,
        typer.Option(
            callback=typed,
            metavar="plane|sphere:r=R|paraboloid:r=R",
            help="Over the two directions; a sphere or a paraboloid has its top where the tool "
            "stands at home, and R is its radius of curvature there.",
        ),
    ] = "plane",
    orientation: Annotated[
        Orientation, typer.Option(help="Of the tool on a sphere or a paraboloid.")
    ] = Orientation.VERTICAL,
    feed: Annotated[
        str | None,
        typer.Option(metavar="DIR", help="Feed along one of the two: lines of reversals."),
    ] = None,
    out: Annotated[
        str | None,
        typer.Option("--out", "-o", metavar="DIR", help="Write grid, points and lines there: CSV."),
    ] = None,
    json: Json = False,
) -> None:
    """Find where the drives of a machine turn back as its tool goes over a surface."""
    from strutwork.reports.cli import reversals as work

    work.run(target, over, (surface, orientation.value), feed, out, json=json)
