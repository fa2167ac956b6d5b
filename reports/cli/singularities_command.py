"""The options of `strutwork singularities`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import JointAt, Json, Pose, Ranges, Target
from strutwork.reports.cli.usage import typed


def singularities(
    target: Target,
    line: Annotated[
        str | None,
        typer.Option(
            callback=typed,
            metavar="DIR=LOW..HIGH[:N]",
            help="Search along a line of N poses, as in x=0..40mm; several coordinates, "
            "separated by commas, vary together.",
        ),
    ] = None,
    plane: Annotated[
        str | None,
        typer.Option(
            callback=typed,
            metavar="DIR,DIR",
            help="Find curves over two coordinates, with --from and --to; or as in "
            "x=-40mm..40mm:41,ry=-30deg..30deg:41.",
        ),
    ] = None,
    low: Annotated[
        str | None,
        typer.Option(
            "--from",
            callback=typed,
            metavar="DIR=VALUE,DIR=VALUE",
            help="Start of the line or plane.",
        ),
    ] = None,
    high: Annotated[
        str | None,
        typer.Option(
            "--to", callback=typed, metavar="DIR=VALUE,DIR=VALUE", help="End of the line or plane."
        ),
    ] = None,
    steps: Annotated[
        int,
        typer.Option(min=2, max=100_000, help="Number of poses along each coordinate of a plane."),
    ] = 41,
    at: Annotated[
        list[str] | None,
        typer.Option(
            "--at",
            callback=typed,
            metavar="DIR=VALUE,...",
            help="Fixed coordinates of a line or plane; those not named stay at home.",
        ),
    ] = None,
    pose: Pose = None,
    joint: JointAt = None,
    length: Annotated[
        str | None,
        typer.Option(
            callback=typed,
            metavar="LENGTH",
            help="Translation that counts as much as one radian; the machine's size by default.",
        ),
    ] = None,
    ranges: Annotated[
        Ranges, typer.Option(help="Joints whose ranges bound a line or plane.")
    ] = Ranges.ALL,
    out: Annotated[
        str | None,
        typer.Option("--out", "-o", metavar="DIR", help="Write the result to this folder as CSV."),
    ] = None,
    json: Json = False,
) -> None:
    """Find singular poses of a machine, their type and the motion that is lost there."""
    if line is not None and plane is not None:
        raise typer.BadParameter("give --line or --plane.")
    if line is None and plane is None and (at or out or low or high):
        raise typer.BadParameter("--at, --from, --to and --out belong to --line or --plane.")
    if plane is None and (low or high):
        raise typer.BadParameter("--from and --to belong to --plane.")
    from strutwork.reports.cli import singularities as work
    from strutwork.reports.singularity_words import line_of_words, plane_of_words

    work.run(
        target,
        None if line is None else line_of_words(line),
        None if plane is None else plane_of_words(plane, low, high, steps),
        at or (),
        (pose or (), joint or ()),
        length,
        ranges=ranges.value,
        out=out,
        json=json,
    )
