"""Lines and planes of a machine's poses, in which singularities are looked for."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS, Placement, Poses
from strutwork.kinematics.pose_family import PoseFamily, TaskSection
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
    section = TaskSection.of(model.motion, names, at)
    whole = model.closed_form is not None and len(section.directions) == 6
    limits = model.limits if whole else joint_limits(model.structure.linkage)
    chosen = _chosen(limits, kinds)

    def place(parameters: Array) -> Placement:
        placed = _own(model, section, parameters) if whole else section.place(parameters)
        return check_limits(chosen, placed)

    return PoseFamily.along(section, length, place if whole or chosen else None)


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
