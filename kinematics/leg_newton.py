"""Compiled code for inverse kinematics leg by leg: Newton's method on the joints of a chain."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.jit import jit
from strutwork.kinematics.leg_turns import rotation_log, turn_about, turn_by_vector

Array = NDArray[Any]

#: What a leg's way ended at.
ARRIVED, END_OF_REACH, DISAGREES, TOO_MANY = 0, 1, 2, 3


#: What changes of a joint that is passed, and where its nodes and axes are.
STATE = np.dtype(
    [
        ("slides", float, (3,)),
        ("angles", float, (3,)),
        ("turned", float, (3, 3)),
        ("near_axes", float, (3, 3)),
        ("far_axes", float, (3, 3)),
        ("near", float, (3,)),
        ("far", float, (3,)),
    ],
    align=True,
)

#: What is open, the leg's rates, the equations, their solution, the rates at a step's beginning,
#: the end's place and the tool's that are wanted, its body's rotation, the end's axes there, and how
#: far these are apart from the leg's.
SCRATCH = np.dtype(
    [
        ("left", float, (6,)),
        ("rates", float, (6, 6)),
        ("equations", float, (6, 7)),
        ("change", float, (6,)),
        ("before", float, (6, 6)),
        ("wanted", float, (3,)),
        ("target", float, (3,)),
        ("turn", float, (3, 3)),
        ("rotation", float, (3, 3)),
        ("apart", float, (3, 3)),
    ],
    align=True,
)


def workspace(system: Any) -> tuple[Array, Array, Array]:
    """State of all joints that are passed, at home; the same once more; scratch."""
    state = np.zeros(len(system.steps), STATE)
    state["turned"] = np.eye(3)
    return state, state.copy(), np.zeros(1, SCRATCH)


def home_rates(system: Any, leg: int) -> Array:
    """Rates of a leg's end by its coordinates at home, on (v / L, ω), (3 or 6, n)."""
    state, _, scratch = workspace(system)
    _home(system, scratch[0])
    _pass(system, leg, state, scratch[0])
    _rates(system, leg, state, scratch[0])
    rows = 3 if system.legs["ball"][leg] else 6
    return np.array(scratch[0]["rates"][:rows, : system.legs["unknowns"][leg]])


@jit()
def _home(s, w):  # type: ignore[no-untyped-def]
    """The tool's body as it is at home."""
    for r in range(3):
        w.target[r] = s.reference[s.platform, r]
        for k in range(3):
            w.turn[r, k] = 1.0 if r == k else 0.0


@jit()
def _begin(s, step, from_tool, at, w):  # type: ignore[no-untyped-def]
    """Near node and axes of a leg's first joint, on the ground or on the placed tool body."""
    for r in range(3):
        if from_tool == 1:
            at.near[r] = w.target[r]
            a, b, c = w.turn[r, 0], w.turn[r, 1], w.turn[r, 2]
            for k in range(3):
                at.near[r] += w.turn[r, k] * (step.offset[k] - s.reference[s.platform, k])
                at.near_axes[r, k] = (
                    a * step.onward[0, k] + b * step.onward[1, k] + c * step.onward[2, k]
                )
        else:
            at.near[r] = step.offset[r]
            for k in range(3):
                at.near_axes[r, k] = step.onward[r, k]


@jit()
def _next(step, before, at):  # type: ignore[no-untyped-def]
    """Near node and axes of a joint from the far ones of the joint before."""
    for r in range(3):
        a, b, c = before.far_axes[r, 0], before.far_axes[r, 1], before.far_axes[r, 2]
        at.near[r] = before.far[r] + a * step.offset[0] + b * step.offset[1] + c * step.offset[2]
        for k in range(3):
            at.near_axes[r, k] = (
                a * step.onward[0, k] + b * step.onward[1, k] + c * step.onward[2, k]
            )


