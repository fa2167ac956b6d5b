"""The exact worst case over tolerance zones, with a certificate.

A quantity of one component is worst at the support function of the zones, a sum over them of
norms. One of two components, a radial force, is the largest of those over the directions e of
the plane: f(e) = e·mean + Σ h(Gᵀe). f is sublinear, so between two directions at which it is known
the quantity lies within the corner of their two support lines: an upper bound that shrinks
with the square of the angle between them. What is round in f, a disc that rolls inside the round
zones' images, is taken off first and added again, so that a force alike in every direction is
bounded as fast as any other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import NumericalError
from strutwork.overconstraint.responses import Responses
from strutwork.overconstraint.unit_sets import Ball, Disc

Array = NDArray[Any]

#: Directions at the start, around the whole circle.
STARTS = 48

#: Bisections at most; each divides the gap by four.
STEPS = 40


@dataclass(frozen=True)
class WorstCase:
    """Largest magnitude of every quantity that the tolerances allow.

    Parameters
    ----------
    responses : Responses
    value : (..., q)
        Reached by `parameters`; N, N·m, m or rad.
    bound : (..., q)
        No combination exceeds it; equal to `value` but for the tolerance of the certificate, in the
        same unit.
    direction : (..., q, 2)
        Unit vector of the worst force among the quantity's directions.
    parameters : (..., q, k)
        The worst z, no unit.
    shares : (..., q, t)
        What each tolerance adds to the worst value, as a share of it; they sum to one where the
        zones' middles cause nothing.
    """

    responses: Responses
    value: Array
    bound: Array
    direction: Array
    parameters: Array
    shares: Array

    def __repr__(self) -> str:
        return f"<WorstCase: {len(self.responses.quantities)} quantities, SI>"

    def misfits(self, quantity: int) -> Array:
        """The worst combination for a quantity, (..., g), in the order of the columns, m and rad.

        Parameters
        ----------
        quantity : int
            Its index among the responses' quantities.
        """
        sources = self.responses.sources
        z = self.parameters[..., quantity, :]
        return np.asarray(sources.mean + (sources.map @ z[..., None])[..., 0])


def worst_case(responses: Responses, tolerance: float = 1e-9) -> WorstCase:
    """Exact worst case of every quantity.

    Parameters
    ----------
    responses : Responses
    tolerance : float
        Largest gap between bound and value, as a share of the value.

    Returns
    -------
    WorstCase

    Raises
    ------
    NumericalError
        The bound did not come down to the value.
    """
    batch = responses.gain.shape[:-2]
    k = responses.gain.shape[-1]
    sources = responses.sources
    count = int(np.prod(batch, dtype=int))
    gain = responses.gain.reshape(count, 2, k)
    mean = responses.mean.reshape(count, 2)
    value, bound, direction = _largest(responses, gain, mean, tolerance)
    pull = np.einsum("qik,qi->qk", gain, direction)
    parts = sources.supports(pull)
    belongs = sources.owner[:, None] == np.arange(len(sources.tolerances))
    shares = (parts @ belongs) / np.where(value > 0, value, 1.0)[:, None]
    extreme = sources.extreme(pull)
    reached = np.linalg.norm(mean + np.einsum("qik,qk->qi", gain, extreme), axis=-1)
    # the corner that was pointed at may lie a little aside of the direction, and then further out
    value = np.maximum(value, reached)
    excess = bound - value
    if np.any(excess > tolerance * np.maximum(value, 1e-300) * (1 + 1e-6) + 1e-300):
        raise NumericalError(
            "worst case",
            f"its bound exceeds its value by {np.max(excess / np.maximum(value, 1e-300)):.2g}.",
            "Request a larger tolerance.",
        )
    return WorstCase(
        responses,
        value.reshape(batch),
        np.maximum(bound, value).reshape(batch),
        direction.reshape(*batch, 2),
        extreme.reshape(*batch, k),
        shares.reshape(*batch, len(sources.tolerances)),
    )


def _reach(responses: Responses, gain: Array, mean: Array, directions: Array) -> Array:
    """Values of f at directions (q, a, 2), (q, a)."""
    pull = directions @ gain
    return np.asarray(
        (directions @ mean[..., None])[..., 0] + responses.sources.supports(pull).sum(axis=-1)
    )


def _largest(
    responses: Responses, gain: Array, mean: Array, tolerance: float
) -> tuple[Array, Array, Array]:
    """Largest f over the circle, its upper bound and the direction, (q,), (q,), (q, 2)."""
    count = len(gain)
    line = ~np.any(gain[:, 1], axis=-1) & (mean[:, 1] == 0)
    value, bound = np.zeros(count), np.zeros(count)
    direction = np.tile([1.0, 0.0], (count, 1))
    if np.any(line):
        ends = np.array([[1.0, 0.0], [-1.0, 0.0]])
        reach = _reach(responses, gain[line], mean[line], np.broadcast_to(ends, (line.sum(), 2, 2)))
        first = reach.argmax(axis=-1)
        value[line] = bound[line] = reach[np.arange(len(reach)), first]
        direction[line] = ends[first]
    plane = np.flatnonzero(~line)
    if plane.size:
        value[plane], bound[plane], turn = _on_circle(
            responses, gain[plane], mean[plane], tolerance
        )
        direction[plane] = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    return value, bound, direction


def _on_circle(
    responses: Responses, gain: Array, mean: Array, tolerance: float
) -> tuple[Array, Array, Array]:
    """Branch and bound over arcs; value, bound and angle of each quantity."""
    count = len(gain)
    turns = np.linspace(0.0, 2 * np.pi, STARTS + 1)
    around = np.stack([np.cos(turns), np.sin(turns)], axis=-1)
    reach = _reach(responses, gain, mean, np.broadcast_to(around, (count, STARTS + 1, 2)))
    first = reach.argmax(axis=-1)
    best, at = reach[np.arange(count), first], turns[first]
    disc = _rolling_disc(responses, gain)
    owner = np.repeat(np.arange(count), STARTS)
    low, high = np.tile(turns[:-1], count), np.tile(turns[1:], count)
    f_low, f_high = reach[:, :-1].ravel(), reach[:, 1:].ravel()
    closed = np.zeros(count)
    for _ in range(STEPS):
        round_ = disc[owner]
        upper = round_ + _corner(f_low - round_, f_high - round_, high - low)
        open_ = upper > best[owner] * (1 + tolerance)
        np.maximum.at(closed, owner[~open_], upper[~open_])
        if not np.any(open_):
            return best, np.maximum(closed, best), at
        owner, low, high = owner[open_], low[open_], high[open_]
        f_low, f_high = f_low[open_], f_high[open_]
        middle = (low + high) / 2
        e = np.stack([np.cos(middle), np.sin(middle)], axis=-1)[:, None]
        f = _reach(responses, gain[owner], mean[owner], e)[:, 0]
        order = np.argsort(f)
        better = order[f[order] > best[owner[order]]]
        # ascending, so that the largest of a quantity is written last
        best[owner[better]], at[owner[better]] = f[better], middle[better]
        owner = np.concatenate([owner, owner])
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
        f_low, f_high = np.concatenate([f_low, f]), np.concatenate([f, f_high])
    round_ = disc[owner]
    np.maximum.at(closed, owner, round_ + _corner(f_low - round_, f_high - round_, high - low))
    return best, np.maximum(closed, best), at


def _rolling_disc(responses: Responses, gain: Array) -> Array:
    """Radius of a disc that rolls inside every quantity's set of forces, (q,).

    A disc or ball becomes an ellipse of half-axes a ≥ b, whose least radius of curvature is b²/a;
    those of a Minkowski sum add up (Schneider, Convex bodies, section 3.2).
    """
    radius = np.zeros(len(gain))
    for shape, _, index in responses.sources.by_shape:
        if isinstance(shape, Disc | Ball):
            axes = np.linalg.svd(np.moveaxis(gain[..., index], 1, -2), compute_uv=False)
            a, b = axes[..., 0], axes[..., 1]
            radius += (b**2 / np.where(a > 0, a, 1.0)).sum(axis=-1)
    return radius


def _corner(first: Array, second: Array, turn: Array) -> Array:
    """Distance of the corner of two support lines whose normals are `turn` apart.

    Where the corner does not lie between the normals, the farther line bounds the arc.
    """
    cosine, sine = np.cos(turn), np.sin(turn)
    beside = np.minimum(first, second) < np.maximum(first, second) * cosine
    # as a sum of squares, or narrow arcs would lose the bound to cancellation
    corner = np.hypot(first - second, 2 * np.sqrt(np.abs(first * second)) * np.sin(turn / 2)) / sine
    return np.where(
        beside, np.maximum(first, second), np.maximum(corner, np.maximum(first, second))
    )
