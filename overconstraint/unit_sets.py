"""The shapes of tolerance zones, at unit size.

A zone's parameters z range over a convex set that is symmetric about zero. Its support function
h(c) = max cᵀz says what the zone can do at worst to a quantity that is linear in z; the
maximiser says how.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]


class UnitSet(Protocol):
    """A convex set of parameters, symmetric about zero."""

    @property
    def dimension(self) -> int:
        """Number of parameters."""

    def support(self, direction: Array) -> Array:
        """Largest cᵀz over the set, (...).

        Parameters
        ----------
        direction : (..., d)
            Coefficients c of z in the quantity, any unit.
        """

    def extreme(self, direction: Array) -> Array:
        """A z at which it is reached, (..., d); zero where the direction is zero.

        Parameters
        ----------
        direction : (..., d)
            Coefficients c of z in the quantity, any unit.
        """

    def inside(self, uniform: Array) -> Array:
        """Points uniform in the set, (..., d).

        Parameters
        ----------
        uniform : (..., d)
            Numbers in [0, 1], no unit.
        """

    def surface(self, uniform: Array) -> Array:
        """Points on the set's surface, (..., d).

        Parameters
        ----------
        uniform : (..., d)
            Numbers in [0, 1], no unit.
        """

    def gauge(self, point: Array) -> Array:
        """What the set must be scaled by for the point to lie on its surface, (...).

        Parameters
        ----------
        point : (..., d)
            z, no unit.
        """

    @property
    def surface_variance(self) -> float:
        """Variance of every parameter over `surface`; they are not correlated."""


@dataclass(frozen=True)
class Interval:
    """−1 ≤ z ≤ 1.

    Parameters
    ----------
    dimension : int
        Number of parameters: 1.
    """

    dimension: int = 1

    def support(self, direction: Array) -> Array:
        """Largest cᵀz over the set, (...).

        Parameters
        ----------
        direction : (..., 1)
            Coefficients c of z in the quantity, any unit.
        """
        return np.asarray(np.abs(direction[..., 0]))

    def extreme(self, direction: Array) -> Array:
        """A z at which it is reached, (..., 1).

        Parameters
        ----------
        direction : (..., 1)
            Coefficients c of z in the quantity, any unit.
        """
        return np.sign(direction)

    def inside(self, uniform: Array) -> Array:
        """Points uniform in the set, (..., 1).

        Parameters
        ----------
        uniform : (..., 1)
            Numbers in [0, 1], no unit.
        """
        return np.asarray(2 * uniform - 1)

    def surface(self, uniform: Array) -> Array:
        """Points on its surface, (..., 1).

        Parameters
        ----------
        uniform : (..., 1)
            Numbers in [0, 1], no unit.
        """
        return np.where(uniform < 0.5, -1.0, 1.0)

    def gauge(self, point: Array) -> Array:
        """Scale of the set at which a point lies on its surface, (...).

        Parameters
        ----------
        point : (..., 1)
            z, no unit.
        """
        return np.asarray(np.abs(point[..., 0]))

    @property
    def surface_variance(self) -> float:
        """Variance of every parameter over the surface."""
        return 1.0


@dataclass(frozen=True)
class Disc:
    """|z| ≤ 1 in the plane: a tilted axis in its cone, a centre in its circle.

    Parameters
    ----------
    dimension : int
        Number of parameters: 2.
    """

    dimension: int = 2

    def support(self, direction: Array) -> Array:
        """Largest cᵀz over the set, (...).

        Parameters
        ----------
        direction : (..., 2)
            Coefficients c of z in the quantity, any unit.
        """
        return np.asarray(np.hypot(direction[..., 0], direction[..., 1]))

    def extreme(self, direction: Array) -> Array:
        """A z at which it is reached, (..., 2).

        Parameters
        ----------
        direction : (..., 2)
            Coefficients c of z in the quantity, any unit.
        """
        return _unit(direction)

    def inside(self, uniform: Array) -> Array:
        """Points uniform in the set, (..., 2).

        Parameters
        ----------
        uniform : (..., 2)
            Numbers in [0, 1], no unit.
        """
        return np.asarray(np.sqrt(uniform[..., 1:]) * self.surface(uniform))

    def surface(self, uniform: Array) -> Array:
        """Points on its surface, (..., 2).

        Parameters
        ----------
        uniform : (..., 2)
            Numbers in [0, 1], no unit.
        """
        turn = 2 * np.pi * uniform[..., 0]
        return np.stack([np.cos(turn), np.sin(turn)], axis=-1)

    def gauge(self, point: Array) -> Array:
        """Scale of the set at which a point lies on its surface, (...).

        Parameters
        ----------
        point : (..., 2)
            z, no unit.
        """
        return np.asarray(np.linalg.norm(point, axis=-1))

    @property
    def surface_variance(self) -> float:
        """Variance of every parameter over the surface."""
        return 1 / 2


@dataclass(frozen=True)
class Ball:
    """|z| ≤ 1 in space: a point in its sphere.

    Parameters
    ----------
    dimension : int
        Number of parameters: 3.
    """

    dimension: int = 3

    def support(self, direction: Array) -> Array:
        """Largest cᵀz over the set, (...).

        Parameters
        ----------
        direction : (..., 3)
            Coefficients c of z in the quantity, any unit.
        """
        return np.asarray(np.linalg.norm(direction, axis=-1))

    def extreme(self, direction: Array) -> Array:
        """A z at which it is reached, (..., 3).

        Parameters
        ----------
        direction : (..., 3)
            Coefficients c of z in the quantity, any unit.
        """
        return _unit(direction)

    def inside(self, uniform: Array) -> Array:
        """Points uniform in the set, (..., 3).

        Parameters
        ----------
        uniform : (..., 3)
            Numbers in [0, 1], no unit.
        """
        return np.asarray(np.cbrt(uniform[..., 2:]) * self.surface(uniform))

    def surface(self, uniform: Array) -> Array:
        """Points on its surface, (..., 3).

        Parameters
        ----------
        uniform : (..., 3)
            Numbers in [0, 1], no unit.
        """
        turn, height = 2 * np.pi * uniform[..., 0], 2 * uniform[..., 1] - 1
        radius = np.sqrt(np.maximum(1 - height**2, 0.0))
        return np.stack([radius * np.cos(turn), radius * np.sin(turn), height], axis=-1)

    def gauge(self, point: Array) -> Array:
        """Scale of the set at which a point lies on its surface, (...).

        Parameters
        ----------
        point : (..., 3)
            z, no unit.
        """
        return np.asarray(np.linalg.norm(point, axis=-1))

    @property
    def surface_variance(self) -> float:
        """Variance of every parameter over the surface."""
        return 1 / 3


@dataclass(frozen=True)
class PlaneZone:
    """|z₁| + |z₂| + |z₃| ≤ 1: a plane between two parallel planes.

    z₁ is the height of a rectangle's middle, z₂ and z₃ the heights that its two tilts add at its
    edges, as shares of half the distance of the planes: its corners lie between them.

    Parameters
    ----------
    dimension : int
        Number of parameters: 3.
    """

    dimension: int = 3

    def support(self, direction: Array) -> Array:
        """Largest cᵀz over the set, (...).

        Parameters
        ----------
        direction : (..., 3)
            Coefficients c of z in the quantity, any unit.
        """
        return np.asarray(np.abs(direction).max(axis=-1))

    def extreme(self, direction: Array) -> Array:
        """A z at which it is reached, (..., 3).

        Parameters
        ----------
        direction : (..., 3)
            Coefficients c of z in the quantity, any unit.
        """
        first = np.abs(direction).argmax(axis=-1)[..., None] == np.arange(3)
        return np.where(first, np.sign(direction), 0.0)

    def inside(self, uniform: Array) -> Array:
        """Points uniform in the set, (..., 3).

        Parameters
        ----------
        uniform : (..., 3)
            Numbers in [0, 1], no unit.
        """
        side, size = np.where(uniform < 0.5, -1.0, 1.0), np.abs(2 * uniform - 1)
        # the volume of the corner beyond z₁ goes with the cube of what is left, and so on
        first = 1 - np.cbrt(1 - size[..., 0])
        second = (1 - first) * (1 - np.sqrt(1 - size[..., 1]))
        third = (1 - first - second) * size[..., 2]
        return np.asarray(side * np.stack([first, second, third], axis=-1))

    def surface(self, uniform: Array) -> Array:
        """Points on its surface, (..., 3).

        Parameters
        ----------
        uniform : (..., 3)
            Numbers in [0, 1], no unit.
        """
        side, size = np.where(uniform < 0.5, -1.0, 1.0), np.abs(2 * uniform - 1)
        first = 1 - np.sqrt(1 - size[..., 0])
        second = (1 - first) * size[..., 1]
        return np.asarray(side * np.stack([first, second, 1 - first - second], axis=-1))

    def gauge(self, point: Array) -> Array:
        """Scale of the set at which a point lies on its surface, (...).

        Parameters
        ----------
        point : (..., 3)
            z, no unit.
        """
        return np.asarray(np.abs(point).sum(axis=-1))

    @property
    def surface_variance(self) -> float:
        """Variance of every parameter over the surface."""
        return 1 / 6


def _unit(direction: Array) -> Array:
    size = np.linalg.norm(direction, axis=-1, keepdims=True)
    return np.asarray(direction / np.where(size == 0, 1.0, size))