@jit()
def _across(step, at):  # type: ignore[no-untyped-def]
    """Far node and axes of a joint from its near ones."""
    forward = step.sign > 0.0
    if step.turns == 3:
        for r in range(3):
            for k in range(3):
                total = 0.0
                for m in range(3):
                    # against the joint its rotation is undone
                    part = at.turned[m, k] if forward else at.turned[k, m]
                    total += at.near_axes[r, m] * part
                at.far_axes[r, k] = total
    else:
        for r in range(3):
            for k in range(3):
                at.far_axes[r, k] = at.near_axes[r, k]
        if step.turns == 1:
            turn_about(at.far_axes, step.first, step.sign * at.angles[step.first])
        elif step.turns == 2 and forward:
            turn_about(at.far_axes, step.first, at.angles[step.first])
            turn_about(at.far_axes, step.second, at.angles[step.second])
        elif step.turns == 2:
            turn_about(at.far_axes, step.second, -at.angles[step.second])
            turn_about(at.far_axes, step.first, -at.angles[step.first])
    for r in range(3):
        at.far[r] = at.near[r]
        for k in range(3):
            if step.slides[k] == 1:
                # what slides is measured along the axes of the joint's first body
                axis = at.near_axes[r, k] if forward else -at.far_axes[r, k]
                at.far[r] += axis * at.slides[k]


@jit()
def _pass(s, leg, state, w):  # type: ignore[no-untyped-def]
    """Pass a leg and find what is open at its end, over the length; the largest part of it."""
    first, last = s.legs[leg].start, s.legs[leg].stop - 1
    ball = s.legs[leg].ball == 1
    _begin(s, s.steps[first], s.legs[leg].from_tool, state[first], w)
    for i in range(first, last + 1):
        if i > first:
            _next(s.steps[i], state[i - 1], state[i])
        if i < last or not ball:
            _across(s.steps[i], state[i])
    step, end = s.steps[last], state[last]
    at_tool = step.body == s.platform
    largest = 0.0
    for r in range(3):
        w.wanted[r] = step.far[r]
        if at_tool:
            w.wanted[r] = w.target[r]
            for k in range(3):
                w.wanted[r] += w.turn[r, k] * (step.far[k] - s.reference[s.platform, k])
        w.left[r] = (w.wanted[r] - (end.near[r] if ball else end.far[r])) / s.length
        largest = max(largest, abs(w.left[r]))
    if not ball:
        _end_axes(step, at_tool, w)
        for r in range(3):
            for k in range(3):
                w.apart[r, k] = (
                    w.rotation[r, 0] * end.far_axes[k, 0]
                    + w.rotation[r, 1] * end.far_axes[k, 1]
                    + w.rotation[r, 2] * end.far_axes[k, 2]
                )
        rotation_log(w.apart, w.left, 3)
        for r in range(3, 6):
            largest = max(largest, abs(w.left[r]))
    return largest


@jit()
def _end_axes(step, at_tool, w):  # type: ignore[no-untyped-def]
    """Axes of a leg's last joint on the body where it ends, into `w.rotation`."""
    for r in range(3):
        for k in range(3):
            w.rotation[r, k] = step.frame[r, k]
            if at_tool:
                w.rotation[r, k] = (
                    w.turn[r, 0] * step.frame[0, k]
                    + w.turn[r, 1] * step.frame[1, k]
                    + w.turn[r, 2] * step.frame[2, k]
                )


@jit()
def _rates(s, leg, state, w):  # type: ignore[no-untyped-def]
    """Rates of a leg's end at the place that is wanted, on (v / L, ω), as columns."""
    m, c = w.rates, 0
    for i in range(s.legs[leg].start, s.legs[leg].stop - s.legs[leg].ball):
        step, at = s.steps[i], state[i]
        forward = step.sign > 0.0
        for d in range(6):
            if step.column[d] < 0:
                continue
            k = d % 3
            # the first of two rotations moves with the joint's first body, the second with its
            # second; three are taken about the axes of the first body
            on_near = forward
            if d >= 3 and step.turns == 2 and k == step.second:
                on_near = not forward
            axes = at.near_axes if on_near else at.far_axes
            x, y, z = step.sign * axes[0, k], step.sign * axes[1, k], step.sign * axes[2, k]
            if d < 3:
                m[0, c], m[1, c], m[2, c] = x, y, z
                m[3, c], m[4, c], m[5, c] = 0.0, 0.0, 0.0
            else:
                centre = at.far if forward else at.near
                p = (w.wanted[0] - centre[0]) / s.length
                q = (w.wanted[1] - centre[1]) / s.length
                r = (w.wanted[2] - centre[2]) / s.length
                m[0, c], m[1, c], m[2, c] = y * r - z * q, z * p - x * r, x * q - y * p
                m[3, c], m[4, c], m[5, c] = x, y, z
            c += 1


