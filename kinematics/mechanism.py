"""The interface of a mechanism, and what every mechanism gets from it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.placement import Placement

Array = NDArray[Any]


@dataclass(frozen=True)
class Poses:
    """Poses of the tool: positions and rotation matrices.

    Parameters
    ----------
    position : (..., 3)
        m.
    rotation : (..., 3, 3)
        Proper rotation matrices; columns are the tool axes in the global frame.

    Raises
    ------
    ModelError
        Shapes that do not match, or a matrix that is no rotation.
    """

    position: Array
    rotation: Array

    def __post_init__(self) -> None:
        if self.position.shape[-1:] != (3,) or self.rotation.shape[-2:] != (3, 3):
            raise ModelError(
                "poses",
                f"have shapes {self.position.shape} and {self.rotation.shape}.",
                "Give positions (..., 3) and rotations (..., 3, 3).",
            )
        rotation = self.rotation.real
        if not (np.all(np.isfinite(rotation)) and np.all(np.isfinite(self.position.real))):
            raise ModelError("poses", "hold a value that is not finite.", "Give finite numbers.")
        gap = np.abs(rotation @ np.swapaxes(rotation, -1, -2) - np.eye(3)).max(initial=0.0)
        if gap > 1e-9 or np.any(np.linalg.det(rotation) < 0):
            raise ModelError(
                "poses",
                f"hold a matrix that is not a rotation (off by {gap:.2g}).",
                "Make it with scipy.spatial.transform.Rotation.",
            )

    @classmethod
    def of(cls, position: ArrayLike, rotation: ArrayLike | None = None) -> Poses:
        """Poses from arrays; without a rotation the tool axes are the global ones.

        Parameters
        ----------
        position : (..., 3)
            m.
        rotation : (..., 3, 3), optional
            Rotation matrices; broadcast against the positions.
        """
        p = np.asarray(position, dtype=float)
        r = np.eye(3) if rotation is None else np.asarray(rotation, dtype=float)
        batch = np.broadcast_shapes(p.shape[:-1], r.shape[:-2])
        return cls(np.broadcast_to(p, (*batch, 3)), np.broadcast_to(r, (*batch, 3, 3)))

    def __repr__(self) -> str:
        return f"<Poses: batch {self.batch}, positions in m>"

    @property
    def batch(self) -> tuple[int, ...]:
        """Shape of the batch."""
        return tuple(self.position.shape[:-1])

    def __getitem__(self, index: Any) -> Poses:
        return Poses(self.position[index], self.rotation[index])

    def moved(self, twist: ArrayLike) -> Poses:
        """Poses after a small motion, translation then rotation vector, (..., 6).

        Parameters
        ----------
        twist : (..., 6)
            m and rad, global axes, about the tool centre point.
        """
        # imported late: it takes a third of a small command's start
        from scipy.spatial.transform import Rotation  # noqa: PLC0415

        t = np.asarray(twist, dtype=float)
        flat = t[..., 3:].reshape(-1, 3)
        turn = Rotation.from_rotvec(flat).as_matrix().reshape(*t.shape[:-1], 3, 3)
        return Poses(self.position + t[..., :3], turn @ self.rotation)


@runtime_checkable
class Mechanism(Protocol):
    """A machine's kinematics: its linkage and its inverse kinematics, batch first."""

    @property
    def linkage(self) -> Linkage:
        """Bodies and joints."""

    def place(self, poses: Poses) -> Placement:
        """Inverse kinematics: node positions, joint frames and joint values.

        Poses that cannot be taken are marked in the placement's status with a reason; the
        others are complete.

        Parameters
        ----------
        poses : Poses
            (...); of the tool.
        """

    def home(self) -> Poses:
        """The home pose."""

    def skeleton(self) -> Sequence[tuple[str, str]]:
        """Pairs of nodes that a drawing connects by a line."""


def drive_values(mechanism: Mechanism, placement: Placement) -> Array:
    """Coordinates of the driven directions, (..., a), m or rad, in the linkage's order.

    Parameters
    ----------
    mechanism : Mechanism
        Whose linkage has the a driven directions.
    placement : Placement
        That gives all of them.
    """
    names = list(placement.names)
    return placement.values[..., [names.index(d) for d in mechanism.linkage.driven]]
