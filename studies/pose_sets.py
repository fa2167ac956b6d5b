"""Poses of a design that form no grid: a list of them, or the check points of a hemisphere."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, Placement, Poses
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.limits import Limit, check_limits
from strutwork.machines.model import Model
from strutwork.machines.model_poses import moved
from strutwork.studies.check_points import hemisphere
from strutwork.studies.filters import Filters, PoseStatus
from strutwork.studies.parametric import Fields, Parametric
from strutwork.studies.stiffness_map import stiffness_map

Array = NDArray[Any]


@dataclass(frozen=True)
class TaskList:
    """Poses one by one, by task coordinates of the tool.

    Parameters
    ----------
    axes : mapping of direction to (n,)
        x, y, z of the tool centre point, m; rx, ry, rz, components of its rotation vector from
        home, rad. What is not named stays as it is at home.

    Raises
    ------
    ModelError
        No pose, an unknown direction, a value that is not finite, lists of different lengths.
    """

    axes: Mapping[str, Array]

    def __post_init__(self) -> None:
        if not self.axes or not len(self):
            raise ModelError("poses", "are none.", 'Name one, as x = "100 mm".')
        for name, values in self.axes.items():
            if name not in DIRECTIONS:
                raise ModelError(
                    "poses",
                    f'name the unknown direction "{name}".',
                    "Directions are " + ", ".join(DIRECTIONS) + ".",
                )
            if len(values) != len(self) or not np.all(np.isfinite(values)):
                raise ModelError(
                    "poses",
                    f"have no finite value of {name} for each of them.",
                    "Give each pose the same directions.",
                )

    def __len__(self) -> int:
        return len(next(iter(self.axes.values())))

    def task(self) -> dict[str, Array]:
        """Coordinates of all poses, direction by direction, (n,) each, m and rad."""
        return dict(self.axes)


@dataclass(frozen=True)
class PoseList:
    """Poses of the tool that a machine takes by its own formulas, whatever the path from home.

    Parameters
    ----------
    name : str
        What they are, in words.
    poses : Poses
        (n,); of the tool.
    joint_kinds : tuple of str or None
        Types of joints whose ranges are kept; None for all.
    """

    name: str
    poses: Poses
    joint_kinds: tuple[str, ...] | None = None

    def __len__(self) -> int:
        return len(self.poses.position)

    def __repr__(self) -> str:
        return f"<PoseList: {self.name}; {len(self)} poses>"

    def limits(self, model: Model) -> tuple[Limit, ...]:
        """The joint ranges that are kept.

        Parameters
        ----------
        model : Model
        """
        if self.joint_kinds is None:
            return model.limits
        return tuple(limit for limit in model.limits if limit.kind in self.joint_kinds)

    def placement(self, model: Model) -> Placement:
        """A machine at the poses, (n,); those that it cannot take are marked.

        Parameters
        ----------
        model : Model

        Raises
        ------
        ModelError
            A machine without formulas of its own.
        """
        if model.closed_form is None:
            raise ModelError(
                self.name,
                "are taken by a machine's own formulas, which a model file does not have.",
                "Name poses in [[poses]], or a grid in [workspace].",
            )
        return check_limits(self.limits(model), model.closed_form(self.poses))


#: Poses at which the machines of a study or of a design are asked.
PoseSet = TaskGrid | TaskList | PoseList


def settings_of(poses: PoseSet | None) -> dict[str, Any]:
    """Poses as plain values, which tell different ones apart.

    Parameters
    ----------
    poses : PoseSet or None
    """
    if poses is None:
        return {}
    if isinstance(poses, TaskGrid):
        return {d: v.tolist() for d, v in poses.axes.items()}
    if isinstance(poses, TaskList):
        return {"poses": {d: v.tolist() for d, v in poses.axes.items()}}
    stack = np.concatenate([poses.poses.position, poses.poses.rotation.reshape(-1, 9)], axis=1)
    # eleven digits are the same on every machine
    digest = hashlib.sha256(np.round(stack, 11).tobytes()).hexdigest()
    kinds = {} if poses.joint_kinds is None else {"joint_ranges": list(poses.joint_kinds)}
    return {"poses": poses.name, "count": len(poses), "sha256": digest, **kinds}


def first_pose_can_be_asked(model: Model, poses: PoseSet | None) -> None:
    """Refuse directions in which the tool cannot move, before any machine is made.

    Parameters
    ----------
    model : Model
    poses : PoseSet or None

    Raises
    ------
    ModelError
        Such a direction, or a machine without formulas of its own for a list of poses.
    """
    if isinstance(poses, PoseList):
        poses.placement(model)
    elif poses is not None:
        moved(model, {d: values[:1] for d, values in poses.axes.items()})


def hemisphere_poses(
    machine: Parametric,
    radius: float = 4e-3,
    lattice: int = 10,
    rolls: int = 24,
    joint_kinds: Sequence[str] | None = None,
    condition_limit: float | None = 100.0,
) -> PoseList:
    """Check points of a hemisphere at which the machine as described counts, one pose for each.

    The tool's axis is normal to the hemisphere, its roll about it the one of the largest blocked
    stiffness along x, as in `strutwork.studies.stiffness_map`. The poses do not change with the
    parameters of a design, so that machines are compared at the same ones.

    Parameters
    ----------
    machine : Parametric
    radius : float
        m.
    lattice : int
        As `strutwork.machines.hemisphere_normals`: 317 points for 10.
    rolls : int
        Over a third of a turn.
    joint_kinds : sequence of str, optional
        Types of joints whose ranges are kept; all by default.
    condition_limit : float, optional
        As `strutwork.studies.Filters`, no unit.

    Raises
    ------
    ModelError
        A machine without formulas of its own; no point counts.
    """
    if not isinstance(machine.origin, Fields):
        raise ModelError(
            "hemisphere",
            "needs a machine with formulas of its own, which a model file does not have.",
            "Name poses in [[poses]], or a grid in [workspace].",
        )
    made = machine.origin.machine
    kinds = None if joint_kinds is None else tuple(joint_kinds)
    filters = Filters(joint_kinds=kinds, condition_limit=condition_limit)
    points = hemisphere(made, radius, lattice)
    turns = np.arange(rolls) * (2.0 * np.pi / 3.0 / rolls)
    found = stiffness_map(made, points, turns, filters)
    good = np.flatnonzero(found["status"].to_numpy() == PoseStatus.GOOD)
    if not good.size:
        raise ModelError(
            "hemisphere",
            f"has no check point of {len(points)} that the machine can take.",
            "Choose another radius, or ranges of fewer joints.",
        )
    chosen = found["roll"].to_numpy()[good]
    each = [
        points.poses(slice(int(i), int(i) + 1), np.array([roll]))
        for i, roll in zip(good, chosen, strict=True)
    ]
    poses = Poses(
        np.concatenate([p.position for p in each]), np.concatenate([p.rotation for p in each])
    )
    words = f"hemisphere of {1e3 * radius:.4g} mm, {len(good)} of {len(points)} check points"
    return PoseList(words, poses, kinds)
