"""The options of `strutwork new`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import Json


def new(
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="Name of the machine; the file is NAME.toml.")
    ],
    like: Annotated[
        str,
        typer.Option(
            metavar="KIND",
            help="3-RPS, 6-UPS, linear-Delta, gantry, planar-3-RRR or Tricept.",
        ),
    ],
    json: Json = False,
) -> None:
    """Write a commented model file to start from."""
    from strutwork.reports.cli import new as work

    work.run(name, like, json=json)
