"""A preloaded bearing: its load by displacement, its secant and its tangent."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.contact.contacts import Contacts

Array = NDArray[Any]

DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")

#: Points at which the secant averages the tangent along the way.
POINTS = 8

#: A load below this share of the sum of the forces on all elements is rounding.
ROUNDING = 1e-12


class Geometry(Protocol):
    """What is known of a bearing, from which its contacts follow."""

    def bearing(self) -> Bearing:
        """The bearing, preloaded."""


@dataclass(frozen=True)
class Bearing:
    """Contacts with the state in which they are preloaded, and from which displacements count.

    Parameters
    ----------
    contacts : Contacts
    held : tuple of directions
        Those in which the bearing resists; it is free in the others.
    rows : tuple of str
        Names of the rows of the contacts.
    start : (6,)
        Displacement of the moving body under its preload, where a load outside the bearing keeps
        it, m and rad; zero where two rows preload one another.
    size : float
        A length of the bearing, by which rotations compare with translations, m.
    around : bool
        Whether its elements lie about the axis and preload one another across it, as rollers do:
        the preload is lost where half of the circumference bears nothing.
    """

    contacts: Contacts
    held: tuple[str, ...]
    rows: tuple[str, ...]
    start: Array = field(default_factory=lambda: np.zeros(6))
    size: float = 1.0
    around: bool = False

    @property
    def mask(self) -> NDArray[np.bool_]:
        """Held directions, (6,)."""
        return np.array([d in self.held for d in DIRECTIONS])

    def loads(self, displacement: ArrayLike) -> Array:
        """Load beyond the preload that holds a displacement from the preloaded state, (6,).

        Parameters
        ----------
        displacement : (6,)
            Of the moving body, m and rad.

        Returns
        -------
        loads : (6,)
            N and N·m; none in directions that are not held.
        """
        there = self.contacts.loads(self.start + np.asarray(displacement))
        return np.asarray((there - self.contacts.loads(self.start)) * self.mask)

    def tangent(self, displacement: ArrayLike = (0.0,) * 6) -> Array:
        """Stiffness at a displacement, (6, 6), N/m, N and N·m.

        Parameters
        ----------
        displacement : (6,)
            m and rad; the preloaded state by default.
        """
        stiffness = self.contacts.tangent(self.start + np.asarray(displacement))
        return np.asarray(stiffness * np.outer(self.mask, self.mask))

    def secant(self, displacement: ArrayLike) -> Array:
        """A symmetric stiffness that bears the load at a displacement: S q = F(q), (6, 6).

        The mean of the tangent along the straight way from the preloaded state, which is exact but
        for the quadrature; what that leaves is added by the least symmetric change (Powell 1970).

        Parameters
        ----------
        displacement : (6,)
            m and rad.

        Returns
        -------
        stiffness : (6, 6)
            N/m, N and N·m.
        """
        q = np.asarray(displacement, dtype=float) * self.mask
        points, weights = np.polynomial.legendre.leggauss(POINTS)
        mean = sum(
            0.5 * w * self.tangent(0.5 * (1.0 + x) * q)
            for x, w in zip(points, weights, strict=True)
        )
        scale = np.where(np.arange(6) < 3, 1.0, 1.0 / self.size)
        # rotations as translations at the bearing's size
        s, y = np.asarray(mean) * np.outer(scale, scale), self.loads(q) * scale
        p = q / scale
        square, left = float(p @ p), y - s @ p
        # less is rounding: the loads are differences from those of the preload
        if float(np.abs(left).max()) > ROUNDING * float(self.contacts.elements(self.start).sum()):
            s = s + (np.outer(left, p) + np.outer(p, left)) / square
            s = s - (left @ p) * np.outer(p, p) / square**2
        return np.asarray(s / np.outer(scale, scale))

    def opened(self, displacement: ArrayLike) -> tuple[str, ...]:
        """Rows that bear nothing at a displacement, or the side that does not.

        Parameters
        ----------
        displacement : (6,)
            m and rad.
        """
        closed = self.contacts.approach(self.start + np.asarray(displacement)) > 0.0
        rows = self.contacts.rows
        off = tuple(name for i, name in enumerate(self.rows) if not closed[rows == i].any())
        if off or not self.around:
            return off
        x, y = self.contacts.normals[closed, :2].T
        angles = np.sort(np.arctan2(y, x))
        gaps = np.diff(np.append(angles, angles[0] + 2.0 * np.pi))
        return ("one side",) if gaps.max() >= np.pi - 1e-9 else ()

    def bearing_share(self, displacement: ArrayLike) -> float:
        """Share of the elements that bear load at a displacement, no unit.

        Parameters
        ----------
        displacement : (6,)
            m and rad.
        """
        return float((self.contacts.approach(self.start + np.asarray(displacement)) > 0.0).mean())

    def opening(self, displacement: ArrayLike) -> float:
        """Share of a displacement at which the first row opens, no unit; one where none does.

        Parameters
        ----------
        displacement : (6,)
            m and rad.
        """
        q = np.asarray(displacement, dtype=float)
        if not self.opened(q):
            return 1.0
        low, high = 0.0, 1.0
        while high - low > 1e-6:
            middle = 0.5 * (low + high)
            low, high = (low, middle) if self.opened(middle * q) else (middle, high)
        return low
