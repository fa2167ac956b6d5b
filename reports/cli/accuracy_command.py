"""The options of `strutwork accuracy`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import JointAt, Json, Pose, Target, Workers
from strutwork.reports.cli.usage import typed


def accuracy(
    target: Target,
    pose: Pose = None,
    joint: JointAt = None,
    over: Annotated[
        list[str] | None,
        typer.Option(
            callback=typed,
            metavar="DIR=LOW..HIGH:N,...",
            help="Poses of the tool, as in --over x=-100mm..100mm:5,y=-100mm..100mm:5.",
        ),
    ] = None,
    drive_error: Annotated[
        list[str] | None,
        typer.Option(
            "--drive-error",
            callback=typed,
            metavar="VALUE",
            help="Error of all drives to either side: a length for linear drives, an angle for "
            "rotary ones; half of the file's resolutions by default. Repeatable.",
        ),
    ] = None,
    play: Annotated[
        list[str] | None,
        typer.Option(
            callback=typed,
            metavar="JOINT:DIR=VALUE",
            help="Play of a joint from stop to stop, as in --play hinge:x=10um. Repeatable.",
        ),
    ] = None,
    tolerances: Annotated[bool, typer.Option(help="Include the tolerances of the file.")] = True,
    errors: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            help="Errors file: temperatures, cutting forces, drives and the ground; prints the "
            "displacement by cause and part.",
        ),
    ] = None,
    axis: Annotated[
        list[str] | None,
        typer.Option(
            callback=typed,
            metavar="DIR=LOW..HIGH:N",
            help="With --errors: linear and angular errors along an axis, as in "
            "--axis x=-100mm..100mm:9. Repeatable.",
        ),
    ] = None,
    out: Annotated[
        str | None,
        typer.Option(
            "--out", "-o", metavar="DIR", help="Write the result to this folder: CSV, NetCDF."
        ),
    ] = None,
    workers: Workers = None,
    json: Json = False,
) -> None:
    """Find how far tolerances, drive errors, play and other causes can displace the tool."""
    if errors is not None:
        if drive_error or play or not tolerances:
            raise typer.BadParameter(
                "--drive-error, --play and --no-tolerances do not go with --errors: state them in "
                "the errors file."
            )
        from strutwork.reports.cli import error_sheet

        at = (pose or (), joint or ())
        error_sheet.run(target, errors, at, over, axis, out, workers=workers, json=json)
        return
    if axis:
        raise typer.BadParameter("--axis belongs to --errors.")
    from strutwork.reports.cli import accuracy as work

    options = work.Options(tuple(drive_error or ()), tuple(play or ()), tolerances)
    work.run(target, (pose or (), joint or ()), over, options, out, workers=workers, json=json)
