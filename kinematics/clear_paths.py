"""Where drives turn back along a path, and the longest straight path on which none does."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.drive_fields import DriveField
from strutwork.kinematics.reversal_points import Patch
from strutwork.kinematics.zero_lines import roots_between

Array = NDArray[Any]

#: A drive that moves less than this share of what such a path could ask of a drive stands still.
STILL = 1e-9

#: Samples along a straight path between which the signs are compared.
SAMPLES = 32

#: Nodes of Gauss's rule for the length of a path.
NODES = 16


@dataclass(frozen=True)
class PathReversals:
    """Where drives turn back along a path.

    Parameters
    ----------
    drives : (r,) of str
    places : (r, 2)
        Parameters, m or rad.
    along : (r,)
        Which piece of the path, from 0, and how far in it, no unit: 2.25 is a quarter along the
        third.
    signs : (s, n) of int
        Of the drives' speeds at the start of each piece, 0 for one that does not move on it.
    """

    drives: tuple[str, ...]
    places: Array
    along: Array
    signs: NDArray[np.int8]


@dataclass(frozen=True)
class ClearPath:
    """A straight path on which no drive turns back.

    Parameters
    ----------
    start, end : (2,)
        Parameters, m or rad.
    length : float
        Of the tool centre point, m; of the rotation vector, rad, where the path only turns.
    """

    start: Array
    end: Array
    length: float


def path_reversals(field: DriveField, points: ArrayLike, samples: int = SAMPLES) -> PathReversals:
    """Where drives turn back along straight pieces between points of the parameters.

    Parameters
    ----------
    field : DriveField
    points : (s + 1, 2)
        Corners of the path, m or rad as the field's parameters are.
    samples : int
        Of every piece: two reversals of one drive between two of them are not seen.

    Raises
    ------
    ModelError
        Fewer than two points, or one out of reach.
    """
    p = np.asarray(points, dtype=float)
    if p.ndim != 2 or p.shape[1] != 2 or len(p) < 2:
        raise ModelError("path", f"has the shape {p.shape}.", "Give two or more points (s + 1, 2).")
    speeds, at, owner, drive = _reversals(field, p[:-1], p[1:], samples)
    lost = np.isnan(speeds).any(axis=(1, 2))
    if lost.any():
        raise ModelError(
            "path",
            f"leaves the reach of the machine on its segment {int(lost.argmax()) + 1}.",
            "Keep it within the reach.",
        )
    start, end = (np.sign(speeds[:, k]).astype(np.int8) for k in (1, -2))
    # a drive may also turn back where two pieces meet
    corner = np.argwhere(start[1:] * end[:-1] < 0)
    owner = np.concatenate([owner, corner[:, 0] + 1])
    at = np.concatenate([at, np.zeros(len(corner))])
    drive = np.concatenate([drive, corner[:, 1]])
    order = np.argsort(owner + at, kind="stable")
    owner, at, drive = owner[order], at[order], drive[order]
    return PathReversals(
        tuple(field.drives[k] for k in drive),
        p[owner] + at[:, None] * (p[owner + 1] - p[owner]),
        owner + at,
        start,
    )


def longest_clear_path(
    field: DriveField,
    patch: Patch,
    ways: ArrayLike,
    moving: NDArray[np.intp],
    lines: int = 21,
) -> ClearPath | None:
    """Longest straight path on a patch on which no drive turns back.

    Parameters
    ----------
    field : DriveField
    patch : Patch
    ways : (w, 2)
        Directions of the parameters that are tried, of any length, m or rad as these are.
    moving : (a,) of int
        Drives that move on the patch; the others turn back nowhere.
    lines : int
        Evenly spaced lines along each way across the patch, its middle among them.

    Returns
    -------
    ClearPath or None
        None where no line lies within reach.
    """
    best: ClearPath | None = None
    for way in np.asarray(ways, dtype=float):
        low, high = _chords(patch, way, lines)
        speeds, at, owner, _ = _reversals(field, low, high, SAMPLES, moving)
        for n in np.flatnonzero(~np.isnan(speeds).any(axis=(1, 2))):
            stops = np.sort(np.concatenate([[0.0, 1.0], at[owner == n]]))
            starts, ends = stops[:-1], stops[1:]
            chord = high[n] - low[n]
            for a, b in zip(starts, ends, strict=True):
                if b > a:
                    path = (low[n] + a * chord, low[n] + b * chord)
                    length = _length(field, *path)
                    if best is None or length > best.length * (1 + 1e-9):
                        best = ClearPath(*path, length)
    return best


def _moves(speeds: Array, gradient: Array, way: Array) -> NDArray[np.bool_]:
    """Which drives move on each piece at all, (r, n).

    A drive that a way does not move has speeds of rounding alone, with signs of their own: they
    are small beside what the gradients could make of a way of that length.
    """
    foreseen = np.nanmax(np.abs(gradient), initial=0.0) * np.linalg.norm(way, axis=-1)
    return np.asarray(np.abs(speeds).max(axis=1) > STILL * foreseen[:, None])


def _reversals(
    field: DriveField,
    low: Array,
    high: Array,
    samples: int,
    moving: NDArray[np.intp] | None = None,
) -> tuple[Array, Array, NDArray[np.intp], NDArray[np.intp]]:
    """Speeds along pieces (r, s, n), 0 of what stands still; reversals' places, pieces, drives."""
    shares = np.linspace(0.0, 1.0, samples + 1)
    way = high - low
    points = low[:, None] + shares[:, None] * way[:, None]
    g = field.gradient(points.reshape(-1, 2)).reshape(*points.shape[:2], -1, 2)
    speeds = np.einsum("rsna,ra->rsn", g, way)
    # out of reach they stay not a number
    moves = _moves(speeds, g, way)
    if moving is not None:
        moves &= np.isin(np.arange(g.shape[2]), moving)
    still = ~moves[:, None] & ~np.isnan(speeds)
    speeds = np.where(still, 0.0, speeds)
    signs = np.sign(speeds)
    # a sample that hits a reversal has the sign that comes before it, so that none is counted
    # twice; a reversal at the very start is none
    for s in range(1, signs.shape[1]):
        signs[:, s] = np.where(signs[:, s] == 0, signs[:, s - 1], signs[:, s])
    owner, sample, drive = np.nonzero(signs[:, :-1] * signs[:, 1:] < 0)
    first, second = points[owner, sample], points[owner, sample + 1]

    def speed(p: Array, k: NDArray[np.intp]) -> Array:
        along = field.gradient(p)[np.arange(len(p)), drive[k]]
        return np.asarray((along * way[owner[k]]).sum(axis=-1))

    places = roots_between(speed, first, second)
    size = (way[owner] ** 2).sum(axis=-1)
    at = ((places - low[owner]) * way[owner]).sum(axis=-1) / np.where(size > 0, size, 1.0)
    return speeds, at, owner, drive


