"""`strutwork convert`: from a robot file to a model file, and back."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from strutwork.errors import ModelError
from strutwork.files import write_text
from strutwork.machines.load import ROBOT_FILES, load
from strutwork.machines.robots import model_text, read_robot, robot_of, robot_text
from strutwork.machines.robots.choices import Choices
from strutwork.machines.robots.robot import WORLD, Robot
from strutwork.machines.schema_file import DIRECTIVE, put_beside
from strutwork.names import visible
from strutwork.reports.cli.output import console, print_json


def run(
    source: str, target: str, tool: str | None, drives: Sequence[str] | None, *, json: bool
) -> None:
    """Write the other file, and say what it does not have."""
    path = Path(target)
    if path.exists():
        raise ModelError(target, "exists.", "Give another name, or move the file away.")
    robot = _read(source, tool, drives)
    if path.suffix.lower() == ".toml":
        text = _model_text(robot, Path(source).name)
        write_text(path, f"{DIRECTIVE}\n{text}")
        schema = put_beside(path)
    else:
        write_text(path, robot_text(robot, path))
        schema = None
    # what fixes a base on the ground is no joint to a reader
    joints = [j for j in robot.joints if j.kind != "fixed" or WORLD not in {j.parent, j.child}]
    written = [str(file) for file in (path, schema) if file is not None]
    if json:
        print_json(
            {
                "data": written,
                "links": len(robot.links),
                "joints": len(joints),
                "mass": {"total": robot.mass, "center": robot.centre.tolist()},
                "notes": list(robot.notes),
            }
        )
        return
    for note in robot.notes:
        sys.stderr.write(f"Note: {visible(note)}\n")
    out = console()
    for file in written:
        out.print(f"Written: {visible(file)}", markup=False, soft_wrap=True)
    out.print(f"{len(robot.links)} links, {len(joints)} joints, {robot.mass:.6g} kg", markup=False)


def _read(source: str, tool: str | None, drives: Sequence[str] | None) -> Robot:
    if Path(source).suffix.lower() in ROBOT_FILES:
        return read_robot(source, Choices(tool, None if drives is None else tuple(drives)))
    if tool is not None or drives is not None:
        raise ModelError(
            source,
            "is no robot file: it has its tool and drives.",
            "Leave out --tool and --drive.",
        )
    return robot_of(load(source))


def _model_text(robot: Robot, source: str) -> str:
    from strutwork.machines.robots.models import model_of

    # a file that cannot be read again is not written
    model_of(robot, source)
    return model_text(robot, source)
