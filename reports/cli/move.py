"""`strutwork move`: where the joints and the tool of a machine go."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from strutwork.errors import ModelError
from strutwork.files import write_text
from strutwork.kinematics.motion import Moved
from strutwork.machines.limits import check_limits, joint_limits
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.machines.model_poses import walked
from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json, print_table
from strutwork.reports.cli.subject import where
from strutwork.reports.motion_table import (
    Coordinate,
    moved_columns,
    moved_csv,
    read_targets,
)


def run(
    name: str,
    pose: Sequence[str],
    joint: Sequence[str],
    targets: str | None,
    out: str | None,
    *,
    json: bool,
) -> None:
    """Move, and print where everything stands."""
    if targets is not None and (pose or joint):
        raise ModelError("move", "is given a file of targets and others.", "Give one or the other.")
    at = where(pose, joint)
    wanted: dict[Coordinate, Any] = {**{("", d): v for d, v in at.task.items()}, **at.joints}
    if targets is not None:
        wanted |= read_targets(Path(targets))
    model = load(name)
    _print(model, _moved(model, wanted), out, json=json)


def _moved(model: Model, wanted: dict[Coordinate, Any]) -> tuple[Moved, list[str]]:
    task = {d: v for (owner, d), v in wanted.items() if not owner}
    joints = {pair: v for pair, v in wanted.items() if pair[0]}
    found = walked(model, task, joints)
    # a range of a coordinate that only the machine's own formulas know is no motion's
    placed = check_limits(joint_limits(model.structure.linkage), found.placement)
    return found, [placed.reason(i) for i in np.ndindex(*placed.batch)]


def _print(model: Model, result: tuple[Moved, list[str]], out: str | None, *, json: bool) -> None:
    moved, reasons = result
    columns = moved_columns(model.motion, moved)
    if out is not None:
        write_text(Path(out), moved_csv(columns, reasons))
    if json:
        print_json(
            {
                "targets": len(reasons),
                "reached": reasons.count(""),
                "status": [r or None for r in reasons],
                "share": np.atleast_1d(moved.share).tolist(),
                "columns": {k: v.tolist() for k, v in columns.items()},
            }
            | ({"data": [out]} if out is not None else {})
        )
        return
    screen = console()
    screen.print(model.title or "Model", markup=False, style="bold")
    if len(reasons) == 1:
        rows = [(*name.rpartition(", ")[::2], float(v[0])) for name, v in columns.items()]
        print_table(screen, "Coordinates", ["", "unit", "value"], rows)
    screen.print(f"{reasons.count('')} of {len(reasons)} targets reached", markup=False)
    shares = np.atleast_1d(moved.share)
    for reason in dict.fromkeys(r for r in reasons if r):
        found = [i for i, r in enumerate(reasons) if r == reason]
        far = "" if shares[found[0]] >= 1.0 else f", {100 * shares[found[0]]:.3g} % of the way"
        screen.print(
            f"  {len(found)}: {visible(reason)} (first: target {found[0] + 1}{far})",
            markup=False,
            soft_wrap=True,
        )
    if out is not None:
        screen.print(f"Written: {visible(out)}", markup=False, soft_wrap=True)
