"""What tool and drives can do at a pose, by rank: freedoms, redundancy and singularities."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinematics.linkage import Linkage
from kinematics.placement import Placement
from kinematics.rows import constraint_rows
from kinematics.second_order import lost_twists

Array = NDArray[Any]
Mask = NDArray[np.bool_]

#: Passive rows whose singular values are below this share of the largest hold nothing.
HELD = 1e-10

#: Part that the tool, or the drives, have in a motion of unit size before they count as moving.
MOVES = 1e-11


@dataclass(frozen=True)
class MotionSpaces:
    """Motions of a mechanism with free drives, as tool and drives see them.

    The motions of all bodies that passive joints allow are reduced to those in which the tool
    or a drive moves. There a unit motion has a cosine, what the tool does, and a sine, what the
    drives do: a cosine of zero is a motion of the drives at a standing tool, a sine of zero one
    of the tool at standing drives.

    Parameters
    ----------
    inverse : (p, a, 6)
        Least rates per tool twist; infinite in directions that are lost.
    forward : (p, 6, a)
        Tool twist per rate; infinite where the tool moves at standing drives.
    motions : (p, 6, 6)
        Tool twists that can be made, orthonormal columns, the rest zero.
    rank : (p,)
        How many.
    serial, parallel : (p,) of bool
        The tool has lost a motion; the tool moves at standing drives.
    """

    inverse: Array
    forward: Array
    motions: Array
    rank: NDArray[np.intp]
    serial: Mask
    parallel: Mask


def motion_spaces(linkage: Linkage, placement: Placement, length: Array) -> MotionSpaces:
    """Motion spaces at p poses.

    Drives that move at a standing tool are a serial singularity where a neighbouring pose has
    more tool motions (to second order), and redundancy where it has not.

    Parameters
    ----------
    linkage : Linkage
    placement : Placement
        One batch axis.
    length : (p,)
        Compares rotations with translations, m.
    """
    driven_mask = linkage.driven_mask()
    passive = constraint_rows(linkage, placement, linkage.elastic_or_locked() & ~driven_mask)
    drives = constraint_rows(linkage, placement, driven_mask)
    assert linkage.tool is not None
    body = int(linkage.body_of_node[linkage.node_index[linkage.tool]])
    # twists as (v, L ω) and rates as m/s, L rad/s
    unit = np.ones((len(length), 6))
    unit[:, 3:] = length[:, None]
    size = np.where(drives.direction < 3, 1.0, length[:, None])
    columns = np.tile(unit, len(linkage.body_names))
    rows = passive.on_bodies() / columns[:, None, :]
    norm = np.linalg.norm(rows, axis=-1, keepdims=True)
    rows = rows / np.where(norm == 0.0, 1.0, norm)
    null = null_space(rows, HELD * np.linalg.norm(rows, 2, axis=(-2, -1)) if rows.size else 0.0)
    tool = null[:, 6 * body : 6 * body + 6]
    rates = size[..., None] * (drives.on_bodies() / columns[:, None, :]) @ null
    left, values, right = np.linalg.svd(np.concatenate([tool, rates], axis=1), full_matrices=False)
    seen = values > HELD
    left = left * seen[:, None, :]
    cosines, sines = left[:, :6], left[:, 6:]
    u, c, w = np.linalg.svd(cosines, full_matrices=False)
    moving = c > MOVES
    rank = moving.sum(axis=-1)
    made = np.where(moving, 1.0 / np.where(moving, c, 1.0), 0.0)
    inverse = sines @ (np.swapaxes(w, -1, -2) * made[:, None, :]) @ np.swapaxes(u, -1, -2)
    y, s, z = np.linalg.svd(sines)
    count = seen.sum(axis=-1)
    holding = s > MOVES
    parallel = holding.sum(axis=-1) < count
    k = s.shape[-1]
    solved = (
        np.swapaxes(z[:, :k], -1, -2)
        * np.where(holding, 1.0 / np.where(holding, s, 1), 0.0)[:, None, :]
    )
    forward = cosines @ solved @ np.swapaxes(y[..., :k], -1, -2)
    serial = np.zeros(len(length), dtype=bool)
    spare = (count > rank) & (rank < 6)
    if spare.any():
        back = (
            np.swapaxes(right, -1, -2)
            * np.where(seen, 1.0 / np.where(seen, values, 1), 0.0)[:, None, :]
        )
        standing = _standing(cosines[spare], seen[spare])
        lost = lost_twists(
            passive[spare], null[spare], (null @ back)[spare] @ standing, body, columns[spare]
        )
        # what the tool can still do is not lost
        kept = u[spare] * moving[spare][:, None, :]
        lost = lost - kept @ (np.swapaxes(kept, -1, -2) @ lost)
        direction = np.linalg.norm(lost, axis=-1) > 1e-7
        drive = np.linalg.norm(sines[spare] @ standing, axis=-1) > 1e-9
        serial[spare] = direction.any(axis=-1) & drive.any(axis=-1)
        endless = drive[:, :, None] & direction[:, None, :]
        inverse[spare] = np.where(endless, np.inf, inverse[spare])
    loose = _loose(cosines, z, s, seen)
    forward = np.where(loose[..., None], np.inf, forward)
    motions = np.zeros((len(length), 6, 6))
    plain = u * moving[:, None, :] / unit[:, :, None]
    basis, _, _ = np.linalg.svd(plain)
    motions = basis * (np.arange(6) < rank[:, None])[:, None, :]
    return MotionSpaces(
        inverse / size[..., None] * unit[:, None, :],
        forward / unit[..., None] * size[:, None, :],
        motions,
        rank,
        serial,
        parallel,
    )


def null_space(rows: Array, tolerance: Array | float) -> Array:
    """Null space of a stack of matrices, (p, r, n) to (p, n, n): unit columns, the rest zero.

    Columns are blanked instead of cut, so that poses of different rank stay one stack. Singular
    values of at most `tolerance`, (p,), count as zero.
    """
    _, values, right = np.linalg.svd(rows)
    held = np.zeros(right.shape[:-1], dtype=bool)
    if values.shape[-1]:
        held[:, : values.shape[-1]] = values > np.broadcast_to(tolerance, len(rows))[:, None]
    return np.swapaxes(np.where(held[..., None], 0.0, right), -1, -2)


def _standing(cosines: Array, seen: Mask) -> Array:
    """Motions in which a drive moves and the tool stands, columns (p, r, r), the rest zero."""
    # unseen coordinates are held by rows of their own, so that they are not taken for motions
    held = np.eye(seen.shape[-1]) * ~seen[:, None, :]
    return null_space(np.concatenate([cosines, held], axis=1), MOVES)


def _loose(cosines: Array, right: Array, values: Array, seen: Mask) -> Mask:
    """Parts of the tool's twist that move at standing drives, (p, 6)."""
    still = np.ones(right.shape[:-1], dtype=bool)
    still[:, : values.shape[-1]] = values <= MOVES
    free = np.swapaxes(right * still[..., None], -1, -2) * seen[..., None]
    return np.asarray(np.linalg.norm(cosines @ free, axis=-1) > 1e-9)
