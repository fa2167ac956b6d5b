"""Distributions of a parameter about what the machine states."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.machines.model_numbers import Number
from strutwork.names import choices, visible
from strutwork.units import NUMBER, quantity

Array = NDArray[Any]

DISTRIBUTIONS = ("normal", "lognormal", "uniform", "truncated")

#: Where a truncated normal distribution ends without a range, standard deviations.
CUT = 3.0

#: Quantiles of an unbounded distribution that the field of the number must allow.
ALLOWED = (0.01, 0.99)


@dataclass(frozen=True)
class Distribution:
    """The distribution of one number, or of the factor of several.

    Parameters
    ----------
    kind : str
        "normal"; "lognormal", of positive numbers; "uniform", between `low` and `high`;
        "truncated", normal between `low` and `high`.
    mean, deviation : float
        Mean and standard deviation, any unit; of a truncated one those before truncation.
    low, high : float
        Ends, any unit; infinite or zero where there are none.
    """

    kind: str
    mean: float
    deviation: float
    low: float
    high: float

    @cached_property
    def _law(self) -> Any:
        # SciPy's statistics take longer to load than a small study to run
        from scipy import stats  # noqa: PLC0415

        if self.kind == "uniform":
            return stats.uniform(self.low, self.high - self.low)
        if self.kind == "lognormal":
            shape = np.sqrt(np.log1p((self.deviation / self.mean) ** 2))
            return stats.lognorm(shape, scale=self.mean / np.exp(0.5 * shape**2))
        if self.kind == "normal":
            return stats.norm(self.mean, self.deviation)
        ends = [(end - self.mean) / self.deviation for end in (self.low, self.high)]
        return stats.truncnorm(*ends, loc=self.mean, scale=self.deviation)

    def at(self, share: Array) -> Array:
        """Values below which a share of all lies, (n,), any unit.

        Parameters
        ----------
        share : (n,)
            Between 0 and 1, no unit.
        """
        # the ends of an unbounded distribution are infinite
        inner = np.clip(share, 2.0**-53, 1.0 - 2.0**-53)
        return np.asarray(self._law.ppf(inner), dtype=float)

    @property
    def middle(self) -> float:
        """Mean of its values, any unit."""
        return float(self._law.mean())

    @property
    def spread(self) -> float:
        """Standard deviation of its values, any unit."""
        return float(self._law.std())

    @property
    def settings(self) -> dict[str, Any]:
        """What it is, as plain values."""
        return {k: v if isinstance(v, str) or np.isfinite(v) else None for k, v in _dict(self)}


def _dict(law: Distribution) -> list[tuple[str, Any]]:
    return list(asdict(law).items())


def is_share(scatter: object) -> bool:
    """Whether a scatter is a share of the mean, as "10 %".

    Parameters
    ----------
    scatter : object
    """
    return isinstance(scatter, str) and scatter.strip().endswith("%")


def distribution(
    part: str,
    kind: str,
    numbers: Sequence[Number],
    stated: Sequence[object],
    *,
    relative: bool,
) -> Distribution:
    """The distribution of numbers that change together.

    Parameters
    ----------
    part : str
        For messages.
    kind : str
        Of `DISTRIBUTIONS`.
    numbers : sequence of Number
        Of one value each where they are not changed by a factor.
    stated : (mean, scatter, low, high)
        As the study states them; None where it does not. Scatter is the standard deviation, of a
        uniform distribution half its width, and may be a share of the mean: "10 %".
    relative : bool
        The distribution is that of a factor, 1 by default.

    Raises
    ------
    ModelError
        An unknown kind, no scatter, one that is no positive number, ends that the kind does not
        take, or values that the field of a number does not allow.
    UnitError
        Another dimension.
    """
    mean, scatter, low, high = stated
    if kind not in DISTRIBUTIONS:
        raise ModelError(
            part,
            f'has the unknown distribution "{visible(kind)}".',
            choices("Distributions", kind, DISTRIBUTIONS),
        )

    def read(value: Any) -> float:
        return quantity(value, NUMBER, part) if relative else numbers[0].read(value)

    ranged = low is not None and high is not None
    if ranged and kind in ("normal", "lognormal"):
        raise ModelError(
            part,
            f"has a range, and its distribution is {kind}.",
            'Leave one of them out, or choose distribution = "truncated".',
        )
    ends = (read(low), read(high)) if ranged else None
    if ends is not None and not ends[0] < ends[1]:
        raise ModelError(
            part, f"has a range from {ends[0]:g} to {ends[1]:g}.", "Give the lower end first."
        )
    if kind == "uniform" and ends is not None:
        if scatter is not None or mean is not None:
            raise ModelError(
                part,
                "has a range beside a mean or scatter.",
                "Give the range alone, or the scatter.",
            )
        law = Distribution(kind, sum(ends) / 2.0, (ends[1] - ends[0]) / 12.0**0.5, *ends)
    else:
        centre = 1.0 if relative else numbers[0].value
        if mean is not None:
            centre = read(mean)
        law = _about(part, kind, centre, _scatter(part, numbers, scatter, centre, relative), ends)
    _require_allowed(part, law, numbers, relative=relative)
    return law


def _scatter(
    part: str, numbers: Sequence[Number], scatter: object, centre: float, relative: bool
) -> float:
    remedy = 'Give scatter = "10 %" of the mean, or a value with its unit.'
    if scatter is None:
        raise ModelError(part, "has a distribution without scatter.", remedy)
    if is_share(scatter):
        share = quantity(scatter, NUMBER, part)
        if not centre:
            raise ModelError(
                part,
                f"scatters by a share of {visible(numbers[0].path)}, which is 0.",
                "Give the scatter with its unit.",
            )
        found = share * abs(centre)
    elif relative:
        found = quantity(scatter, NUMBER, part)
    else:
        found = float(numbers[0].read(scatter))
    if not found > 0.0:
        raise ModelError(part, f"has the scatter {visible(str(scatter))}.", f"{remedy} Above 0.")
    return found


def _about(
    part: str, kind: str, centre: float, scatter: float, ends: tuple[float, float] | None
) -> Distribution:
    if kind == "uniform":
        return Distribution(kind, centre, scatter / 3.0**0.5, centre - scatter, centre + scatter)
    if kind == "normal":
        return Distribution(kind, centre, scatter, -np.inf, np.inf)
    if kind == "lognormal":
        if centre <= 0.0:
            raise ModelError(
                part,
                f"has a lognormal distribution about {centre:g}.",
                'A lognormal number is positive: choose distribution = "normal".',
            )
        return Distribution(kind, centre, scatter, 0.0, np.inf)
    low, high = ends or (centre - CUT * scatter, centre + CUT * scatter)
    law = Distribution(kind, centre, scatter, low, high)
    if low > centre + 6.0 * scatter or high < centre - 6.0 * scatter:
        raise ModelError(
            part,
            f"is truncated to {low:g} to {high:g}, more than six standard deviations from its mean "
            f"{centre:g}.",
            "Give a range around the mean.",
        )
    return law


def _require_allowed(
    part: str, law: Distribution, numbers: Sequence[Number], *, relative: bool
) -> None:
    """The field of each number allows its values: all of a bounded one, nearly all of another."""
    bounded = law.kind in ("uniform", "truncated")
    ends = (law.low, law.high) if bounded else law.at(np.array(ALLOWED)).tolist()
    for number in numbers:
        for end in ends:
            try:
                number.read(number.value * end if relative else end)
            except ModelError as error:
                which = "reaches" if bounded else "has more than one percent of its values beyond"
                raise ModelError(
                    part,
                    f"{which} {end:.6g}{' times its value' if relative else ''}: {error.problem}",
                    f'{error.remedy} A smaller scatter, "truncated" or "lognormal" stays within.',
                ) from None
