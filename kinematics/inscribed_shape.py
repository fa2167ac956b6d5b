"""Boxes, balls and cylinders that grow about a centre: gauges, tangents, borders."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]
Kind = Literal["box", "ball", "cylinder"]


@dataclass(frozen=True)
class InscribedShape:
    """A convex shape about the origin, of size one.

    Its gauge is the size at which it reaches a point; a shape of size s is all points whose
    gauge is at most s.

    Parameters
    ----------
    kind : "box", "ball" or "cylinder"
        A ball of unequal halves is an ellipsoid. The axis of a cylinder is the last of its own
        directions, about which the first two halves are its radius.
    half : (d,)
        Half of its size along each of its own directions, m and rad.
    rotation : (d, d) or None
        Its own directions as columns, orthonormal; those of the space by default.

    Raises
    ------
    ModelError
        Halves that are not positive, a rotation that is none, or a cylinder that is not in space
        or not round.
    """

    kind: Kind
    half: Array
    rotation: Array | None = None

    def __post_init__(self) -> None:
        half = np.asarray(self.half, dtype=float)
        turn = np.eye(len(half)) if self.rotation is None else np.asarray(self.rotation, float)
        if half.ndim != 1 or not np.all((half > 0) & np.isfinite(half)):
            raise ModelError("shape", f"has the halves {half}.", "Give positive numbers.")
        if turn.shape != (half.size,) * 2 or np.abs(turn @ turn.T - np.eye(half.size)).max() > 1e-9:
            raise ModelError(
                "shape", "has a matrix that is not a rotation.", "Give orthonormal columns."
            )
        if self.kind == "cylinder" and (half.size != 3 or half[0] != half[1]):
            raise ModelError(
                "shape",
                "is no cylinder.",
                "A cylinder has three directions and one radius: half = [r, r, h].",
            )
        object.__setattr__(self, "half", half)
        object.__setattr__(self, "rotation", turn)

    @property
    def turn(self) -> Array:
        """Its own directions as columns, (d, d)."""
        assert self.rotation is not None  # noqa: S101 - set when it was made
        return self.rotation

    def __repr__(self) -> str:
        return f"<InscribedShape: {self.kind}, half {self.half.tolist()}>"

    @property
    def measure(self) -> float:
        """Length, area or volume at size one."""
        d = self.half.size
        unit = {
            "box": 2.0**d,
            "ball": (2.0, np.pi, 4 * np.pi / 3)[d - 1] if d <= 3 else np.nan,
            "cylinder": 2 * np.pi,
        }
        return float(unit[self.kind] * np.prod(self.half))

    def _own(self, points: Array) -> Array:
        return np.asarray(points @ self.turn / self.half)

    def gauge(self, points: Array) -> Array:
        """Size at which the shape reaches points, (...) of (..., d).

        Parameters
        ----------
        points : (..., d)
            From the shape's centre, m and rad.
        """
        own = self._own(points)
        if self.kind == "ball":
            return np.asarray(np.linalg.norm(own, axis=-1))
        if self.kind == "cylinder":
            return np.maximum(np.hypot(own[..., 0], own[..., 1]), np.abs(own[..., 2]))
        return np.asarray(np.abs(own).max(axis=-1))

    def tangent(self, points: Array) -> Array:
        """Normals n with n·p the gauge of p, and n·q at most that of any q, (p, d).

        Parameters
        ----------
        points : (p, d)
            From the shape's centre and not at it, m and rad.
        """
        own = self._own(points)
        flat = np.zeros_like(own)
        if self.kind == "box":
            face = np.abs(own).argmax(axis=-1)
            rows = np.arange(len(own))
            flat[rows, face] = np.where(own[rows, face] < 0.0, -1.0, 1.0)
        elif self.kind == "ball":
            flat = own / np.linalg.norm(own, axis=-1, keepdims=True)
        else:
            around = np.hypot(own[:, 0], own[:, 1])
            side = around >= np.abs(own[:, 2])
            flat[side, :2] = own[side, :2] / around[side, None]
            flat[~side, 2] = np.sign(own[~side, 2])
        return np.asarray(flat / self.half @ self.turn.T)

    def support(self, normals: ArrayLike) -> Array:
        """How far the shape of size one reaches along normals, (...) of (..., d).

        Parameters
        ----------
        normals : (..., d)
            Of any length, 1/m and 1/rad, so that the result has no unit.
        """
        own = np.asarray(normals, dtype=float) @ self.turn * self.half
        if self.kind == "ball":
            return np.asarray(np.linalg.norm(own, axis=-1))
        if self.kind == "cylinder":
            return np.asarray(np.hypot(own[..., 0], own[..., 1]) + np.abs(own[..., 2]))
        return np.asarray(np.abs(own).sum(axis=-1))

    def border(self, count: int) -> Array:
        """Points of the border, (k, d): a grid of `count` on each side of a cube, made to fit.

        Corners and, with an odd count, middles are among them.

        Parameters
        ----------
        count : int
            Points along each side of the cube.
        """
        points = self.filled(count)
        rim = np.isclose(self.cube(count), 1.0)
        return self.fitted(points[rim])

    def fitted(self, points: Array) -> Array:
        """Points moved along their rays to the border, (..., d); none may be the origin.

        Parameters
        ----------
        points : (..., d)
            From the shape's centre, m and rad.
        """
        return np.asarray(points / self.gauge(points)[..., None])

    def cube(self, count: int) -> Array:
        """Largest own coordinate of the points of a grid in the cube of halves one, (k,).

        Parameters
        ----------
        count : int
            Points along each side.
        """
        return np.asarray(np.abs(_cube(self.half.size, count)).max(axis=-1))

    def filled(self, count: int) -> Array:
        """Points that fill the shape, border included, (k, d).

        Parameters
        ----------
        count : int
            Points along each side of the cube that is made to fit.
        """
        cube = _cube(self.half.size, count)
        level = np.abs(cube).max(axis=-1)
        points = (cube * self.half) @ self.turn.T
        gauge = self.gauge(points)
        # each shell of the cube on the shape's of the same size
        return np.asarray(
            points * np.divide(level, gauge, out=np.ones_like(gauge), where=gauge > 0)[:, None]
        )


def _cube(dimensions: int, count: int) -> Array:
    axis = np.linspace(-1.0, 1.0, count)
    grids = np.meshgrid(*[axis] * dimensions, indexing="ij")
    return np.stack([g.ravel() for g in grids], axis=-1)


def plane_turn(angle: float) -> Array:
    """Rotation of a plane's shape by an angle, rad, (2, 2).

    Parameters
    ----------
    angle : float
        rad, from the first direction to the second.
    """
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])


def box_of(sides: Sequence[float]) -> InscribedShape:
    """A box of given proportions along the directions themselves.

    Parameters
    ----------
    sides : (d,) of float
        Whole sides, m and rad; only their ratios count where the box is to grow.
    """
    return InscribedShape("box", np.asarray(sides, dtype=float) / 2)
