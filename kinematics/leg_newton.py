"""Compiled code for inverse kinematics leg by leg: Newton's method on the joints of a chain."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.jit import jit
from strutwork.kinematics.leg_pass import SCRATCH, STATE, end_axes, home_tool, pass_leg, rates
from strutwork.kinematics.leg_turns import rotation_log, turn_by_vector

Array = NDArray[Any]

#: What a leg's way ended at.
ARRIVED, END_OF_REACH, TOO_MANY = 0, 1, 2


def workspace(system: Any) -> tuple[Array, Array, Array]:
    """State of all joints that are passed, (s,), at home; the same once more; scratch, (1,).

    Parameters
    ----------
    system : LegSystem
        With s joints in all its legs.
    """
    state = np.zeros(len(system.steps), STATE)
    state["turned"] = np.eye(3)
    return state, state.copy(), np.zeros(1, SCRATCH)


def home_rates(system: Any, leg: int) -> Array:
    """Rates of a leg's end by its coordinates at home, on (v / L, ω), (3 or 6, n).

    Parameters
    ----------
    system : LegSystem
        All legs.
    leg : int
        Which one.
    """
    state, _, scratch = workspace(system)
    home_tool(system, scratch[0])
    pass_leg(system, leg, state, scratch[0])
    rates(system, leg, state, scratch[0])
    rows = 3 if system.legs["ball"][leg] else 6
    return np.array(scratch[0]["rates"][:rows, : system.legs["unknowns"][leg]])


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
def _correct(s, leg, w):  # type: ignore[no-untyped-def]
    """Correction of a leg's coordinates; determinant of its rates, which has their sign."""
    m, a = w.rates, w.equations
    n = s.legs[leg].unknowns
    if n == 3:
        return _solve_three(m, w.left, w.change)
    for i in range(n):
        for c in range(n):
            a[i, c] = m[i, c]
        a[i, n] = w.left[i]
    return _eliminate(a, n, w.change)


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
    corrections.
    """
    shrink, farthest, closed, rounding, believed, most = rules
    n = s.legs[leg].unknowns
    before, size = np.inf, 0.0
    for _ in range(most):
        size = pass_leg(s, leg, state, w)
        if size <= rounding or (before <= believed and size <= closed):
            return ARRIVED, size
        rates(s, leg, state, w)
        if not _correct(s, leg, w) * sign > 0.0:
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
    """Sign of the determinant of each leg's rates in a state, which is home.

    Parameters
    ----------
    s : LegSystem
        All legs.
    signs : (l,)
        Filled with ±1, or 0 where the rates are singular.
    state : (s,) of `STATE`
        Of all joints, at home.
    scratch : (1,) of `SCRATCH`
        Overwritten.
    """
    w = scratch[0]
    home_tool(s, w)
    for leg in range(signs.shape[0]):
        pass_leg(s, leg, state, w)
        rates(s, leg, state, w)
        signs[leg] = np.sign(_correct(s, leg, w))


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
            end_axes(step, step.body == s.platform, w)
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
    """Walk all legs to p targets; see `leg_walk.LegWalk`. A leg that ends ends the others there.

    Parameters
    ----------
    s : LegSystem
        All legs.
    start : (3,)
        The tool at home, m.
    ends : (p, 3), (p, 3) and (p, 3, 3)
        Targets of the tool: position, m; rotation from home as a vector, rad, and as a matrix.
    signs : (l,)
        As `home_signs` fills them.
    rules : tuple
        Limits of Newton's method for the last step and for those on the way, the shortest step as a
        share of the way, the most steps.
    work : tuple
        As `workspace` makes it.
    found : tuple of arrays
        Filled: positions (p, b, 3), m, and rotations (p, b, 3, 3) of the bodies, joint coordinates
        (p, c), m and rad, share of the way (p,), largest gap over the length (p,), steps (p,), why
        the way ended (p,) and at which leg (p,).
    """
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
                pass_leg(s, leg, state, w)
            _bodies(s, leg, state, position[p], rotation[p])
        for r in range(3):
            position[p, s.platform, r] = w.target[r]
            for k in range(3):
                rotation[p, s.platform, r, k] = w.turn[r, k]
