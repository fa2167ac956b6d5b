"""How thick a flexure is along its length."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import asinh, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

#: Gauss points of one half. Integrals of 1/h³ hold to 1e-11 down to t/R = 1e-4.
POINTS = 64
#: Intervals of one half between stations.
INTERVALS = 120


@dataclass(frozen=True)
class Profile:
    """A thickness along x, symmetric about x = 0.

    Parameters
    ----------
    x, weights, thickness : (n,)
        Gauss points, their weights and the thickness there, m.
    stations, station_thickness : (m,)
        Sections from one end to the other, both included, and the thickness there, m.
    """

    x: Array
    weights: Array
    thickness: Array
    stations: Array
    station_thickness: Array

    @property
    def length(self) -> float:
        """From end to end, m."""
        return float(self.stations[-1] - self.stations[0])

    def integral(self, values: Array) -> float:
        """Of values at the Gauss points, (n,), over the length; their unit times m.

        Parameters
        ----------
        values : (n,)
            Any unit.
        """
        return float(self.weights @ values)


def leaf_profile(length: float, thickness: float) -> Profile:
    """A constant thickness.

    Parameters
    ----------
    length, thickness : float
        m.
    """
    points, weights = _gauss()
    half = length / 2.0
    x = np.concatenate([-half * points[::-1], half * points])
    stations = half * np.linspace(-1.0, 1.0, 2 * INTERVALS + 1)
    return Profile(
        x,
        half * np.concatenate([weights[::-1], weights]),
        np.full(len(x), thickness),
        stations,
        np.full(len(stations), thickness),
    )


def notch_profile(
    thickness: float, half_length: float, half_height: float, cut: float = 1.0
) -> Profile:
    """Two elliptic notches opposite each other: h = t + 2 a_y (1 - cos φ) at x = a_x sin φ.

    With s = tan(φ/2) the thickness is t + 4 a_y s²/(1 + s²); s = c sinh(v), c² = t/(4 a_y),
    spreads the points evenly over the thin part, however thin.

    Parameters
    ----------
    thickness : float
        t, the least, m.
    half_length, half_height : float
        Semi-axes a_x along the hinge and a_y into it, m; both are the radius of a circle.
    cut : float
        Depth of each notch as a share of a_y, no unit; 1 to the middle of the ellipse.
    """
    points, weights = _gauss()
    scale = sqrt(thickness / (4.0 * half_height))
    # tan(φ/2) where 1 - cos φ is the cut
    end = asinh(sqrt(cut / (2.0 - cut)) / scale)

    def at(v: Array) -> tuple[Array, Array, Array]:
        s = scale * np.sinh(v)
        square = 1.0 + s**2
        slope = half_length * 2.0 * (1.0 - s**2) / square**2 * scale * np.cosh(v)
        return 2.0 * half_length * s / square, slope, thickness + 4.0 * half_height * s**2 / square

    x, slope, h = at(end * points)
    weight = end * weights * slope
    stations, _, rest = at(end * np.linspace(-1.0, 1.0, 2 * INTERVALS + 1))
    return Profile(
        np.concatenate([-x[::-1], x]),
        np.concatenate([weight[::-1], weight]),
        np.concatenate([h[::-1], h]),
        stations,
        rest,
    )


@lru_cache(maxsize=1)
def _gauss() -> tuple[Array, Array]:
    """Points and weights between 0 and 1."""
    points, weights = np.polynomial.legendre.leggauss(POINTS)
    return (points + 1.0) / 2.0, weights / 2.0