@jit()
def _solve_three(m, left, x):  # type: ignore[no-untyped-def]
    """Solve three equations by Cramer's rule; the determinant."""
    a = m[1, 1] * m[2, 2] - m[1, 2] * m[2, 1]
    b = m[1, 2] * m[2, 0] - m[1, 0] * m[2, 2]
    c = m[1, 0] * m[2, 1] - m[1, 1] * m[2, 0]
    whole = m[0, 0] * a + m[0, 1] * b + m[0, 2] * c
    over = 1.0 / whole
    x[0] = over * (
        a * left[0]
        + (m[0, 2] * m[2, 1] - m[0, 1] * m[2, 2]) * left[1]
        + (m[0, 1] * m[1, 2] - m[0, 2] * m[1, 1]) * left[2]
    )
    x[1] = over * (
        b * left[0]
        + (m[0, 0] * m[2, 2] - m[0, 2] * m[2, 0]) * left[1]
        + (m[0, 2] * m[1, 0] - m[0, 0] * m[1, 2]) * left[2]
    )
    x[2] = over * (
        c * left[0]
        + (m[0, 1] * m[2, 0] - m[0, 0] * m[2, 1]) * left[1]
        + (m[0, 0] * m[1, 1] - m[0, 1] * m[1, 0]) * left[2]
    )
    return whole


@jit()
def _eliminate(a, n, x):  # type: ignore[no-untyped-def]
    """Gauss elimination with row pivoting of n rows with their right side; the determinant."""
    whole = 1.0
    for k in range(n):
        best, at = abs(a[k, k]), k
        for i in range(k + 1, n):
            if abs(a[i, k]) > best:
                best, at = abs(a[i, k]), i
        if not best > 0.0:
            return 0.0
        if at != k:
            whole = -whole
            for c in range(k, n + 1):
                a[k, c], a[at, c] = a[at, c], a[k, c]
        whole *= a[k, k]
        over = 1.0 / a[k, k]
        for i in range(k + 1, n):
            factor = a[i, k] * over
            for c in range(k + 1, n + 1):
                a[i, c] -= factor * a[k, c]
    for k in range(n - 1, -1, -1):
        total = a[k, n]
        for c in range(k + 1, n):
            total -= a[k, c] * x[c]
        x[k] = total / a[k, k]
    return whole


@jit()
def _correct(s, leg, begins, w):  # type: ignore[no-untyped-def]
    """Correction of a leg's coordinates, least squares where rows are more; sign of its rates.

    With more rows than unknowns the sign is of the rates now against those where the step begins.
    """
    m, a = w.rates, w.equations
    n, rows = s.legs[leg].unknowns, 3 if s.legs[leg].ball == 1 else 6
    if n == 0:
        return 1.0
    if n == rows == 3:
        return _solve_three(m, w.left, w.change)
    if n == rows:
        for i in range(n):
            for c in range(n):
                a[i, c] = m[i, c]
            a[i, n] = w.left[i]
        return _eliminate(a, n, w.change)
    if begins:
        for r in range(rows):
            for c in range(n):
                w.before[r, c] = m[r, c]
    for i in range(n):
        for c in range(n):
            a[i, c] = 0.0
            for r in range(rows):
                a[i, c] += m[r, i] * w.before[r, c]
        a[i, n] = 0.0
    sense = _eliminate(a, n, w.change)
    for i in range(n):
        for c in range(n):
            a[i, c] = 0.0
            for r in range(rows):
                a[i, c] += m[r, i] * m[r, c]
        a[i, n] = 0.0
        for r in range(rows):
            a[i, n] += m[r, i] * w.left[r]
    if _eliminate(a, n, w.change) == 0.0:
        return 0.0
    return sense


