"""The options of `strutwork map`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import Json, Ranges, Workers
from strutwork.reports.cli.usage import typed


def map_command(
    machine: Annotated[
        str,
        typer.Argument(
            metavar="FILE_OR_MACHINE", help="A model file, or a machine: NAME or NAME:VARIANT."
        ),
    ],
    over: Annotated[
        list[str] | None,
        typer.Option(
            callback=typed,
            metavar="DIR=LOW..HIGH:N,...",
            help="Poses of the tool, as in --over x=-100mm..100mm:5,rz=0deg..20deg:3; those of "
            "the file's \\[workspace] by default.",
        ),
    ] = None,
    out: Annotated[
        str | None,
        typer.Option(
            "--out", "-o", metavar="DIR", help="Write the map to this folder as NetCDF and CSV."
        ),
    ] = None,
    ranges: Annotated[
        Ranges, typer.Option(help="Joint ranges that a pose must respect.")
    ] = Ranges.ALL,
    lattice: Annotated[
        int,
        typer.Option(
            min=1, max=200, help="Resolution; 10 gives 317 check points, or 21 x 21 in x and tilt."
        ),
    ] = 10,
    rolls: Annotated[
        int,
        typer.Option(min=1, max=720, help="Number of rolls about the normal tried at each point."),
    ] = 24,
    workers: Workers = None,
    vibration: Annotated[
        bool,
        typer.Option(
            "--vibration", help="Frequencies and dynamic stiffness instead of static stiffness."
        ),
    ] = False,
    json: Json = False,
) -> None:
    """Map the stiffness or the vibration of a machine over its workspace.

    A machine of the literature has check points of its own, on a hemisphere or over x and tilt:
    --ranges, --lattice and --rolls are of these.
    """
    if over or not _in_catalogue(machine):
        from strutwork.reports.cli import survey

        survey.run(machine, over, out, vibration=vibration, workers=workers, json=json)
        return
    if vibration:
        from strutwork.reports.cli import vibration_map

        vibration_map.run(
            machine,
            out,
            ranges=ranges.value,
            lattice=lattice,
            rolls=rolls,
            workers=workers,
            json=json,
        )
        return
    from strutwork.reports.cli import stiffness as work

    work.run(
        machine,
        out,
        ranges=ranges.value,
        lattice=lattice,
        rolls=rolls,
        workers=workers,
        json=json,
    )


def _in_catalogue(name: str) -> bool:
    from strutwork.machines.naming import is_machine

    return is_machine(name)
