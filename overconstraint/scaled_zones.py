"""Worst case as a function of the tolerances' sizes: convex, and known by its cuts.

With every tolerance s scaled by tₛ, a quantity's worst case is the largest over directions e of
e·mean + Σ tₛ aₛ(e), aₛ(e) the support of the tolerance's zones in Gᵀe. Each direction gives a
linear function of t that the worst case never falls below: a cut.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.overconstraint.responses import Responses
from strutwork.overconstraint.worst_case import WorstCase, worst_case

Array = NDArray[Any]

#: Certificate of the worst case at scaled sizes.
CERTIFICATE = 1e-10

#: Share of a limit that is aimed at: within this and the certificate the limit is held.
AIM = 1 - 5e-10

#: Newton steps along a ray at most.
ROUNDS = 60


@dataclass(frozen=True)
class Cuts:
    """Lower bounds of quantities over limits: offset + rows·t.

    Parameters
    ----------
    rows : (m, t)
        Per unit scale, no unit; not negative.
    offset : (m,)
        Of the zones' middles, no unit.
    """

    rows: Array
    offset: Array

    def joined(self, other: Cuts) -> Cuts:
        """Both together.

        Parameters
        ----------
        other : Cuts
        """
        return Cuts(
            np.concatenate([self.rows, other.rows]), np.concatenate([self.offset, other.offset])
        )

    def kept(self, which: Array) -> Cuts:
        """Some of them.

        Parameters
        ----------
        which : (k,) or (m,) of bool
            Indices, or a mask.
        """
        return Cuts(self.rows[which], self.offset[which])


@dataclass(frozen=True)
class ScaledZones:
    """Limited quantities under tolerances of changing size.

    Parameters
    ----------
    responses : Responses
        Of the limited quantities.
    limit : (q,)
        N, N·m, m or rad.
    low, high : (t,)
        Bounds of the scales, no unit; equal for a tolerance that stays.
    """

    responses: Responses
    limit: Array
    low: Array
    high: Array

    def at(self, scale: Array) -> Responses:
        """Responses with the zones scaled.

        Parameters
        ----------
        scale : (t,)
            Of the tolerances, no unit.
        """
        return scaled(self.responses, scale)

    def worst(self, scale: Array) -> tuple[WorstCase, Array]:
        """Worst case at a scale, and its bound over the limits as one row, (p q,).

        Parameters
        ----------
        scale : (t,)
            Of the tolerances, no unit.
        """
        found = worst_case(self.at(scale), CERTIFICATE)
        return found, (found.bound / self.limit).ravel()

    def cuts(self, direction: Array) -> Cuts:
        """Cuts in given directions, one row per direction.

        Parameters
        ----------
        direction : (..., q, 2)
            Unit vectors among the quantities' components.
        """
        sources = self.responses.sources
        pull = np.einsum("...qik,...qi->...qk", self.responses.gain, direction)
        belongs = np.eye(len(self.low))[sources.owner]
        parts = sources.supports(pull) @ belongs
        offset = np.einsum("...qi,...qi->...q", self.responses.mean, direction)
        return Cuts(
            (parts / self.limit[:, None]).reshape(-1, len(self.low)),
            (offset / self.limit).ravel(),
        )

    def first_cuts(self) -> Cuts:
        """Cuts in eight directions and at the worst case of the zones as they are."""
        turns = np.arange(8) * (np.pi / 4)
        shape = (*self.responses.gain.shape[:-2], 2)
        found = self.cuts(worst_case(self.responses, CERTIFICATE).direction)
        for e in np.stack([np.cos(turns), np.sin(turns)], axis=-1):
            found = found.joined(self.cuts(np.broadcast_to(e, shape)))
        return found.kept(np.any(found.rows > 0, axis=-1) | (found.offset > 0))

    def check_reachable(self) -> None:
        """Check that the limits are kept by the least sizes.

        Raises
        ------
        ModelError
            Names the joint, its limit, and the least force.
        """
        found, share = self.worst(self.low)
        if np.all(share < AIM):
            return
        first = int(np.argmax(share))
        q = first % len(self.limit)
        quantity = self.responses.quantities[q]
        least = found.value.ravel()[first]
        raise ModelError(
            f"limit of the {quantity.name}",
            f"{self.limit[q]:.6g} {quantity.unit} cannot be met: with every tolerance that may "
            f"change at its least, the worst case is still {least:.6g} {quantity.unit}.",
            "Raise the limit, lower the bounds, free a fixed tolerance, or move the middle of a "
            "zone that loads this joint.",
        )

    def along(self, ray: Array, cuts: Cuts) -> tuple[float, Cuts]:
        """Largest λ for which clip(λ ray, low, high) keeps all limits.

        Newton's method on a maximum of convex functions: each step solves the cuts known so far
        exactly, and so comes down to the root from above.

        Parameters
        ----------
        ray : (t,)
            Scales in proportion, no unit.
        cuts : Cuts
            Those known so far.

        Returns
        -------
        factor : float
            Infinite where no limit stops it.
        cuts : Cuts
            With those that were found on the way.

        Raises
        ------
        NumericalError
            It did not come down.
        """
        for _ in range(ROUNDS):
            factor = self.stop(ray, cuts, AIM)
            scale = self.clip(factor, ray)
            if not np.all(np.isfinite(scale)):
                return np.inf, cuts
            found, share = self.worst(scale)
            if np.all(share <= 1):
                return factor, cuts
            cuts = cuts.joined(self.cuts(found.direction).kept(share > AIM))
        raise NumericalError(
            "allocation",
            f"the worst case did not come down to its limit in {ROUNDS} steps.",
            "Give limits and sizes closer to one another.",
        )

    def clip(self, factor: float, ray: Array) -> Array:
        """Scales on the ray, within their bounds, (t,).

        Parameters
        ----------
        factor : float
            No unit.
        ray : (t,)
            Scales in proportion, no unit.
        """
        with np.errstate(invalid="ignore"):
            scale = np.where(ray > 0, factor * ray, 0.0)
        return np.clip(scale, self.low, self.high)

    def corners(self, ray: Array) -> Array:
        """Factors at which a scale meets a bound, ascending from zero, (c,).

        Parameters
        ----------
        ray : (t,)
            Scales in proportion, no unit.
        """
        ends = np.concatenate([self.low, self.high]) / np.concatenate([ray, ray])
        return np.unique(np.concatenate([[0.0], ends[np.isfinite(ends)]]))

    def stop(self, ray: Array, cuts: Cuts, share: float = 1.0) -> float:
        """Largest factor at which no cut is above a share of its limit: they rise in pieces.

        Parameters
        ----------
        ray : (t,)
            Scales in proportion, no unit.
        cuts : Cuts
        share : float
            Share of the limits that counts as reached.
        """
        corners = self.corners(ray)
        last = corners[-1]
        path = np.stack([*(self.clip(c, ray) for c in corners), self.clip(2 * last + 1, ray)])
        knots = np.append(corners, 2 * last + 1)
        height = cuts.rows @ path.T + cuts.offset[:, None] - share
        under = height <= 0
        # the first piece that ends above, taken on beyond the last knot
        piece = np.minimum(np.argmin(under, axis=1), len(knots) - 1)
        piece = np.where(under.all(axis=1), len(knots) - 1, np.maximum(piece, 1))
        row = np.arange(len(piece))
        rise = (height[row, piece] - height[row, piece - 1]) / (knots[piece] - knots[piece - 1])
        flat = rise <= 0
        stop = knots[piece - 1] - height[row, piece - 1] / np.where(flat, 1.0, rise)
        return float(np.min(np.where(flat, np.inf, stop), initial=np.inf))


def scaled(responses: Responses, scale: Array) -> Responses:
    """Responses whose tolerances' zones are scaled about their middles.

    Parameters
    ----------
    responses : Responses
    scale : (t,)
        Of each tolerance, no unit.
    """
    weight = by_parameter(responses, scale)
    sources = responses.sources
    return replace(
        responses,
        gain=responses.gain * weight,
        sources=replace(sources, map=sources.map * weight),
    )


def by_parameter(responses: Responses, by_tolerance: Array) -> Array:
    """What belongs to tolerances, for each of the k parameters of their zones, (k, ...).

    Parameters
    ----------
    responses : Responses
    by_tolerance : (t, ...)
        Any unit.
    """
    blocks = responses.sources.blocks
    owner = np.repeat(responses.sources.owner, [block.shape.dimension for block in blocks])
    return np.asarray(by_tolerance)[owner]
