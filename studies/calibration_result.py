"""What a calibration by measurements gives: values with intervals, and how well they agree."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import isfinite, sqrt
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.studies.experiment import Experiment
from strutwork.studies.identifiability import Identifiability
from strutwork.studies.measurement import at_words
from strutwork.studies.undetermined import Undetermined

if TYPE_CHECKING:
    from strutwork.machines.model import Model

Array = NDArray[Any]

#: Deviations to either side of the middle 95 % of a normal distribution.
NINETY_FIVE = 1.959963984540054

#: A chi squared rarer than this says that the scatter stated is not the scatter there is.
RARE = 0.05

Verdict = Literal["identifiable", "not identifiable", "at its bound"]


@dataclass(frozen=True)
class Found:
    """One number that was looked for.

    Parameters
    ----------
    name, unit, meaning : str
    value, guess : float
        In `unit`, any unit.
    low, high : float
        The bounds, any unit.
    deviation : float
        Standard deviation of the scaled number, no unit; infinite where nothing determines it.
    interval : (float, float) or None
        95 % confidence interval, any unit; None where there is none.
    verdict : "identifiable", "not identifiable" or "at its bound"
    prior : bool
        Whether what was known before takes part.
    """

    name: str
    unit: str
    meaning: str
    value: float
    guess: float
    low: float
    high: float
    deviation: float
    interval: tuple[float, float] | None
    verdict: Verdict
    prior: bool

    @property
    def ratio(self) -> float:
        """The value as a share of the first guess, no unit; not a number for a guess of zero."""
        return self.value / self.guess if self.guess else float("nan")

    def to_dict(self) -> dict[str, Any]:
        """Plain values; None where a number does not exist."""
        return {
            **{k: v for k, v in vars(self).items() if k not in ("deviation", "interval")},
            "ratio": self.ratio if isfinite(self.ratio) else None,
            "interval": None if self.interval is None else list(self.interval),
        }


@dataclass(frozen=True)
class Agreement:
    """How a measurement agrees with the model.

    Parameters
    ----------
    name, kind, pose : str
    labels : tuple of t str
    unit : str
    measured, scatter, before, after : (t,)
        In `unit`, any unit.
    """

    name: str
    kind: str
    pose: str
    labels: tuple[str, ...]
    unit: str
    measured: Array
    scatter: Array
    before: Array
    after: Array

    def rms(self, computed: Array) -> float:
        """Root mean square of the residuals in scatters, no unit.

        Parameters
        ----------
        computed : (t,)
            `before` or `after`, any unit.
        """
        return float(np.sqrt(np.mean(((computed - self.measured) / self.scatter) ** 2)))

    def to_dict(self) -> dict[str, Any]:
        """Plain values."""
        numbers = ("measured", "scatter", "before", "after")
        return {
            "name": self.name,
            "kind": self.kind,
            "pose": self.pose,
            "labels": list(self.labels),
            "unit": self.unit,
            **{k: getattr(self, k).tolist() for k in numbers},
            "rms_before": self.rms(self.before),
            "rms_after": self.rms(self.after),
        }


@dataclass(frozen=True, repr=False)
class MachineCalibration:
    """What a calibration by measurements gives.

    Parameters
    ----------
    experiment : Experiment
    point : (g,)
        Best scaled numbers, no unit.
    found : tuple of g Found
    agreements : tuple of Agreement
    identified : Identifiability
        What the measurements determine without what was known before, at the best numbers.
    undetermined : tuple of Undetermined
    costs : (s,)
        Half the sum of squared residuals at the end of each start, no unit; infinite where one
        failed.
    notes : tuple of str
    failures : tuple of str
        Why starts failed.
    """

    experiment: Experiment
    point: Array
    found: tuple[Found, ...]
    agreements: tuple[Agreement, ...]
    identified: Identifiability
    undetermined: tuple[Undetermined, ...]
    costs: Array
    notes: tuple[str, ...] = ()
    failures: tuple[str, ...] = ()

    def __repr__(self) -> str:
        known = sum(f.verdict == "identifiable" for f in self.found)
        return (
            f"<MachineCalibration: {known} of {len(self.found)} parameters identifiable, chi "
            f"squared {self.chi_squared:.4g} for {self.freedom} degrees of freedom>"
        )

    @property
    def values(self) -> dict[str, float]:
        """Values by the names of the parameters, each in its SI unit."""
        return {f.name: f.value for f in self.found}

    @property
    def numbers(self) -> dict[str, float]:
        """Every calibrated number of the machine by its path, SI."""
        return self.experiment.numbers(np.array([f.value for f in self.found]))

    @property
    def model(self) -> Model:
        """The calibrated machine, at home."""
        return self.experiment.machine.model(self.numbers)

    @cached_property
    def chi_squared(self) -> float:
        """Sum of the squared residuals of the measurements."""
        return float(sum(len(a.measured) * a.rms(a.after) ** 2 for a in self.agreements))

    @property
    def freedom(self) -> int:
        """Measured numbers less combinations that were fitted to them."""
        return self.experiment.count - self.identified.rank

    @property
    def probability(self) -> float | None:
        """Of a chi squared so large if the scatter is as stated; None without freedom."""
        if self.freedom < 1:
            return None
        from scipy.stats import chi2  # noqa: PLC0415 - slow to load

        return float(chi2.sf(self.chi_squared, self.freedom))

    @property
    def scatter_words(self) -> str:
        """Whether the stated scatter agrees with that of the residuals."""
        p = self.probability
        if p is None:
            return (
                "There are no more measured numbers than combinations fitted to them, so that the "
                "residuals say nothing about the scatter."
            )
        size = f"chi squared {self.chi_squared:.4g} for {self.freedom} degrees of freedom"
        factor = sqrt(self.chi_squared / self.freedom)
        if p < RARE / 2:
            return (
                f"The residuals are {factor:.2g} times as large as the stated scatter ({size}): "
                "the scatter is larger than stated, or the model lacks something. Intervals that "
                f"the residuals support are {factor:.2g} times as wide."
            )
        if p > 1 - RARE / 2:
            return (
                f"The residuals are {factor:.2g} times the stated scatter ({size}): the "
                "measurements are better than stated, and the intervals are wider than need be."
            )
        return f"The residuals agree with the stated scatter ({size})."

    def to_dict(self) -> dict[str, Any]:
        """Plain values; None where a number does not exist."""
        return {
            "calibration": self.experiment.source,
            "model": self.experiment.machine.title,
            "parameters": [f.to_dict() for f in self.found],
            "calibrated": self.numbers,
            "measurements": [a.to_dict() for a in self.agreements],
            "undetermined": [u.to_dict() for u in self.undetermined],
            "determined_combinations": self.identified.rank,
            "chi_squared": self.chi_squared,
            "degrees_of_freedom": self.freedom,
            "probability": self.probability,
            "scatter": self.scatter_words,
            "costs": [float(c) if isfinite(c) else None for c in self.costs],
            "notes": list(self.notes),
            "failures": list(self.failures),
        }


def agreements_of(experiment: Experiment, point: Array) -> tuple[Agreement, ...]:
    """How each measurement agrees at the first guess and at other numbers.

    Parameters
    ----------
    experiment : Experiment
    point : (g,)
        Scaled numbers, no unit.
    """
    before = experiment.computed(experiment.values(experiment.guess))
    after = experiment.computed(experiment.values(point))
    return tuple(
        Agreement(m.name, m.kind, at_words(m.task), m.labels, m.unit, m.values, m.scatter, b, a)
        for m, b, a in zip(experiment.measurements, before, after, strict=True)
    )
