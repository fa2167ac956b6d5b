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


def home_rates(system: Any, leg: int) -> Array:
    """Rates of a leg's end by its coordinates at home, on (v / L, ω), (3 or 6, n)."""
    work = workspace(system)
    target, turn = system.reference[system.platform].copy(), np.eye(3)
    _pass(system, leg, target, turn, work)
    rows = 3 if system.ball[leg] else 6
    _rates(system, leg, target, work)
    return np.array(work[8][:rows, : system.unknowns[leg]])


def workspace(system: Any) -> tuple[Array, ...]:
    """Arrays that the kernels write to: the state of all legs' joints first, then scratch."""
    steps = len(system.joint)
    slides, angles, turned = np.zeros((steps, 3)), np.zeros((steps, 3)), np.zeros((steps, 3, 3))
    turned[:] = np.eye(3)
    return (
        slides,
        angles,
        turned,
        np.zeros((steps, 3, 3)),  # near axes
        np.zeros((steps, 3, 3)),  # far axes
        np.zeros((steps, 3)),  # near node
        np.zeros((steps, 3)),  # far node
        np.zeros(6),  # what is open
        np.zeros((6, 6)),  # rates
        np.zeros((6, 7)),  # elimination
        np.zeros(6),  # correction
        np.zeros((6, 6)),  # rates at a step's beginning
        np.zeros(3),  # the end's place that is wanted
        np.zeros((3, 3)),  # a rotation
    )


@jit()
def _begin(s, leg, target, turn, near, onward):  # type: ignore[no-untyped-def]
    """Near node and axes of the leg's first joint, on the ground or on the placed tool body."""
    i = s.start[leg]
    for r in range(3):
        if s.from_tool[leg] == 1:
            near[i, r] = target[r]
            for k in range(3):
                near[i, r] += turn[r, k] * (s.offset[i, k] - s.reference[s.platform, k])
                onward[i, r, k] = (
                    turn[r, 0] * s.onward[i, 0, k]
                    + turn[r, 1] * s.onward[i, 1, k]
                    + turn[r, 2] * s.onward[i, 2, k]
                )
        else:
            near[i, r] = s.offset[i, r]
            for k in range(3):
                onward[i, r, k] = s.onward[i, r, k]


@jit()
def _next(s, i, near_axes, far_axes, near, far):  # type: ignore[no-untyped-def]
    """Near node and axes of joint i from the far ones of the joint before."""
    for r in range(3):
        a, b, c = far_axes[i - 1, r, 0], far_axes[i - 1, r, 1], far_axes[i - 1, r, 2]
        near[i, r] = (
            far[i - 1, r] + a * s.offset[i, 0] + b * s.offset[i, 1] + c * s.offset[i, 2]
        )
        for k in range(3):
            near_axes[i, r, k] = (
                a * s.onward[i, 0, k] + b * s.onward[i, 1, k] + c * s.onward[i, 2, k]
            )


@jit()
def _across(s, i, slides, angles, turned, near_axes, far_axes, near, far):  # type: ignore[no-untyped-def]  # noqa: PLR0913, PLR0917
    """Far node and axes of joint i from its near ones."""
    forward = s.sign[i] > 0.0
    count = s.turns[i]
    if count == 3:
        for r in range(3):
            for k in range(3):
                total = 0.0
                for m in range(3):
                    # against the joint its rotation is undone
                    total += near_axes[i, r, m] * (turned[i, m, k] if forward else turned[i, k, m])
                far_axes[i, r, k] = total
    else:
        for r in range(3):
            for k in range(3):
                far_axes[i, r, k] = near_axes[i, r, k]
        if count == 1:
            turn_about(far_axes, i, s.first[i], s.sign[i] * angles[i, s.first[i]])
        elif count == 2 and forward:
            turn_about(far_axes, i, s.first[i], angles[i, s.first[i]])
            turn_about(far_axes, i, s.second[i], angles[i, s.second[i]])
        elif count == 2:
            turn_about(far_axes, i, s.second[i], -angles[i, s.second[i]])
            turn_about(far_axes, i, s.first[i], -angles[i, s.first[i]])
    for r in range(3):
        far[i, r] = near[i, r]
        for k in range(3):
            if s.slides[i, k] == 1:
                # what slides is measured along the axes of the joint's first body
                axis = near_axes[i, r, k] if forward else -far_axes[i, r, k]
                far[i, r] += axis * slides[i, k]


