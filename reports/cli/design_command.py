"""The options of `strutwork design`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import Json


def design(
    file: Annotated[
        str,
        typer.Argument(metavar="FILE", help="A design file; with --pick the result of one."),
    ],
    out: Annotated[
        str | None,
        typer.Option(
            "--out",
            "-o",
            metavar="PATH",
            help="Write the result there: PATH.nc (NetCDF), and a CSV beside it. Finished "
            "generations are kept beside it until then. With --pick the model file.",
        ),
    ] = None,
    report: Annotated[
        str | None, typer.Option("--report", metavar="DIR", help="Write a report of it there.")
    ] = None,
    resume: Annotated[
        bool,
        typer.Option(
            "--resume",
            help="Go on from finished generations, or from a result that has fewer of them.",
        ),
    ] = False,
    pick: Annotated[
        int | None,
        typer.Option(
            min=1, metavar="N", help="Write machine N of the front of a result as a model file."
        ),
    ] = None,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Threads; one per processor by default.")
    ] = None,
    json: Json = False,
) -> None:
    """Search parameters of a machine that are best in several objectives."""
    from strutwork.reports.cli import design as work

    if resume and out is None:
        raise typer.BadParameter("--resume needs --out, beside which generations are kept.")
    if pick is not None:
        if out is None:
            raise typer.BadParameter("--pick needs --out, the model file to write.")
        if resume or report is not None:
            raise typer.BadParameter("--pick reads a result and takes no --resume or --report.")
        work.pick(file, pick, out, json=json)
        return
    work.run(file, out, report, resume=resume, workers=workers, json=json)
