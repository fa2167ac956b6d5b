"""What tool and drives can do at a pose, by rank: freedoms, redundancy and singularities."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.rows import constraint_rows
from strutwork.kinematics.second_order import lost_twists

Array = NDArray[Any]
Mask = NDArray[np.bool_]

#: Passive rows whose singular values are below this share of the largest hold nothing.
HELD = 1e-10

#: Part that the tool, or the drives, have in a motion of unit size before they count as moving.
MOVES = 1e-11

#: Part that a direction of the tool, or a drive, has in what is lost before it counts.
LOST = 1e-7


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
        Least rates per tool twist, m/s or rad/s per m/s and rad/s; infinite in directions that are
        lost.
    forward : (p, 6, a)
        Tool twist per rate, m/s and rad/s per m/s or rad/s; infinite where the tool moves at
        standing drives.
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
    body = linkage.tool_body
    # twists as (v, L ω) and rates as m/s, L rad/s
    unit = np.ones((len(length), 6))
    unit[:, 3:] = length[:, None]
    size = np.where(drives.direction < 3, 1.0, length[:, None])
    columns = np.tile(unit, len(linkage.body_names))
    null = _allowed(passive.on_bodies() / columns[:, None, :])
    tool = null[:, 6 * body : 6 * body + 6]
    rates = size[..., None] * (drives.on_bodies() / columns[:, None, :]) @ null
    left, values, right = np.linalg.svd(np.concatenate([tool, rates], axis=1), full_matrices=False)
    seen = values > HELD
    left = left * seen[:, None, :]
    cosines, sines = left[:, :6], left[:, 6:]
    u, c, w = np.linalg.svd(cosines, full_matrices=False)
    moving = c > MOVES
    rank = moving.sum(axis=-1)
    inverse = sines @ _transposed(w) @ (_inverted(c, MOVES)[..., None] * _transposed(u))
    y, s, z = np.linalg.svd(sines)
    k = s.shape[-1]
    parallel = (s > MOVES).sum(axis=-1) < seen.sum(axis=-1)
    solved = _transposed(z[:, :k]) @ (_inverted(s, MOVES)[..., None] * _transposed(y[..., :k]))
    forward = np.where(_loose(cosines, z, s, seen)[..., None], np.inf, cosines @ solved)
    serial = np.zeros(len(length), dtype=bool)
    spare = (seen.sum(axis=-1) > rank) & (rank < 6)
    if spare.any():
        standing = _standing(cosines[spare], seen[spare])
        back = _transposed(right[spare]) @ (_inverted(values, HELD)[spare][..., None] * standing)
        # what the tool can still do is not lost
        kept = u[spare] * moving[spare][:, None, :]
        lost = lost_twists(passive[spare], null[spare], null[spare] @ back, body, columns[spare])
        direction = np.linalg.norm(lost - kept @ (_transposed(kept) @ lost), axis=-1) > LOST
        drive = np.linalg.norm(sines[spare] @ standing, axis=-1) > LOST
        serial[spare] = direction.any(axis=-1) & drive.any(axis=-1)
        endless = drive[:, :, None] & direction[:, None, :]
        inverse[spare] = np.where(endless, np.inf, inverse[spare])
    basis, _, _ = np.linalg.svd(u * moving[:, None, :] / unit[:, :, None])
    return MotionSpaces(
        inverse / size[..., None] * unit[:, None, :],
        forward / unit[..., None] * size[:, None, :],
        basis * (np.arange(6) < rank[:, None])[:, None, :],
        rank,
        serial,
        parallel,
    )


def _transposed(matrices: Array) -> Array:
    return np.swapaxes(matrices, -1, -2)


def _inverted(values: Array, limit: float) -> Array:
    """One over singular values; zero where they count as zero."""
    return np.where(values > limit, 1.0 / np.where(values > limit, values, 1.0), 0.0)


def _allowed(rows: Array) -> Array:
    """Motions of all bodies that the passive rows allow, (p, n, n)."""
    norm = np.linalg.norm(rows, axis=-1, keepdims=True)
    return null_space(rows / np.where(norm == 0.0, 1.0, norm), share=HELD)


def null_space(rows: Array, tolerance: Array | float = 0.0, *, share: float = 0.0) -> Array:
    """Null space of a stack of matrices, (p, r, n) to (p, n, n): unit columns, the rest zero.

    Columns are blanked instead of cut, so that poses of different rank stay one stack.

    Parameters
    ----------
    rows : (p, r, n)
        In any unit, one for all.
    tolerance : (p,) or float
        Singular values of at most this count as zero, same unit as the rows.
    share : float
        So do those of at most this share of the matrix's largest.
    """
    values, right = _decomposed(rows)
    held = np.zeros(right.shape[:-1], dtype=bool)
    if values.shape[-1]:
        limit = np.maximum(np.broadcast_to(tolerance, len(rows)), share * values[:, 0])
        held[:, : values.shape[-1]] = values > limit[:, None]
    return np.swapaxes(np.where(held[..., None], 0.0, right), -1, -2)


def _decomposed(rows: Array) -> tuple[Array, Array]:
    """Singular values and right singular vectors of a stack.

    The method by halves is fast and does not converge for some matrices of low rank; these are
    done by the older one.
    """
    try:
        _, values, right = np.linalg.svd(rows)
    except np.linalg.LinAlgError:
        if len(rows) > 1:
            each = [_decomposed(one[None]) for one in rows]
            return np.concatenate([v for v, _ in each]), np.concatenate([r for _, r in each])
        from scipy import linalg  # noqa: PLC0415 - for the rare matrix that needs it

        _, value, vectors = linalg.svd(rows[0], lapack_driver="gesvd")
        return value[None], vectors[None]
    return values, right


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
