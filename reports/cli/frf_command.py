"""The options of `strutwork frf`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import JointAt, Json, Loss, Pose, Preload, Ratio, Target
from strutwork.reports.cli.usage import typed


def frf(
    target: Target,
    given: Annotated[
        str,
        typer.Option(
            "--input", callback=typed, metavar="NODE:DIR", help="Where the force acts, as in TCP:x."
        ),
    ],
    low: Annotated[
        float | None,
        typer.Option(
            "--from",
            help="Start of the band, Hz; by default, the band is chosen to cover the response.",
        ),
    ] = None,
    high: Annotated[float | None, typer.Option("--to", help="End of the band, Hz.")] = None,
    output: Annotated[
        str | None,
        typer.Option(
            "--output",
            callback=typed,
            metavar="NODE:DIR",
            help="Where the motion is computed; the input by default.",
        ),
    ] = None,
    pose: Pose = None,
    joint: JointAt = None,
    lines: Annotated[
        int, typer.Option(min=2, max=1_000_000, help="Number of frequency lines, evenly spaced.")
    ] = 1000,
    out: Annotated[
        str | None,
        typer.Option(
            "--out", "-o", metavar="DIR", help="Write it to this folder as UFF-58 and CSV."
        ),
    ] = None,
    modal_ratio: Ratio = None,
    loss_factor: Loss = None,
    preload: Preload = None,
    json: Json = False,
) -> None:
    """Compute a frequency response, and the exact least dynamic stiffness in its band."""
    from strutwork.reports.cli import frf as work
    from strutwork.reports.cli.subject import where

    if (low is None) != (high is None):
        raise typer.BadParameter("give both --from and --to, or neither for an automatic band.")
    work.run(
        target,
        given,
        output,
        None if low is None or high is None else (low, high),
        lines,
        out,
        at=where(pose, joint),
        modal_ratio=modal_ratio,
        loss_factor=loss_factor,
        preload=preload,
        json=json,
    )
