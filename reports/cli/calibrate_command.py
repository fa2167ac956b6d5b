"""The options of `strutwork calibrate`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import Json


def calibrate(
    file: Annotated[str, typer.Argument(metavar="FILE", help="A calibration file.")],
    out: Annotated[
        str | None,
        typer.Option(
            "--out",
            "-o",
            metavar="FILE.toml",
            help="Write the machine there with its calibrated numbers.",
        ),
    ] = None,
    report: Annotated[
        str | None, typer.Option("--report", metavar="DIR", help="Write a report of it there.")
    ] = None,
    poses: Annotated[
        int | None,
        typer.Option(
            "--poses",
            min=1,
            metavar="N",
            help="Choose the N poses at which measurements would determine most.",
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Find stiffnesses and masses of a machine from measurements of it."""
    from strutwork.reports.cli import calibrate as work

    work.run(file, out, report, poses, json=json)
