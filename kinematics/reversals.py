"""Reversals of the drives over a surface: signs, singular points, lines, plates.

A drive that turns back goes through its friction and its play; where the tool goes over a surface
so that none does, neither leaves a mark (Son 2002, chapter 4).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError, UnreachableError
from strutwork.kinematics.clear_paths import ClearPath, longest_clear_path
from strutwork.kinematics.drive_fields import DriveField
from strutwork.kinematics.plates import plate_borders, plates, reach
from strutwork.kinematics.reversal_cones import sectors
from strutwork.kinematics.reversal_points import DriveSingularities, Patch, singularities
from strutwork.kinematics.zero_lines import zero_lines

Array = NDArray[Any]

#: A drive that moves less than this over the whole patch, m or rad, does not move.
STILL = 1e-9


@dataclass(frozen=True)
class Reversals:
    """Behaviour of the drives over a patch of a surface.

    Parameters
    ----------
    field : DriveField
    patch : Patch
    gradient : (k, l, n, 2)
        Of the drives' coordinates over the parameters at the grid's points; NaN at points that
        the machine cannot take.
    """

    field: DriveField
    patch: Patch
    gradient: Array

    def __repr__(self) -> str:
        k, l, n, _ = self.gradient.shape  # noqa: E741
        return f"<Reversals: {n} drives, {k} x {l} points>"

    @property
    def reachable(self) -> NDArray[np.bool_]:
        """Grid points that the machine can take, (k, l)."""
        return np.asarray(~np.isnan(self.gradient).any(axis=(2, 3)))

    @cached_property
    def moving(self) -> NDArray[np.intp]:
        """Indices of the drives that move, (a,); the others turn back nowhere."""
        size = np.nanmax(np.abs(self.gradient * self.patch.span), axis=(0, 1, 3), initial=0.0)
        return np.flatnonzero(size > STILL)

    @cached_property
    def singular(self) -> tuple[DriveSingularities, ...]:
        """Singular points and lines of every drive that moves."""
        return singularities(self.field, self.patch, self.gradient, self.moving)

    def signs(self, feed: ArrayLike) -> NDArray[np.int8]:
        """Of the drives' speeds along a feed direction (2,) at the grid's points, (k, l, n).

        0 where a drive stands still, and out of reach.

        Parameters
        ----------
        feed : (2,)
            Change of the parameters, of any length, in their units.
        """
        speed = self.gradient @ np.asarray(feed, dtype=float)
        return np.asarray(np.nan_to_num(np.sign(speed)), dtype=np.int8)

    def lines(self, feed: ArrayLike) -> dict[str, list[Array]]:
        """Lines on which a feed direction (2,) makes a drive turn back, (c, 2) each, by drive.

        Drives that the feed does not move anywhere have none.

        Parameters
        ----------
        feed : (2,)
            Change of the parameters, of any length, in their units.
        """
        way = np.asarray(feed, dtype=float)
        values = self.gradient @ way
        size = np.nanmax(np.abs(values), axis=(0, 1), initial=0.0)
        whole = np.nanmax(np.abs(self.gradient), axis=(0, 1, 3), initial=0.0)
        # what rounding leaves of a drive that the feed does not move has signs as well
        moved = np.array([k for k in self.moving if size[k] > STILL * whole[k]], dtype=np.intp)

        def speed(points: Array, which: NDArray[np.intp]) -> Array:
            along = self.field.gradient(points) @ way
            return np.asarray(along[np.arange(len(points)), moved[which]])

        found = zero_lines(speed, values[..., moved], self.patch.u, self.patch.v)
        return {self.field.drives[k]: lines for k, lines in zip(moved, found, strict=True)}

    def cones(self, point: ArrayLike) -> tuple[Array, NDArray[np.int8]]:
        """Cones of directions without a reversal at a point (2,): `sectors` of its gradients.

        Parameters
        ----------
        point : (2,)
            Values of the parameters, in their units.

        Raises
        ------
        UnreachableError
            The machine cannot take the point.
        """
        g = self.field.gradient(np.asarray(point, dtype=float)[None])[0]
        if np.isnan(g).any():
            raise UnreachableError("point", "cannot be reached.", "Choose one within reach.")
        still = np.setdiff1d(np.arange(len(g)), self.moving)
        g[still] = 0.0
        return sectors(g)

    @cached_property
    def plates(self) -> NDArray[np.intp]:
        """Number of the plate at each grid point, from 1; 0 on borders and out of reach, (k, l)."""
        return plates(self.gradient * self.patch.span, self.moving)

    def plate_borders(self) -> dict[tuple[str, str], list[Array]]:
        """Lines on which the gradients of two drives are parallel, (c, 2) each, by the drives."""
        return plate_borders(self.field, self.patch, self.gradient * self.patch.span, self.moving)

    def reach(self, start: tuple[int, int]) -> NDArray[np.bool_]:
        """Grid points to which a path without a reversal leads from one of them, (k, l).

        The paths go by straight steps between grid points; a finer grid finds more of them.

        Parameters
        ----------
        start : (int, int)
            Which grid point along u and v.
        """
        return reach(self.patch, self.gradient, self.moving, start)

    def longest(self, ways: ArrayLike, lines: int = 21) -> ClearPath | None:
        """Longest straight path without a reversal along directions (w, 2) of the parameters.

        Parameters
        ----------
        ways : (w, 2)
            Directions of the parameters, of any length, in their units.
        lines : int
            Evenly spaced lines along each way across the patch.
        """
        return longest_clear_path(self.field, self.patch, ways, self.moving, lines)


def reversals(field: DriveField, u: ArrayLike, v: ArrayLike) -> Reversals:
    """Reversals of the drives over a rectangle of the parameters.

    Parameters
    ----------
    field : DriveField
    u, v : (k,), (l,)
        Grid along the parameters, in their units, ascending, three points or more. What comes and
        goes within one cell, and does not show in the index of a gradient, is not seen.

    Returns
    -------
    Reversals

    Raises
    ------
    ModelError
        A grid that does not ascend or is too small.
    UnreachableError
        The machine can take no point of it.
    """
    axes = [np.asarray(a, dtype=float) for a in (u, v)]
    for name, axis in zip(("first", "second"), axes, strict=True):
        if axis.ndim != 1 or len(axis) < 3 or not np.all(np.diff(axis) > 0.0):
            raise ModelError(
                f"{name} parameter",
                "is not an ascending row of three or more values.",
                "Give a range from a lower to a higher value.",
            )
    patch = Patch(*axes)
    gradient = field.gradient(patch.points)
    if np.isnan(gradient).any(axis=(1, 2)).all():
        raise UnreachableError(
            "surface",
            "has no point that the machine can reach.",
            "Move the range into its reach.",
        )
    shape = (len(patch.u), len(patch.v), *gradient.shape[1:])
    return Reversals(field, patch, gradient.reshape(shape))
