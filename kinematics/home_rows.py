"""The rows of a linkage's joints at home, and which of them are independent.

Every question about a motion begins with them: whether the tool can go in a direction, what else
can be held, the way to any target.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.independent import spanned
from strutwork.kinematics.joint_motion import BodyPoses, JointMotion
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.rows import characteristic_length, constraint_rows

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class HomeRows:
    """The held rows of a linkage at home, lengths over L.

    Parameters
    ----------
    length : float
        L, m.
    bodies : BodyPoses
        At home, a batch of one.
    placement : Placement
        Of these bodies, a batch of one.
    matrix : (h, 6 b)
        Rates of the held directions by (v / L, ω), no unit.
    kept : list of int
        Independent rows among them.
    basis : (6 b, i)
        Orthonormal columns that span them.
    """

    length: float
    bodies: BodyPoses
    placement: Placement
    matrix: Array
    kept: list[int]
    basis: Array

    @classmethod
    def of(cls, joints: JointMotion) -> HomeRows:
        """Those of a linkage at home, made once and kept with its joints' motion.

        Parameters
        ----------
        joints : JointMotion
        """
        # a frozen dataclass keeps derived data in its __dict__, as functools.cached_property does
        kept = joints.__dict__
        if "_home_rows" not in kept:
            kept["_home_rows"] = cls._made(joints)
        found: HomeRows = kept["_home_rows"]
        return found

    @classmethod
    def _made(cls, joints: JointMotion) -> HomeRows:
        bodies = joints.start(1)
        positions, frames, _ = joints.place(bodies)
        placement = Placement(positions, frames, np.zeros((1, 0)))
        length = characteristic_length(joints.home)
        rows = constraint_rows(joints.linkage, placement, joints.held).on_bodies(bodies.position)
        matrix = in_one_unit(rows[0], np.argwhere(joints.held)[:, 1], length)
        return cls(length, bodies, placement, matrix, *spanned(matrix))


def in_one_unit(matrix: Array, direction: NDArray[np.intp], length: float) -> Array:
    """Rows by twists of bodies with lengths over L, (..., r, 6 b).

    Parameters
    ----------
    matrix : (..., r, 6 b)
        In m and rad.
    direction : (r,)
        0 to 2 of a translation, 3 to 5 of a rotation.
    length : float
        L, m.
    """
    over = np.where(direction < 3, 1.0 / length, 1.0)
    unit = np.tile(np.repeat([length, 1.0], 3), matrix.shape[-1] // 6)
    return np.asarray(matrix * over[:, None] * unit)