def _chords(patch: Patch, way: Array, lines: int) -> tuple[Array, Array]:
    """Pieces of parallel lines within the patch, (lines, 2) each."""
    corner, span = np.array([patch.u[0], patch.v[0]]), patch.span
    w = way / span
    w = w / np.linalg.norm(w)
    across = np.array([-w[1], w[0]])
    # in the unit square about its middle
    half = 0.5 * np.abs(across).sum()
    offsets = half * np.linspace(-1.0, 1.0, lines + 2)[1:-1]
    if min(np.abs(w)) < 1e-12 and lines > 1:
        offsets = half * np.linspace(-1.0, 1.0, lines)
    base = offsets[:, None] * across
    with np.errstate(divide="ignore"):
        ends = np.where(np.abs(w) < 1e-12, np.inf, np.abs(0.5 / w))
    shift = np.where(np.abs(w) < 1e-12, 0.0, base / np.where(w == 0.0, 1.0, w))
    low = (-ends - shift).max(axis=-1)
    high = (ends - shift).min(axis=-1)
    kept = high > low
    ends_of = [corner + (0.5 + (base + t[:, None] * w)[kept]) * span for t in (low, high)]
    return ends_of[0], ends_of[1]


def _length(field: DriveField, start: Array, end: Array) -> float:
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    points = start + 0.5 * (nodes[:, None] + 1.0) * (end - start)
    return float(0.5 * weights @ field.speed(points, end - start))
