"""The frequency scale that brings two responses closest."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize_scalar
from scipy.signal import correlate

from strutwork.errors import ModelError
from strutwork.fea.assurance import frac

Array = NDArray[Any]

#: Share of the measured lines that a scaled response must still cover.
COVERED = 0.5

#: Peaks of the survey that are looked at closely.
PEAKS = 6

#: The survey leaves out what lies below this share of the band's end.
_LOWEST = 1e-3

#: Points of the survey's logarithmic axis at most.
_MOST_POINTS = 2**20

#: Least number of scales of the survey.
_LEAST_SCALES = 41


@dataclass(frozen=True)
class FracScale:
    """FRAC as it is, and with the frequency scale that makes it best.

    Parameters
    ----------
    frac : float
        On the common lines, frequencies as they are; from 0 to 1, no unit.
    scale : float
        The computed frequencies times this meet the measured ones best; no unit.
    scaled_frac : float
        FRAC at that scale, no unit.
    at_limit : bool
        The best scale lies at the end of the search: the true one may lie beyond.
    """

    frac: float
    scale: float
    scaled_frac: float
    at_limit: bool

    def __repr__(self) -> str:
        return f"<FRAC {self.frac:.3f}, {self.scaled_frac:.3f} at scale {self.scale:.4f}>"


def frac_with_scale(
    computed: tuple[ArrayLike, ArrayLike],
    measured: tuple[ArrayLike, ArrayLike],
    limits: tuple[float, float] = (0.8, 1.25),
) -> FracScale:
    """FRAC of a computed and a measured response, and the best frequency scale.

    The computed response is interpolated (cubic) at measured frequency / scale. On a logarithmic
    axis a scale is a shift: all scales within `limits`, in steps of half the measured line
    spacing at the upper end of the band so that no peak is stepped over, are surveyed by one
    correlation; the best of them are computed as defined and refined by bounded search. A scale
    counts where the computed band still covers half of the measured lines.

    Parameters
    ----------
    computed, measured : (frequencies (f,), values (f,))
        Hz, complex.
    limits : (float, float)
        Least and largest scale, no unit.

    Returns
    -------
    FracScale

    Raises
    ------
    ModelError
        Bands that do not overlap in half of the measured lines, limits without one, frequencies
        too close to be interpolated.
    """
    lines, values = (np.asarray(a) for a in measured)
    own, response = (np.asarray(a) for a in computed)
    low, high = limits
    if not (np.isfinite(high) and 0 < low <= 1 <= high):
        raise ModelError("frequency scale", f"goes from {low:g} to {high:g}.", "Include one.")
    if len(own) < 4 or len(lines) < 4:
        raise ModelError("response", "has fewer than four lines.", "Give more lines.")
    if not (own[-1] > 0 and lines[-1] > 0):
        raise ModelError("response", "has no positive frequency.", "Give a frequency axis.")
    # the criterion knows no unit, powers of huge numbers would
    unit = float(lines[-1])
    lines, own = lines / unit, own / unit
    values, response = _of_size_one(values), _of_size_one(response)
    curve = _interpolated(own, response)
    score = _score(curve, (own[0], own[-1]), lines, values)
    plain = score(1.0)
    if plain < 0:
        raise ModelError(
            "responses",
            f"have too little of the band in common: computed {unit * own[0]:g} to "
            f"{unit * own[-1]:g} Hz, measured {unit * lines[0]:g} to {unit:g} Hz.",
            "Compute at least half of the measured band.",
        )
    step = max(0.5 * float(np.median(np.diff(lines))), 1e-7)
    step = min(step, max(np.log(high / low) / (_LEAST_SCALES - 1), 1e-12))
    # the ends, and one itself: what is equal is found equal
    tried = [low, 1.0, high]
    for peak in _survey(curve, (own[0], own[-1]), (lines, values), (low, high), step):
        tried += [float(np.clip(peak * (1.0 + k * step), low, high)) for k in (-1, 0, 1)]
    scores = [score(s) for s in tried]
    k = int(np.argmax(scores))
    scale, best = tried[k], scores[k]
    around = (max(low, scale * (1.0 - 2.0 * step)), min(high, scale * (1.0 + 2.0 * step)))
    if around[1] > around[0]:
        fine = minimize_scalar(
            lambda s: -score(s), bounds=around, method="bounded", options={"xatol": 1e-9}
        )
        if -fine.fun > best:
            scale, best = float(fine.x), float(-fine.fun)
    beyond = high > low and not low * (1.0 + step) < scale < high * (1.0 - step)
    return FracScale(plain, scale, best, beyond)


def _of_size_one(values: Array) -> Array:
    size = max(np.abs(values.real).max(), np.abs(values.imag).max())
    return values / size if size > 0 else values


def _interpolated(own: Array, response: Array) -> CubicSpline:
    try:
        with np.errstate(all="ignore"):
            curve = CubicSpline(own, response)
    except (ValueError, np.linalg.LinAlgError):
        curve = None
    if curve is None or not np.all(np.isfinite(curve.c)):
        raise ModelError(
            "response",
            "has frequencies too close to one another to be interpolated.",
            "Give each line a frequency of its own.",
        )
    return curve


def _score(
    curve: CubicSpline, band: tuple[float, float], lines: Array, values: Array
) -> Callable[[float], float]:
    """FRAC by scale; −1 where too few lines are covered."""

    def score(scale: float) -> float:
        at = lines / scale
        slack = 1e-9 * band[1]
        inside = (at >= band[0] - slack) & (at <= band[1] + slack)
        if inside.sum() < max(4, COVERED * len(lines)):
            return -1.0
        shifted = curve(np.clip(at[inside], *band))
        if not np.any(shifted) or not np.any(values[inside]):
            return 0.0
        return frac(shifted, values[inside])

    return score


def _survey(
    curve: CubicSpline,
    band: tuple[float, float],
    measured: tuple[Array, Array],
    limits: tuple[float, float],
    step: float,
) -> list[float]:
    """Scales where FRAC has its highest peaks, nearly, in steps of `step`."""
    lines, values = measured
    heard = lines >= max(_LOWEST * lines[-1], np.finfo(float).tiny)
    lines, values = lines[heard], values[heard]
    if len(lines) < 4 or limits[0] == limits[1]:
        return []
    step = max(step, float(np.log(lines[-1] / lines[0])) / _MOST_POINTS)
    first, last = (int(np.floor(np.log(v) / step)) for v in limits)
    here = np.exp(np.arange(np.log(lines[0]), 0.5 * step, step))
    here = here[here <= lines[-1]]
    # lines a point of the axis: the sum over them becomes one over points
    weight = np.gradient(np.interp(here, lines, np.arange(len(lines))))
    wanted = _interpolated(lines, values)(here)
    shift = np.arange(len(here) + last - first) - last
    there = here[0] * np.exp(shift * step)
    inside = (there >= band[0]) & (there <= band[1])
    shifted = np.where(inside, curve(np.clip(there, *band)), 0.0)
    covered = correlate(inside.astype(float), weight, "valid", "fft")
    own = correlate(np.abs(shifted) ** 2, weight, "valid", "fft")
    theirs = correlate(inside.astype(float), weight * np.abs(wanted) ** 2, "valid", "fft")
    cross = np.abs(correlate(shifted, weight * wanted, "valid", "fft")) ** 2
    size = own * theirs
    # what rounding leaves of a correlation is no response
    good = (covered >= 0.9 * COVERED * weight.sum()) & (size > 1e-12 * size.max(initial=0.0))
    found = np.where(good, cross / np.where(good, size, 1.0), -1.0)
    padded = np.concatenate([[-2.0], found, [-2.0]])
    peaks = np.flatnonzero((found >= padded[:-2]) & (found >= padded[2:]) & good)
    best = peaks[np.argsort(-found[peaks], kind="stable")[:PEAKS]]
    return [float(np.exp((last - k) * step)) for k in best]
