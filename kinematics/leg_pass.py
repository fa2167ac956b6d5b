"""Compiled passing of a leg: where its joints are, what is open at its end, and its rates."""

from __future__ import annotations

import numpy as np

from strutwork.jit import jit
from strutwork.kinematics.leg_turns import rotation_log, turn_about

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
#: the end's place and the tool's that are wanted, its body's rotation, and another.
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
    ],
    align=True,
)


@jit()
def home_tool(s, w):  # type: ignore[no-untyped-def]
    """The tool's body as it is at home.

    Parameters
    ----------
    s : LegSystem
        All legs.
    w : record of `SCRATCH`
        Its `target`, m, and `turn` are filled.
    """
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
def pass_leg(s, leg, state, w):  # type: ignore[no-untyped-def]
    """Pass a leg and find what is open at its end, over the length; the largest part of it.

    Parameters
    ----------
    s : LegSystem
        All legs.
    leg : int
        Which one.
    state : (s,) of `STATE`
        Of all joints; `slides`, m, and `angles`, rad, are read, the rest of this leg's is filled.
    w : record of `SCRATCH`
        The tool's `target` and `turn` are read; `left`, over the length and rad, is filled.
    """
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
        end_axes(step, at_tool, w)
        for r in range(3):
            for k in range(3):
                w.before[r, k] = (
                    w.rotation[r, 0] * end.far_axes[k, 0]
                    + w.rotation[r, 1] * end.far_axes[k, 1]
                    + w.rotation[r, 2] * end.far_axes[k, 2]
                )
        rotation_log(w.before, w.left, 3)
        for r in range(3, 6):
            largest = max(largest, abs(w.left[r]))
    return largest


@jit()
def end_axes(step, at_tool, w):  # type: ignore[no-untyped-def]
    """Axes of a leg's last joint on the body where it ends, into `w.rotation`.

    Parameters
    ----------
    step : record of `STEP`
        The last joint.
    at_tool : bool
        Whether the leg ends at the tool's body, else on the ground.
    w : record of `SCRATCH`
        The tool's `turn` is read.
    """
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
def rates(s, leg, state, w):  # type: ignore[no-untyped-def]
    """Rates of a leg's end at the place that is wanted, on (v / L, ω), as columns.

    Parameters
    ----------
    s : LegSystem
        All legs.
    leg : int
        Which one, passed by `pass_leg`.
    state : (s,) of `STATE`
        Of all joints.
    w : record of `SCRATCH`
        Its `rates` (3 or 6, n) are filled: 1/m of slides, no unit of turns.
    """
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
