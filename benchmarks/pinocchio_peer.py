"""Inverse kinematics with Pinocchio of a machine whose legs end in balls on the platform.

The legs are branches of one tree on the ground, three joints each, frames and data allocated
once. The tool's pose gives where each ball must be; Newton's method closes all branches from
home. `computeJointJacobians` gives places and rates of all branches in one call, and the three
equations of each are solved as a stack: fewer calls than with `getConstraintsJacobian` of
`CONTACT_3D` constraints, and six small systems in the place of a large one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import as_strided
from numpy.typing import NDArray

from strutwork.kinematics import Motion, Poses
from strutwork.kinematics.jacobians import Jacobians
from strutwork.kinematics.leg_chains import leg_paths
from strutwork.kinematics.limits import SLACK, joint_limits

Array = NDArray[Any]

#: Gap at which a leg is closed, m, and corrections at most.
CLOSED, MOST = 1e-12, 20
#: Poses whose equations are solved at once.
PIECE = 512


@dataclass(frozen=True)
class Branches:
    """Legs as branches of a tree, at home.

    Parameters
    ----------
    kinds : (3 l,) of int
        0 to 5 for the free direction x, y, z, rx, ry, rz of each joint.
    places : (3 l, 12)
        Place and rotation, row by row, of each joint in the axes of the one before.
    ends, seats : (l, 3)
        Each leg's ball in the axes of its last joint, and from the tool in the tool's axes, m.
    driven : (a,) of int
        Coordinates that are driven, in the order of the linkage.
    signs : (3 l,)
        1 where a leg goes through the joint from its first node to its second, else -1.
    names : tuple of (joint, direction)
    low, high : (3 l,)
        Joint ranges, from home.
    """

    kinds: NDArray[np.int32]
    places: Array
    ends: Array
    seats: Array
    driven: NDArray[np.int32]
    signs: Array
    names: tuple[tuple[str, str], ...]
    low: Array
    high: Array


def branches(motion: Motion) -> Branches:
    """The legs of a machine, each of three single joints and a ball on the platform.

    Raises
    ------
    ValueError
        Other legs.
    """
    linkage, home = motion.linkage, motion.home
    paths = leg_paths(linkage)
    if paths is None:
        message = "the machine does not fall into legs of three joints and a ball"
        raise ValueError(message)
    free = ~(linkage.elastic_or_locked() & ~linkage.driven_mask())
    tool = home.positions[linkage.node_index[linkage.tool or ""]]
    kinds, places, ends, seats, signs, names = [], [], [], [], [], []
    for path in paths:
        before, begin = np.zeros(3), np.eye(3)
        for j, sign in path[:-1]:
            joint = linkage.joints[j]
            at, axes = home.positions[linkage.node_index[joint.between[0]]], home.frames[j]
            for d in np.flatnonzero(free[j])[::sign]:
                kinds.append(int(d))
                places.append([*(begin.T @ (at - before)), *(begin.T @ axes).ravel()])
                names.append((joint.name, ("x", "y", "z", "rx", "ry", "rz")[d]))
                signs.append(float(sign))
                before, begin = at, axes
        ball = linkage.joints[path[-1][0]]
        seat = home.positions[linkage.node_index[ball.between[0]]]
        ends.append(begin.T @ (seat - before))
        seats.append(motion.rotation.T @ (seat - tool))
        if ball.type != "spherical" or len(kinds) != 3 * len(ends):
            message = f"the leg that ends in {ball.name} is not three joints and a ball"
            raise ValueError(message)
    at_home = dict(zip(motion.joints.names, motion.home_values, strict=True))
    low, high = np.full(len(names), -np.inf), np.full(len(names), np.inf)
    for limit in joint_limits(linkage):
        k, zero = (
            names.index((limit.joint, limit.coordinate)),
            at_home[limit.joint, limit.coordinate],
        )
        low[k], high[k] = limit.low - zero, limit.high - zero
    return Branches(
        np.asarray(kinds, dtype=np.int32),
        np.asarray(places),
        np.asarray(ends),
        np.asarray(seats),
        np.asarray([names.index(name) for name in linkage.driven], dtype=np.int32),
        np.asarray(signs),
        tuple(names),
        low,
        high,
    )


@dataclass(frozen=True)
class Answer:
    """Coordinates from home of the drives, their rates by the tool's twist, margin and ranges.

    Shapes (p, a), (p, a, 6), (p,), and (p,) where legs close within their joints' ranges.
    """

    drives: Array
    rates: Array
    margin: Array
    good: NDArray[np.bool_]


class PinocchioLegs:
    """The legs of a machine in Pinocchio, called from Python pose by pose."""

    def __init__(self, motion: Motion) -> None:
        import pinocchio as pin  # noqa: PLC0415 - a benchmark extra

        self.motion, self.legs = motion, branches(motion)
        self.model = pin.Model()
        joints = [
            getattr(pin, f"JointModel{kind}") for kind in ("PX", "PY", "PZ", "RX", "RY", "RZ")
        ]
        frames, parent = [], 0
        for k, (kind, at) in enumerate(zip(self.legs.kinds, self.legs.places, strict=True)):
            place = pin.SE3(at[3:].reshape(3, 3), at[:3])
            parent = self.model.addJoint(
                0 if k % 3 == 0 else parent, joints[kind](), place, f"q{k}"
            )
            if k % 3 == 2:
                end = pin.SE3(np.eye(3), self.legs.ends[k // 3])
                frame = pin.Frame(f"end{k // 3}", parent, end, pin.FrameType.OP_FRAME)
                frames.append(self.model.addFrame(frame))
        self.data = self.model.createData()
        self._step = pin.computeJointJacobians
        self._update = pin.updateFramePlacements
        # views, taken once: Pinocchio writes into the same memory at every call
        first = self.data.oMf[frames[0]].translation
        step = np.diff([self.data.oMf[f].translation.ctypes.data for f in frames])
        if np.ptp(step) or np.diff(frames).max() != 1:
            message = "frames of the ends do not follow one another in Pinocchio's memory"
            raise RuntimeError(message)
        self._ends = as_strided(first, (len(frames), 3), (int(step[0]), first.strides[0]))
        # of each leg's coordinate, velocity at the origin and angular velocity
        self._rates = self.data.J.T.reshape(len(frames), 3, 6)
        if not np.shares_memory(self._rates, self.data.J):
            message = "the Jacobian is not stored column by column"
            raise RuntimeError(message)

    def survey(self, poses: Poses, length: float) -> Answer:
        """Drives, Jacobian, joint ranges and margin of poses, (p,)."""
        wanted = targets(self.legs, poses)
        q, blocks, closed = self.solve(wanted)
        row = np.linalg.inv(blocks).reshape(len(q), -1, 3)[:, self.legs.driven]
        arm = (wanted - poses.position[:, None])[:, self.legs.driven // 3]
        rates = np.concatenate([row, np.cross(arm, row)], axis=-1)
        return answer(self.motion, self.legs, q, rates, closed, length)

    def solve(self, wanted: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Coordinates (p, 3 l), rates of the ends (p, l, 3, 3), and where the legs close.

        Newton's steps are made by all poses together: Pinocchio is called pose by pose, the
        equations of all are solved at once.
        """
        count, legs = wanted.shape[:2]
        values, blocks = np.zeros((count, 3 * legs)), np.empty((count, legs, 3, 3))
        closed = np.zeros(count, dtype=bool)
        for first in range(0, count, PIECE):
            left = np.arange(first, min(first + PIECE, count))
            for _ in range(MOST):
                ends, rates = self._passed(values[left])
                x, y, z = (np.ascontiguousarray(ends[..., k, None]) for k in range(3))
                u, v, w, a, b, c = (rates[..., k] for k in range(6))
                # velocity of the ends from that of the bodies at the origin
                block = np.stack([u + b * z - c * y, v + c * x - a * z, w + a * y - b * x], axis=-2)
                gap = wanted[left] - ends
                values[left] += np.linalg.solve(block, gap[..., None]).reshape(len(left), -1)
                done = np.abs(gap).max(axis=(1, 2)) <= CLOSED
                blocks[left[done]], closed[left[done]] = block[done], True
                left = left[~done]
                if not len(left):
                    break
            blocks[left] = np.eye(3)
        return values, blocks, closed

    def _passed(self, values: Array) -> tuple[Array, Array]:
        """Ends (p, l, 3) and rates of the bodies at the origin (p, l, 3, 6)."""
        legs = len(self._ends)
        ends, rates = np.empty((len(values), legs, 3)), np.empty((len(values), legs, 3, 6))
        model, data, step, update = self.model, self.data, self._step, self._update
        for q, end, rate in zip(values, ends, rates, strict=True):
            step(model, data, q)
            update(model, data)
            end[:], rate[:] = self._ends, self._rates
        return ends, rates


def targets(legs: Branches, poses: Poses) -> Array:
    """Where the balls must be, (p, l, 3)."""
    turned = (poses.rotation[:, None] @ legs.seats[..., None])[..., 0]
    return np.ascontiguousarray(poses.position[:, None] + turned)


def answer(
    motion: Motion,
    legs: Branches,
    q: Array,
    rates: Array,
    closed: NDArray[np.bool_],
    length: float,
) -> Answer:
    """What is told of coordinates and rates that were found; the margin as ours, by NumPy."""
    own = q * legs.signs
    inside = ((own >= legs.low - SLACK) & (own <= legs.high + SLACK)).all(axis=-1)
    rates = rates * legs.signs[legs.driven, None]
    serial = np.zeros(len(q), dtype=bool)
    found = Jacobians(rates, motion.linkage.driven, np.full(len(q), length), serial)
    return Answer(own[:, legs.driven], rates, found.margin(), closed & inside)
