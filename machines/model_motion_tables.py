"""Home, task, workspace and drives from the tables of a model file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import degrees

import numpy as np

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Joint
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.drives import Drive
from strutwork.machines.limits import SLACK, joint_limits_of
from strutwork.machines.model_motion_schema import WorkspaceTable
from strutwork.machines.model_parts import by_direction, unknown
from strutwork.machines.model_schema import ModelTable

#: A joint coordinate by its joint and direction.
Coordinate = tuple[str, str]


def home_values(tables: ModelTable, joints: Sequence[Joint]) -> dict[Coordinate, float]:
    """Joint coordinates in the configuration of the file, m and rad.

    Parameters
    ----------
    tables : ModelTable
    joints : sequence of Joint
        Those of the file.

    Raises
    ------
    ModelError
        An unknown joint, a coordinate outside its own limits.
    """
    known = {joint.name: joint for joint in joints}
    found: dict[Coordinate, float] = {}
    for name, table in tables.home.items():
        if name not in known:
            raise unknown("home", "joint", name, known)
        found |= {(name, d): value for d, value in by_direction(table).items()}
    for limit in joint_limits_of(joints):
        value = found.get((limit.joint, limit.coordinate), 0.0)
        if not limit.low - SLACK <= value <= limit.high + SLACK:
            raise ModelError(
                f"joint {limit.joint}",
                f"has limits that exclude home: {limit.words}, and it is "
                f"{_shown(limit.coordinate, value)} there.",
                f"Correct the limits, or give its value: [home.{limit.joint}] with "
                f"{limit.coordinate} = …; without it home counts as zero.",
            )
    return found


def _shown(direction: str, value: float) -> str:
    turns = direction.startswith("r")
    return f"{degrees(value) if turns else 1e3 * value:.6g} {'deg' if turns else 'mm'}"


def task_of(tables: ModelTable) -> tuple[str, ...]:
    """Directions in which the tool is to move; empty where the file does not say.

    Parameters
    ----------
    tables : ModelTable

    Raises
    ------
    ModelError
        None or a direction twice, or a task without a tool.
    """
    if tables.task is None:
        return ()
    named = tables.task.directions
    if not named or len(set(named)) < len(named):
        raise ModelError("task", "names no direction or one twice.", "Name each direction once.")
    if tables.tool is None:
        raise ModelError("task", "is given without a tool.", 'Add [tool] with tcp = "NODE".')
    return tuple(d for d in DIRECTIONS if d in named)


def workspace_of(tables: ModelTable, task: Sequence[str]) -> TaskGrid | None:
    """The poses that maps and reports look at.

    Parameters
    ----------
    tables : ModelTable
    task : sequence of str
        Directions of the task; empty where it has none.

    Raises
    ------
    ModelError
        A direction that is none of the task's, an empty range, too many poses.
    """
    return None if tables.workspace is None else grid_of_table(tables.workspace, task)


def grid_of_table(table: WorkspaceTable, task: Sequence[str] = ()) -> TaskGrid:
    """The poses of one table.

    Parameters
    ----------
    table : WorkspaceTable
    task : sequence of str
        Directions that it may name; empty for all.

    Raises
    ------
    ModelError
        As `workspace_of`.
    """
    axes: dict[str, np.ndarray[tuple[int], np.dtype[np.float64]]] = {}
    for direction in DIRECTIONS:
        span = getattr(table, direction)
        if span is None:
            continue
        if task and direction not in task:
            raise ModelError(
                "workspace",
                f"goes along {direction}, which is not one of the task's directions.",
                f"The task has {', '.join(task)}: add it there, or remove it here.",
            )
        if not span.from_ < span.to:
            raise ModelError(f"workspace.{direction}", "has no extent.", "Give from below to.")
        axes[direction] = np.linspace(span.from_, span.to, span.points)
    if not axes:
        raise ModelError("workspace", "names no direction.", "Name one, as in x = {from, to}.")
    return TaskGrid(axes)


def drives_of(tables: ModelTable, joints: Mapping[str, Joint]) -> tuple[Drive, ...]:
    """What drives can do, one entry per driven direction.

    Parameters
    ----------
    tables : ModelTable
    joints : mapping of str to Joint
        Those of the file, by name.

    Raises
    ------
    ModelError
        An unknown joint, a direction that is not driven, one given twice, quantities of the
        other kind.
    """
    found: dict[Coordinate, Drive] = {}
    for i, table in enumerate(tables.drives):
        part = f"drives[{i}]"
        if (table.joint is None) == (table.joints is None):
            raise ModelError(part, "names no joint, or both joint and joints.", "Give one of them.")
        turns = table.direction.startswith("r")
        for wrong, right in (("speed", "turning_speed"), ("force", "torque")):
            if getattr(table, wrong if turns else right) is not None:
                raise ModelError(
                    part,
                    f"gives {wrong if turns else right} to a drive that "
                    f"{'turns' if turns else 'slides'}.",
                    f"Give {right if turns else wrong}.",
                )
        step = table.angular_resolution if turns else table.resolution
        if (table.resolution if turns else table.angular_resolution) is not None:
            raise ModelError(
                part,
                "gives the resolution of the other kind of drive.",
                f"Give {'angular_resolution' if turns else 'resolution'}.",
            )
        for name in table.joints if table.joints is not None else (table.joint or "",):
            if name not in joints:
                raise unknown(part, "joint", name, joints)
            key = (name, table.direction)
            if table.direction not in joints[name].driven:
                raise ModelError(
                    part,
                    f"is of {name}:{table.direction}, which is not driven.",
                    f'Add driven = ["{table.direction}"] to the joint.',
                )
            if key in found:
                raise ModelError(part, f"gives {name}:{table.direction} twice.", "Give it once.")
            found[key] = Drive(
                *key,
                speed=table.turning_speed if turns else table.speed,
                force=table.torque if turns else table.force,
                resolution=step,
            )
    return tuple(found.values())
