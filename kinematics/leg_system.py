"""Legs as arrays, each a row of joints between ground and tool: what compiled kinematics reads."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.joint_motion import JointMotion
from strutwork.kinematics.leg_chains import leg_paths
from strutwork.kinematics.rows import characteristic_length

Array = NDArray[Any]
Ints = NDArray[np.int64]

#: Least singular value of a leg's rates at home, as a share of the largest, from which Newton's
#: method can start.
REGULAR = 1e-6
#: Legs that reasons can tell apart.
MOST_LEGS = 40


class LegSystem(NamedTuple):
    """Legs in the order in which each is passed, one entry a joint that is passed, s in all.

    A leg is passed from the ground to the tool's body, or from there to the ground where only
    its joint at the ground turns in all ways: a ball at the end needs to meet its place alone.

    Parameters
    ----------
    start : (l + 1,)
        Range of each leg's joints.
    unknowns : (l,)
        Coordinates that are solved for: all, or those before the ball at the end.
    from_tool, ball : (l,)
        1 where the leg is passed from the tool's body; 1 where a ball ends it.
    joint : (s,)
    sign : (s,)
        1 where the joint is passed from its first node to its second, else −1.
    body : (s,)
        Moving body beyond the joint, −1 for the ground.
    slides : (s, 3)
        1 for a free translation.
    turns : (s,)
        Free rotations.
    first, second : (s,)
        Axis, 0 to 2, of the first and of the second of one or two free rotations.
    column : (s, 6)
        Coordinate of each free direction, else −1.
    onward : (s, 3, 3)
        From the joint passed before, or from the leg's beginning, to this joint's axes, at home.
    offset : (s, 3)
        From that joint's far node to this one's near node, in that joint's axes, m.
    far : (s, 3)
        Far node at home, m.
    frame : (s, 3, 3)
        Joint axes at home.
    reference : (b, 3)
        Reference points of the bodies at home, m.
    platform : int
    length : float
        By which angles are made comparable, m.
    """

    start: Ints
    unknowns: Ints
    from_tool: Ints
    ball: Ints
    joint: Ints
    sign: Array
    body: Ints
    slides: Ints
    turns: Ints
    first: Ints
    second: Ints
    column: Ints
    onward: Array
    offset: Array
    far: Array
    frame: Array
    reference: Array
    platform: int
    length: float


def leg_system(joints: JointMotion) -> LegSystem | None:
    """The legs of a linkage, or None where Newton's method leg by leg does not fit.

    It fits where the linkage falls into legs (`leg_chains.leg_paths`), none with more freedoms
    than six, all regular at home: there the tool's pose fixes each leg by itself.
    """
    linkage = joints.linkage
    if linkage.tool is None or linkage.tool_body < 0:
        return None
    paths = leg_paths(linkage)
    if not paths or len(paths) > MOST_LEGS:
        return None
    free = ~joints.held
    passed = [_Leg(joints, free, path) for path in paths]
    if any(leg.freedoms > 6 for leg in passed):
        return None
    column = np.full(free.shape, -1, dtype=np.int64)
    column[free] = np.arange(int(free.sum()))
    steps = [step for leg in passed for step in leg.steps]
    index = np.array([j for j, _ in steps], dtype=np.int64)
    turning = free[index, 3:]
    axes = [_axes(turns) for turns in turning]
    system = LegSystem(
        start=np.cumsum([0, *(len(leg.steps) for leg in passed)], dtype=np.int64),
        unknowns=np.array([leg.freedoms - 3 * leg.ball for leg in passed], dtype=np.int64),
        from_tool=np.array([leg.from_tool for leg in passed], dtype=np.int64),
        ball=np.array([leg.ball for leg in passed], dtype=np.int64),
        joint=index,
        sign=np.array([sign for _, sign in steps], dtype=float),
        body=np.array([b for leg in passed for b in leg.bodies], dtype=np.int64),
        slides=free[index, :3].astype(np.int64),
        turns=turning.sum(axis=1).astype(np.int64),
        first=np.array([e for e, _ in axes], dtype=np.int64),
        second=np.array([f for _, f in axes], dtype=np.int64),
        column=column[index],
        onward=np.concatenate([leg.onward for leg in passed]),
        offset=np.concatenate([leg.offset for leg in passed]),
        far=np.concatenate([leg.far for leg in passed]),
        frame=np.ascontiguousarray(joints.home.frames[index], dtype=float),
        reference=np.ascontiguousarray(joints.start(1).position[0], dtype=float),
        platform=linkage.tool_body,
        length=characteristic_length(joints.home),
    )
    return system if _regular(system) else None


class _Leg:
    """One leg on its way to arrays."""

    def __init__(self, joints: JointMotion, free: Array, path: list[tuple[int, int]]) -> None:
        linkage, home = joints.linkage, joints.home
        self.freedoms = int(free[[j for j, _ in path]].sum())
        balls = [bool(free[j, 3:].all() and not free[j, :3].any()) for j, _ in path]
        self.from_tool = int(balls[0] and not balls[-1])
        self.ball = int(balls[0] or balls[-1])
        self.steps = [(j, -s) for j, s in reversed(path)] if self.from_tool else path
        nodes = joints.nodes
        owner = linkage.body_of_node
        far = [int(nodes[j, 1 if s > 0 else 0]) for j, s in self.steps]
        near = [int(nodes[j, 0 if s > 0 else 1]) for j, s in self.steps]
        self.bodies = [int(owner[n]) for n in far]
        self.far = np.asarray(home.positions[far], dtype=float)
        axes = np.concatenate([np.eye(3)[None], home.frames[[j for j, _ in self.steps]]])
        places = np.concatenate([np.zeros((1, 3)), home.positions[far]])
        before = np.swapaxes(axes[:-1], -1, -2)
        self.onward = before @ axes[1:]
        apart = home.positions[near] - places[:-1]
        self.offset = (before @ apart[..., None])[..., 0]


def _axes(turns: Array) -> tuple[int, int]:
    """Axes of one or two free rotations: of two, the first moves with the joint's first body."""
    if turns.sum() == 1:
        return int(np.flatnonzero(turns)[0]), 0
    if turns.sum() == 2:
        locked = int(np.flatnonzero(~turns)[0])
        return (locked + 1) % 3, (locked + 2) % 3
    return 0, 0


def _regular(system: LegSystem) -> bool:
    """Whether the rates of each leg at home are independent."""
    from strutwork.kinematics.leg_newton import home_rates  # noqa: PLC0415 - numba is slow to import

    for leg in range(len(system.unknowns)):
        values = np.linalg.svd(home_rates(system, leg), compute_uv=False)
        if values.size and values[-1] < REGULAR * values[0]:
            return False
    return True
