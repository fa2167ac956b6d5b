"""The options of `strutwork study`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import Json


def study(
    file: Annotated[
        str,
        typer.Argument(
            metavar="FILE", help="A study file; with --paths a model file or a machine."
        ),
    ],
    out: Annotated[
        str | None,
        typer.Option(
            "--out",
            "-o",
            metavar="PATH",
            help="Write the result there: PATH.nc (NetCDF) or PATH.zarr, and a CSV beside it. What "
            "is finished is kept beside it until then.",
        ),
    ] = None,
    report: Annotated[
        str | None, typer.Option("--report", metavar="DIR", help="Write a report of it there.")
    ] = None,
    resume: Annotated[
        bool,
        typer.Option("--resume", help="Go on from what an interrupted run had finished."),
    ] = False,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Threads; one per processor by default.")
    ] = None,
    paths: Annotated[
        bool,
        typer.Option("--paths", help="List the numbers of a machine that a study can vary."),
    ] = False,
    json: Json = False,
) -> None:
    """Vary numbers of a machine and ask each machine that comes of it."""
    from strutwork.reports.cli import study as work

    if paths:
        work.list_paths(file, json=json)
        return
    if resume and out is None:
        raise typer.BadParameter("--resume needs --out, beside which finished parts are kept.")
    work.run(file, out, report, resume=resume, workers=workers, json=json)
