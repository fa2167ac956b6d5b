"""How constraint rows change as their bodies move: the second order of the kinematics, exact."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.frames import cross
from strutwork.kinematics.rows import ConstraintRows

Array = NDArray[Any]


def row_rates(rows: ConstraintRows, references: Array, twists: Array) -> Array:
    """Time derivative of `rows.on_bodies(references)` along a motion of the bodies.

    A row A q = 0 that keeps holding gives A q̈ = −Ȧ q̇. A row's axis is carried by its joint's
    first body; of a joint with two free rotations the second axis is carried by the second body,
    and the held one stands across both. Where a joint slides, its place on the first body is
    where its second node is.

    Parameters
    ----------
    rows : ConstraintRows
        At p poses.
    references : (p, b, 3)
        Points fixed in the bodies, m.
    twists : (p, 6 b)
        Velocities of those points and angular velocities, m/s and rad/s.

    Returns
    -------
    rates : (p, r, 6 b)
    """
    linkage, positions = rows.linkage, rows.placement.positions
    count, bodies = len(twists), len(linkage.body_names)
    owner, nodes = linkage.body_of_node[rows.nodes], rows.nodes
    # the ground is −1, the last
    still = np.zeros((count, 1, 6))
    moving = np.concatenate([twists.reshape(count, bodies, 6), still], axis=1)
    points = np.concatenate([references, still[..., :3]], axis=1)
    spin = [moving[:, owner[:, k], 3:] for k in (0, 1)]
    arm = [positions[:, nodes[:, k]] - points[:, owner[:, k]] for k in (0, 1)]
    second = cross(spin[1], arm[1])
    place = moving[:, owner[:, 1], :3] + second
    arm_rate = [place - moving[:, owner[:, 0], :3], second]
    shift = rows.direction < 3
    axis = np.where(shift[:, None], rows.axes[..., :3], rows.axes[..., 3:])
    change = _axis_rates(rows, axis, spin)
    result = np.zeros((count, len(rows), bodies, 6))
    apart = owner[:, 0] != owner[:, 1]
    for side, sign in enumerate((-1.0, 1.0)):
        r = np.flatnonzero(apart & (owner[:, side] >= 0) & shift)
        e, rate = sign * axis[:, r], sign * change[:, r]
        result[:, r, owner[r, side], :3] = rate
        result[:, r, owner[r, side], 3:] = cross(arm_rate[side][:, r], e) + cross(
            arm[side][:, r], rate
        )
        r = np.flatnonzero(apart & (owner[:, side] >= 0) & ~shift)
        result[:, r, owner[r, side], 3:] = sign * change[:, r]
    flat = result.reshape(count, len(rows), 6 * bodies)
    if rows.tied is not None:
        others = row_rates(rows.tied.others, references, twists)
        flat[:, rows.tied.rows] -= rows.tied.ratio[:, None] * others
    return flat


def _axis_rates(rows: ConstraintRows, axis: Array, spin: list[Array]) -> Array:
    """Rates of the rows' axes, (p, r, 3)."""
    change = cross(spin[0], axis)
    linkage = rows.linkage
    held = linkage.still_mask()
    for r, (joint, direction) in enumerate(zip(rows.joint, rows.direction, strict=True)):
        locks = np.flatnonzero(held[joint, 3:])
        if direction < 3 or len(locks) != 1:
            continue
        locked, turn = int(locks[0]), int(direction) - 3
        e, f = (rows.placement.frames[:, joint, :, (locked + k) % 3] for k in (1, 2))
        if turn == locked:
            change[:, r] = cross(cross(spin[0][:, r], e), f) + cross(e, cross(spin[1][:, r], f))
        elif turn == (locked + 2) % 3:
            change[:, r] = cross(spin[1][:, r], f)
    return change
