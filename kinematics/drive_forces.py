"""Inverse dynamics: forces and powers of drives, and joint reactions, of a motion."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError, SingularPoseError
from strutwork.kinematics.dynamics import PlacedDynamics
from strutwork.kinematics.frames import cross
from strutwork.kinematics.row_rates import row_rates

Array = NDArray[Any]

#: Share of the largest singular value of the drives' rates below which a motion is not driven.
DRIVEN = 1e-9
#: Share of the forces that drives may leave unbalanced: rounding.
BALANCE = 1e-8


@dataclass(frozen=True)
class Forces:
    """Forces along a motion; made by `inverse_dynamics`.

    Parameters
    ----------
    at : PlacedDynamics
    rates : (p, t)
        Of the coordinates, m/s or rad/s.
    twists, accelerations : (p, 6 b)
        Of the bodies at their centres of mass, m/s and rad/s, m/s² and rad/s².
    needed : (p, 6 b)
        What joints and drives must do to the bodies there, N and N·m.
    wrench : (p, 6)
        That acts on the tool at its centre point, N and N·m.
    """

    at: PlacedDynamics
    rates: Array
    twists: Array
    accelerations: Array
    needed: Array
    wrench: Array

    def __repr__(self) -> str:
        return f"<Forces: {self.at!r}>"

    @cached_property
    def coordinates(self) -> Array:
        """Q, the forces that go with the coordinates, (p, t)."""
        return np.asarray(np.einsum("pnt,pn->pt", self.at.placed.map, self.needed))

    @property
    def spins(self) -> Array:
        """Moments that bodies which spin freely would need not to, (p, k), N·m.

        Where they are not zero such a body begins to spin; the other forces hold while it does
        not.
        """
        return np.asarray(np.einsum("pnk,pn->pk", self.at.placed.spin_map, self.needed))

    @cached_property
    def drives(self) -> Array:
        """Forces of the drives, (p, a), N or N·m.

        With more drives than freedoms those of least norm, moments over the machine's size.

        Raises
        ------
        SingularPoseError
            A parallel singularity: there the drives do not hold the coordinates.
        ModelError
            Fewer drives than freedoms, which cannot make this motion.
        """
        scaled, size = self.at.scaled_drives
        dynamics = self.at.of
        enough = scaled.shape[-2] >= scaled.shape[-1]
        if enough and np.any(self.at.held <= DRIVEN):
            first = int(np.flatnonzero(self.at.held <= DRIVEN)[0])
            raise SingularPoseError(
                f"pose {first}",
                "is a parallel singularity: the drives do not hold the tool there.",
                "Omit it, or keep the path away from it.",
            )
        across = np.swapaxes(scaled, -1, -2)
        arm = np.where(dynamics.coordinates.rotary, dynamics.motion.length, 1.0)
        right = (self.coordinates / arm)[..., None]
        if scaled.shape[-2] == scaled.shape[-1]:
            found = np.linalg.solve(across, right)
        elif enough:
            found = scaled @ np.linalg.solve(across @ scaled, right)
        else:
            found = np.linalg.pinv(across) @ right
            left = np.abs(across @ found - right).max(initial=0.0)
            if left > BALANCE * np.abs(right).max(initial=0.0):
                raise ModelError(
                    "drives",
                    f"are {scaled.shape[-2]} for {scaled.shape[-1]} freedoms and cannot make this "
                    "motion.",
                    "Drive more joint directions, or hold the freedoms that nothing drives.",
                )
        return np.asarray(found[..., 0] * size)

    @property
    def rates_of_drives(self) -> Array:
        """Rates of the drives, (p, a), m/s or rad/s."""
        return np.asarray(np.einsum("pat,pt->pa", self.at.drive_map, self.rates))

    @property
    def accelerations_of_drives(self) -> Array:
        """Second derivatives of the drives' coordinates, (p, a), m/s² or rad/s²."""
        placed = self.at.placed
        drift = row_rates(placed.drives, placed.points, self.twists)
        steady = np.einsum("pan,pn->pa", drift, self.twists)
        return np.asarray(
            np.einsum("pan,pn->pa", placed.drives_on_bodies, self.accelerations) + steady
        )

    @property
    def powers(self) -> Array:
        """Powers of the drives, (p, a), W."""
        return np.asarray(self.drives * self.rates_of_drives)

    @property
    def given_power(self) -> Array:
        """Power of the wrench on the tool, (p,), W."""
        if not np.any(self.wrench):
            return np.zeros(self.at.poses)
        twist = np.einsum("pkn,pn->pk", self.at.placed.tool_on_bodies, self.twists)
        return np.asarray(np.sum(twist * self.wrench, axis=-1))

    @property
    def determined(self) -> bool:
        """Whether rigid bodies determine what the joints bear: none of them is held twice."""
        placed = self.at.placed
        square = self.at.drive_map.shape[-1] == self.at.drive_map.shape[-2]
        return square and len(placed.of.plan[0]) == len(placed.held)

    @property
    def reactions(self) -> Array:
        """Forces of each joint's first body on its second in the held directions, (p, r).

        In joint axes at the joint's place, N and N·m, in the order of `reaction_labels`.

        Raises
        ------
        ModelError
            An over-constrained or redundantly driven linkage, of which rigid bodies do not
            determine them.
        """
        if not self.determined:
            raise ModelError(
                "joint reactions",
                "are not determined: the linkage is over-constrained or driven redundantly. "
                "Rigid bodies do not determine how its joints share a load.",
                (
                    "Solve the elastic structure (`strutwork solve`), or free the redundant "
                    "directions."
                ),
            )
        placed = self.at.placed
        driven = np.einsum("pan,pa->pn", placed.drives_on_bodies, self.drives)
        return placed.row_forces(self.needed - driven)

    @property
    def reaction_labels(self) -> tuple[str, ...]:
        """Names of the reactions, `joint:direction`."""
        return self.at.placed.held.labels


def inverse_dynamics(
    at: PlacedDynamics, rates: ArrayLike, changes: ArrayLike, wrench: ArrayLike = 0.0
) -> Forces:
    """Drive forces that produce a motion.

    Parameters
    ----------
    at : PlacedDynamics
        At p poses.
    rates, changes : (p, t) or (t,)
        First and second derivatives of the coordinates, m/s or rad/s, m/s² or rad/s².
    wrench : (p, 6), (6,) or ()
        That acts on the tool at its centre point, N and N·m, global axes; 0 for none.
    """
    first, second = at.full(rates), at.full(changes)
    twists = at.placed.twists(first)
    accelerations = at.placed.accelerations(first, second)
    needed = at.weighted(accelerations[..., None])[..., 0].reshape(at.poses, -1, 6)
    spin = twists.reshape(at.poses, -1, 6)[..., 3:]
    needed[..., 3:] += cross(spin, np.einsum("pbij,pbj->pbi", at.inertia, spin))
    left = needed.reshape(at.poses, -1) - at.weights
    acting = np.zeros((at.poses, 6)) + np.asarray(wrench, dtype=float)
    if np.any(acting):
        left -= np.einsum("pkn,pk->pn", at.placed.tool_on_bodies, acting)
    return Forces(at, first, twists, accelerations, left, acting)
