"""The options of `strutwork lobes`."""

from __future__ import annotations

from enum import StrEnum
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


class Way(StrEnum):
    """Which way the cutter turns against the feed."""

    UP = "up"
    DOWN = "down"


def lobes(
    target: Target,
    process: Annotated[
        str | None,
        typer.Option(
            callback=typed,
            metavar="FILE",
            help="A file of the cut; its keys are those of a model's \\[process], which is used "
            "where nothing else is said. Other options change it.",
        ),
    ] = None,
    tool: Annotated[
        str | None,
        typer.Option(
            "--tool",
            callback=typed,
            metavar="diameter=D,teeth=N,...",
            help="The cutter, as in --tool diameter=20mm,teeth=4; also helix and lead angle.",
        ),
    ] = None,
    material: Annotated[
        str | None,
        typer.Option(
            callback=typed,
            metavar="NAME",
            help="Workpiece material: of Strutwork's library, or FILE.toml:NAME of a file.",
        ),
    ] = None,
    speeds: Annotated[
        str | None,
        typer.Option(
            callback=typed, metavar="LOW..HIGH:N", help="Spindle speeds, rpm: 2000..12000:51."
        ),
    ] = None,
    immersion: Annotated[
        float | None,
        typer.Option(help="Radial depth of cut by the diameter, above 0 to 1, the default."),
    ] = None,
    way: Annotated[Way | None, typer.Option(help="Up- or down-milling; down by default.")] = None,
    node: Annotated[
        str,
        typer.Option(
            callback=typed,
            metavar="NODE",
            help="Where it cuts, or NODE-NODE for the first relative to the second.",
        ),
    ] = "TCP",
    axis: Annotated[
        str | None,
        typer.Option(
            callback=typed,
            metavar="DIR",
            help="Axis of the tool, from its tip to its holder; z by default. At poses, axis and "
            "feed turn with the tool.",
        ),
    ] = None,
    feed: Annotated[
        str | None,
        typer.Option(callback=typed, metavar="DIR", help="Direction of the feed; x by default."),
    ] = None,
    feed_per_tooth: Annotated[
        str | None, typer.Option(callback=typed, help="For removal rates; 0.1 mm by default.")
    ] = None,
    deepest: Annotated[
        str | None,
        typer.Option(
            callback=typed,
            help="Largest depth tried exactly; ten times the absolute limit by default.",
        ),
    ] = None,
    rose: Annotated[
        bool, typer.Option("--rose", help="Also the depths by direction of the feed.")
    ] = False,
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
            help="Write the limits to this folder as CSV, poses as NetCDF and CSV.",
        ),
    ] = None,
    modal_ratio: Ratio = None,
    loss_factor: Loss = None,
    preload: Preload = None,
    json: Json = False,
) -> None:
    """Compute how deep a machine can mill without chatter, by spindle speed and pose."""
    from strutwork.reports.cli import lobes as work
    from strutwork.reports.cli.cut_words import CutWords
    from strutwork.reports.cli.subject import where

    turning = None if way is None else way.value
    work.run(
        target,
        CutWords(process, tool, material, speeds, immersion, turning, axis, feed, feed_per_tooth),
        node=node,
        deepest=deepest,
        over=over,
        rose=rose,
        out=out,
        workers=workers,
        at=where(pose, joint),
        modal_ratio=modal_ratio,
        loss_factor=loss_factor,
        preload=preload,
        json=json,
    )
