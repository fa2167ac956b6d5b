"""Statistics of a stiffness map: mean, spread, quantiles, best and worst pose."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.studies.check_points import area_weights
from strutwork.studies.filters import PoseStatus

Array = NDArray[Any]
Meaning = Literal["blocked", "free"]
Weights = Literal["points", "area"]

QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)


@dataclass(frozen=True)
class PoseValue:
    """A value and its pose.

    Parameters
    ----------
    index : int
        Of the point or pose in its dataset.
    value : float
        N/m or N·m/rad.
    position : tuple of float
        m.
    roll : float or None
        rad; None where the dataset has no rolls.
    """

    index: int
    value: float
    position: tuple[float, ...]
    roll: float | None


@dataclass(frozen=True)
class Statistics:
    """Statistics of a sample.

    Parameters
    ----------
    count : int
    mean : float
        In the values' own unit.
    variance : float
        In the square of their unit; of the population: divided by n, or by n − 1 if `sample`; with
        weights, the weighted mean of squared deviations.
    standard_deviation : float
        Root of `variance`, in their unit.
    quantiles : tuple of float
        At `QUANTILES`: 5, 25, 50, 75 and 95 %; in their unit.
    sample : bool
        Whether `variance` is the sample's.
    """

    count: int
    mean: float
    variance: float
    standard_deviation: float
    quantiles: tuple[float, ...]
    sample: bool = False


def statistics(
    values: ArrayLike, weights: ArrayLike | None = None, sample: bool = False
) -> Statistics:
    """Statistics of a sample.

    Parameters
    ----------
    values : (n,)
        Any unit. Positive infinity, a direction that is locked, makes mean and variance infinite;
        quantiles are then values of the sample.
    weights : (n,), optional
        Not negative, any unit. Without, every value counts once and quantiles are interpolated;
        with, a quantile is the first value at which the weights reach its share.
    sample : bool
        Variance with n − 1; not with weights.

    Returns
    -------
    Statistics

    Raises
    ------
    ModelError
        No values, values that are not finite, wrong weights, or one value for a sample's
        variance.
    """
    x = np.asarray(values, dtype=float)
    if x.ndim != 1 or not x.size or np.any(np.isnan(x) | np.isneginf(x)):
        raise ModelError(
            "statistics", "of no values, or of values that are not numbers.", "Remove the rest."
        )
    stiff = bool(np.any(np.isinf(x)))
    if weights is None:
        if sample and x.size < 2:
            raise ModelError("statistics", "a sample of one.", "Use the population's variance.")
        variance = np.inf if stiff else float(x.var(ddof=1 if sample else 0))
        # between a finite value and an infinite one nothing can be interpolated
        quantiles = np.quantile(x, QUANTILES, method="inverted_cdf" if stiff else "linear")
        mean = float(x.mean())
    else:
        w = np.asarray(weights, dtype=float)
        if w.shape != x.shape or not np.all(w >= 0) or not 0 < w.sum() < np.inf or sample:
            raise ModelError(
                "statistics",
                "the weights are not one per value, negative, all zero, or go with a sample.",
                "Give finite weights that are not negative, and the population's variance.",
            )
        # what weighs nothing takes no part, however stiff
        part, share = x[w > 0], w[w > 0]
        mean = float(np.average(part, weights=share))
        variance = np.inf
        if np.isfinite(mean):
            variance = float(np.average((part - mean) ** 2, weights=share))
        quantiles = np.quantile(x, QUANTILES, weights=w, method="inverted_cdf")
    return Statistics(
        x.size, mean, variance, variance**0.5, tuple(float(q) for q in quantiles), sample
    )


@dataclass(frozen=True)
class AxisSummary:
    """Stiffness along one direction over a map.

    Parameters
    ----------
    direction : str
    unit : str
        Of the values; the variance has its square.
    statistics : Statistics
    best, worst : PoseValue
        Largest and smallest stiffness.
    """

    direction: str
    unit: str
    statistics: Statistics
    best: PoseValue
    worst: PoseValue


@dataclass(frozen=True)
class Summary:
    """Summary of a stiffness map.

    Parameters
    ----------
    machine : str
    joint_model : str
    meaning : "blocked" or "free"
        What stiffness along an axis means: (C⁻¹)_ii or 1/C_ii.
    weights : "points" or "area"
    points, points_kept : int
    axes : tuple of AxisSummary
    """

    machine: str
    joint_model: str
    meaning: Meaning
    weights: Weights
    points: int
    points_kept: int
    axes: tuple[AxisSummary, ...]

    def __repr__(self) -> str:
        means = ", ".join(f"K{a.direction * 2} {a.statistics.mean:.4g} {a.unit}" for a in self.axes)
        return f"<Summary of {self.machine}: {self.points_kept} of {self.points} points, {means}>"

    def axis(self, direction: str) -> AxisSummary:
        """The summary of one direction.

        Parameters
        ----------
        direction : str
            Of x y z rx ry rz.

        Raises
        ------
        ModelError
            A direction that was not summed up.
        """
        for entry in self.axes:
            if entry.direction == direction:
                return entry
        raise ModelError(
            "summary",
            f'has no direction "{direction}".',
            "Directions: " + ", ".join(a.direction for a in self.axes) + ".",
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers and strings, SI; None stands for infinite, where the tool is locked."""
        return {key: _plain(value) for key, value in asdict(self).items()}