@jit()
def _pass(s, leg, target, turn, work):  # type: ignore[no-untyped-def]
    """Pass the leg and find what is open at its end, over the length; the largest part of it."""
    slides, angles, turned, near_axes, far_axes, near, far, left = work[:8]
    wanted, rotation = work[12], work[13]
    first, last = s.start[leg], s.start[leg + 1] - 1
    _begin(s, leg, target, turn, near, near_axes)
    for i in range(first, last + 1):
        if i > first:
            _next(s, i, near_axes, far_axes, near, far)
        if i < last or s.ball[leg] == 0:
            _across(s, i, slides, angles, turned, near_axes, far_axes, near, far)
    at_tool = s.body[last] == s.platform
    for r in range(3):
        wanted[r] = s.far[last, r]
        if at_tool:
            wanted[r] = target[r]
            for k in range(3):
                wanted[r] += turn[r, k] * (s.far[last, k] - s.reference[s.platform, k])
    reached = near if s.ball[leg] == 1 else far
    largest = 0.0
    for r in range(3):
        left[r] = (wanted[r] - reached[last, r]) / s.length
        largest = max(largest, abs(left[r]))
    if s.ball[leg] == 0:
        _apart(s, last, at_tool, turn, far_axes, rotation)
        rotation_log(rotation, left, 3)
        for r in range(3, 6):
            largest = max(largest, abs(left[r]))
    return largest


@jit()
def _apart(s, last, at_tool, turn, far_axes, rotation):  # type: ignore[no-untyped-def]
    """Rotation that leads the leg's end to where it is wanted."""
    for r in range(3):
        for k in range(3):
            total = 0.0
            for m in range(3):
                axis = s.frame[last, r, m]
                if at_tool:
                    axis = (
                        turn[r, 0] * s.frame[last, 0, m]
                        + turn[r, 1] * s.frame[last, 1, m]
                        + turn[r, 2] * s.frame[last, 2, m]
                    )
                total += axis * far_axes[last, k, m]
            rotation[r, k] = total


@jit()
def _rates(s, leg, target, work):  # type: ignore[no-untyped-def]
    """Rates of the leg's end at the place that is wanted, on (v / L, ω), as columns."""
    near_axes, far_axes, near, far, m, wanted = (
        work[3], work[4], work[5], work[6], work[8], work[12],
    )  # fmt: skip
    c = 0
    first, last = s.start[leg], s.start[leg + 1] - 1
    for i in range(first, last + 1 - s.ball[leg]):
        forward = s.sign[i] > 0.0
        for d in range(6):
            if s.column[i, d] < 0:
                continue
            k = d % 3
            # the first of two rotations moves with the joint's first body, the second with its
            # second; three are taken about the axes of the first body
            on_near = forward
            if d >= 3 and s.turns[i] == 2 and k == s.second[i]:
                on_near = not forward
            axes = near_axes if on_near else far_axes
            x, y, z = (
                s.sign[i] * axes[i, 0, k],
                s.sign[i] * axes[i, 1, k],
                s.sign[i] * axes[i, 2, k],
            )
            if d < 3:
                m[0, c], m[1, c], m[2, c] = x, y, z
                m[3, c], m[4, c], m[5, c] = 0.0, 0.0, 0.0
            else:
                centre = far if forward else near
                p = (wanted[0] - centre[i, 0]) / s.length
                q = (wanted[1] - centre[i, 1]) / s.length
                r = (wanted[2] - centre[i, 2]) / s.length
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
def _correct(s, leg, begins, work):  # type: ignore[no-untyped-def]
    """Correction of the leg's coordinates, least squares where rows are more; sign of its rates.

    With more rows than unknowns the sign is of the rates now against those where the step begins.
    """
    left, m, a, x, before = work[7], work[8], work[9], work[10], work[11]
    n, rows = s.unknowns[leg], 3 if s.ball[leg] == 1 else 6
    if n == 0:
        return 1.0
    if n == rows == 3:
        return _solve_three(m, left, x)
    if n == rows:
        for i in range(n):
            for c in range(n):
                a[i, c] = m[i, c]
            a[i, n] = left[i]
        return _eliminate(a, n, x)
    if begins:
        for r in range(rows):
            for c in range(n):
                before[r, c] = m[r, c]
    for i in range(n):
        for c in range(n):
            a[i, c] = 0.0
            for r in range(rows):
                a[i, c] += m[r, i] * before[r, c]
        a[i, n] = 0.0
    sense = _eliminate(a, n, x)
    for i in range(n):
        for c in range(n):
            a[i, c] = 0.0
            for r in range(rows):
                a[i, c] += m[r, i] * m[r, c]
        a[i, n] = 0.0
        for r in range(rows):
            a[i, n] += m[r, i] * left[r]
    if _eliminate(a, n, x) == 0.0:
        return 0.0
    return sense


