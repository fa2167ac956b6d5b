"""Distribution of every quantity when the tolerances fall as they do in a workshop."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.overconstraint.limits import Limits, limit_vector
from strutwork.overconstraint.responses import Responses
from strutwork.overconstraint.sampling import SCRAMBLES, draw, points_per_scramble, uniform_numbers
from strutwork.overconstraint.spread import BINS, Spread
from strutwork.overconstraint.tally import Tally
from strutwork.overconstraint.worst_case import WorstCase, worst_case

Array = NDArray[Any]

#: Of the intervals about the quantiles.
LEVEL = 0.95

#: Fine cells per bin at most; what a quantile's place is known to.
FINENESS = 256

#: Fine cells of all variables together at most: 64 MB.
CELLS = 2**23

#: Numbers of a chunk: it stays in the cache.
CHUNK = 2**18

#: What rounding may add to the exact worst case, as a share of it.
ROUNDING = 1e-9

SEED = 2002


@dataclass(frozen=True)
class Distribution:
    """Sampled distribution of every quantity of some responses.

    Parameters
    ----------
    responses : Responses
    shares : tuple of float
        Shares of the assemblies that do not exceed the quantiles.
    values : Spread
        Of the quantities, (..., q, ...); N, N·m, m or rad.
    utilisation : Spread or None
        Of the largest quantity over limit in each assembly, (...), where limits were given.
    method : str
    samples : int
    confidence : str
        What `low` and `high` say.
    resolution : float
        Width of a fine cell as a share of the worst case: quantiles and their bounds are known
        to this; all else is exact for the sample.
    """

    responses: Responses
    shares: tuple[float, ...]
    values: Spread
    utilisation: Spread | None
    method: str
    samples: int
    confidence: str
    resolution: float

    def __repr__(self) -> str:
        return (
            f"<Distribution: {len(self.responses.quantities)} quantities, {self.samples} samples, "
            f"{self.method}, batch {self.values.mean.shape[:-1]}, SI>"
        )

    def to_dict(self) -> dict[str, Any]:
        """Everything as lists, SI."""
        return {
            "quantities": [q.name for q in self.responses.quantities],
            "units": [q.unit for q in self.responses.quantities],
            "shares": list(self.shares),
            "method": self.method,
            "samples": self.samples,
            "confidence": self.confidence,
            "values": self.values.to_dict(),
            "utilisation": self.utilisation.to_dict() if self.utilisation else None,
        }


def distribution(
    responses: Responses,
    samples: int = 100_000,
    method: str = "monte_carlo",
    seed: int = SEED,
    quantiles: Sequence[float] = (0.5, 0.9, 0.95, 0.99, 0.999),
    worst: WorstCase | None = None,
    limits: Limits | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Distribution:
    """Sample the tolerances and the resulting quantities in chunks.

    Parameters
    ----------
    responses : Responses
        At a batch of poses all see the same samples. Memory does not grow with the samples.
    samples : int
        For quasi-Monte Carlo rounded up, to `SCRAMBLES` times a power of two.
    method : str
        "monte_carlo" or "quasi_monte_carlo" (scrambled Sobol' sequences).
    seed : int
    quantiles : sequence of float
        Shares between 0 and 1.
    worst : WorstCase, optional
        Of these responses, if it is known.
    limits : mapping of (joint, kind) to float, optional
        For the distribution of the utilisation, the largest of quantity over limit in each
        assembly: what share of the assemblies keeps all limits at once.
    progress : callable, optional
        Called with (samples done, samples in all).

    Returns
    -------
    Distribution
        Confidence of Monte Carlo's quantiles by order statistics, free of any assumption on
        the distribution (David and Nagaraja, Order Statistics, 7.1), of quasi-Monte Carlo's
        by Student's t over the independent scrambles.

    Raises
    ------
    ModelError
        An unknown method, no samples, a share that is none, too many poses, or as `limits`.
    NumericalError
        A sample beyond the exact worst case.
    """
    shares = tuple(float(share) for share in quantiles)
    if not all(0 < share < 1 for share in shares) or not shares:
        raise ModelError("quantiles", f"they are {shares}.", "Give shares between 0 and 1.")
    worst = worst_case(responses) if worst is None else worst
    weight = None if limits is None else 1 / limit_vector(responses, limits)
    variables = _Variables.of(responses, worst, weight)
    fineness = min(FINENESS, CELLS // (BINS * len(variables.span)))
    if fineness < 4:
        raise ModelError(
            "distribution",
            f"{len(variables.span)} quantities at all poses are too many at once.",
            "Use fewer poses at a time.",
        )
    spread_out = 2 ** int(np.log2(fineness)) * BINS
    chunk = 2 ** int(np.log2(max(64, CHUNK // len(variables.span))))
    quasi = method == "quasi_monte_carlo"
    total = SCRAMBLES * points_per_scramble(samples) if quasi else samples
    span = np.where(variables.span > 0, variables.span, 1.0)
    tallies: list[Tally] = []
    each: list[Array] = []
    done = 0
    parameters = responses.sources.parameters
    whole = Tally(span, spread_out)
    for scramble, uniform in uniform_numbers(method, parameters, samples, seed, chunk):
        if scramble == len(tallies):
            tallies.append(Tally(span, spread_out) if quasi else whole)
        tallies[scramble].add(variables.sample(draw(responses.sources, uniform)))
        done += len(uniform)
        if quasi and tallies[scramble].count == total // SCRAMBLES:
            each.append(tallies[scramble].quantile(np.array(shares)))
            whole.join(tallies[scramble])
        if progress is not None:
            progress(done, total)
    found = whole.quantile(np.array(shares))
    low, high = _over_scrambles(found, each, span) if quasi else _by_ranks(whole, shares)
    spread = Spread(
        found,
        low,
        high,
        whole.mean,
        whole.deviation,
        whole.largest,
        variables.span,
        whole.histogram(BINS),
    )
    values, utilisation = variables.split(spread)
    return Distribution(
        responses,
        shares,
        values,
        utilisation,
        method,
        total,
        f"{LEVEL:.0%} "
        + (f"over {SCRAMBLES} scrambles, Student's t" if quasi else "by order statistics"),
        1 / spread_out,
    )


@dataclass(frozen=True)
class _Variables:
    """The rows that are sampled: quantities at all poses, then the utilisation of each pose."""

    first: Array
    second: Array
    plane: NDArray[np.intp]
    mean: Array
    weight: Array | None
    batch: tuple[int, ...]
    span: Array

    @staticmethod
    def of(responses: Responses, worst: WorstCase, weight: Array | None) -> _Variables:
        batch = responses.gain.shape[:-3]
        count, k = int(np.prod(responses.gain.shape[:-2], dtype=int)), responses.gain.shape[-1]
        gain, mean = responses.gain.reshape(count, 2, k), responses.mean.reshape(count, 2)
        plane = np.flatnonzero(np.any(gain[:, 1], axis=-1) | (mean[:, 1] != 0))
        span = worst.bound.reshape(count)
        if weight is not None:
            span = np.concatenate([span, (worst.bound * weight).max(axis=-1).ravel()])
        return _Variables(gain[:, 0], gain[plane, 1], plane, mean, weight, batch, span)

    def sample(self, z: Array) -> Array:
        """Values of all rows, (v, n), from parameters (n, k)."""
        one = self.first @ z.T + self.mean[:, :1]
        np.abs(one, out=one)
        if self.plane.size:
            two = self.second @ z.T + self.mean[self.plane, 1:]
            one[self.plane] = np.sqrt(one[self.plane] ** 2 + two**2)
        if self.weight is not None:
            used = self.weight > 0
            by_pose = one.reshape(-1, len(self.weight), one.shape[-1])[:, used]
            share = (by_pose * self.weight[used, None]).max(axis=1)
            one = np.concatenate([one, share])
        beyond = one.max(axis=1) > self.span * (1 + ROUNDING)
        if np.any(beyond) or not np.all(np.isfinite(one)):
            raise NumericalError(
                "distribution",
                "a sample exceeds the exact worst case.",
                "Give the worst case of these responses, or leave it to be computed.",
            )
        return one

    def split(self, spread: Spread) -> tuple[Spread, Spread | None]:
        """The quantities' part and the utilisation's, in the shape of the batch."""
        count = len(self.first)
        fields = [getattr(spread, name) for name in Spread.__dataclass_fields__]
        each = count // max(int(np.prod(self.batch, dtype=int)), 1)
        values = Spread(*(f[:count].reshape(*self.batch, each, *f.shape[1:]) for f in fields))
        if self.weight is None:
            return values, None
        return values, Spread(*(f[count:].reshape((*self.batch, *f.shape[1:])) for f in fields))


def _by_ranks(tally: Tally, shares: Sequence[float]) -> tuple[Array, Array]:
    """Order statistics between which each quantile lies at `LEVEL`, whatever the distribution."""
    # read when asked for: statistics take longer to load than all else that a command needs
    from scipy.stats import binom  # noqa: PLC0415

    tail = (1 - LEVEL) / 2
    n = tally.count
    low = binom.ppf(tail, n, shares).astype(np.intp)
    high = binom.ppf(1 - tail, n, shares).astype(np.intp) + 1
    return tally.between(low, upper=False), tally.between(high, upper=True)


def _over_scrambles(found: Array, each: list[Array], span: Array) -> tuple[Array, Array]:
    """Student's t over estimates that do not know each other."""
    # read when asked for: statistics take longer to load than all else that a command needs
    from scipy.stats import t as student  # noqa: PLC0415

    scatter = np.std(each, axis=0, ddof=1) / np.sqrt(len(each))
    half = student.ppf((1 + LEVEL) / 2, len(each) - 1) * scatter
    return np.maximum(found - half, 0.0), np.minimum(found + half, span[:, None])
