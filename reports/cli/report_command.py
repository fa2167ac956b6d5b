"""The options of `strutwork report`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import JointAt, Json, Pose
from strutwork.reports.cli.usage import typed


def report(
    target: Annotated[
        str,
        typer.Argument(metavar="TARGET", help="A machine, a paper's key or a FILE."),
    ] = "",
    pose: Pose = None,
    joint: JointAt = None,
    out: Annotated[
        str | None,
        typer.Option("--out", "-o", metavar="DIR", help="Folder; out/TARGET by default."),
    ] = None,
    everything: Annotated[
        bool,
        typer.Option(
            "--all",
            help="Every machine and paper, and a page that compares the machines; out/all by "
            "default.",
        ),
    ] = False,
    verify: Annotated[
        bool,
        typer.Option("--verify", help="Compare the report in the folder TARGET with its manifest."),
    ] = False,
    pdf: Annotated[
        bool,
        typer.Option(
            "--pdf", help="Also as report.pdf, printed by an installed browser (extra pdf)."
        ),
    ] = False,
    fresh: Annotated[
        bool,
        typer.Option(
            "--fresh", help="Compute everything again and ignore stored results of earlier runs."
        ),
    ] = False,
    errors: Annotated[
        str | None,
        typer.Option(
            metavar="FILE",
            help="Errors file: the chapter on accuracy has the displacement of the tool by cause "
            "and part.",
        ),
    ] = None,
    process: Annotated[
        str | None,
        typer.Option(
            callback=typed,
            metavar="FILE",
            help="A file of the cut whose stability is reported, "
            "instead of the model's \\[process].",
        ),
    ] = None,
    json: Json = False,
) -> None:
    """Write a report: one HTML file that opens offline, and its data files."""
    from strutwork.reports.cli import report as work
    from strutwork.reports.cli.subject import where

    if everything:
        if target or pose or joint or verify or pdf or errors or process:
            raise typer.BadParameter(
                "--all takes no target, pose or other option but --out and --fresh."
            )
        work.run_all(out, json, fresh=fresh)
        return
    if not target:
        raise typer.BadParameter("Name a machine, a paper or a file, or give --all.")
    if verify:
        if out is not None or pdf or errors is not None:
            raise typer.BadParameter(
                "--verify writes nothing: leave --out, --pdf and --errors out."
            )
        work.verify(target, json)
        return
    at = where(pose, joint)
    work.run(target, out, json, at, pdf=pdf, fresh=fresh, errors=errors, process=process)
