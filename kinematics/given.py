"""What a motion is given: poses or coordinates of the tool, and coordinates of joints."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.joint import DIRECTIONS
from strutwork.kinematics.joint_motion import JointMotion
from strutwork.kinematics.mechanism import Poses
from strutwork.kinematics.turns import rotation_matrix, rotation_vector
from strutwork.names import choices

Array = NDArray[Any]


@dataclass(frozen=True)
class Given:
    """Targets of a motion, with the batch made flat, p poses.

    Parameters
    ----------
    batch : tuple of int
    start : Poses or None
        The tool at home, where it is given something.
    tool : Poses or None
        (p)
    task : tuple of int
        Directions of the tool that are given one by one.
    task_values : (p, t)
        m and rad.
    joint, direction : (m,)
        Joint coordinates that are given.
    values : (p, m)
        Relative to home, m and rad.
    names : tuple of str
        Of these coordinates, as in `ram1:z`.
    """

    batch: tuple[int, ...]
    start: Poses | None
    tool: Poses | None
    task: tuple[int, ...]
    task_values: Array
    joint: NDArray[np.intp]
    direction: NDArray[np.intp]
    values: Array
    names: tuple[str, ...] = ()

    @property
    def poses(self) -> int:
        """Number of targets."""
        return len(self.values)

    def pose(self, index: NDArray[np.intp], share: Array) -> tuple[Array, Array]:
        """Position and rotation of the tool at a share of the way, (k, 3) and (k, 3, 3).

        Parameters
        ----------
        index : (k,) of int
            Which targets.
        share : (k,)
            Of each one's way from `start`, 0 to 1, no unit.
        """
        assert self.tool is not None  # noqa: S101 - asked for only where it is given
        assert self.start is not None  # noqa: S101
        start, part = self.start, share[:, None]
        end = self.tool.rotation[index]
        position = start.position + part * (self.tool.position[index] - start.position)
        whole = rotation_vector(end @ start.rotation.T)
        # at the end the target itself, without the rounding of the way
        rotation = np.where(
            share[:, None, None] == 1.0, end, rotation_matrix(part * whole) @ start.rotation
        )
        return position, rotation


def given(
    joints: JointMotion,
    start: Poses | None,
    home_values: Array,
    tool: Poses | None,
    task: Mapping[str, ArrayLike] | None,
    wanted: Mapping[tuple[str, str], ArrayLike] | None,
) -> Given:
    """Check and broadcast what a motion is given.

    Parameters
    ----------
    joints : JointMotion
        Says which coordinates there are.
    start : Poses or None
        The tool at home, one pose.
    home_values : (c,)
        Coordinates at home, m or rad, in the order of `JointMotion.names`.
    tool : Poses or None
        (...); targets of the tool.
    task : mapping of direction to (...), or None
        Some coordinates of the tool instead, m and rad.
    wanted : mapping of (joint, direction) to (...), or None
        Joint coordinates, m and rad; all batches broadcast.

    Raises
    ------
    ModelError
        Nothing is given, both `tool` and `task` are, an unknown name or direction, or values
        that are not finite or do not broadcast.
    """
    part = "motion"
    if tool is not None and task:
        raise ModelError(part, "is given both a pose and a task.", "Give one of the two.")
    if tool is None and not task and not wanted:
        raise ModelError(part, "is given no target.", "Give a pose, a task or joint coordinates.")
    for name in task or ():
        if name not in DIRECTIONS:
            raise ModelError(
                part,
                f'the task names the unknown direction "{name}".',
                "Directions are " + ", ".join(DIRECTIONS) + ".",
            )
    directions = tuple(d for d in DIRECTIONS if d in (task or {}))
    pairs = tuple(wanted or {})
    for pair in pairs:
        _check_coordinate(joints, pair)
    try:
        batch = np.broadcast_shapes(
            *(np.shape(v) for v in (task or {}).values()),
            *(np.shape(v) for v in (wanted or {}).values()),
            () if tool is None else tool.batch,
        )
    except ValueError as error:
        raise ModelError(
            part, "has targets whose shapes do not match.", "Give arrays that broadcast."
        ) from error
    index = [joints.names.index(pair) for pair in pairs]
    values = _flat(batch, [(wanted or {})[pair] for pair in pairs]) - home_values[index]
    task_values = _flat(batch, [(task or {})[d] for d in directions])
    for shown, found in ((pairs, values), (directions, task_values)):
        wrong = np.argwhere(~np.isfinite(found))
        if len(wrong):
            raise ModelError(
                part,
                f"{shown[wrong[0, 1]]} of target {wrong[0, 0]} is not finite.",
                "Give finite numbers, m and rad.",
            )
    count = len(values)
    poses = None
    if tool is not None:
        poses = Poses(
            np.broadcast_to(tool.position, (*batch, 3)).reshape(count, 3),
            np.broadcast_to(tool.rotation, (*batch, 3, 3)).reshape(count, 3, 3),
        )
    found_joints = joints.linkage.joint_index
    return Given(
        batch,
        start,
        poses,
        tuple(DIRECTIONS.index(d) for d in directions),
        task_values,
        np.array([found_joints[name] for name, _ in pairs], dtype=np.intp),
        np.array([DIRECTIONS.index(d) for _, d in pairs], dtype=np.intp),
        values,
        tuple(f"{name}:{d}" for name, d in pairs),
    )


def _flat(batch: tuple[int, ...], values: list[ArrayLike]) -> Array:
    """Values of several names side by side, (p, m)."""
    count = int(np.prod(batch, dtype=int))
    parts = [np.broadcast_to(np.asarray(v, dtype=float), batch).reshape(count) for v in values]
    return np.stack(parts, axis=-1) if parts else np.zeros((count, 0))


def _check_coordinate(joints: JointMotion, pair: tuple[str, str]) -> None:
    name, direction = pair
    if pair in joints.names:
        joint = joints.linkage.joints[joints.linkage.joint_index[name]]
        if (
            direction.startswith("r")
            and not joints.still[joints.linkage.joint_index[name], 3:].any()
        ):
            raise ModelError(
                f"joint {name}",
                f"rotates freely in all directions: {direction} alone is not a coordinate of it.",
                f"Give the pose of the tool, or make the {joint.type} joint of single ones.",
            )
        return
    mine = [d for n, d in joints.names if n == name]
    if mine:
        raise ModelError(
            f"joint {name}",
            f'"{direction}" does not move in it.',
            f"Its coordinates are {', '.join(mine)}.",
        )
    known = dict.fromkeys(n for n, _ in joints.names)
    raise ModelError(
        "motion", f'names the unknown joint "{name}".', choices("Joints that move", name, known)
    )
