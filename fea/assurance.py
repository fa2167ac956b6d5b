"""Assurance criteria: how alike two shapes, two spans of shapes or two responses are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize_scalar

from strutwork.errors import ModelError

Array = NDArray[Any]

#: Directions of a span below this share of the largest are rounding.
SPAN_RANK = 1e-8

#: Frequency scales are tried up to this many.
MOST_SCALES = 4001

#: Share of the measured lines that a scaled response must still cover.
COVERED = 0.5


def mac(first: ArrayLike, second: ArrayLike) -> Array:
    """Modal assurance criterion |aᴴb|² / (aᴴa · bᴴb) of every pair of shapes.

    Allemang, The modal assurance criterion, Sound and Vibration 37 (2003).

    Parameters
    ----------
    first, second : (m, k), (n, k)
        Shapes as rows, real or complex.

    Returns
    -------
    mac : (m, n)
        From 0 to 1; unchanged when a shape is multiplied by any complex number.

    Raises
    ------
    ModelError
        Shapes of different lengths, a zero shape, a number that is not finite.
    """
    a, b = _shapes(first), _shapes(second)
    if a.shape[1] != b.shape[1]:
        raise ModelError(
            "shapes", f"have {a.shape[1]} and {b.shape[1]} entries.", "Give common directions."
        )
    return np.asarray(np.minimum(np.abs(a.conj() @ b.T) ** 2, 1.0))


def _shapes(rows: ArrayLike) -> Array:
    a = np.atleast_2d(np.asarray(rows))
    if not np.all(np.isfinite(a)):
        raise ModelError("shapes", "hold a number that is not finite.", "Leave it out.")
    # the largest entry first: the square of a tiny number would vanish
    largest = np.abs(a).max(axis=1, keepdims=True, initial=0.0)
    if np.any(largest == 0):
        raise ModelError("shapes", "hold one that is zero everywhere.", "Leave it out.")
    a = a / largest
    return np.asarray(a / np.linalg.norm(a, axis=1, keepdims=True))


def subspace_mac(first: ArrayLike, second: ArrayLike) -> float:
    """Squared cosine of the largest principal angle between two spans of shapes.

    One where the spans are the same (or the smaller lies in the larger), however the shapes
    within them are chosen; for two single shapes it is the MAC. Björck and Golub, Numerical
    methods for computing angles between linear subspaces, Math. Comp. 27 (1973).

    Parameters
    ----------
    first, second : (m, k), (n, k)
        Shapes as rows.

    Raises
    ------
    ModelError
        As `mac`.
    """
    cosines = np.linalg.svd(_span(first).conj().T @ _span(second), compute_uv=False)
    return float(min(cosines[-1] ** 2, 1.0))


def _span(rows: ArrayLike) -> Array:
    """Orthonormal columns of the span of shapes."""
    left, values, _ = np.linalg.svd(_shapes(rows).T, full_matrices=False)
    return np.asarray(left[:, values > SPAN_RANK * values[0]])


def in_span(shapes: ArrayLike, span: ArrayLike) -> Array:
    """Share of each shape (m, k) that lies in the span of others, squared, (m,)."""
    parts = _span(span).conj().T @ _shapes(shapes).T
    return np.asarray(np.minimum((np.abs(parts) ** 2).sum(axis=0), 1.0))


def frac(first: ArrayLike, second: ArrayLike) -> float:
    """Frequency response assurance criterion |Σ h₁* h₂|² / (Σ|h₁|² Σ|h₂|²), from 0 to 1.

    Heylen and Lammens, FRAC: a consistent way of comparing frequency response functions,
    International Conference on Identification in Engineering Systems (1996).

    Parameters
    ----------
    first, second : (f,)
        On the same lines.

    Raises
    ------
    ModelError
        As `mac`.
    """
    return float(mac(np.asarray(first)[None], np.asarray(second)[None])[0, 0])


@dataclass(frozen=True)
class FracScale:
    """FRAC as it is, and with the frequency scale that makes it best.

    Parameters
    ----------
    frac : float
        On the common lines, frequencies as they are.
    scale : float
        The computed frequencies times this meet the measured ones best.
    scaled_frac : float
        FRAC at that scale.
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

    The computed response is interpolated (cubic) at measured frequency / scale. Scales from
    `limits` are tried in geometric steps of half the measured line spacing at the upper end of
    the band, so that no peak is stepped over, and the best refined by bounded search. A scale
    counts where the computed band still covers half of the measured lines.

    Parameters
    ----------
    computed, measured : (frequencies (f,), values (f,))
        Hz, complex.
    limits : (float, float)

    Returns
    -------
    FracScale

    Raises
    ------
    ModelError
        Bands that do not overlap in half of the measured lines, or limits without one.
    """
    lines, values = (np.asarray(a) for a in measured)
    own, response = (np.asarray(a) for a in computed)
    low, high = limits
    if not (np.isfinite(high) and 0 < low <= 1 <= high):
        raise ModelError("frequency scale", f"goes from {low:g} to {high:g}.", "Include one.")
    if len(own) < 4 or len(lines) < 4:
        raise ModelError("response", "has fewer than four lines.", "Give more lines.")
    spline = CubicSpline(own, response)

    def score(scale: float) -> float:
        at = lines / scale
        slack = 1e-9 * own[-1]
        inside = (at >= own[0] - slack) & (at <= own[-1] + slack)
        if inside.sum() < max(4, COVERED * len(lines)):
            return -1.0
        shifted = spline(np.clip(at[inside], own[0], own[-1]))
        if not np.any(shifted) or not np.any(values[inside]):
            return 0.0
        return frac(shifted, values[inside])

    plain = score(1.0)
    if plain < 0:
        raise ModelError(
            "responses",
            f"share too little of the band: computed {own[0]:g} to {own[-1]:g} Hz, measured "
            f"{lines[0]:g} to {lines[-1]:g} Hz.",
            "Compute at least half of the measured band.",
        )
    step = 0.5 * float(np.median(np.diff(lines))) / lines[-1]
    count = int(np.clip(np.ceil(np.log(high / low) / step), 41, MOST_SCALES))
    # one itself is tried too: what is equal is found equal
    tried = np.unique(np.concatenate([np.geomspace(low, high, count), [1.0]]))
    scores = np.array([score(s) for s in tried])
    k = int(scores.argmax())
    scale, best = float(tried[k]), float(scores[k])
    around = (float(tried[max(k - 1, 0)]), float(tried[min(k + 1, len(tried) - 1)]))
    if around[1] > around[0]:
        fine = minimize_scalar(
            lambda s: -score(s), bounds=around, method="bounded", options={"xatol": 1e-9}
        )
        if -fine.fun > best:
            scale, best = float(fine.x), float(-fine.fun)
    return FracScale(plain, scale, best, k in (0, len(tried) - 1) and high > low)
