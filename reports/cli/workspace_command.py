"""The options of `strutwork workspace`."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from strutwork.reports.cli.choices import Json, Target
from strutwork.reports.cli.usage import typed


class Inscribed(StrEnum):
    """Shapes that are sought inside a workspace."""

    BOX = "box"
    BALL = "ball"
    CYLINDER = "cylinder"


def workspace(
    target: Target,
    over: Annotated[
        list[str] | None,
        typer.Option(
            callback=typed,
            metavar="DIR=LOW..HIGH:N,...",
            help="One to three directions of the tool, as in --over x=-100mm..100mm:41; N odd. "
            "A direction with one value is where the tool is placed first. By default the "
            "machine's own or the file's \\[workspace].",
        ),
    ] = None,
    tilt: Annotated[
        str | None,
        typer.Option(metavar="ANGLE", help="Orientation of the tool, the same everywhere."),
    ] = None,
    azimuth: Annotated[
        str, typer.Option(metavar="ANGLE", help="Direction of --tilt, from the tool's x.")
    ] = "0 deg",
    dexterous: Annotated[
        str | None,
        typer.Option(
            metavar="ANGLE", help="All tilts up to this angle, in all directions, must be good."
        ),
    ] = None,
    azimuths: Annotated[
        int, typer.Option(min=3, max=360, help="Number of directions that --dexterous checks.")
    ] = 12,
    roll: Annotated[
        str | None,
        typer.Option(
            metavar="LOW..HIGH:N", help="Rolls about the tool's axis, all of which must be good."
        ),
    ] = None,
    spare: Annotated[
        str | None,
        typer.Option(
            callback=typed,
            metavar="NAME=LOW..HIGH:N",
            help="A coordinate of which one good value is enough: roll, a direction of the tool, "
            "or JOINT:DIR.",
        ),
    ] = None,
    radius: Annotated[
        str | None,
        typer.Option(metavar="LENGTH", help="Bodies have this radius and must not collide."),
    ] = None,
    interference: Annotated[
        bool,
        typer.Option(
            "--interference",
            help="Shapes of the file, and beams as thick as their sections, must not collide.",
        ),
    ] = False,
    conditioning: Annotated[
        float | None,
        typer.Option(help="Least 1/condition of the drives, as a share of that at home."),
    ] = None,
    amplification: Annotated[
        str | None,
        typer.Option(
            metavar="HIGH|LOW..HIGH",
            help="Bounds of the tool's velocity, m/s, for drive rates of 1 m/s in all, as 0.33..3.",
        ),
    ] = None,
    stiffness: Annotated[
        str | None,
        typer.Option(
            metavar="STIFFNESS",
            help="Least stiffness at the tool in its softest direction, as '10 N/um'.",
        ),
    ] = None,
    largest: Annotated[
        Inscribed | None, typer.Option(help="Find the largest shape of this kind inside.")
    ] = None,
    proportions: Annotated[
        str | None,
        typer.Option(metavar="A:B:C", help="Sizes of --largest along the directions, as 2:1:1."),
    ] = None,
    around: Annotated[
        str | None,
        typer.Option(
            callback=typed,
            metavar="DIR=VALUE,...",
            help="Centre of --largest; anywhere by default.",
        ),
    ] = None,
    out: Annotated[
        str | None,
        typer.Option(
            "--out", "-o", metavar="DIR", help="Write it to this folder: NetCDF, CSV, STL and PLY."
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Find the poses that a machine can reach: size, number of pieces and limits."""
    if tilt is not None and dexterous is not None:
        raise typer.BadParameter("give --tilt or --dexterous, not both.")
    if radius is not None and interference:
        raise typer.BadParameter("give --radius or --interference, not both.")
    if largest is None and (proportions is not None or around is not None):
        raise typer.BadParameter("--proportions and --around belong to --largest.")
    from strutwork.reports.cli import workspace as work

    work.run(
        target,
        over or (),
        work.Asked(
            tilt=tilt,
            azimuth=azimuth,
            dexterous=dexterous,
            azimuths=azimuths,
            roll=roll,
            spare=spare,
            radius=radius,
            interference=interference,
            conditioning=conditioning,
            amplification=amplification,
            stiffness=stiffness,
        ),
        work.Wanted(None if largest is None else largest.value, proportions, around),
        out,
        json=json,
    )