@jit()
def _apply(s, leg, work):  # type: ignore[no-untyped-def]
    """Add the correction to the leg's joints."""
    slides, angles, turned, x = work[0], work[1], work[2], work[10]
    c = 0
    for i in range(s.start[leg], s.start[leg + 1] - s.ball[leg]):
        for k in range(3):
            if s.column[i, k] >= 0:
                slides[i, k] += s.length * x[c]
                c += 1
        if s.turns[i] == 3:
            turn_by_vector(turned, i, x[c], x[c + 1], x[c + 2], work[13])
            c += 3
        else:
            for k in range(3):
                if s.column[i, 3 + k] >= 0:
                    angles[i, k] += x[c]
                    c += 1


@jit()
def newton_leg(s, leg, target, turn, home_sign, rules, work):  # type: ignore[no-untyped-def]
    """Newton's method on one leg for a placed tool body, from the state that `work` holds.

    `rules`: share by which corrections must shrink, largest first correction, gap at which a
    leg is closed, gap that rounding leaves, correction after which a closed leg is believed,
    gap that a leg of fewer freedoms may keep. Returns what the step ended at and the gap.
    """
    shrink, farthest, closed, rounding, last, open_ = rules
    n, rows = s.unknowns[leg], 3 if s.ball[leg] == 1 else 6
    before, size = np.inf, 0.0
    for correction in range(8):
        size = _pass(s, leg, target, turn, work)
        if size <= rounding or (before <= last and size <= (closed if n == rows else open_)):
            return 0, size
        if n < rows and before <= 1e-9:
            return 2, size
        _rates(s, leg, target, work)
        sign = _correct(s, leg, correction == 0, work)
        if not sign * home_sign > 0.0:
            return 1, size
        norm = 0.0
        for c in range(n):
            norm = max(norm, abs(work[10][c]))
        if n == 0:
            return (0 if size <= open_ else 2), size
        if not (norm <= farthest and (norm <= shrink * before or norm <= 1e-9)):
            return 1, size
        _apply(s, leg, work)
        before = norm
    return 1, size


@jit()
def home_signs(s, signs, target, work):  # type: ignore[no-untyped-def]
    """Sign of the determinant of each leg's rates in the state that `work` holds, which is home."""
    turn = np.eye(3)
    for leg in range(signs.shape[0]):
        _pass(s, leg, target, turn, work)
        _rates(s, leg, target, work)
        signs[leg] = np.sign(_correct(s, leg, True, work))


@jit()
def _keep(s, leg, work, kept):  # type: ignore[no-untyped-def]
    """Copy the state of a leg's joints."""
    for i in range(s.start[leg], s.start[leg + 1]):
        for k in range(3):
            kept[0][i, k], kept[1][i, k] = work[0][i, k], work[1][i, k]
        if s.turns[i] == 3:
            for r in range(3):
                for k in range(3):
                    kept[2][i, r, k] = work[2][i, r, k]


@jit()
def _at_share(way, share, target, turn):  # type: ignore[no-untyped-def]
    """Place of the tool and rotation of its body at a share of the way."""
    start, end, whole, last = way
    if share == 1.0:
        for r in range(3):
            target[r] = end[r]
            for k in range(3):
                turn[r, k] = last[r, k]
        return
    for r in range(3):
        target[r] = start[r] + share * (end[r] - start[r])
        for k in range(3):
            turn[r, k] = 1.0 if r == k else 0.0
    flat = turn.reshape(1, 3, 3)
    turn_by_vector(flat, 0, share * whole[0], share * whole[1], share * whole[2], np.empty((3, 3)))


@jit()
def _unwrap(s, i, work, values):  # type: ignore[no-untyped-def]
    """Coordinates of a joint that turns in all ways, counted on from the last ones."""
    left = work[7]
    rotation_log(work[2][i], left, 0)
    for k in range(3):
        column = s.column[i, 3 + k]
        ahead = left[k] - values[column]
        values[column] += ahead - 2.0 * np.pi * np.floor(0.5 + ahead / (2.0 * np.pi))


@jit()
def _coordinates(s, leg, turn, work, values):  # type: ignore[no-untyped-def]
    """Joint coordinates of a leg that has arrived, relative to home."""
    slides, angles, turned, near_axes = work[0], work[1], work[2], work[3]
    for i in range(s.start[leg], s.start[leg + 1]):
        if s.ball[leg] == 1 and i == s.start[leg + 1] - 1:
            at_tool = s.body[i] == s.platform
            for r in range(3):
                for k in range(3):
                    total = 0.0
                    for m in range(3):
                        axis = s.frame[i, m, k]
                        if at_tool:
                            axis = (
                                turn[m, 0] * s.frame[i, 0, k]
                                + turn[m, 1] * s.frame[i, 1, k]
                                + turn[m, 2] * s.frame[i, 2, k]
                            )
                        total += near_axes[i, m, r] * axis
                    if s.sign[i] > 0.0:
                        turned[i, r, k] = total
                    else:
                        turned[i, k, r] = total
        for k in range(3):
            if s.column[i, k] >= 0:
                values[s.column[i, k]] = slides[i, k]
            if s.column[i, 3 + k] >= 0 and s.turns[i] < 3:
                values[s.column[i, 3 + k]] = angles[i, k]
        if s.turns[i] == 3:
            _unwrap(s, i, work, values)


