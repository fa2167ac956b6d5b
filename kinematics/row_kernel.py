"""Compiled constraint rows of one pose, and Gauss elimination that passes over their zeros."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from strutwork.jit import jit
from strutwork.kinematics.joint_motion import JointMotion
from strutwork.kinematics.leg_place import place_bodies
from strutwork.kinematics.leg_turns import rotation_log

Array = NDArray[Any]
Ints = NDArray[np.int64]


class RowSystem(NamedTuple):
    """A linkage as arrays.

    Parameters
    ----------
    owner : (n,)
        Body of each node, −1 for the ground.
    arms : (n, 3)
        At home, from the body's reference point, on the ground from the origin, m.
    ends : (j, 2)
        Nodes of each joint.
    slides : (j,) of bool
    locked : (j,)
        Of two free rotations the one that is locked, else −1.
    locks : (j,)
        Number of locked rotations.
    frames : (j, 3, 3)
        Axes at home as columns, unit vectors.
    joint, direction : (h,)
        Of each held row.
    free_joint, free_direction : (c,)
        Of each joint coordinate.
    column : (b,)
        Where a body's six columns begin: bodies with few neighbours come first.
    platform : int
        The tool's body.
    length : float
        By which lengths are divided, m.
    """

    owner: Ints
    arms: Array
    ends: Ints
    slides: NDArray[np.bool_]
    locked: Ints
    locks: Ints
    frames: Array
    joint: Ints
    direction: Ints
    free_joint: Ints
    free_direction: Ints
    column: Ints
    platform: int
    length: float


def row_system(joints: JointMotion, length: float) -> RowSystem:
    """The linkage of a joint motion as arrays.

    Parameters
    ----------
    joints : JointMotion
        Of the linkage.
    length : float
        By which lengths are divided, m.
    """
    linkage, home = joints.linkage, joints.home
    owner = linkage.body_of_node.astype(np.int64)
    bodies = joints.start(1).position[0]
    origin = np.concatenate([bodies, np.zeros((1, 3))])
    turning = ~joints.held[:, 3:]
    joint, direction = (found.astype(np.int64) for found in np.nonzero(joints.held))
    free_joint, free_direction = (found.astype(np.int64) for found in np.nonzero(~joints.held))
    return RowSystem(
        owner,
        # the ground is −1, the last
        np.ascontiguousarray(home.positions - origin[owner], dtype=float),
        joints.nodes.astype(np.int64),
        np.asarray(joints.sliding),
        np.where(turning.sum(axis=1) == 2, np.argmin(turning, axis=1), -1).astype(np.int64),
        (~turning).sum(axis=1).astype(np.int64),
        np.ascontiguousarray(home.frames, dtype=float),
        joint,
        direction,
        free_joint,
        free_direction,
        6 * _places(owner[joints.nodes], len(bodies)),
        linkage.tool_body if linkage.tool is not None else -1,
        length,
    )


def _places(pairs: Ints, count: int) -> Ints:
    """Place of each body in an order of least fill: each next has the fewest neighbours left."""
    near: list[set[int]] = [set() for _ in range(count)]
    for first, second in pairs.tolist():
        if first != second and min(first, second) >= 0:
            near[first].add(second)
            near[second].add(first)
    left, place = set(range(count)), np.zeros(count, dtype=np.int64)
    for k in range(count):
        body = min(left, key=lambda b: (len(near[b]), b))
        place[body] = k
        left.remove(body)
        for other in near[body]:
            # those that it joined now meet one another
            near[other] = (near[other] | near[body]) - {body, other}
    return place


@jit()
def place_pose(s, position, rotation, positions, frames):  # type: ignore[no-untyped-def]
    """Nodes and joint axes of one pose of the bodies.

    Parameters
    ----------
    s : RowSystem
        The linkage.
    position : (1, b, 3)
        Reference points of the bodies, m.
    rotation : (1, b, 3, 3)
        Of the bodies from home.
    positions : (1, n, 3)
        Filled: nodes, m.
    frames : (1, j, 3, 3)
        Filled: joint axes as columns.
    """
    place_bodies(
        position,
        rotation,
        (s.owner, s.arms),
        (s.ends, s.slides, s.locked, s.frames),
        positions,
        frames,
    )


@jit()
def _axis(s, rotation, j, side, k, out):  # type: ignore[no-untyped-def]
    """Axis k of a joint that moves with its first or second body."""
    b = s.owner[s.ends[j, side]]
    for r in range(3):
        out[r] = s.frames[j, r, k]
    if b >= 0:
        for r in range(3):
            out[r] = (
                rotation[b, r, 0] * s.frames[j, 0, k]
                + rotation[b, r, 1] * s.frames[j, 1, k]
                + rotation[b, r, 2] * s.frames[j, 2, k]
            )


@jit()
def _end(s, position, rotation, n, out):  # type: ignore[no-untyped-def]
    """Place of a node on its own body."""
    b = s.owner[n]
    for r in range(3):
        out[r] = s.arms[n, r]
        if b >= 0:
            out[r] = position[b, r]
            for k in range(3):
                out[r] += rotation[b, r, k] * s.arms[n, k]


@jit()
def pass_joint(s, position, rotation, j, work):  # type: ignore[no-untyped-def]
    """Axes of a joint that go with either body, their turn, and its nodes' places.

    Parameters
    ----------
    s : RowSystem
        The linkage.
    position : (b, 3)
        Reference points of the bodies, m.
    rotation : (b, 3, 3)
        Of the bodies from home.
    j : int
        Which joint.
    work : (3, 3), (3, 3), (3, 3), (3,) and (2, 3)
        Filled: axes of the first and of the second body as rows, the second's in the first's as a
        matrix; left alone; places of both nodes, m.
    """
    first, second, turn, _, ends = work
    for k in range(3):
        _axis(s, rotation, j, 0, k, first[k])
        _axis(s, rotation, j, 1, k, second[k])
    for side in range(2):
        _end(s, position, rotation, s.ends[j, side], ends[side])
    for i in range(3):
        for k in range(3):
            turn[i, k] = (
                first[i, 0] * second[k, 0] + first[i, 1] * second[k, 1] + first[i, 2] * second[k, 2]
            )


@jit()
def joint_coordinates(s, position, rotation, values):  # type: ignore[no-untyped-def]
    """Joint coordinates of p poses of the bodies, turns counted on from those in `values`.

    Parameters
    ----------
    s : RowSystem
        The linkage.
    position : (p, b, 3)
        Reference points of the bodies, m.
    rotation : (p, b, 3, 3)
        Of the bodies from home.
    values : (p, c)
        Coordinates before, overwritten by those now, m and rad.
    """
    work = (np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.zeros(3), np.empty((2, 3)))
    first, _, turn, log, ends = work
    for p in range(position.shape[0]):
        last = -1
        for c in range(s.free_joint.shape[0]):
            j, d = s.free_joint[c], s.free_direction[c]
            if j != last:
                last = j
                pass_joint(s, position[p], rotation[p], j, work)
                if s.locks[j] == 0:
                    rotation_log(turn, log, 0)
            if d < 3:
                found = 0.0
                for i in range(3):
                    found += first[d, i] * (ends[1, i] - ends[0, i])
                values[p, c] = found
                continue
            e = d - 3
            f, g = (e + 1) % 3, (e + 2) % 3
            if s.locks[j] == 0:
                found = log[e]
            elif s.locks[j] == 2:
                found = np.arctan2(turn[g, f], turn[f, f])
            elif e == (s.locked[j] + 1) % 3:
                # the first of two free rotations: about the axis of the first body
                found = np.arctan2(turn[g, f], turn[f, f])
            else:
                found = np.arctan2(turn[g, f], turn[g, g])
            ahead = found - values[p, c]
            values[p, c] += ahead - 2.0 * np.pi * np.floor(0.5 + ahead / (2.0 * np.pi))


@jit()
def fill_row(s, r, nodes, frames, references, out):  # type: ignore[no-untyped-def]
    """One held row on (v / L, ω) of all bodies, each about its reference point, in `out`.

    Parameters
    ----------
    s : RowSystem
        The linkage.
    r : int
        Which of its held rows.
    nodes : (n, 3)
        Places of the nodes, m.
    frames : (j, 3, 3)
        Joint axes as columns.
    references : (b, 3)
        Reference points of the bodies, m.
    out : (6 b,)
        Filled, no unit.
    """
    out[:] = 0.0
    j, d = s.joint[r], s.direction[r]
    k = d % 3
    if s.owner[s.ends[j, 0]] == s.owner[s.ends[j, 1]]:
        return
    for side in range(2):
        n = s.ends[j, side]
        b = s.owner[n]
        if b < 0:
            continue
        sign = -1.0 if side == 0 else 1.0
        x, y, z = sign * frames[j, 0, k], sign * frames[j, 1, k], sign * frames[j, 2, k]
        c = s.column[b]
        if d >= 3:
            out[c + 3], out[c + 4], out[c + 5] = x, y, z
            continue
        p = (nodes[n, 0] - references[b, 0]) / s.length
        q = (nodes[n, 1] - references[b, 1]) / s.length
        t = (nodes[n, 2] - references[b, 2]) / s.length
        out[c], out[c + 1], out[c + 2] = x, y, z
        out[c + 3], out[c + 4], out[c + 5] = q * z - t * y, t * x - p * z, p * y - q * x


@jit()
def _pivot(a, k, n, order):  # type: ignore[no-untyped-def]
    """Bring the largest entry of a column up to row k; the sign that this gives, 0 without one."""
    best, at = 0.0, k
    for i in range(k, n):
        size = abs(a[order[i], k])
        if size > best:
            best, at = size, i
    if not best > 0.0:
        return 0.0
    order[k], order[at] = order[at], order[k]
    sign = 1.0 if at == k else -1.0
    return sign if a[order[k], k] > 0.0 else -sign


@jit()
def _solve_back(a, n, order):  # type: ignore[no-untyped-def]
    """From the triangle to the unknowns."""
    for k in range(n - 1, -1, -1):
        p = order[k]
        for c in range(n, a.shape[1]):
            total = a[p, c]
            for i in range(k + 1, n):
                if a[p, i] != 0.0:
                    total -= a[p, i] * a[order[i], c]
            a[p, c] = total / a[p, k]


@jit()
def eliminate(a, n, order, where):  # type: ignore[no-untyped-def]
    """Solve n equations for the right sides in the columns from n on, in place of them.

    Row pivoting; what is zero is passed over. The solution of unknown k stands in row `order[k]`.
    Returns the sign of the determinant, 0 where there is none.

    Parameters
    ----------
    a : (m, c)
        Coefficients in n columns, then right sides, in any unit; overwritten.
    n : int
        Number of equations, at most m.
    order : (n,) of int
        Filled.
    where : (c,) of int
        Overwritten.
    """
    sign = 1.0
    for i in range(n):
        order[i] = i
    for k in range(n):
        sign *= _pivot(a, k, n, order)
        if sign == 0.0:
            return sign
        p, count = order[k], 0
        for c in range(k + 1, a.shape[1]):
            if a[p, c] != 0.0:
                where[count] = c
                count += 1
        over = 1.0 / a[p, k]
        for i in range(k + 1, n):
            r = order[i]
            if a[r, k] != 0.0:
                factor = a[r, k] * over
                for w in range(count):
                    a[r, where[w]] -= factor * a[p, where[w]]
    _solve_back(a, n, order)
    return sign
