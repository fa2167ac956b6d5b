"""Directional matrices over the angle of rotation, with the helix in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]

#: Breakpoints nearer to one another than this, rad, are one.
SAME = 1e-12


def _products(first: Array, second: Array) -> Array:
    """Terms (6, 3, 3) of a product of two vectors that are linear in (sin φ, cos φ, 1)."""
    terms = np.zeros((6, 3, 3))
    # sin², sin cos, cos², sin, cos, 1
    place = [[0, 1, 3], [1, 2, 4], [3, 4, 5]]
    for i in range(3):
        for j in range(3):
            terms[place[i][j]] += np.outer(first[i], second[j])
    return terms


def _edge_axes(lead: float) -> tuple[Array, Array, Array, Array]:
    """Tangential, radial, axial force and chip normal: rows by sin φ, cos φ and 1, (3, 3)."""
    s, c = np.sin(lead), np.cos(lead)
    # at a right angle nothing acts along the axis but for rounding
    c = 0.0 if abs(c) < 1e-15 else c
    tangential = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    radial = np.array([[-s, 0.0, 0.0], [0.0, -s, 0.0], [0.0, 0.0, c]])
    axial = np.array([[-c, 0.0, 0.0], [0.0, -c, 0.0], [0.0, 0.0, -s]])
    return tangential, radial, axial, -radial


def edge_terms(coefficients: tuple[float, float, float], lead: float) -> Array:
    """Terms (6, 3, 3), Pa, of the force on the tool per motion of its tip and depth of cut.

    Altintas (2012), section 3.7, for one tooth: chip thickness x sin φ sin κ + y cos φ sin κ −
    z cos κ, width of the chip by depth 1/sin κ.

    Parameters
    ----------
    coefficients : (3,) tuple
        Tangential, radial, axial, Pa.
    lead : float
        κ, rad.
    """
    tangential, radial, axial, normal = _edge_axes(lead)
    kt, kr, ka = coefficients
    force = kt * tangential + kr * radial + ka * axial
    return np.asarray(_products(force, normal) / np.sin(lead))


def flank_terms(friction: float, lead: float) -> Array:
    """Terms (6, 3, 3), no unit, of the force on the tool by the flank per normal velocity.

    Parameters
    ----------
    friction : float
        No unit.
    lead : float
        κ, rad.
    """
    return edge_terms((friction, 1.0, 0.0), lead)


@dataclass(frozen=True)
class Directional:
    """A directional matrix of all teeth, by the angle of rotation.

    Parameters
    ----------
    terms : (6, 3, 3)
        Of one tooth by sin², sin cos, cos², sin, cos of its angle and 1, any unit.
    entry, leave : float
        Angles between which a tooth cuts, rad.
    pitch : float
        Between teeth, rad.
    lag : float
        Of the edge per depth by its helix, rad/m.
    """

    terms: Array
    entry: float
    leave: float
    pitch: float
    lag: float

    @property
    def average(self) -> Array:
        """Mean over a turn, (3, 3), its own unit; the helix does not change it."""
        swept = _integral(np.array(self.leave)) - _integral(np.array(self.entry))
        return np.asarray(np.tensordot(swept, self.terms, 1) / self.pitch)

    def breaks(self, depth: float) -> Array:
        """Angles (b,) in a pitch where it is not smooth, rad, from 0 at the entry.

        Parameters
        ----------
        depth : float
            m.
        """
        swept, lag = self.leave - self.entry, self.lag * depth
        angles = [a % self.pitch for a in (0.0, swept, lag, swept + lag)]
        angles = sorted(0.0 if self.pitch - a < SAME else a for a in angles)
        keep = [angles[0]] + [b for a, b in pairwise(angles) if b - a > SAME]
        return np.array([*keep, self.pitch])

    def cuts(self, angle: float, depth: float) -> bool:
        """Whether a tooth cuts somewhere along the depth.

        Parameters
        ----------
        angle : float
            From the entry, rad.
        depth : float
            m.
        """
        span = self.leave - self.entry + self.lag * depth
        return bool(angle % self.pitch < span)

    def at(self, angles: Array, depth: float) -> Array:
        """The matrix (..., 3, 3), mean along the depth, of its own unit.

        Parameters
        ----------
        angles : (...)
            From the entry, rad.
        depth : float
            m.
        """
        lag = self.lag * depth
        span = self.leave - self.entry + lag
        first = self.entry + np.mod(angles, self.pitch)
        teeth = np.arange(int(np.ceil(span / self.pitch)) + 1) * self.pitch
        angle = np.add.outer(teeth, first)
        if lag > 0:
            ends = np.clip(np.stack([angle, angle - lag]), self.entry, self.leave)
            upper, lower = _integral(ends)
            total = (upper - lower).sum(axis=0) / lag
        else:
            total = np.where((angle < self.leave)[..., None], _powers(angle), 0.0).sum(axis=0)
        return np.asarray((total @ self.terms.reshape(6, 9)).reshape(*np.shape(angles), 3, 3))


def _powers(angle: Array) -> Array:
    s, c = np.sin(angle), np.cos(angle)
    return np.stack([s * s, s * c, c * c, s, c, np.ones_like(s)], axis=-1)


def _integral(angle: Array) -> Array:
    s, c = np.sin(angle), np.cos(angle)
    half = 0.5 * angle
    return np.stack(
        [half - 0.5 * s * c, 0.5 * s * s, half + 0.5 * s * c, -c, s, np.asarray(angle)], axis=-1
    )