@jit()
def _apply(s, leg, state, w):  # type: ignore[no-untyped-def]
    """Add the correction to a leg's joints."""
    x, c = w.change, 0
    for i in range(s.legs[leg].start, s.legs[leg].stop - s.legs[leg].ball):
        step, at = s.steps[i], state[i]
        for k in range(3):
            if step.slides[k] == 1:
                at.slides[k] += s.length * x[c]
                c += 1
        if step.turns == 3:
            turn_by_vector(at.turned, x[c], x[c + 1], x[c + 2])
            c += 3
        else:
            for k in range(3):
                if step.column[3 + k] >= 0:
                    at.angles[k] += x[c]
                    c += 1


@jit()
def _newton(s, leg, sign, rules, state, w):  # type: ignore[no-untyped-def]
    """Newton's method on one leg for a placed tool body; what it ended at and the gap.

    `rules`: share by which corrections must shrink, largest first correction, gap at which a
    leg is closed, gap that rounding leaves, correction after which a closed leg is believed,
    gap that a leg of fewer freedoms may keep, corrections.
    """
    shrink, farthest, closed, rounding, believed, open_, most = rules
    n = s.legs[leg].unknowns
    square = n == (3 if s.legs[leg].ball == 1 else 6)
    before, size = np.inf, 0.0
    for correction in range(most):
        size = _pass(s, leg, state, w)
        if size <= rounding or (before <= believed and size <= (closed if square else open_)):
            return ARRIVED, size
        # least squares have come to rest with something open
        if not square and before <= 1e-9:
            return DISAGREES, size
        if n == 0:
            return (ARRIVED if size <= open_ else DISAGREES), size
        _rates(s, leg, state, w)
        if not _correct(s, leg, correction == 0, w) * sign > 0.0:
            return END_OF_REACH, size
        norm = 0.0
        for c in range(n):
            norm = max(norm, abs(w.change[c]))
        if not (norm <= farthest and (norm <= shrink * before or norm <= 1e-9)):
            return END_OF_REACH, size
        _apply(s, leg, state, w)
        before = norm
    return END_OF_REACH, size


@jit()
def home_signs(s, signs, state, scratch):  # type: ignore[no-untyped-def]
    """Sign of the determinant of each leg's rates in a state, which is home."""
    w = scratch[0]
    _home(s, w)
    for leg in range(signs.shape[0]):
        _pass(s, leg, state, w)
        _rates(s, leg, state, w)
        signs[leg] = np.sign(_correct(s, leg, True, w))


@jit()
def _copy(s, leg, state, kept):  # type: ignore[no-untyped-def]
    """Copy what changes of a leg's joints."""
    for i in range(s.legs[leg].start, s.legs[leg].stop):
        for k in range(3):
            kept[i].slides[k], kept[i].angles[k] = state[i].slides[k], state[i].angles[k]
        if s.steps[i].turns == 3:
            for r in range(3):
                for k in range(3):
                    kept[i].turned[r, k] = state[i].turned[r, k]


@jit()
def _at_share(way, share, w):  # type: ignore[no-untyped-def]
    """Place the tool and its body at a share of the way."""
    start, end, whole, last = way
    for r in range(3):
        # at the end the target itself, without the rounding of the way
        w.target[r] = end[r] if share == 1.0 else start[r] + share * (end[r] - start[r])
        for k in range(3):
            w.turn[r, k] = last[r, k] if share == 1.0 else (1.0 if r == k else 0.0)
    if share < 1.0:
        turn_by_vector(w.turn, share * whole[0], share * whole[1], share * whole[2])


@jit()
def _coordinates(s, leg, state, w, values):  # type: ignore[no-untyped-def]
    """Joint coordinates of a leg that has arrived, relative to home, turns counted on."""
    for i in range(s.legs[leg].start, s.legs[leg].stop):
        step, at = s.steps[i], state[i]
        if s.legs[leg].ball == 1 and i == s.legs[leg].stop - 1:
            _end_axes(step, step.body == s.platform, w)
            for r in range(3):
                for k in range(3):
                    total = 0.0
                    for m in range(3):
                        total += at.near_axes[m, r] * w.rotation[m, k]
                    if step.sign > 0.0:
                        at.turned[r, k] = total
                    else:
                        at.turned[k, r] = total
        for k in range(3):
            if step.slides[k] == 1:
                values[step.column[k]] = at.slides[k]
            if step.turns < 3 and step.column[3 + k] >= 0:
                values[step.column[3 + k]] = at.angles[k]
        if step.turns == 3:
            rotation_log(at.turned, w.left, 0)
            for k in range(3):
                column = step.column[3 + k]
                ahead = w.left[k] - values[column]
                values[column] += ahead - 2.0 * np.pi * np.floor(0.5 + ahead / (2.0 * np.pi))


