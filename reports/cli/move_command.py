"""The options of `strutwork move`."""

from __future__ import annotations

from typing import Annotated

import typer

from strutwork.reports.cli.choices import JointAt, Json, Pose, Target


def move(
    target: Target,
    pose: Pose = None,
    joint: JointAt = None,
    targets: Annotated[
        str | None,
        typer.Option(metavar="CSV", help="Many targets: columns such as “x, mm” or “ram1:z, mm”."),
    ] = None,
    out: Annotated[
        str | None,
        typer.Option("--out", "-o", metavar="CSV", help="Write all coordinates to this file."),
    ] = None,
    branches: Annotated[
        bool,
        typer.Option(
            "--branches",
            help="Also list the other assembly modes at the drives reached and the working "
            "modes at the pose, also below the target in the file of --out.",
        ),
    ] = False,
    json: Json = False,
) -> None:
    """Move a machine: from poses of the tool to joint coordinates, and back."""
    from strutwork.reports.cli import move as work

    work.run(target, pose or (), joint or (), targets, out, branches=branches, json=json)
