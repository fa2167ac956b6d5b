"""The options of `strutwork servo`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import (
    JointAt,
    Json,
    Loss,
    Over,
    Pose,
    Preload,
    Ratio,
    Target,
    Workers,
)
from strutwork.reports.cli.usage import typed


def servo(
    target: Target,
    servos: Annotated[
        str | None,
        typer.Option(
            callback=typed,
            metavar="FILE",
            help="Controllers of the drives, tables \\[\\[servos]], in place of the model's.",
        ),
    ] = None,
    port: Annotated[
        list[str] | None,
        typer.Option(
            callback=typed,
            metavar="NODE:DIR",
            help="Where the stiffness is computed, as in TCP:x; by default x, y and z of the "
            "tool. Repeatable.",
        ),
    ] = None,
    low: Annotated[
        float | None,
        typer.Option("--from", help="Start of the band, Hz; by default, the band is chosen."),
    ] = None,
    high: Annotated[float | None, typer.Option("--to", help="End of the band, Hz.")] = None,
    modes: Annotated[
        int | None,
        typer.Option(
            min=1,
            help="Number of modes that are kept; by default those up to twice the band, and up "
            "to 2000 Hz. The others count statically.",
        ),
    ] = None,
    over: Over = None,
    workers: Workers = None,
    pose: Pose = None,
    joint: JointAt = None,
    out: Annotated[
        str | None,
        typer.Option(
            "--out",
            "-o",
            metavar="DIR",
            help="Write poles, margins and responses to this folder as CSV, poses as NetCDF and "
            "CSV.",
        ),
    ] = None,
    modal_ratio: Ratio = None,
    loss_factor: Loss = None,
    preload: Preload = None,
    json: Json = False,
) -> None:
    """Close the loops of the drives: poles, margins, dynamic stiffness with servos."""
    from strutwork.reports.cli import servo as work
    from strutwork.reports.cli.subject import where

    if (low is None) != (high is None):
        raise typer.BadParameter("give both --from and --to, or neither for an automatic band.")
    work.run(
        target,
        servos,
        port or (),
        None if low is None or high is None else (low, high),
        modes,
        over=over,
        workers=workers,
        out=out,
        at=where(pose, joint),
        modal_ratio=modal_ratio,
        loss_factor=loss_factor,
        preload=preload,
        json=json,
    )
