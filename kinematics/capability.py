"""What the tool can do within the limits of every drive: polytopes, exact."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, product
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]

#: Generators of a zonotope whose corners are counted out: 2 to that power.
MOST = 16

#: Part of the largest one below which a direction or offset is none.
NOTHING = 1e-12


@dataclass(frozen=True)
class Zonotope:
    """Sums Σ tᵢ gᵢ with |tᵢ| ≤ 1, centred on zero.

    Forces of the tool, Cᵀ τ with |τᵢ| ≤ limitᵢ, are one for any number of drives (C, the inverse
    Jacobian); velocities and errors of the tool, J q̇, for as many drives as freedoms.

    Parameters
    ----------
    generators : (..., d, a)
        As columns, in units that may be compared.
    """

    generators: Array

    def __repr__(self) -> str:
        *batch, d, a = self.generators.shape
        return f"<Zonotope: {a} generators in {d} dimensions, batch {tuple(batch)}>"

    def support(self, direction: ArrayLike) -> Array:
        """Largest component along a direction, (...): Σ |gᵢ · n| (a unit vector's is a length).

        Parameters
        ----------
        direction : (d,) or (..., d)
            n, in the units in which the generators are compared; of a unit vector the result is a
            distance.
        """
        n = np.asarray(direction, dtype=float)
        return np.asarray(np.abs(np.einsum("...da,...d->...a", self.generators, n)).sum(axis=-1))

    @property
    def corners(self) -> Array:
        """Sums with all signs, (..., 2^(a−1), d), without their negatives: all vertices are there.

        Raises
        ------
        ModelError
            More than `MOST` generators.
        """
        count = self.generators.shape[-1]
        if count > MOST:
            raise ModelError(
                "zonotope", f"has {count} generators.", f"At most {MOST} are enumerated."
            )
        signs = np.array([(1.0, *rest) for rest in product((1.0, -1.0), repeat=count - 1)])
        return np.asarray(np.swapaxes(self.generators @ signs.T, -1, -2))

    @property
    def largest(self) -> Array:
        """Farthest vertex from zero, (...): the largest amplification, as the norm is convex."""
        return np.asarray(np.linalg.norm(self.corners, axis=-1).max(axis=-1))

    def facets(self) -> tuple[Array, Array]:
        """Unit normals (..., m, d) and offsets (..., m): |n · x| ≤ offset.

        A facet is parallel to d − 1 generators: its normal is at right angles to them and its
        offset the support there. Where those are dependent the offset is infinite.
        """
        d, count = self.generators.shape[-2:]
        picks = np.array(list(combinations(range(count), d - 1)), dtype=np.intp)
        chosen = np.moveaxis(self.generators[..., picks], -3, -1)
        size = np.linalg.norm(self.generators, axis=(-2, -1))[..., None]
        _, values, right = np.linalg.svd(chosen)
        normals = right[..., -1, :]
        smallest = values[..., -1] if d > 1 else np.ones(values.shape[:-1])
        offsets = np.abs(np.einsum("...md,...da->...ma", normals, self.generators)).sum(axis=-1)
        return normals, np.where(smallest <= NOTHING * size, np.inf, offsets)

    @property
    def guaranteed(self) -> Array:
        """Radius of the largest ball inside, (...): what can be had in every direction.

        Zero where the generators do not span the space.
        """
        d, count = self.generators.shape[-2:]
        values = np.linalg.svd(self.generators, compute_uv=False)
        flat = (
            np.ones(self.generators.shape[:-2], dtype=bool)
            if count < d
            else values[..., d - 1] <= NOTHING * values[..., 0]
        )
        _, offsets = self.facets()
        return np.where(flat, 0.0, offsets.min(axis=-1, initial=np.inf))


def force_zonotope(inverse: ArrayLike, limits: ArrayLike) -> Zonotope:
    """Forces that the tool can exert within the drives' limits, with any moment or without one.

    Parameters
    ----------
    inverse : (..., a, k)
        Columns of the inverse Jacobian: rates of the drives for the tool's velocities of one
        unit, as those of v alone; loads in the other directions are then borne elsewhere.
    limits : (a,)
        Greatest forces or moments of the drives, N or N·m.

    Raises
    ------
    ModelError
        Limits that are not positive, or rates that are not finite: at a serial singularity the
        drives bear any load in the direction that is lost.
    """
    matrix = _finite(inverse, "a serial singularity", "inverse Jacobian")
    return Zonotope(np.swapaxes(matrix, -1, -2) * _limits(limits, matrix.shape[-2]))


def velocity_zonotope(forward: ArrayLike, limits: ArrayLike) -> Zonotope:
    """Velocities, or errors, of the tool within the drives' limits, with any rotation.

    Parameters
    ----------
    forward : (..., k, a)
        Rows of the Jacobian of a machine with as many drives as freedoms: tool velocity per drive
        rate, units of the tool's over those of `limits`.
    limits : (a,)
        Greatest rates, m/s or rad/s, or errors, m or rad, of the drives.

    Raises
    ------
    ModelError
        Limits that are not positive, or velocities that are not finite: at a parallel
        singularity held drives do not hold the tool.
    """
    matrix = _finite(forward, "a parallel singularity", "Jacobian")
    return Zonotope(matrix * _limits(limits, matrix.shape[-1]))


def _finite(matrix: ArrayLike, where: str, what: str) -> Array:
    found = np.asarray(matrix, dtype=float)
    if found.ndim < 2 or not np.all(np.isfinite(found)):
        raise ModelError(
            what, "is not a finite matrix.", f"Leave out poses out of reach and at {where}."
        )
    return found


def _limits(limits: ArrayLike, count: int) -> Array:
    found = np.asarray(limits, dtype=float)
    if found.shape != (count,) or not np.all(np.isfinite(found) & (found > 0.0)):
        raise ModelError(
            "drives", f"have limits {found.tolist()}.", f"Give {count} positive numbers."
        )
    return found
