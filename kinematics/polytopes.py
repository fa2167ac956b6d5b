"""Polytopes round zero by their half-spaces, |A x| ≤ b: sections, projections, vertices."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError

from strutwork.errors import ModelError, NumericalError
from strutwork.kinematics.capability import Zonotope

Array = NDArray[Any]


@dataclass(frozen=True)
class Polytope:
    """Points x with |A x| ≤ b, at one pose.

    Velocities of the tool within the drives' rates, |C v| ≤ q̇, for any number of drives; forces
    without any moment, a section of the `Zonotope` of forces and moments.

    Parameters
    ----------
    normals : (m, d)
        A, in the unit of b over that of x: any unit.
    offsets : (m,)
        b, any unit, positive; rows with an infinite one do not count.
    """

    normals: Array
    offsets: Array

    def __repr__(self) -> str:
        return (
            f"<Polytope: {2 * len(self.offsets)} half-spaces in {self.normals.shape[1]} dimensions>"
        )

    @classmethod
    def of(cls, zonotope: Zonotope) -> Polytope:
        """The half-spaces of a zonotope, one pose.

        Parameters
        ----------
        zonotope : Zonotope
            Without batch axes.

        Raises
        ------
        ModelError
            More than one pose.
        """
        if zonotope.generators.ndim != 2:
            raise ModelError("polytope", "of a batch of poses.", "Choose one pose.")
        normals, offsets = zonotope.facets()
        kept = np.isfinite(offsets)
        return cls(normals[kept], offsets[kept])

    @classmethod
    def of_rates(cls, inverse: ArrayLike, limits: ArrayLike) -> Polytope:
        """Velocities whose drive rates, (a, d) of them, keep the limits (a,).

        Parameters
        ----------
        inverse : (a, d)
            Drive rates per velocity of the tool, columns of the inverse Jacobian, units of `limits`
            per that of the velocity.
        limits : (a,)
            Greatest rates of the drives, m/s or rad/s, positive.
        """
        return cls(np.asarray(inverse, dtype=float), np.asarray(limits, dtype=float))

    def section(self, directions: tuple[int, ...]) -> Polytope:
        """Its points whose other coordinates are zero.

        Parameters
        ----------
        directions : tuple of int
            Numbers of the coordinates that stay.
        """
        return Polytope(self.normals[:, list(directions)], self.offsets)

    @property
    def guaranteed(self) -> float:
        """Radius of the largest ball inside."""
        size = np.linalg.norm(self.normals, axis=1)
        active = size > 0.0
        return float((self.offsets[active] / size[active]).min(initial=np.inf))

    @cached_property
    def vertices(self) -> Array:
        """(v, d).

        Raises
        ------
        NumericalError
            It has no end, or no inside.
        """
        rows = np.concatenate([self.normals, -self.normals])
        b = np.concatenate([self.offsets, self.offsets])
        rank = np.linalg.matrix_rank(self.normals)
        if rank < self.normals.shape[1] or not np.all(b > 0.0):
            raise NumericalError(
                "polytope",
                "is unbounded or has no interior.",
                "The pose is singular: choose another.",
            )
        half = np.concatenate([rows, -b[:, None]], axis=1)
        try:
            found = HalfspaceIntersection(half, np.zeros(rows.shape[1])).intersections
        except QhullError as error:
            raise NumericalError(
                "polytope", f"has no distinct vertices: {error}", "Take another pose."
            ) from error
        scale = np.abs(found).max()
        _, index = np.unique(np.round(found / scale, 10), axis=0, return_index=True)
        return np.asarray(found[np.sort(index)])

    @property
    def largest(self) -> float:
        """Farthest vertex from zero."""
        return float(np.linalg.norm(self.vertices, axis=1).max())

    def projection(self, directions: tuple[int, ...]) -> Polytope:
        """Its shadow: some coordinates of its points, whatever the others.

        Parameters
        ----------
        directions : tuple of int
            Numbers of the coordinates that stay.
        """
        shadow = self.vertices[:, list(directions)]
        hull = ConvexHull(shadow)
        equations = hull.equations
        return Polytope(equations[:, :-1], -equations[:, -1])
