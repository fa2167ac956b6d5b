"""Rotations and poses as the formats write them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import axes_frame

Array = NDArray[Any]


@dataclass(frozen=True)
class Pose:
    """Place and rotation of a frame in another one.

    Parameters
    ----------
    position : (3,)
        m.
    rotation : (3, 3)
        Rotation matrix: its axes as columns.
    """

    position: Array = field(default_factory=lambda: np.zeros(3))
    rotation: Array = field(default_factory=lambda: np.eye(3))

    def __matmul__(self, other: Pose) -> Pose:
        """The pose of a frame that is given in this one."""
        return Pose(self.at(other.position), self.rotation @ other.rotation)

    def at(self, point: ArrayLike) -> Array:
        """A point of this frame in the outer one, (3,), m.

        Parameters
        ----------
        point : (3,)
            m.
        """
        return np.asarray(self.position + self.rotation @ np.asarray(point, dtype=float))

    @property
    def inverse(self) -> Pose:
        """The outer frame in this one."""
        turned = self.rotation.T
        return Pose(-turned @ self.position, turned)


def about(axis: int, angle: float) -> Array:
    """Rotation matrix about x, y or z, (3, 3).

    Parameters
    ----------
    axis : int
        0, 1 or 2.
    angle : float
        rad.
    """
    c, s = np.cos(angle), np.sin(angle)
    matrix = np.eye(3)
    f, g = (axis + 1) % 3, (axis + 2) % 3
    matrix[f, f] = matrix[g, g] = c
    matrix[f, g], matrix[g, f] = -s, s
    return matrix


def roll_pitch_yaw(angles: ArrayLike) -> Array:
    """Rotation about the fixed axes x, then y, then z, (3, 3), as in URDF and SDFormat.

    Parameters
    ----------
    angles : (3,)
        rad.
    """
    roll, pitch, yaw = np.asarray(angles, dtype=float)
    return about(2, yaw) @ about(1, pitch) @ about(0, roll)


def quaternion(values: ArrayLike, part: str) -> Array:
    """Rotation matrix of a quaternion of any length, scalar first, (3, 3).

    Parameters
    ----------
    values : (4,)
        No unit.
    part : str
        Named in an error.

    Raises
    ------
    ModelError
        Length zero.
    """
    q = np.asarray(values, dtype=float)
    length = float(np.linalg.norm(q))
    if length < 1e-12:
        raise ModelError(part, "has a quaternion of length zero.", "Give a rotation.")
    w, x, y, z = q / length
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def axis_angle(axis: ArrayLike, angle: float, part: str) -> Array:
    """Rotation matrix about any axis, (3, 3).

    Parameters
    ----------
    axis : (3,)
        Any length but zero, any unit.
    angle : float
        rad.
    part : str
        Named in an error.

    Raises
    ------
    ModelError
        An axis of length zero.
    """
    x, y, z = unit(axis, part)
    half = angle / 2
    s = np.sin(half)
    return quaternion((np.cos(half), x * s, y * s, z * s), part)


def unit(axis: ArrayLike, part: str) -> Array:
    """An axis of length one, (3,).

    Parameters
    ----------
    axis : (3,)
        Any length but zero, any unit.
    part : str
        Named in an error.

    Raises
    ------
    ModelError
        An axis of length zero.
    """
    found = np.asarray(axis, dtype=float)
    length = float(np.linalg.norm(found))
    if length < 1e-12:
        raise ModelError(part, "has an axis of length zero.", "Give its axis a direction.")
    return np.asarray(found / length)


def joint_axes(axis: ArrayLike, part: str, second: ArrayLike | None = None) -> Array:
    """Axes of a joint by its axis, and its second one, (3, 3).

    Parameters
    ----------
    axis : (3,)
        World axes, any length but zero, any unit.
    part : str
        Named in an error.
    second : (3,), optional
        World axes, any unit.

    Raises
    ------
    ModelError
        An axis of length zero, or a second one along the first.
    """
    return axes_frame(unit(axis, part), second, part)
