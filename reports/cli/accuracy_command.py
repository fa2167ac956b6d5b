"""The options of `strutwork accuracy`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import JointAt, Json, Pose, Target
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
    out: Annotated[
        str | None,
        typer.Option(
            "--out", "-o", metavar="DIR", help="Write the result to this folder: CSV, NetCDF."
        ),
    ] = None,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Number of threads; one per processor by default.")
    ] = None,
    json: Json = False,
) -> None:
    """Find how far tolerances, drive errors and play can displace the tool."""
    from strutwork.reports.cli import accuracy as work

    options = work.Options(tuple(drive_error or ()), tuple(play or ()), tolerances)
    work.run(target, (pose or (), joint or ()), over, options, out, workers=workers, json=json)
