"""The machine that a command works on, at home or where --pose and --joint put it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from strutwork.errors import ModelError
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.machines.model_poses import at_pose
from strutwork.reports.motion_table import Coordinate, targets_of_words


@dataclass(frozen=True)
class Where:
    """What --pose and --joint say, in SI.

    Parameters
    ----------
    task : mapping of direction to float
    joints : mapping of (joint, direction) to float
    """

    task: dict[str, float]
    joints: dict[Coordinate, float]

    @property
    def home(self) -> bool:
        """Whether nothing was said."""
        return not self.task and not self.joints

    def put(self, model: Model) -> Model:
        """The machine there.

        Raises
        ------
        ModelError, UnreachableError
            As `strutwork.machines.model_poses.at_pose`.
        """
        return at_pose(model, self.task, self.joints)


HOME = Where({}, {})


def where(pose: Sequence[str] | None, joint: Sequence[str] | None) -> Where:
    """Read --pose and --joint.

    Raises
    ------
    ModelError
        A joint's coordinate in --pose, or the tool's in --joint.
    """
    tool = targets_of_words(pose or (), "--pose")
    joints = targets_of_words(joint or (), "--joint")
    for owner, direction in tool:
        if owner:
            raise ModelError(
                "--pose", f"names the joint {owner}:{direction}.", "Use --joint for it."
            )
    for owner, direction in joints:
        if not owner:
            raise ModelError(
                "--joint", f"names no joint for {direction}.", f"Write JOINT:{direction}=VALUE."
            )
    return Where({d: v for (_, d), v in tool.items()}, dict(joints))


def subject(target: str, pose: Sequence[str] | None, joint: Sequence[str] | None) -> Model:
    """A machine of the catalogue or a model file, where --pose and --joint put it.

    Raises
    ------
    ModelError, UnreachableError
        No such machine, a wrong model, or a pose that it cannot take.
    """
    return where(pose, joint).put(load(target))
