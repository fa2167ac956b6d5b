"""Trajectories: coordinates over time, twice differentiable, from samples or made."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.coordinates import Coordinates

Array = NDArray[Any]

#: Fewest samples of a quintic spline, and of any.
QUINTIC, FEWEST = 6, 4
#: Share of the largest acceleration by which every other sample may tell another one.
ROUGH = 0.2
#: Nodes of an interval, ends counted: of the Lobatto rule, exact for polynomials of degree 9.
NODES = 6
#: Size of rounding in sampled coordinates, as a share of the largest.
ROUNDING = 1e-13


@dataclass(frozen=True)
class Trajectory:
    """Coordinates over time.

    Parameters
    ----------
    coordinates : Coordinates
    times : (k,)
        Of the samples, s, ascending: between them the path is smooth.
    curve : callable
        From times (p,) to values, rates and second derivatives, (3, p, t).
    """

    coordinates: Coordinates
    times: Array
    curve: Callable[[Array], Array]

    def __repr__(self) -> str:
        return (
            f"<Trajectory: {', '.join(self.coordinates.labels)} over {self.duration:.4g} s, "
            f"{len(self.times)} samples>"
        )

    @property
    def duration(self) -> float:
        """S."""
        return float(self.times[-1] - self.times[0])

    def at(self, times: ArrayLike) -> tuple[Array, Array, Array]:
        """Values, rates and second derivatives at times, (p, t) each, m and rad over s and s².

        Parameters
        ----------
        times : (p,) or ()
            s.
        """
        found = self.curve(np.atleast_1d(np.asarray(times, dtype=float)))
        return found[0], found[1], found[2]

    @cached_property
    def quadrature(self) -> tuple[Array, Array]:
        """Times and weights of the Gauss-Lobatto rule on every interval of samples, (n,), s.

        Samples are among them; the weights of two intervals add up where they meet.
        """
        points, weights = lobatto(NODES)
        start, span = self.times[:-1, None], np.diff(self.times)[:, None]
        inner = start + span * (points[:-1] + 1.0) / 2.0
        times = np.append(inner.ravel(), self.times[-1])
        share = span * weights / 2.0
        whole = np.zeros(len(times))
        last = NODES - 1
        for k in range(NODES):
            whole[k : k + last * len(span) : last] += share[:, k]
        return times, whole


def lobatto(count: int) -> tuple[Array, Array]:
    """Nodes and weights (n,) of the Gauss-Lobatto rule on −1 to 1 (Abramowitz and Stegun 25.4.32).

    Parameters
    ----------
    count : int
        Number of nodes, both ends among them.
    """
    legendre = np.polynomial.legendre.Legendre.basis(count - 1)
    inner = np.sort(legendre.deriv().roots().real)
    nodes = np.concatenate([[-1.0], inner, [1.0]])
    return nodes, 2.0 / (count * (count - 1) * legendre(nodes) ** 2)


def sampled(
    coordinates: Coordinates,
    times: ArrayLike,
    values: ArrayLike,
    rates: ArrayLike | None = None,
    changes: ArrayLike | None = None,
) -> Trajectory:
    """A trajectory through samples.

    Without derivatives the quintic spline through the values (cubic for fewer than 6 samples);
    with rates and second derivatives the quintic between each two samples that has them.

    Parameters
    ----------
    coordinates : Coordinates
    times : (k,)
        s.
    values : (k, t)
        m and rad, of rotation vectors and turns without jumps by whole turns.
    rates, changes : (k, t), optional
        First and second derivatives, m and rad over s and s², both or none.

    Raises
    ------
    ModelError
        Fewer than four samples, times that do not ascend, numbers that are not finite, shapes
        that do not match, or one of the derivatives alone.
    """
    # imported late: it takes a third of a small command's start
    from scipy.interpolate import BPoly, make_interp_spline  # noqa: PLC0415

    t, x = np.asarray(times, dtype=float), np.asarray(values, dtype=float)
    if (rates is None) != (changes is None):
        raise ModelError(
            "trajectory",
            "has only first or only second derivatives.",
            "Give speeds and accelerations, or neither.",
        )
    given = [x, *(np.asarray(d, dtype=float) for d in (rates, changes) if d is not None)]
    if t.ndim != 1 or any(g.shape != (len(t), len(coordinates)) for g in given):
        raise ModelError(
            "trajectory",
            f"has {t.shape} times and values {x.shape} of {len(coordinates)} coordinates.",
            "Give a row per time and a column per coordinate.",
        )
    _check_times(t, 2 if rates is not None else FEWEST)
    bad = np.flatnonzero(~np.isfinite(np.concatenate(given, axis=1)).all(axis=1))
    if bad.size:
        raise ModelError(
            "trajectory", f"is not finite at t = {t[bad[0]]:g} s.", "Give finite numbers."
        )
    if rates is None:
        curve = make_interp_spline(t, x, k=5 if len(t) >= QUINTIC else 3, axis=0)
    else:
        curve = BPoly.from_derivatives(t, np.stack(given, axis=1), orders=5)
    slopes = (curve, curve.derivative(1), curve.derivative(2))
    return Trajectory(coordinates, t, partial(_stacked, slopes))


def _stacked(slopes: Sequence[Callable[[Array], Array]], at: Array) -> Array:
    """Values, rates and second derivatives, (3, p, t)."""
    return np.stack([np.asarray(c(at)) for c in slopes])


def _check_times(t: Array, fewest: int) -> None:
    if len(t) < fewest:
        raise ModelError(
            "trajectory",
            f"has {len(t)} samples.",
            f"Give {fewest} at least: acceleration is taken from their curvature.",
        )
    bad = np.flatnonzero(~(np.diff(t) > 0) | ~np.isfinite(np.diff(t)))
    if bad.size:
        raise ModelError(
            "trajectory",
            f"has a time that does not ascend: {t[bad[0] + 1]:g} s after {t[bad[0]]:g} s.",
            "Sort the samples by time, and remove duplicates.",
        )


@dataclass(frozen=True)
class Roughness:
    """Where samples of a coordinate do not lie on a smooth curve.

    Parameters
    ----------
    label : str
        Of the coordinate.
    time : float
        s.
    share : float
        Share of the largest acceleration by which accelerations from all samples and from every
        other differ there.
    """

    label: str
    time: float
    share: float

    def __str__(self) -> str:
        return (
            f"{self.label} is not smooth near t = {self.time:.4g} s: accelerations from all "
            f"samples and from every other one differ by {100 * self.share:.0f} % of the largest"
        )


def roughness(
    coordinates: Coordinates, times: ArrayLike, values: ArrayLike
) -> tuple[Roughness, ...]:
    """Coordinates whose samples are too far apart, noisy, or have a corner or a jump.

    The second derivative of the spline through all samples, beside that through every other
    one: on a smooth path that is sampled densely enough they agree.

    Parameters
    ----------
    coordinates : Coordinates
        t of them.
    times : (k,)
        s, ascending.
    values : (k, t)
        m and rad.

    Returns
    -------
    tuple of Roughness
        One for each coordinate whose accelerations differ by more than `ROUGH`; empty for fewer
        than twelve samples, which are too few.
    """
    t, x = np.asarray(times, dtype=float), np.asarray(values, dtype=float)
    if len(t) < 2 * QUINTIC:
        return ()
    half = np.unique(np.append(np.arange(0, len(t), 2), len(t) - 1))
    whole = sampled(coordinates, t, x).at(t)[2]
    gap = np.abs(whole - sampled(coordinates, t[half], x[half]).at(t)[2])
    largest = np.abs(whole).max(axis=0)
    # second differences of what rounding leaves of a coordinate that stands
    noise = ROUNDING * np.abs(x).max(axis=0) / float(np.min(np.diff(t))) ** 2
    found = []
    for k, label in enumerate(coordinates.labels):
        first = int(np.argmax(gap[:, k]))
        if gap[first, k] > max(ROUGH * largest[k], noise[k]):
            found.append(Roughness(label, float(t[first]), float(gap[first, k] / largest[k])))
    return tuple(found)
