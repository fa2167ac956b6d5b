"""Share of assemblies that keep their limits, as a function of the tolerances' sizes.

On a ray of sizes a quantity's components are linear in the factor, so that each sampled assembly
keeps its limits on an interval of factors, by roots of quadratics: the largest factor at which a
share of the sample does is exact, by sorting.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.overconstraint.sampling import draw, uniform_numbers
from strutwork.overconstraint.scaled_zones import ScaledZones, by_parameter

Array = NDArray[Any]

#: Numbers of a chunk.
CHUNK = 2**19

#: Share of the sample about a quantile that its slope is averaged over, and no fewer than so many.
WINDOW = (0.005, 200)


@dataclass(frozen=True)
class SampledZones:
    """Limited quantities under sampled tolerances of changing size.

    Parameters
    ----------
    zones : ScaledZones
    share : float
        Share of the assemblies that keep all limits, at all poses.
    samples, seed : int
    """

    zones: ScaledZones
    share: float
    samples: int
    seed: int

    def along(self, ray: Array) -> float:
        """Largest λ at which clip(λ ray, low, high) lets the share of the sample keep all limits.

        Parameters
        ----------
        ray : (t,)
            Scales in proportion, no unit; positive where a tolerance may change.

        Returns
        -------
        factor : float
            Infinite where no limit stops it.

        Raises
        ------
        ModelError
            Too few assemblies keep them at any λ.
        """
        corners = self.zones.corners(ray)
        ends = np.append(corners[1:], np.inf)
        for start, end in zip(corners[::-1], ends[::-1], strict=True):
            low, high = self._intervals(ray, start, end)
            factor = _largest(low, high, self.needed)
            if factor is not None:
                return factor
        raise ModelError(
            "limits",
            f"fewer than {self.share:.6g} of the assemblies meet them, even with every tolerance "
            "that may change at its least.",
            "Raise the limits, lower the bounds, or free a fixed tolerance.",
        )

    @property
    def needed(self) -> int:
        """Assemblies of the sample that have to keep their limits."""
        return int(np.ceil(self.share * self.samples - 1e-9))

    def utilisation(self, scale: Array) -> tuple[Array, NDArray[np.intp]]:
        """Largest quantity over limit of every assembly, (n,), and its row among (p q,).

        Parameters
        ----------
        scale : (t,)
            Of the tolerances, no unit.
        """
        gain, mean, limit = self._rows(by_parameter(self.zones.responses, scale))
        found, which = [], []
        for z in self._chunks():
            size = np.linalg.norm(_values(gain, z) + mean[..., None], axis=1) / limit[:, None]
            which.append(size.argmax(axis=0))
            found.append(size.max(axis=0))
        return np.concatenate(found), np.concatenate(which)

    def slopes(self, scale: Array) -> tuple[Array, Array]:
        """How the quantile of the utilisation grows with each scale, and what makes it.

        The mean slope of the assemblies about the quantile (Hong 2009, Theorem 2).

        Parameters
        ----------
        scale : (t,)
            Of the tolerances, no unit.

        Returns
        -------
        slopes : (t,)
        makes : (q,)
            Share of those assemblies in which the quantity is the largest over its limit.
        """
        size, which = self.utilisation(scale)
        width = max(int(WINDOW[0] * len(size)), min(WINDOW[1], len(size)))
        first = int(np.clip(self.needed - 1 - width // 2, 0, len(size) - width))
        near = np.sort(np.argsort(size, kind="stable")[first : first + width])
        z = self._chosen(near)
        weight = by_parameter(self.zones.responses, scale)
        gain, mean, limit = self._rows(np.ones_like(weight))
        gain, mean = gain[which[near]], mean[which[near]]
        value = np.einsum("nik,nk->ni", gain, weight * z) + mean
        e = value / np.maximum(np.linalg.norm(value, axis=-1), 1e-300)[:, None]
        pull = np.einsum("nik,ni->nk", gain, e) * z / limit[which[near], None]
        belongs = by_parameter(self.zones.responses, np.eye(len(scale)))
        quantity = which[near] % len(self.zones.limit)
        makes = np.bincount(quantity, minlength=len(self.zones.limit)) / width
        return (pull @ belongs).mean(axis=0), makes

    def _intervals(self, ray: Array, start: float, end: float) -> tuple[Array, Array]:
        """Factors between two corners at which each assembly keeps all limits; low > high: none."""
        zones = self.zones
        inside = start + 1.0 if np.isinf(end) else (start + end) / 2
        moves = (inside * ray > zones.low) & (inside * ray < zones.high)
        slope = np.where(moves, ray, 0.0)
        still = np.where(moves, 0.0, zones.clip(inside, ray))
        gain, mean, limit = self._rows(by_parameter(zones.responses, still))
        way, _, _ = self._rows(by_parameter(zones.responses, slope))
        low, high = [], []
        for z in self._chunks():
            at = _values(gain, z) + mean[..., None]
            along = _values(way, z)
            first, last = _roots(
                (along**2).sum(axis=1),
                (at * along).sum(axis=1),
                (at**2).sum(axis=1) - limit[:, None] ** 2,
            )
            low.append(np.maximum(first.max(axis=0), start))
            high.append(np.minimum(last.min(axis=0), end))
        return np.concatenate(low), np.concatenate(high)

    def _rows(self, weight: Array) -> tuple[Array, Array, Array]:
        """Gain, mean and limit of all quantities at all poses in one row."""
        responses = self.zones.responses
        k = responses.gain.shape[-1]
        mean = responses.mean.reshape(-1, 2)
        repeat = len(mean) // len(self.zones.limit)
        gain = (responses.gain * weight).reshape(-1, 2, k)
        return gain, mean, np.tile(self.zones.limit, repeat)

    def _size(self) -> int:
        rows = int(np.prod(self.zones.responses.mean.shape, dtype=int))
        return int(2 ** int(np.log2(max(64, CHUNK // rows))))

    def _chunks(self) -> Iterator[Array]:
        sources = self.zones.responses.sources
        stream = uniform_numbers(
            "monte_carlo", sources.parameters, self.samples, self.seed, self._size()
        )
        for _, uniform in stream:
            yield draw(sources, uniform)

    def _chosen(self, which: NDArray[np.intp]) -> Array:
        """Parameters of some assemblies, in order."""
        found, start = [], 0
        for z in self._chunks():
            ends = np.searchsorted(which, [start, start + len(z)])
            found.append(z[which[ends[0] : ends[1]] - start])
            start += len(z)
        return np.concatenate(found)


def _values(gain: Array, z: Array) -> Array:
    """Components of every row and sample, (q, 2, n)."""
    return np.asarray((gain.reshape(-1, gain.shape[-1]) @ z.T).reshape(*gain.shape[:2], len(z)))


def _roots(a: Array, b: Array, c: Array) -> tuple[Array, Array]:
    """Where a λ² + 2 b λ + c ≤ 0, a ≥ 0, without cancellation; first > last where nowhere."""
    inside = b**2 - a * c
    root = np.sqrt(np.maximum(inside, 0.0))
    flat = a <= 0
    safe = np.where(flat, 1.0, a)
    # of two roots one is found by division by a, the other by their product c/a
    sum_ = b + np.where(b > 0, root, -root)
    other = c / np.where(sum_ == 0, 1.0, -sum_)
    one = -sum_ / safe
    other = np.where(sum_ == 0, one, other)
    first, last = np.minimum(one, other), np.maximum(one, other)
    never = np.where(flat, c > 0, inside < 0)
    first = np.where(never, np.inf, np.where(flat, -np.inf, first))
    return first, np.where(never, -np.inf, np.where(flat, np.inf, last))


def _largest(low: Array, high: Array, needed: int) -> float | None:
    """Largest factor that lies in so many of the intervals, None if there is none."""
    real = low <= high
    starts, ends = np.sort(low[real]), np.sort(high[real])
    within = np.searchsorted(starts, ends, side="right") - np.searchsorted(ends, ends, side="left")
    enough = np.flatnonzero(within >= needed)
    return float(ends[enough[-1]]) if enough.size else None
