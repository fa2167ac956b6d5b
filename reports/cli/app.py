"""The commands and their options.

A command imports its work when it runs, so that help and wrong usage answer at once.
"""

from __future__ import annotations

import sys
import warnings
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
