"""Lines and planes of a machine's poses, in which singularities are looked for."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Placement, Poses, characteristic_length
from strutwork.kinematics.lost_motion import Kind, Lost
from strutwork.kinematics.pose_family import PoseFamily, TaskSection, joined
from strutwork.kinematics.singular_distance import Distance, singularity_distance
from strutwork.kinematics.singular_poses import classify
from strutwork.kinematics.tool_drive_space import Freedoms, check_driven, tool_drive_space
from strutwork.kinematics.turns import rotation_matrix
from strutwork.machines.limits import Limit, check_limits, joint_limits
from strutwork.machines.model import Model

Array = NDArray[Any]


def section_family(
    model: Model,
    names: tuple[str, ...],
    at: Mapping[str, float] | None = None,
    length: float | None = None,
    *,
    kinds: Iterable[str] | None = None,
) -> PoseFamily:
    """Poses of a machine by some of its task coordinates.

    Parameters
    ----------
    model : Model
        Its own formulas place it where it has some and the section gives whole poses.
    names : tuple of directions
        That change.
    at : mapping of direction to float
        Others, m and rad; what is not named stays as at home, where it can.
    length : float, optional
        L, m; default the machine's characteristic length.
    kinds : iterable of str, optional
        Joint types whose ranges count; default all.

    Raises
    ------
    ModelError
        As `TaskSection.of`.
    """
    given = dict(at or {})
    if set(names) <= set(model.task):
        # the file says what its tool is to do: that stays before anything else
        home = dict(zip(DIRECTIONS, model.motion.task_of(model.motion.home_pose), strict=True))
        given = {d: float(home[d]) for d in model.task if d not in names} | given
    section = TaskSection.of(model.motion, names, given)
    whole = model.closed_form is not None and len(section.directions) == 6
    limits = model.limits if whole else joint_limits(model.structure.linkage)
    chosen = _chosen(limits, kinds)

    def place(parameters: Array) -> Placement:
        placed = _own(model, section, parameters) if whole else section.place(parameters)
        return check_limits(chosen, placed)

    return PoseFamily.along(section, length, place if whole or chosen else None)


def pose_distance(model: Model, length: float | None = None) -> PoseDistance:
    """Distance of the machine, where it stands, from singularities.

    Parameters
    ----------
    model : Model
        At home, or as `at_pose` puts it elsewhere.
    length : float, optional
        L, m; default the machine's characteristic length.

    Raises
    ------
    ModelError
        As `tool_drive_space`, and no tool.
    """
    model.require_tool()
    linkage, motion = model.structure.linkage, model.motion
    chosen = characteristic_length(motion.home) if length is None else length
    here = replace(
        model.placement[None], values=np.zeros((1, 0)), names=(), turns=None, status=None
    )
    # what has no drives or no moving tool is refused before anything is moved
    check_driven(linkage, chosen)
    # the pose may be singular: ranks are those of poses beside it, a hundredth of its size away
    rest = motion.rest()
    if not rest:
        raise ModelError(
            "tool",
            "moves in no direction at home.",
            "Place it on a body that moves, or home where it can move.",
        )
    rng = np.random.default_rng(1)
    beside = {
        d: v + rng.uniform(-0.01, 0.01, 16) * (1.0 if d.startswith("r") else chosen)
        for d, v in rest.items()
    }
    moved = motion.move(task=beside).placement
    near = moved[moved.reachable]
    near = replace(near, values=np.zeros((len(near.positions), 0)), names=(), turns=None)
    known = tool_drive_space(linkage, joined([here, near]), chosen).known
    distance = singularity_distance(linkage, here, chosen, known)
    (kind,), (lost,) = classify(linkage, here, known, chosen)
    return PoseDistance(distance, known, kind, lost)


@dataclass(frozen=True)
class PoseDistance:
    """Distance of one pose from singularities.

    Parameters
    ----------
    distance : Distance
        Of a batch of one.
    known : Freedoms
        Of the machine beside the pose.
    kind : Kind or None
        Where the pose is singular itself.
    lost : Lost or None
    """

    distance: Distance
    known: Freedoms
    kind: Kind | None
    lost: Lost | None


def _chosen(limits: Iterable[Limit], kinds: Iterable[str] | None) -> tuple[Limit, ...]:
    if kinds is None:
        return tuple(limits)
    wanted = set(kinds)
    return tuple(limit for limit in limits if limit.kind in wanted)


def _own(model: Model, section: TaskSection, parameters: Array) -> Placement:
    """By the machine's own formulas."""
    values = section.values(parameters)
    task = np.stack([values[d] for d in DIRECTIONS], axis=1)
    closed_form = model.closed_form
    assert closed_form is not None  # noqa: S101 - asked by the caller
    return closed_form(Poses(task[:, :3], rotation_matrix(task[:, 3:]) @ model.rotation))
