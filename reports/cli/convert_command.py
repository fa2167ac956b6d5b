"""The options of `strutwork convert`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import Json


def convert(
    source: Annotated[
        str,
        typer.Argument(
            metavar="FILE_OR_MACHINE",
            help="A robot file (.urdf, .sdf, .xml for MJCF), a model file, or a machine.",
        ),
    ],
    target: Annotated[
        str,
        typer.Argument(
            metavar="FILE", help="The file to write: .toml, .urdf, .sdf, or .xml for MJCF."
        ),
    ],
    tool: Annotated[
        str | None,
        typer.Option(metavar="LINK", help="Link, frame or site of a robot file that is the tool."),
    ] = None,
    drive: Annotated[
        list[str] | None,
        typer.Option(
            metavar="JOINT",
            help="A driven joint of a robot file, or JOINT:DIRECTION. Repeatable.",
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Convert between model files and robot files: URDF, SDF and MJCF, with closed loops."""
    from strutwork.reports.cli import convert as work

    work.run(source, target, tool, drive, json=json)
