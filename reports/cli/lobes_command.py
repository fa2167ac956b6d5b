"""The options of `strutwork lobes`."""

from __future__ import annotations

from enum import StrEnum
from typing import Annotated

import typer

from strutwork.reports.cli.choices import JointAt, Json, Loss, Pose, Preload, Ratio, Target
from strutwork.reports.cli.usage import typed


class Way(StrEnum):
    """Which way the cutter turns against the feed."""

    UP = "up"
    DOWN = "down"


def lobes(
    target: Target,
    tool: Annotated[
        str,
        typer.Option(
            "--tool",
            callback=typed,
            metavar="diameter=D,teeth=N,...",
            help="The cutter, as in --tool diameter=20mm,teeth=4; also helix and lead angle.",
        ),
    ],
    material: Annotated[
        str,
        typer.Option(
            callback=typed,
            metavar="NAME",
            help="Workpiece material: of Strutwork's library, or FILE.toml:NAME of a file.",
        ),
    ],
    speeds: Annotated[
        str,
        typer.Option(
            callback=typed, metavar="LOW..HIGH:N", help="Spindle speeds, rpm: 2000..12000:51."
        ),
    ],
    immersion: Annotated[
        float, typer.Option(help="Radial depth of cut by the diameter, above 0 to 1.")
    ] = 1.0,
    way: Annotated[Way, typer.Option(help="Up- or down-milling.")] = Way.DOWN,
    node: Annotated[
        str,
        typer.Option(
            callback=typed,
            metavar="NODE",
            help="Where it cuts, or NODE-NODE for the first relative to the second.",
        ),
    ] = "TCP",
    axis: Annotated[
        str,
        typer.Option(
            callback=typed, metavar="DIR", help="Axis of the tool, from its tip to its holder."
        ),
    ] = "z",
    feed: Annotated[
        str, typer.Option(callback=typed, metavar="DIR", help="Direction of the feed.")
    ] = "x",
    feed_per_tooth: Annotated[
        str, typer.Option(callback=typed, help="For removal rates.")
    ] = "0.1 mm",
    deepest: Annotated[
        str | None,
        typer.Option(
            callback=typed,
            help="Largest depth tried exactly; ten times the absolute limit by default.",
        ),
    ] = None,
    pose: Pose = None,
    joint: JointAt = None,
    out: Annotated[
        str | None,
        typer.Option("--out", "-o", metavar="DIR", help="Write the limits to this folder as CSV."),
    ] = None,
    modal_ratio: Ratio = None,
    loss_factor: Loss = None,
    preload: Preload = None,
    json: Json = False,
) -> None:
    """Compute how deep a machine can mill without chatter, by spindle speed."""
    from strutwork.reports.cli import lobes as work
    from strutwork.reports.cli.subject import where

    work.run(
        target,
        tool,
        material,
        immersion,
        way.value,
        speeds,
        node=node,
        axis=axis,
        feed=feed,
        feed_per_tooth=feed_per_tooth,
        deepest=deepest,
        out=out,
        at=where(pose, joint),
        modal_ratio=modal_ratio,
        loss_factor=loss_factor,
        preload=preload,
        json=json,
    )
