"""Bodies that only spin about a line of their own: screws, rotors, pulleys and gears.

Their turn moves no joint, so that a step may turn them by any angle; how far is counted by what the
step foresees.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.joint_motion import BodyPoses, JointMotion
from strutwork.kinematics.placement import COINCIDENCE

Array = NDArray[Any]
Indices = NDArray[np.intp]

#: Sine of the angle by which axes of one line may differ.
PARALLEL = 1e-9


@dataclass(frozen=True)
class Spins:
    """The spinning bodies of a linkage with couplings, and the turns that are counted.

    Parameters
    ----------
    body : (s,)
        Indices of the bodies.
    line : (s, 3)
        Their lines at home, unit vectors.
    column : (c,)
        Turns of joints about z among the joint coordinates.
    axis : (c, 3)
        Of those joints at home, unit vectors.
    between : (c, 2)
        Bodies of those joints, −1 for the ground.
    """

    body: Indices
    line: Array
    column: Indices
    axis: Array
    between: Indices

    @classmethod
    def of(cls, joints: JointMotion, asked: int = -1) -> Spins | None:
        """Those of a linkage; None where no coordinate follows another or nothing spins.

        The body whose pose is asked for is none of them: its turn is counted by its pose.

        Parameters
        ----------
        joints : JointMotion
            Of the linkage.
        asked : int
            Number of the body whose pose is asked for; −1 for none.
        """
        linkage = joints.linkage
        if not linkage.ties:
            return None
        found = {
            b: line
            for b in range(len(linkage.body_names))
            if b != asked and (line := _line(joints, b)) is not None
        }
        if not found:
            return None
        owner = linkage.body_of_node[joints.nodes]
        names = {name: k for k, name in enumerate(joints.names)}
        turning = [
            j
            for j, joint in enumerate(linkage.joints)
            if (joint.name, "rz") in names and any(int(b) in found for b in owner[j])
        ]
        return cls(
            np.array(list(found), dtype=np.intp),
            np.array(list(found.values())),
            np.array([names[linkage.joints[j].name, "rz"] for j in turning], dtype=np.intp),
            joints.home.frames[turning, :, 2],
            owner[turning],
        )

    def others(self, bodies: BodyPoses, change: Array) -> Array:
        """A change of the bodies without their spins, (p, b, 6).

        Parameters
        ----------
        bodies : BodyPoses
            At p poses.
        change : (p, b, 6)
            Translation, in any unit, then rotation vector, rad.
        """
        line = np.einsum("psij,sj->psi", bodies.rotation[:, self.body], self.line)
        left = change.copy()
        turn = np.einsum("psi,psi->ps", line, change[:, self.body, 3:])
        left[:, self.body, 3:] -= turn[..., None] * line
        return left

    def foreseen(self, bodies: BodyPoses, change: Array) -> Array:
        """By how much a change of the bodies turns the counted joints, (p, c), rad.

        Parameters
        ----------
        bodies : BodyPoses
            At p poses.
        change : (p, b, 6)
            Translation, in any unit, then rotation vector, rad.
        """
        still = np.zeros((len(change), 1, 3))
        turn = np.concatenate([change[..., 3:], still], axis=1)
        same = np.broadcast_to(np.eye(3), (len(change), 1, 3, 3))
        first = np.concatenate([bodies.rotation, same], axis=1)[:, self.between[:, 0]]
        axis = np.einsum("pcij,cj->pci", first, self.axis)
        apart = turn[:, self.between[:, 1]] - turn[:, self.between[:, 0]]
        return np.asarray(np.einsum("pci,pci->pc", axis, apart))


def _line(joints: JointMotion, body: int) -> Array | None:
    """The line about which all joints of a body turn, if they do, (3,)."""
    linkage = joints.linkage
    mine = np.flatnonzero((linkage.body_of_node[joints.nodes] == body).any(axis=1))
    # about z alone
    if not mine.size or not np.all(joints.still[mine, 3:] == [True, True, False]):
        return None
    axes = joints.home.frames[mine, :, 2]
    place = joints.home.positions[joints.nodes[mine, 0]]
    line, apart = axes[0], place - place[0]
    off = np.linalg.norm(np.cross(apart, line), axis=-1).max()
    tilt = np.linalg.norm(np.cross(axes, line), axis=-1).max()
    return np.asarray(line) if off <= COINCIDENCE and tilt <= PARALLEL else None
