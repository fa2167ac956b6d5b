"""Compiled Newton's method of a step of `walk.Walk`, where there are as many rows as unknowns."""

from __future__ import annotations

import numpy as np

from strutwork.jit import jit
from strutwork.kinematics.leg_turns import rotation_log, turn_by_vector
from strutwork.kinematics.row_kernel import eliminate, fill_row, pass_joint, place_pose

#: What is asked of the tool: its pose, or some directions of it.
POSE, TASK = 1, 2


@jit()
def _held(s, position, rotation, frames, work, left):  # type: ignore[no-untyped-def]
    """What the held directions leave open, lengths over L."""
    first, _, turn, log, ends = work
    last = -1
    for r in range(s.joint.shape[0]):
        j, d = s.joint[r], s.direction[r]
        if j != last:
            last = j
            pass_joint(s, position, rotation, j, work)
            if s.locks[j] == 3:
                rotation_log(turn, log, 0)
        if d < 3:
            left[r] = 0.0
            # along the axes of the rows, so that these are its rates; free translations go with
            # the first body
            for i in range(3):
                axis = first[d, i] if s.slides[j] else frames[j, i, d]
                left[r] += axis * (ends[1, i] - ends[0, i])
            left[r] /= s.length
        elif s.locks[j] == 3:
            left[r] = log[d - 3]
        elif s.locks[j] == 1:
            left[r] = -turn[(d - 2) % 3, (d - 1) % 3]
        else:
            left[r] = _tilt(s, r, d - 3, turn)


@jit()
def _tilt(s, r, k, turn):  # type: ignore[no-untyped-def]
    """Part k of e × R e, e the only free rotation of the joint of a held row."""
    e = 3 - k
    for i in range(s.joint.shape[0]):
        # the other locked one
        if s.joint[i] == s.joint[r] and s.direction[i] >= 3 and s.direction[i] - 3 != k:
            e -= s.direction[i] - 3
    if k == (e + 1) % 3:
        return -turn[(e + 2) % 3, e]
    return turn[(e + 1) % 3, e]


@jit()
def _tool(s, asks, p, position, rotation, work, left):  # type: ignore[no-untyped-def]
    """What is open at the tool of pose p; its body's rotation vector stays in `log`."""
    kind, asked, tool, targets, places, rotations = asks
    target, place, turned = targets[p], places[p], rotations[p]
    _, second, turn, log, _ = work
    h, b = s.joint.shape[0], s.platform
    if kind == POSE:
        for r in range(3):
            left[h + r] = (position[b, r] - place[r]) / s.length
            for k in range(3):
                second[r, k] = 0.0
                for i in range(3):
                    second[r, k] += rotation[b, r, i] * tool[i, k]
        for r in range(3):
            for k in range(3):
                turn[r, k] = 0.0
                for i in range(3):
                    turn[r, k] += second[r, i] * turned[k, i]
        rotation_log(turn, left, h + 3)
    elif kind == TASK:
        rotation_log(rotation[b], log, 0)
        for t in range(asked.shape[0]):
            d = asked[t]
            if d < 3:
                left[h + t] = (position[b, d] - target[t]) / s.length
            else:
                left[h + t] = log[d - 3] - target[t]


@jit()
def _tool_row(s, kind, d, log, out):  # type: ignore[no-untyped-def]
    """Row of a direction of the tool; a turn that is asked alone is one of its rotation vector."""
    out[:] = 0.0
    c = s.column[s.platform]
    if d < 3 or kind == POSE:
        out[c + d] = 1.0
        return
    x, y, z = log[0], log[1], log[2]
    square = x * x + y * y + z * z
    if square < 1e-4:
        share = 1.0 / 12.0 + square / 720.0
    else:
        t = np.sqrt(square)
        share = 1.0 / square - (1.0 + np.cos(t)) / (2.0 * t * np.sin(t))
    k = d - 3
    i, m = (k + 1) % 3, (k + 2) % 3
    # 1 − [v]×/2 + share [v]×², and [v]×² = v vᵀ − |v|²
    out[c + 3 + k] = 1.0 + share * (log[k] * log[k] - square)
    out[c + 3 + i] = 0.5 * log[m] + share * log[k] * log[i]
    out[c + 3 + m] = -0.5 * log[i] + share * log[k] * log[m]


@jit()
def _apply(s, a, order, position, rotation):  # type: ignore[no-untyped-def]
    """Move the bodies by the solution, against what is open."""
    n = a.shape[0]
    for b in range(s.column.shape[0]):
        c = s.column[b]
        for r in range(3):
            position[b, r] -= s.length * a[order[c + r], n]
        turn_by_vector(rotation[b], -a[order[c + 3], n], -a[order[c + 4], n], -a[order[c + 5], n])


@jit()
def newton_step(s, asks, rows, rules, position, rotation, good, error):  # type: ignore[no-untyped-def]
    """Newton's method from each of p poses of the bodies, which are moved in place.

    Parameters
    ----------
    s : RowSystem
        The linkage.
    asks : tuple
        What is asked of the tool: 0 for nothing, `POSE` or `TASK`; which directions (t,); its
        rotation at home (3, 3); their targets (p, t), m and rad; the pose's place (p, 3), m, and
        rotation (p, 3, 3).
    rows : (p, 6 b) of int
        Rows that are solved for: held ones, then what is asked.
    rules : tuple
        How much a correction must shrink and may be at most, when gaps count as closed and as
        rounding, the correction before which they are believed, the most corrections, how open rows
        may stay that are not solved for; lengths over L, rad.
    position : (p, b, 3)
        Reference points of the bodies, m; moved.
    rotation : (p, b, 3, 3)
        Of the bodies from home; moved.
    good : (p,) of bool
        Set where it converges on the same branch; false before.
    error : (p,)
        Filled: largest gap, over L or rad.
    """
    shrink, farthest, closed, rounding, believed, most, otherwise = rules
    kind, asked = asks[0], asks[1]
    n, h, count = rows.shape[1], s.joint.shape[0], asked.shape[0]
    left, a = np.zeros(h + count), np.empty((n, n + 1))
    order, where = np.empty(n, dtype=np.int64), np.empty(n + 1, dtype=np.int64)
    nodes, frames = np.empty((1, *s.arms.shape)), np.empty((1, *s.frames.shape))
    work = (np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.zeros(3), np.empty((2, 3)))
    for p in range(position.shape[0]):
        before, first = np.inf, 0.0
        for step in range(most):
            place_pose(s, position[p : p + 1], rotation[p : p + 1], nodes, frames)
            _held(s, position[p], rotation[p], frames[0], work, left)
            _tool(s, asks, p, position[p], rotation[p], work, left)
            whole, size = np.abs(left).max(), 0.0
            for i in range(n):
                r = rows[p, i]
                size = max(size, abs(left[r]))
                a[i, n] = left[r]
                if r < h:
                    fill_row(s, r, nodes[0], frames[0], position[p], a[i, :n])
                else:
                    _tool_row(s, kind, asked[r - h], work[3], a[i, :n])
            error[p] = whole
            sign = eliminate(a, n, order, where)
            first = sign if step == 0 else first
            if size <= rounding or (size <= closed and before <= believed):
                # two branches that part at a singularity have determinants of opposite sign
                good[p] = whole <= otherwise and sign * first > 0.0
                break
            norm = np.abs(a[:, n]).max()
            if sign == 0.0 or not (norm <= farthest and (norm <= shrink * before or norm <= 1e-9)):
                break
            before = norm
            _apply(s, a, order, position[p], rotation[p])
