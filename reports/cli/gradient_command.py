"""The options of `strutwork gradient`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import Json, Loss, Pose, Ratio, Target
from strutwork.reports.cli.usage import typed


def gradient(
    target: Target,
    of: Annotated[
        list[str] | None,
        typer.Option(
            "--of",
            callback=typed,
            metavar="QUANTITY",
            help="stiffness_z (other directions free), blocked_stiffness_z, frequency_1, "
            "least_dynamic_stiffness_z, displacement:NODE:z@CASE or joint_force:JOINT:z@CASE. "
            "Repeatable; the three translational stiffnesses by default.",
        ),
    ] = None,
    by: Annotated[
        list[str] | None,
        typer.Option(
            "--by",
            callback=typed,
            metavar="PATH",
            help="A number of the machine, as in sections.ram.diameter; joints.ball*.stiffness.z "
            "or nodes.a.x+nodes.b.x move together. Repeatable; by default all sizes, materials, "
            "stiffnesses and masses.",
        ),
    ] = None,
    pose: Pose = None,
    worst: Annotated[
        bool,
        typer.Option(
            "--worst", help="At the pose of the machine's workspace where the first is least."
        ),
    ] = False,
    low: Annotated[
        float, typer.Option("--from", help="Start of the band of a least dynamic stiffness, Hz.")
    ] = 1.0,
    high: Annotated[float, typer.Option("--to", help="End of that band, Hz.")] = 1000.0,
    modal_ratio: Ratio = None,
    loss_factor: Loss = None,
    out: Annotated[
        str | None,
        typer.Option("--out", "-o", metavar="CSV", help="Write every gradient there."),
    ] = None,
    json: Json = False,
) -> None:
    """Find what to change first: what more of each dimension does to stiffness or frequency."""
    from strutwork.reports.cli import gradient as work

    options = work.Options(tuple(of or ()), tuple(by or ()), worst, (low, high))
    work.run(target, pose or (), options, (modal_ratio, loss_factor), out, json=json)
