"""A set of rolling contacts between two bodies: forces and stiffness by their displacement."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.contact.law import ContactLaw

Array = NDArray[Any]

#: Approach, as a share of the displacement of a roller, that is rounding.
ROUNDING = 1e-14


@dataclass(frozen=True)
class Contacts:
    """Balls or rollers between a body that stands and one that is displaced.

    A ball lies between two grooves. The approach of its contacts is the growth of the distance
    between the centres of the grooves' sections, in the plane across the direction of rolling
    (Jones 1960; Harris, Rolling Bearing Analysis): the contact angle changes with the load. A slice
    of a roller is pressed along a fixed normal. Speeds are low: no centrifugal force acts.

    All vectors are in the axes of the bearing.

    Parameters
    ----------
    points : (n, 3)
        Centres of the moving body's grooves, from the centre of the bearing, m.
    normals : (n, 3)
        Unit vectors from the centre of the standing groove to that of the moving one: a contact
        closes where the moving body is displaced along them.
    rolling : (n, 3)
        Unit vectors along which the elements roll and bear nothing.
    distances : (n,)
        Between the centres of the two grooves where the contacts just touch, m; infinite of
        rollers, whose normal stays.
    shifts : (n, 3)
        By how much the moving grooves are displaced where the bearing is not, m: preload; across
        `rolling`.
    rows : (n,)
        Which row each element belongs to.
    law : ContactLaw
        Of each element with both of its contacts.
    """

    points: Array
    normals: Array
    rolling: Array
    distances: Array
    shifts: Array
    rows: NDArray[np.intp]
    law: ContactLaw

    def __len__(self) -> int:
        return len(self.points)

    def shifted(self, shifts: ArrayLike) -> Self:
        """The same with other shifts.

        Parameters
        ----------
        shifts : (n, 3) or (3,)
            m.
        """
        return replace(self, shifts=np.broadcast_to(np.asarray(shifts, float), (len(self), 3)))

    def joined(self, other: Contacts) -> Contacts:
        """These and others of the same law as one set; the others' rows come after.

        Parameters
        ----------
        other : Contacts
        """
        after = int(self.rows.max()) + 1
        both = {
            name: np.concatenate([getattr(self, name), getattr(other, name)])
            for name in ("points", "normals", "rolling", "distances", "shifts")
        }
        return Contacts(**both, rows=np.concatenate([self.rows, other.rows + after]), law=self.law)

    def approach(self, displacement: ArrayLike) -> Array:
        """Approach of each element's contacts, (n,), m; negative where they are open.

        Parameters
        ----------
        displacement : (6,)
            Of the moving body at the centre: translation and small rotation, m and rad.
        """
        return self._state(displacement)[0]

    def elements(self, displacement: ArrayLike) -> Array:
        """Force on each element, (n,), N.

        Parameters
        ----------
        displacement : (6,)
            m and rad.
        """
        return self.law.force(self.approach(displacement))

    def energy(self, displacement: ArrayLike) -> float:
        """Energy of all contacts, J.

        Parameters
        ----------
        displacement : (6,)
            m and rad.
        """
        return float(self.law.energy(self.approach(displacement)).sum())

    def loads(self, displacement: ArrayLike) -> Array:
        """Force and moment on the moving body that hold a displacement, (6,), N and N·m.

        The gradient of the energy.

        Parameters
        ----------
        displacement : (6,)
            m and rad; also complex, for derivatives.
        """
        approach, directions, _ = self._state(displacement)
        forces = self.law.force(approach)[:, None] * directions
        moments = np.cross(self.points, forces)
        return np.concatenate([forces.sum(axis=0), moments.sum(axis=0)])

    def tangent(self, displacement: ArrayLike) -> Array:
        """Derivative of the loads, (6, 6) symmetric, N/m, N and N·m.

        Parameters
        ----------
        displacement : (6,)
            m and rad.
        """
        approach, w, spans = self._state(displacement)
        force, slope = self.law.force(approach), self.law.slope(approach)
        along = w[:, :, None] * w[:, None, :]
        plane = np.eye(3) - self.rolling[:, :, None] * self.rolling[:, None, :] - along
        turned = np.where(np.isfinite(spans), force / spans, 0.0)
        local = slope[:, None, None] * along + turned[:, None, None] * plane
        # displacement of a groove by that of the body: u + θ × p
        motion = np.zeros((len(self), 3, 6))
        motion[:, :, :3] = np.eye(3)
        x, y, z = self.points.T
        motion[:, 0, 4], motion[:, 0, 5] = z, -y
        motion[:, 1, 3], motion[:, 1, 5] = -z, x
        motion[:, 2, 3], motion[:, 2, 4] = y, -x
        result = motion.reshape(-1, 6).T @ (local @ motion).reshape(-1, 6)
        return np.asarray(0.5 * (result + result.T))

    def _state(self, displacement: ArrayLike) -> tuple[Array, Array, Array]:
        """Approach (n,), direction of the force (n, 3), distance between the centres (n,)."""
        q = np.asarray(displacement)
        moved = q[:3] + np.cross(np.broadcast_to(q[3:], self.points.shape), self.points)
        tiny = ROUNDING * np.sqrt((np.abs(moved) ** 2).sum(axis=-1))
        moved = moved - (moved * self.rolling).sum(axis=-1)[:, None] * self.rolling + self.shifts
        straight = (moved * self.normals).sum(axis=-1)
        ball = np.isfinite(self.distances)
        rest = np.where(ball, self.distances, 1.0)
        across = moved - straight[:, None] * self.normals
        # |a + w| − |a| = w·(2 a + w) / (|a + w| + |a|), which keeps the digits of small motions
        span = np.sqrt((rest + straight) ** 2 + (across**2).sum(axis=-1))
        grown = ((moved**2).sum(axis=-1) + 2.0 * rest * straight) / (span + rest)
        directions = ((rest + straight)[:, None] * self.normals + across) / span[:, None]
        # a roller across the load is not closed by rounding, of whose root its slope is
        straight = np.where((straight.real > 0.0) & (straight.real <= tiny), 0.0, straight)
        return (
            np.where(ball, grown, straight),
            np.where(ball[:, None], directions, self.normals),
            np.where(ball, span, np.inf),
        )