@jit()
def _walk_leg(s, leg, way, limit, sign, rules, work, values):  # type: ignore[no-untyped-def]
    """Walk one leg from home to a share of the way.

    Returns what it ended at, the share that was gone, the gap there and the steps made.
    """
    newton, rough, shortest, most = rules
    state, kept, scratch = work
    w = scratch[0]
    share, stride, gap, steps = 0.0, 1.0, 0.0, 0
    _to_home(s, leg, state, values)
    _to_home(s, leg, kept, values)
    while steps < most:
        steps += 1
        ahead = min(share + stride, limit)
        _at_share(way, ahead, w)
        # on the way a point need not be met exactly: the next begins with a correction anyway
        ended, size = _newton(s, leg, sign, newton if ahead == limit else rough, state, w)
        if ended == ARRIVED:
            share, gap = ahead, size
            stride *= 2.0
            _coordinates(s, leg, state, w, values)
            if share >= limit:
                return ARRIVED, share, gap, steps
            _copy(s, leg, state, kept)
            continue
        _copy(s, leg, kept, state)
        stride = 0.5 * min(stride, limit - share)
        if stride < shortest:
            return ended, share, gap, steps
    return TOO_MANY, share, gap, steps


@jit()
def _to_home(s, leg, state, values):  # type: ignore[no-untyped-def]
    """A leg's joints as they are at home."""
    for i in range(s.legs[leg].start, s.legs[leg].stop):
        for k in range(3):
            state[i].slides[k], state[i].angles[k] = 0.0, 0.0
            for r in range(3):
                state[i].turned[r, k] = 1.0 if r == k else 0.0
        for d in range(6):
            if s.steps[i].column[d] >= 0:
                values[s.steps[i].column[d]] = 0.0


@jit()
def _bodies(s, leg, state, position, rotation):  # type: ignore[no-untyped-def]
    """Reference points and rotations of a leg's bodies."""
    for i in range(s.legs[leg].start, s.legs[leg].stop - 1):
        step, at = s.steps[i], state[i]
        b = step.body
        for r in range(3):
            position[b, r] = at.far[r]
            for k in range(3):
                total = 0.0
                for m in range(3):
                    total += at.far_axes[r, m] * step.frame[k, m]
                rotation[b, r, k] = total
                position[b, r] += total * (s.reference[b, k] - step.far[k])


@jit()
def walk_legs(s, start, ends, signs, rules, work, found):  # type: ignore[no-untyped-def]
    """Walk all legs to p targets; see `leg_walk.LegWalk`. A leg that ends ends the others there."""
    end, whole, last = ends
    position, rotation, coordinates, share, gap, steps, ended, which = found
    state, w = work[0], work[2][0]
    for p in range(end.shape[0]):
        way = (start, end[p], whole[p], last[p])
        limit, leg = 1.0, 0
        while leg < signs.shape[0]:
            reason, gone, size, made = _walk_leg(
                s, leg, way, limit, signs[leg], rules, work, coordinates[p]
            )
            gap[p] = max(gap[p] if leg else 0.0, size)
            steps[p] = max(steps[p], made)
            leg += 1
            if reason != ARRIVED:
                # the legs before it have gone further: they go again, to where this one ends
                limit, ended[p], which[p], leg = gone, reason, leg - 1, 0
                if gone == 0.0:
                    break
        share[p] = limit
        _at_share(way, limit, w)
        for leg in range(signs.shape[0]):
            if limit == 0.0:
                _to_home(s, leg, state, coordinates[p])
            if limit < 1.0:
                _pass(s, leg, state, w)
            _bodies(s, leg, state, position[p], rotation[p])
        for r in range(3):
            position[p, s.platform, r] = w.target[r]
            for k in range(3):
                rotation[p, s.platform, r, k] = w.turn[r, k]
