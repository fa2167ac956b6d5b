"""Rigid-body dynamics of a linkage: equation of motion, drive forces, joint reactions, energy.

With N from the rates of the coordinates x to the twists of the bodies about their centres of
mass (`body_motion`), M_b the mass of the bodies and w their weights:

    M ẍ + C ẋ + g = Q,  M = Nᵀ M_b N,  C = Nᵀ (M_b Ṅ + Ω I N),  g = −Nᵀ w

(virtual power, Kane and Levinson 1985, section 6.1). Ω I is the matrix [ω]× I of each body, so
that Ṁ − 2 C is skew.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError, NumericalError, SingularPoseError
from strutwork.kinematics.body_masses import BodyMasses
from strutwork.kinematics.body_motion import BodyMotion
from strutwork.kinematics.coordinates import Coordinates
from strutwork.kinematics.frames import cross_matrix
from strutwork.kinematics.motion import Motion, Moved
from strutwork.kinematics.placed_motion import PlacedMotion

Array = NDArray[Any]

#: Share of the largest entry at which the least eigenvalue of a mass matrix is rounding.
POSITIVE = 1e-12
#: Share of the momentum of a free spin that may be in motions of the coordinates: rounding.
BALANCED = 1e-7

STANDARD_GRAVITY = (0.0, 0.0, -9.80665)


@dataclass(frozen=True)
class Dynamics:
    """A linkage of rigid bodies with mass.

    Elastic directions of joints are held, springs and dampers are left out.

    Parameters
    ----------
    motion : Motion
    masses : BodyMasses
        At the motion's home, bodies in the order of `Linkage.body_names`.
    coordinates : Coordinates
        That describe the motion, as many as it has freedoms.
    gravity : (3,)
        m/s².

    Raises
    ------
    ModelError
        Masses of another number of bodies, a gravity that is not three finite numbers, or as
        `BodyMotion`.
    """

    motion: Motion
    masses: BodyMasses
    coordinates: Coordinates
    gravity: ArrayLike = STANDARD_GRAVITY
    bodies: BodyMotion = field(init=False, repr=False)

    def __post_init__(self) -> None:
        names = self.motion.linkage.body_names
        if len(self.masses.mass) != len(names):
            raise ModelError(
                "body masses",
                f"are those of {len(self.masses.mass)} bodies; the linkage has {len(names)}.",
                "Give one for each of: " + ", ".join(names) + ".",
            )
        pull = np.asarray(self.gravity, dtype=float)
        if pull.shape != (3,) or not np.all(np.isfinite(pull)):
            raise ModelError("gravity", "is not three finite numbers.", "Give m/s² along x, y, z.")
        made = BodyMotion(self.motion, self.coordinates, self.masses.centre)
        object.__setattr__(self, "bodies", made)

    def at(self, moved: Moved) -> PlacedDynamics:
        """The dynamics at reached poses; batch axes are made one.

        Parameters
        ----------
        moved : Moved
            Poses that the motion has reached, any batch axes.

        Raises
        ------
        UnreachableError
            A pose that was not reached.
        SingularPoseError
            A pose at which the coordinates do not determine how the bodies move.
        ModelError
            A body that spins freely and is not balanced about its line: how it moves depends on
            more than the coordinates.
        """
        placed = self.bodies.at(moved)
        if placed.singular.any():
            first = int(np.flatnonzero(placed.singular)[0])
            raise SingularPoseError(
                f"pose {first}",
                f"is singular: there {', '.join(self.coordinates.labels)} do not determine how "
                "the bodies move (a leg is at the end of its working mode).",
                "Omit such poses, or describe the motion by other coordinates.",
            )
        made = PlacedDynamics(self, placed)
        if self.bodies.idle:
            made.require_balanced()
        return made


@dataclass(frozen=True)
class PlacedDynamics:
    """Dynamics at p poses; made by `Dynamics.at`.

    Forces go with the coordinates or drives: N along a shift, N·m about a turn.

    Parameters
    ----------
    of : Dynamics
        The linkage with its masses and coordinates.
    placed : PlacedMotion
        How its bodies move at the p poses.
    """

    of: Dynamics
    placed: PlacedMotion

    def __repr__(self) -> str:
        return f"<PlacedDynamics: {len(self.of.coordinates)} coordinates, {self.poses} poses>"

    @property
    def poses(self) -> int:
        """Number of poses."""
        return len(self.placed.position)

    @cached_property
    def inertia(self) -> Array:
        """Inertia of the bodies about their centres, global axes, (p, b, 3, 3), kg·m²."""
        turn = self.placed.rotation
        return np.asarray(turn @ self.of.masses.inertia @ np.swapaxes(turn, -1, -2))

    def weighted(self, twists: Array) -> Array:
        """M_b times twists or their time derivatives, (p, 6 b, k).

        Parameters
        ----------
        twists : (p, 6 b, k)
            Of the bodies at their centres of mass, m/s and rad/s; or accelerations, m/s² and
            rad/s².
        """
        parts = twists.reshape(self.poses, -1, 6, twists.shape[-1])
        result = np.empty_like(parts)
        result[:, :, :3] = self.of.masses.mass[:, None, None] * parts[:, :, :3]
        result[:, :, 3:] = self.inertia @ parts[:, :, 3:]
        return result.reshape(twists.shape)

    @cached_property
    def weights(self) -> Array:
        """Weights of the bodies as wrenches at their centres, (p, 6 b)."""
        result = np.zeros((self.poses, len(self.of.masses.mass), 6))
        result[..., :3] = self.of.masses.mass[:, None] * np.asarray(self.of.gravity, dtype=float)
        return result.reshape(self.poses, -1)

    @cached_property
    def mass(self) -> Array:
        """M, (p, t, t), symmetric positive definite.

        Raises
        ------
        NumericalError
            A motion of the coordinates that moves no mass.
        """
        matrix = np.swapaxes(self.placed.map, -1, -2) @ self.weighted(self.placed.map)
        matrix = (matrix + np.swapaxes(matrix, -1, -2)) / 2.0
        size = np.sqrt(np.abs(np.diagonal(matrix, axis1=-2, axis2=-1)))
        size = np.where(size > 0, size, 1.0)
        least = np.linalg.eigvalsh(matrix / size[:, :, None] / size[:, None, :])[:, 0]
        if least.min(initial=np.inf) <= POSITIVE:
            raise NumericalError(
                "mass matrix",
                f"is not positive at pose {int(np.argmin(least))}: the bodies that move there "
                "have no mass.",
                "Give the tool's body and what it carries a mass.",
            )
        return np.asarray(matrix)

    def require_balanced(self) -> None:
        """Refuse bodies that spin freely and whose spin moves the others, or is moved by them.

        Raises
        ------
        ModelError
            Names the body.
        """
        spins = self.placed.spin_map
        weighted = self.weighted(spins)
        own = np.einsum("pnk,pnk->pk", spins, weighted)
        other = np.einsum("pnt,pnt->pt", self.placed.map, self.weighted(self.placed.map))
        shared = np.abs(np.swapaxes(self.placed.map, -1, -2) @ weighted)
        most = np.sqrt(other[:, :, None] * own[:, None, :])
        bad = np.argwhere(shared > BALANCED * np.where(most > 0, most, 1.0))
        if len(bad):
            raise ModelError(
                f"body {self.of.bodies.idle[int(bad[0, 2])]}",
                "rotates freely about a line about which its mass is not balanced: the "
                "coordinates do not determine how it moves.",
                "Hold or drive the joint that lets it move, or give a coordinate of that joint.",
            )

    def coriolis(self, rates: ArrayLike) -> Array:
        """C at rates (p, t) of the coordinates, (p, t, t); Ṁ − 2 C is skew.

        Parameters
        ----------
        rates : (p, t) or (t,)
            Of the coordinates, m/s or rad/s.
        """
        given = self.full(rates)
        spin = self.placed.twists(given).reshape(self.poses, -1, 6)[..., 3:]
        whole = self.weighted(self.placed.map_rate(given))
        parts = self.placed.map.reshape(self.poses, -1, 6, len(self.of.coordinates))
        turned = cross_matrix(spin) @ self.inertia @ parts[:, :, 3:]
        whole.reshape(parts.shape)[:, :, 3:] += turned
        return np.asarray(np.swapaxes(self.placed.map, -1, -2) @ whole)

    @property
    def weight(self) -> Array:
        """The force g of the coordinates that holds the bodies against gravity, (p, t)."""
        return np.asarray(-np.einsum("pnt,pn->pt", self.placed.map, self.weights))

    def kinetic(self, rates: ArrayLike) -> Array:
        """Kinetic energy at rates (p, t), (p,), J.

        Parameters
        ----------
        rates : (p, t) or (t,)
            Of the coordinates, m/s or rad/s.
        """
        twists = self.placed.twists(self.full(rates))
        momenta = self.weighted(twists[..., None])[..., 0]
        return np.asarray(np.sum(twists * momenta, axis=-1) / 2.0)

    @property
    def potential(self) -> Array:
        """Potential energy of the weights, zero at the origin, (p,), J."""
        pull = np.asarray(self.of.gravity, dtype=float)
        return np.asarray(-np.einsum("b,pbi,i->p", self.of.masses.mass, self.placed.points, pull))

    def full(self, rates: ArrayLike) -> Array:
        """Numbers for the coordinates, broadcast to all poses, (p, t).

        Parameters
        ----------
        rates : (p, t), (t,) or ()
            One number for a coordinate, in any unit.
        """
        shape = (self.poses, len(self.of.coordinates))
        return np.broadcast_to(np.asarray(rates, dtype=float), shape)

    @cached_property
    def drive_map(self) -> Array:
        """Rates of the drives per rate of the coordinates, (p, a, t)."""
        return np.asarray(self.placed.drives_on_bodies @ self.placed.map)

    @cached_property
    def scaled_drives(self) -> tuple[Array, Array]:
        """`drive_map` with turns at the machine's size, and the size of each drive, (a,)."""
        length = self.of.motion.length
        turning = np.array([d.startswith("r") for _, d in self.of.motion.linkage.driven])
        size = np.where(turning, length, 1.0)
        arm = np.where(self.of.coordinates.rotary, length, 1.0)
        return size[:, None] * self.drive_map / arm, size

    @cached_property
    def drive_values(self) -> Array:
        """Singular values of that map, largest first, (p, min(a, t))."""
        return np.asarray(np.linalg.svd(self.scaled_drives[0], compute_uv=False))

    @property
    def held(self) -> Array:
        """How well the drives hold the coordinates, (p,): least over largest singular value.

        The largest counts as one at least. 0 at a parallel singularity, or with fewer drives than
        freedoms.
        """
        values = self.drive_values
        count = len(self.of.coordinates)
        if values.shape[-1] < count or not count:
            return np.zeros(self.poses)
        return np.asarray(values[:, -1] / np.maximum(values[:, 0], 1.0))

    @property
    def drive_sign(self) -> Array:
        """Sense of as many drives as coordinates, (p,), else 0; it changes at singularities."""
        scaled = self.scaled_drives[0]
        if scaled.shape[-1] != scaled.shape[-2]:
            return np.zeros(self.poses)
        return np.asarray(np.linalg.slogdet(scaled)[0])
