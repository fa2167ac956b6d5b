"""The commands and their options.

A command imports its work when it runs, so that help and wrong usage answer at once.
"""

from __future__ import annotations

import sys
import warnings
from enum import StrEnum
from typing import Annotated

import typer

from strutwork import StrutworkError, __version__

app = typer.Typer(
    name="strutwork",
    help="Stiffness, mobility and joint forces of parallel and hybrid machines.",
    epilog="Exit status: 0 done, 1 the model is wrong or cannot be solved, 2 wrong usage.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

ModelFile = Annotated[str, typer.Argument(metavar="FILE", help="A model file (TOML).")]
Json = Annotated[
    bool, typer.Option("--json", help="Print one JSON object, in SI units, and nothing else.")
]


class Ranges(StrEnum):
    """Joints whose ranges a pose must keep."""

    ALL = "all"
    REVOLUTE = "revolute"
    NONE = "none"


def main() -> None:
    """Run the program: the console script."""
    with warnings.catch_warnings():
        warnings.showwarning = _show_warning
        try:
            app()
        except StrutworkError as error:
            sys.stderr.write(f"Error: {error}\n")
            sys.exit(1)


def _show_warning(message: Warning | str, *_: object, **__: object) -> None:
    sys.stderr.write(f"Warning: {message}\n")


def _print_version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"strutwork {__version__}")
        raise typer.Exit


@app.callback()
def program(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_print_version, is_eager=True, help="Print the version."
        ),
    ] = False,
) -> None:
    """Stiffness, mobility and joint forces of parallel and hybrid machines."""


@app.command()
def machines(json: Json = False) -> None:
    """List the machines of the literature, with their papers."""
    from reports.cli import machines as work

    work.run(json)


@app.command()
def check(file: ModelFile, json: Json = False) -> None:
    """Count freedoms and redundant constraints of a model file, and name them."""
    from reports.cli import check as work

    work.run(file, json)


@app.command()
def solve(file: ModelFile, json: Json = False) -> None:
    """Solve the load cases of a model file, and the stiffness at its tool."""
    from reports.cli import solve as work

    work.run(file, json)


@app.command("map")
def map_stiffness(
    machine: Annotated[
        str, typer.Argument(metavar="MACHINE", help="As `strutwork machines` says.")
    ],
    out: Annotated[
        str | None,
        typer.Option("--out", "-o", metavar="DIR", help="Write the map there as NetCDF and CSV."),
    ] = None,
    apparent: Annotated[
        bool,
        typer.Option("--apparent", help="Links clamped in the platform, not on spherical joints."),
    ] = False,
    ranges: Annotated[
        Ranges, typer.Option(help="Whose joint ranges a pose must keep.")
    ] = Ranges.ALL,
    lattice: Annotated[
        int, typer.Option(min=1, max=200, help="Fineness of the check points; 10 gives 317.")
    ] = 10,
    rolls: Annotated[
        int, typer.Option(min=1, max=720, help="Rolls about the normal tried at each point.")
    ] = 24,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Threads; one a processor by default.")
    ] = None,
    json: Json = False,
) -> None:
    """Map the stiffness of a machine over the hemisphere of its check points."""
    from reports.cli import stiffness as work

    work.run(
        machine,
        out,
        apparent=apparent,
        ranges=ranges.value,
        lattice=lattice,
        rolls=rolls,
        workers=workers,
        json=json,
    )


@app.command()
def report(
    target: Annotated[
        str,
        typer.Argument(metavar="TARGET", help="A machine, a comparison (azulay-2014) or a FILE."),
    ],
    out: Annotated[
        str | None,
        typer.Option("--out", "-o", metavar="DIR", help="Folder; out/TARGET by default."),
    ] = None,
    json: Json = False,
) -> None:
    """Write a report: one HTML file that opens offline, and its data files."""
    from reports.cli import report as work

    work.run(target, out, json)
