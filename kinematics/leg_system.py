"""Legs as arrays, each a row of joints between ground and tool: what compiled kinematics reads."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.home_rows import HomeRows
from strutwork.kinematics.joint_motion import JointMotion
from strutwork.kinematics.leg_chains import leg_paths

Array = NDArray[Any]

#: Least singular value of a leg's rates at home, as a share of the largest, from which Newton's
#: method can start.
REGULAR = 1e-6
#: Legs that reasons can tell apart.
MOST_LEGS = 40


#: Of a leg: range of its joints; how many coordinates are solved for, all or those before the
#: ball at its end; whether it is passed from the tool's body on, and whether a ball ends it.
LEG = np.dtype([(name, np.int64) for name in ("start", "stop", "unknowns", "from_tool", "ball")])

#: Of a joint that is passed: 1 where that is from its first node to its second, else −1; its
#: index; the moving body beyond it, −1 for the ground; free translations; number of free
#: rotations and, of one or two, their axes, 0 to 2; coordinate of each free direction, else −1.
#: At home: its axes in those of the joint before, and the place of its near node there, from
#: that joint's far node, m; its far node, m, and its axes.
STEP = np.dtype(
    [
        ("sign", float),
        ("joint", np.int64),
        ("body", np.int64),
        ("slides", np.int64, (3,)),
        ("turns", np.int64),
        ("first", np.int64),
        ("second", np.int64),
        ("column", np.int64, (6,)),
        ("onward", float, (3, 3)),
        ("offset", float, (3,)),
        ("far", float, (3,)),
        ("frame", float, (3, 3)),
    ],
    align=True,
)


class LegSystem(NamedTuple):
    """Legs, and their joints in the order in which each leg is passed.

    A leg is passed from the ground to the tool's body, or from there to the ground where only
    its joint at the ground turns in all ways: a ball at the end needs to meet its place alone.

    Parameters
    ----------
    legs : (l,) of `LEG`
        Indices of the steps of each leg, and how it is passed.
    steps : (s,) of `STEP`
        The joints of all legs, leg by leg; places of nodes at home, m.
    reference : (b, 3)
        Reference points of the bodies at home, m.
    platform : int
        The tool's body.
    length : float
        By which angles are made comparable, m.
    """

    legs: Array
    steps: Array
    reference: Array
    platform: int
    length: float


def leg_system(joints: JointMotion) -> LegSystem | None:
    """The legs of a linkage, or None where Newton's method leg by leg does not fit.

    It fits where the linkage falls into legs (`leg_chains.leg_paths`) of six freedoms each, all
    regular at home: there the tool's pose fixes each leg by itself.

    Parameters
    ----------
    joints : JointMotion
        Of the linkage at home.
    """
    linkage = joints.linkage
    if linkage.tool is None or linkage.tool_body < 0:
        return None
    paths = leg_paths(linkage)
    if not paths or len(paths) > MOST_LEGS:
        return None
    free = ~joints.held
    passed = [_Leg(free, path) for path in paths]
    # a leg that cannot follow every pose of the tool is closed with all others, by `walk.Walk`
    if any(leg.freedoms != 6 for leg in passed):
        return None
    stop = np.cumsum([len(leg.steps) for leg in passed])
    legs = np.zeros(len(passed), LEG)
    legs["start"], legs["stop"] = [0, *stop[:-1]], stop
    for k, leg in enumerate(passed):
        legs[k]["unknowns"] = leg.freedoms - 3 * leg.ball
        legs[k]["from_tool"], legs[k]["ball"] = leg.from_tool, leg.ball
    system = LegSystem(
        legs,
        np.concatenate([leg.packed(joints, free) for leg in passed]),
        np.ascontiguousarray(joints.start(1).position[0], dtype=float),
        linkage.tool_body,
        HomeRows.of(joints).length,
    )
    return system if _regular(system) else None


class _Leg:
    """One leg on its way to arrays."""

    def __init__(self, free: Array, path: list[tuple[int, int]]) -> None:
        self.freedoms = int(free[[j for j, _ in path]].sum())
        balls = [bool(free[j, 3:].all() and not free[j, :3].any()) for j, _ in path]
        self.from_tool = int(balls[0] and not balls[-1])
        self.ball = int(balls[0] or balls[-1])
        self.steps = [(j, -s) for j, s in reversed(path)] if self.from_tool else path

    def packed(self, joints: JointMotion, free: Array) -> Array:
        """The leg's joints, (s,) of `STEP`."""
        home, owner = joints.home, joints.linkage.body_of_node
        column = np.full(free.shape, -1, dtype=np.int64)
        column[free] = np.arange(int(free.sum()))
        far = [int(joints.nodes[j, 1 if sign > 0 else 0]) for j, sign in self.steps]
        near = [int(joints.nodes[j, 0 if sign > 0 else 1]) for j, sign in self.steps]
        index = [j for j, _ in self.steps]
        axes = np.concatenate([np.eye(3)[None], home.frames[index]])
        places = np.concatenate([np.zeros((1, 3)), home.positions[far]])
        before = np.swapaxes(axes[:-1], -1, -2)
        turning = [_axes(free[j, 3:]) for j in index]
        steps = np.zeros(len(index), STEP)
        steps["sign"] = [sign for _, sign in self.steps]
        steps["joint"], steps["body"] = index, owner[far]
        steps["slides"], steps["turns"] = free[index, :3], free[index, 3:].sum(axis=1)
        steps["first"], steps["second"] = zip(*turning, strict=True)
        steps["column"] = column[index]
        steps["onward"] = before @ axes[1:]
        apart = home.positions[near] - places[:-1]
        steps["offset"] = (before @ apart[..., None])[..., 0]
        steps["far"], steps["frame"] = home.positions[far], home.frames[index]
        return steps


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

    for leg in range(len(system.legs)):
        values = np.linalg.svd(home_rates(system, leg), compute_uv=False)
        if values.size and values[-1] < REGULAR * values[0]:
            return False
    return True
