"""Exact largest magnitude of a sum over poles on a band, with its certificate.

As in `strutwork.fea.peak`, with poles anywhere in the plane: cells of the frequency axis whose
bound by Taylor's theorem lies below the largest value known are dropped, the others halved.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.fea.peak import TOLERANCE

Array = NDArray[Any]

#: Cells that may be looked at in all.
MOST_CELLS = 2_000_000

#: Entries of an array of cells by poles.
BLOCK = 2_000_000


@dataclass(frozen=True)
class PoleSum:
    """H(ω) = Σ r_k / (iω − s_k) + constant − moving / ω².

    Parameters
    ----------
    poles : (k,)
        s_k, complex, rad/s.
    residues : (k,)
        r_k, complex, m/(N·s).
    constant : complex
        m/N.
    moving : float
        Of rigid-body modes that nothing drags, 1/kg.
    """

    poles: Array
    residues: Array
    constant: complex
    moving: float

    def derivatives(self, omega: Array) -> tuple[Array, Array, Array]:
        """H and its first two derivatives by ω, (w,) each.

        Parameters
        ----------
        omega : (w,)
            ω, rad/s.
        """
        inverse = 1.0 / (1j * omega[:, None] - self.poles)
        term = self.residues * inverse
        h0 = term.sum(axis=1) + self.constant
        h1 = -1j * (term * inverse).sum(axis=1)
        h2 = -2.0 * (term * inverse**2).sum(axis=1)
        if self.moving:
            h0 = h0 - self.moving / omega**2
            h1 = h1 + 2.0 * self.moving / omega**3
            h2 = h2 - 6.0 * self.moving / omega**4
        return h0, h1, h2

    def square(self, omega: Array) -> tuple[Array, Array, Array]:
        """|H|² and its first two derivatives by ω, (w,) each.

        Parameters
        ----------
        omega : (w,)
            ω, rad/s.
        """
        h0, h1, h2 = self.derivatives(omega)
        return (
            np.abs(h0) ** 2,
            2.0 * (h0.conj() * h1).real,
            2.0 * (np.abs(h1) ** 2 + (h0.conj() * h2).real),
        )

    def bounds(self, low: Array, high: Array, f0: Array, f1: Array) -> Array:
        """Bound of |H|² over cells from the value and slope in their middles, (w,).

        Parameters
        ----------
        low, high : (w,)
            Ends of the cells, rad/s.
        f0 : (w,)
            |H|² in the middle, m²/N².
        f1 : (w,)
            Its derivative by ω, m²/N² by rad/s.
        """
        at, decay = self.poles.imag, self.poles.real
        gap = np.maximum(0.0, np.maximum(low[:, None] - at, at - high[:, None]))
        with np.errstate(divide="ignore", over="ignore"):
            near = 1.0 / np.sqrt(gap**2 + decay**2)
            first = np.abs(self.residues) * near**2
            second = (2.0 * first * near).sum(axis=1)
        first = first.sum(axis=1)
        if self.moving:
            first = first + 2.0 * abs(self.moving) / low**3
            second = second + 6.0 * abs(self.moving) / low**4
        half = 0.5 * (high - low)
        size = np.sqrt(f0) + first * half
        with np.errstate(invalid="ignore", over="ignore"):
            taylor = f0 + np.abs(f1) * half + half**2 * (first**2 + size * second)
            found = np.minimum(size**2, taylor)
        return np.where(np.isnan(found), np.inf, found)


def largest_on_band(
    total: PoleSum, low: float, high: float, tolerance: float = TOLERANCE
) -> tuple[float, float, bool]:
    """Place, rad/s, and size of the largest |H| on a band; whether the proof was finished.

    Parameters
    ----------
    total : PoleSum
    low, high : float
        Ends of the band, rad/s.
    tolerance : float
        Of the certificate, as a share of the size.
    """
    inside = total.poles.imag[(total.poles.imag > low) & (total.poles.imag < high)]
    edges = np.unique(np.concatenate([[low, high], inside]))
    values, _, _ = total.square(edges)
    place, best = float(edges[values.argmax()]), float(values.max())
    lower, upper = edges[:-1], edges[1:]
    seen, certified = 0, True
    block = max(BLOCK // max(len(total.poles), 1), 16)
    while len(lower):
        seen += len(lower)
        if seen > MOST_CELLS:
            certified = False
            break
        rest_low, rest_high = [], []
        for start in range(0, len(lower), block):
            a, b = lower[start : start + block], upper[start : start + block]
            middle = 0.5 * (a + b)
            value, first, _ = total.square(middle)
            k = int(value.argmax())
            if value[k] > best:
                place, best = _polished(total, float(middle[k]), low, high)
            limit = total.bounds(a, b, value, first)
            open_ = (limit > best * (1.0 + tolerance) ** 2) & (b - a > 1e-14 * b)
            a, b, middle = a[open_], b[open_], middle[open_]
            rest_low += [a, middle]
            rest_high += [middle, b]
        lower, upper = np.concatenate(rest_low), np.concatenate(rest_high)
    place, best = _polished(total, place, low, high)
    return place, float(np.sqrt(best)), certified


def _polished(total: PoleSum, place: float, low: float, high: float) -> tuple[float, float]:
    """Newton's method uphill from a place; never lower than where it started."""
    value = float(total.square(np.array([place]))[0][0])
    for _ in range(60):
        _, first, second = (float(x[0]) for x in total.square(np.array([place])))
        if second >= 0.0:
            break
        trial = min(max(place - first / second, low), high)
        better = float(total.square(np.array([trial]))[0][0])
        if better < value or trial == place:
            break
        place, value = trial, better
    return place, value
