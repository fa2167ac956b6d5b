"""`strutwork move`: where the joints and the tool of a machine go."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from strutwork.errors import ModelError
from strutwork.files import write_text
from strutwork.kinematics import Poses
from strutwork.kinematics.branches import Branches
from strutwork.kinematics.branches import branches as working_modes
from strutwork.kinematics.motion import Moved
from strutwork.machines.limits import check_limits, joint_limits
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.machines.model_poses import walked
from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json, print_table, table
from strutwork.reports.cli.subject import where
from strutwork.reports.motion_table import (
    Coordinate,
    moved_columns,
    moved_csv,
    read_targets,
    way_columns,
)
from strutwork.studies.machine_modes import STARTS, machine_modes

#: Columns of the ways of each kind.
Ways = dict[str, dict[str, Any]]


def run(
    name: str,
    pose: Sequence[str],
    joint: Sequence[str],
    targets: str | None,
    out: str | None,
    *,
    branches: bool,
    json: bool,
) -> None:
    """Move, and print where everything stands."""
    if targets is not None and (pose or joint):
        raise ModelError(
            "move", "is given both a file of targets and single ones.", "Give one or the other."
        )
    at = where(pose, joint)
    wanted: dict[Coordinate, Any] = {**{("", d): v for d, v in at.task.items()}, **at.joints}
    if targets is not None:
        wanted |= read_targets(Path(targets))
    model = load(name)
    found = _moved(model, wanted)
    ways, rows = _ways(model, found[0]) if branches else ({}, {})
    _print(model, found, out, (ways, rows), json=json)


def _moved(model: Model, wanted: dict[Coordinate, Any]) -> tuple[Moved, list[str]]:
    task = {d: v for (owner, d), v in wanted.items() if not owner}
    joints = {pair: v for pair, v in wanted.items() if pair[0]}
    found = walked(model, task, joints)
    # a range of a coordinate that only the machine's own formulas know is no motion's
    placed = check_limits(joint_limits(model.structure.linkage), found.placement)
    return found, [placed.reason(i) for i in np.ndindex(*placed.batch)]


def _ways(model: Model, found: Moved) -> tuple[dict[str, Any], Ways]:
    """Other ways to put the machine together where it stands: for JSON, m and rad, and for CSV.

    Raises
    ------
    ModelError
        Several targets, or one that was not reached.
    """
    if found.reached.size != 1 or not found.reached.all():
        raise ModelError(
            "--branches",
            "needs one target that can be reached.",
            "Give one pose, or joint coordinates, and leave --targets out.",
        )
    placement = found.placement if not found.placement.batch else found.placement[0]
    modes = machine_modes(model, placement)
    assert found.tool is not None  # noqa: S101 - asked by `machine_modes`
    pose = Poses(found.tool.position.reshape(3), found.tool.rotation.reshape(3, 3))
    working = working_modes(model.motion, tool=pose, starts=STARTS)
    task = model.motion.task_of(modes.tool)
    names = model.motion.joints.names
    inner = _coordinates(model, working)
    here = np.ravel(placement.values)
    held = {
        pair: np.full(len(modes), here[placement.names.index(pair)])
        for pair in model.structure.linkage.driven
    }
    same = Poses(
        np.broadcast_to(pose.position, (len(inner), 3)),
        np.broadcast_to(pose.rotation, (len(inner), 3, 3)),
    )
    rows = {
        "assembly mode": way_columns(model.motion, modes.tool, held),
        "working mode": way_columns(model.motion, same, dict(zip(names, inner.T, strict=True))),
    }
    ways = {
        "assembly_modes": task.tolist(),
        "every": modes.every,
        "working_modes": [
            {
                f"{joint}:{d}": float(value)
                for (joint, d), value in zip(names, row, strict=True)
                if (joint, d) in model.structure.linkage.driven
            }
            for row in inner
        ],
    }
    return ways, rows


def _coordinates(model: Model, found: Branches) -> Any:
    """Joint coordinates of ways, (m, c)."""
    joints = model.motion.joints
    _, _, gaps = joints.place(found.bodies)
    return joints.coordinates(found.bodies, gaps)[:, ~joints.still] + model.motion.home_values


def _print_ways(ways: dict[str, Any]) -> None:
    screen = console()
    rows = [
        # what is left of rounding, mm and deg, is no place
        (k + 1, *(np.round([*(1e3 * v for v in row[:3]), *np.degrees(row[3:])], 6) + 0.0).tolist())
        for k, row in enumerate(ways["assembly_modes"])
    ]
    heads = ["mode", "x, mm", "y, mm", "z, mm", "rx, deg", "ry, deg", "rz, deg"]
    which = "all" if ways["every"] else "found from several starts; there may be others"
    screen.print(
        table(f"Assembly modes at these drives, the present one first: {which}", heads, rows)
    )
    drives = ways["working_modes"]
    if drives and drives[0]:
        names = list(drives[0])
        turns = [n.rpartition(":")[2].startswith("r") for n in names]
        rows = [
            (
                k + 1,
                *(
                    float(np.degrees(v)) if t else 1e3 * v
                    for v, t in zip(way.values(), turns, strict=True)
                ),
            )
            for k, way in enumerate(drives)
        ]
        heads = [
            "mode",
            *(f"{n}, {'deg' if t else 'mm'}" for n, t in zip(names, turns, strict=True)),
        ]
        screen.print(table("Working modes at this pose, found from several starts", heads, rows))


def _print(
    model: Model,
    result: tuple[Moved, list[str]],
    out: str | None,
    others: tuple[dict[str, Any], Ways],
    *,
    json: bool,
) -> None:
    moved, reasons = result
    ways, rows = others
    columns = moved_columns(model.motion, moved)
    if out is not None:
        write_text(Path(out), moved_csv(columns, reasons, rows))
    if json:
        print_json(
            {
                "targets": len(reasons),
                "reached": reasons.count(""),
                "status": [r or None for r in reasons],
                "share": np.atleast_1d(moved.share).tolist(),
                "columns": {k: v.tolist() for k, v in columns.items()},
            }
            | ways
            | ({"data": [out]} if out is not None else {})
        )
        return
    screen = console()
    screen.print(model.title or "Model", markup=False, style="bold")
    if len(reasons) == 1:
        cells = [(*name.rpartition(", ")[::2], float(v[0])) for name, v in columns.items()]
        title = "Coordinates" if not reasons[0] else "Coordinates where the motion ended"
        print_table(screen, title, ["", "unit", "value"], cells)
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
    if ways:
        _print_ways(ways)
    if out is not None:
        screen.print(f"Written: {visible(out)}", markup=False, soft_wrap=True)
