"""Surfaces in the space of the tool's task coordinates, over two parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.joint import DIRECTIONS

Array = NDArray[Any]

#: Height, slopes (m, 2) and second derivatives (m, 2, 2) over points (m, 2) of x and y, m.
Height = Callable[[Array], tuple[Array, Array, Array]]


class TaskSurface(Protocol):
    """Task coordinates over two parameters."""

    @property
    def parameters(self) -> tuple[str, str]:
        """Directions of the tool that the parameters are."""

    @property
    def named(self) -> tuple[str, ...]:
        """Directions of the tool that the surface gives."""

    def task(self, points: Array) -> tuple[dict[str, Array], Array]:
        """Task coordinates and their derivatives: (m,) each, m and rad, and (m, t, 2).

        Parameters
        ----------
        points : (m, 2)
            Values of the parameters, m or rad.
        """


@dataclass(frozen=True)
class Plane:
    """Two task coordinates, each for itself; the others stay.

    Parameters
    ----------
    parameters : (str, str)
        Directions of the tool: x, y, z of the tool centre point, rx, ry, rz of its rotation
        vector from home.

    Raises
    ------
    ModelError
        An unknown direction, or one twice.
    """

    parameters: tuple[str, str]

    def __post_init__(self) -> None:
        first, second = self.parameters
        for name in self.parameters:
            if name not in DIRECTIONS:
                raise ModelError(
                    "surface",
                    f'names the unknown direction "{name}".',
                    "Directions are " + ", ".join(DIRECTIONS) + ".",
                )
        if first == second:
            raise ModelError("surface", f"names {first} twice.", "Name two directions.")

    @property
    def named(self) -> tuple[str, ...]:
        """The two."""
        return self.parameters

    def task(self, points: Array) -> tuple[dict[str, Array], Array]:
        """The two coordinates, (m,) each, and their derivatives, (m, 2, 2).

        Parameters
        ----------
        points : (m, 2)
            Values of the parameters, m or rad.
        """
        rates = np.broadcast_to(np.eye(2), (len(points), 2, 2))
        return {name: points[:, k] for k, name in enumerate(self.parameters)}, rates


@dataclass(frozen=True)
class Dome:
    """A surface over x and y that is machined from above: z, and the tilts where it asks.

    Parameters
    ----------
    height : callable
        Of `sphere`, `paraboloid`, or a function of one's own.
    orientation : "vertical" or "normal"
        The tool stays as at home, or turns from there by the least rotation that takes z into
        the surface's normal.
    """

    height: Height
    orientation: Literal["vertical", "normal"] = "vertical"

    @property
    def parameters(self) -> tuple[str, str]:
        """Directions of the parameters: x and y."""
        return "x", "y"

    @property
    def named(self) -> tuple[str, ...]:
        """Directions that it gives."""
        return ("x", "y", "z") if self.orientation == "vertical" else ("x", "y", "z", "rx", "ry")

    def task(self, points: Array) -> tuple[dict[str, Array], Array]:
        """Coordinates x, y, z, if normal rx and ry, (m,) each, and their derivatives (m, t, 2).

        Parameters
        ----------
        points : (m, 2)
            x and y, m.
        """
        z, slope, bend = self.height(points)
        found = {"x": points[:, 0], "y": points[:, 1], "z": z}
        flat = np.broadcast_to(np.eye(2), (len(points), 2, 2))
        rates = np.concatenate([flat, slope[:, None]], axis=1)
        if self.orientation == "vertical":
            return found, rates
        # from z into (−z_x, −z_y, 1): about (z_y, −z_x, 0) by the arc tangent of its length
        square = (slope * slope).sum(axis=-1)
        share, change = _arc_share(square)
        axis = np.stack([slope[:, 1], -slope[:, 0]], axis=-1)
        turn = np.stack([bend[:, 1], -bend[:, 0]], axis=1)
        grows = 2.0 * np.einsum("mi,mij->mj", slope, bend)
        tilt = share[:, None] * axis
        tilts = share[:, None, None] * turn + change[:, None, None] * (
            axis[:, :, None] * grows[:, None, :]
        )
        found |= {"rx": tilt[:, 0], "ry": tilt[:, 1]}
        return found, np.concatenate([rates, tilts], axis=1)


def sphere(radius: float, top: ArrayLike) -> Height:
    """Height of a sphere.

    Parameters
    ----------
    radius : float
        m.
    top : (3,)
        Its highest point, m.

    Raises
    ------
    ModelError
        A radius that is not positive; later, points that are not above the sphere.
    """
    peak = _checked(radius, top, "sphere")

    def height(points: Array) -> tuple[Array, Array, Array]:
        aside = points - peak[:2]
        left = radius**2 - (aside * aside).sum(axis=-1)
        if np.any(left <= 0.0):
            raise ModelError(
                "surface",
                f"reaches beyond the sphere's radius of {1e3 * radius:g} mm.",
                "Use a smaller range, or a larger radius.",
            )
        rise = np.sqrt(left)[:, None]
        slope = -aside / rise
        bend = -(np.eye(2) + slope[:, :, None] * slope[:, None, :]) / rise[:, :, None]
        return peak[2] - radius + rise[:, 0], slope, bend

    return height


def paraboloid(radius: float, top: ArrayLike) -> Height:
    """Height of a paraboloid of revolution.

    Parameters
    ----------
    radius : float
        Of curvature at its top, m.
    top : (3,)
        Its highest point, m.

    Raises
    ------
    ModelError
        A radius that is not positive.
    """
    peak = _checked(radius, top, "paraboloid")

    def height(points: Array) -> tuple[Array, Array, Array]:
        aside = points - peak[:2]
        z = peak[2] - (aside * aside).sum(axis=-1) / (2 * radius)
        return z, -aside / radius, np.broadcast_to(-np.eye(2) / radius, (len(points), 2, 2))

    return height


def _checked(radius: float, top: ArrayLike, what: str) -> Array:
    if not (np.isfinite(radius) and radius > 0.0):
        raise ModelError(f"surface {what}", f"has the radius {radius:g} m.", "Give a positive one.")
    return np.asarray(top, dtype=float)


def _arc_share(square: Array) -> tuple[Array, Array]:
    """arctan(r)/r of r², and its derivative over r²."""
    small = square < 1e-4
    safe = np.where(small, 1.0, square)
    root = np.sqrt(safe)
    share = np.arctan(root) / root
    change = (1.0 / (1.0 + safe) - share) / (2.0 * safe)
    # the series to r¹⁰: what it leaves out is below rounding
    near = 1 - square / 3 + square**2 / 5 - square**3 / 7 + square**4 / 9
    slope = -1 / 3 + 2 * square / 5 - 3 * square**2 / 7 + 4 * square**3 / 9 - 5 * square**4 / 11
    return np.where(small, near, share), np.where(small, slope, change)