def summary(
    dataset: xr.Dataset,
    meaning: Meaning = "blocked",
    directions: Sequence[str] = ("x", "y", "z"),
    weights: Weights = "points",
    sample: bool = False,
) -> Summary:
    """Summarise the points of a map that count.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `stiffness_map` or `sweep`.
    meaning : "blocked" or "free"
        Blocked, (C⁻¹)_ii, is what agrees with the tables of Azulay et al.
    directions : sequence of str
        Of x y z rx ry rz.
    weights : "points" or "area"
        Each point once, as in the paper, or by the area of the hemisphere that belongs to it.
    sample : bool
        Variance with n − 1 in place of n. The paper does not say which; for its 317 points
        they differ by 0.3 %.

    Returns
    -------
    Summary

    Raises
    ------
    ModelError
        No point counts, another word for `meaning` or `weights`, or an unknown direction.
    """
    if meaning not in ("blocked", "free") or weights not in ("points", "area"):
        raise ModelError(
            "summary",
            f'of "{meaning}" stiffness weighted by "{weights}".',
            'Choose "blocked" or "free"; "points" or "area".',
        )
    unknown = [d for d in directions if d not in dataset["direction"]]
    if unknown:
        raise ModelError(
            "summary", f'unknown direction "{unknown[0]}".', "Choose of x y z rx ry rz."
        )
    if weights == "area" and "normal" not in dataset:
        raise ModelError(
            "summary", "this study has no hemisphere to weight by.", 'Use weights "points".'
        )
    kept = np.flatnonzero(dataset["status"].to_numpy() == PoseStatus.GOOD)
    if not kept.size:
        raise ModelError(
            f"map of {dataset.attrs.get('machine', 'a machine')}",
            "no valid pose: " + str(dataset.attrs.get("dropped_by_reason", "")),
            "Widen the filters, or move the poses into the workspace.",
        )
    stiffness = dataset[f"stiffness_{meaning}"]
    area = area_weights(dataset["normal"].to_numpy())[kept] if weights == "area" else None
    axes = []
    for direction in directions:
        values = stiffness.sel(direction=direction).to_numpy()[kept]
        axes.append(
            AxisSummary(
                direction,
                "N m/rad" if direction.startswith("r") else "N/m",
                statistics(values, area, sample),
                _found(dataset, kept, values, int(values.argmax())),
                _found(dataset, kept, values, int(values.argmin())),
            )
        )
    return Summary(
        str(dataset.attrs.get("machine", "")),
        str(dataset.attrs.get("joint_model", "")),
        meaning,
        weights,
        int(dataset["status"].size),
        int(kept.size),
        tuple(axes),
    )


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return type(value)(_plain(entry) for entry in value)
    return None if isinstance(value, float) and np.isinf(value) else value


def _found(dataset: xr.Dataset, kept: NDArray[np.intp], values: Array, at: int) -> PoseValue:
    index = int(kept[at])
    position = tuple(float(p) for p in dataset["position"].to_numpy()[index])
    roll = float(dataset["roll"].to_numpy()[index]) if "roll" in dataset else None
    return PoseValue(index, float(values[at]), position, roll)