@jit()
def _walk_leg(s, leg, way, limit, sign, rules, shortest, most, work, kept, values):  # type: ignore[no-untyped-def]  # noqa: PLR0913, PLR0917
    """Walk one leg from the state in `work` to a share of the way.

    Returns what it ended at, the share that was gone, the gap there and the steps made.
    """
    target, turn = np.empty(3), np.empty((3, 3))
    share, stride, gap, ended, steps = 0.0, 1.0, 0.0, 0, 0
    _keep(s, leg, work, kept)
    # on the way a point need not be met exactly: the next begins with a correction anyway
    rough = (rules[0], rules[1], 1e-6, rules[3], 1e-2, rules[5])
    while steps < most:
        steps += 1
        ahead = min(share + stride, limit)
        _at_share(way, ahead, target, turn)
        state, size = newton_leg(
            s, leg, target, turn, sign, rules if ahead == limit else rough, work
        )
        if state == 0:
            share, gap = ahead, size
            stride *= 2.0
            _coordinates(s, leg, turn, work, values)
            if share >= limit:
                return 0, share, gap, steps
            _keep(s, leg, work, kept)
            continue
        ended = state
        _keep(s, leg, kept, work)
        stride = 0.5 * min(stride, limit - share)
        if stride < shortest:
            return ended, share, gap, steps
    return 3, share, gap, steps


@jit()
def _to_home(s, leg, work, values):  # type: ignore[no-untyped-def]
    """A leg's joints as they are at home."""
    for i in range(s.start[leg], s.start[leg + 1]):
        for k in range(3):
            work[0][i, k], work[1][i, k] = 0.0, 0.0
            for r in range(3):
                work[2][i, r, k] = 1.0 if r == k else 0.0
        for d in range(6):
            if s.column[i, d] >= 0:
                values[s.column[i, d]] = 0.0


@jit()
def _bodies(s, leg, work, position, rotation):  # type: ignore[no-untyped-def]
    """Reference points and rotations of a leg's bodies."""
    far_axes, far = work[4], work[6]
    last = s.start[leg + 1] - 1
    for i in range(s.start[leg], last):
        b = s.body[i]
        for r in range(3):
            position[b, r] = far[i, r]
            for k in range(3):
                total = 0.0
                for m in range(3):
                    total += far_axes[i, r, m] * s.frame[i, k, m]
                rotation[b, r, k] = total
            for k in range(3):
                position[b, r] += rotation[b, r, k] * (s.reference[b, k] - s.far[i, k])


@jit()
def walk_legs(s, start, end, whole, last, signs, rules, shortest, most, work, kept, found):  # type: ignore[no-untyped-def]  # noqa: PLR0913, PLR0917
    """Walk all legs to p targets; see `leg_walk.LegWalk`.

    A leg that ends on its way ends the others there.
    """
    position, rotation, coordinates, share, gap, steps, ended, which = found
    target, turn = np.empty(3), np.empty((3, 3))
    for p in range(end.shape[0]):
        way = (start, end[p], whole[p], last[p])
        limit, leg = 1.0, 0
        while leg < signs.shape[0]:
            _to_home(s, leg, work, coordinates[p])
            state, gone, size, made = _walk_leg(
                s, leg, way, limit, signs[leg], rules, shortest, most, work, kept, coordinates[p]
            )
            gap[p] = max(gap[p] if leg else 0.0, size)
            steps[p] = max(steps[p], made)
            leg += 1
            if state != 0:
                # those before have gone further, and stand where this one ends
                limit, ended[p], which[p], leg = gone, state, leg - 1, 0
                if gone == 0.0:
                    break
        share[p] = limit
        _at_share(way, limit, target, turn)
        for leg in range(signs.shape[0]):
            if limit == 0.0:
                _to_home(s, leg, work, coordinates[p])
            # scratch holds what was tried last, which need not be where the leg stands
            _pass(s, leg, target, turn, work)
            _bodies(s, leg, work, position[p], rotation[p])
        for r in range(3):
            position[p, s.platform, r] = target[r]
            for k in range(3):
                rotation[p, s.platform, r, k] = turn[r, k]
