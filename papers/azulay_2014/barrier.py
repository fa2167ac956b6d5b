"""The ring of singular poses that no machine of Azulay et al. 2014 crosses with six drives.

With its drives held each joint of the platform can only move along τ_i, across the last link and
in the leg's plane. With e_ij from joint j to joint i, of unit length, the platform is held if and
only if

    s = (e_12·τ_1)(e_23·τ_2)(e_31·τ_3) − (e_12·τ_2)(e_23·τ_3)(e_31·τ_1)

is not zero: s = 0 is a type 2 singularity (Azulay 2014, eq. 35), and det J⁻¹ is s times a factor
that no type 2 singularity changes. On the check points' hemisphere s has one sign at the pole and
the other at 90° whatever the roll, so every way between them crosses s = 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from strutwork.errors import NumericalError
from strutwork.kinematics import Poses, tangent_rotation
from strutwork.kinematics.frames import cross, dot, turned
from strutwork.machines import ThreeLegs
from strutwork.machines.legs import LegPlacement
from strutwork.machines.radial import Radial

Array = NDArray[Any]

#: Radius of the check points' hemisphere, m (section 3.2).
RADIUS = 4e-3
#: Tilts and rolls at which the sign is looked at: half a degree and five degrees.
TILTS, ROLLS = 181, 24
#: Halvings of half a degree: far below what any table shows.
HALVINGS = 40


@dataclass(frozen=True)
class Ring:
    """Tilts at which a machine is singular on the hemisphere, a roll each.

    Parameters
    ----------
    roll : (r,)
        rad, over a third of a turn, both ends included.
    tilt : (r,)
        The one tilt from the pole at which s is zero, rad.
    pole_sign : float
        Sign of s at the pole.
    radius : float
        Of the hemisphere, m.
    """

    roll: Array
    tilt: Array
    pole_sign: float
    radius: float

    def __repr__(self) -> str:
        low, high = self.extent
        return f"<Ring from {1e3 * low:.2f} to {1e3 * high:.2f} mm, {len(self.roll)} rolls>"

    @property
    def distance(self) -> Array:
        """Distance of the singular tool position from the pole's axis, m, (r,)."""
        return np.asarray(self.radius * np.sin(self.tilt))

    @property
    def extent(self) -> tuple[float, float]:
        """Least and largest distance over the rolls, m."""
        return float(self.distance.min()), float(self.distance.max())


def legs_at(machine: ThreeLegs, poses: Poses) -> tuple[Radial, LegPlacement]:
    """The platform's joints, and the legs that reach them."""
    points = poses.position[..., None, :] + turned(poses.rotation, machine.seats)
    radial = machine.radial(points)
    return radial, machine.place_legs(radial)


def signed(machine: ThreeLegs, poses: Poses) -> Array:
    """The function s of each pose: zero where the platform moves though its drives are held.

    Parameters
    ----------
    machine : ThreeLegs
    poses : Poses
        Batch (...).

    Returns
    -------
    (...) ndarray
        Pure numbers; not a number where a leg does not reach.
    """
    radial, legs = legs_at(machine, poses)
    points = radial.points
    tau = cross(radial.tangent, legs.link)
    # e_12, e_23, e_31
    apart = points - np.roll(points, -1, axis=-2)
    apart = apart / np.sqrt(dot(apart, apart))[..., None]
    own, other = dot(apart, tau), dot(apart, np.roll(tau, -1, axis=-2))
    s = own.prod(axis=-1) - other.prod(axis=-1)
    missing = np.any([fault.any(axis=-1) for fault in legs.faults.values()], axis=0)
    return np.asarray(np.where(missing, np.nan, s))


def tilted(machine: ThreeLegs, tilt: Array, roll: Array, radius: float = RADIUS) -> Poses:
    """Poses on the hemisphere, tangent to it, tilted towards the base's x axis.

    The guide is a whole circle, so that another direction is another roll and nothing else.
    """
    tilt, roll = np.broadcast_arrays(tilt, roll)
    normal = np.stack([np.sin(tilt), np.zeros(tilt.shape), np.cos(tilt)], axis=-1)
    centre = np.array([0.0, 0.0, machine.pole_height - radius])
    return Poses.of(centre + radius * normal, tangent_rotation(normal, roll))


def ring(machine: ThreeLegs, radius: float = RADIUS, rolls: int = ROLLS) -> Ring:
    """Where a machine is singular on the hemisphere.

    Parameters
    ----------
    machine : ThreeLegs
    radius : float
        m.
    rolls : int
        Steps of a third of a turn.

    Returns
    -------
    Ring

    Raises
    ------
    NumericalError
        The signed function does not change once and for all between pole and 90° at some roll.
    """
    roll = np.linspace(0.0, 2.0 * np.pi / 3.0, rolls + 1)
    grid = np.linspace(0.0, np.pi / 2.0, TILTS)
    s = signed(machine, tilted(machine, grid[:, None], roll, radius))
    # of a leg that does not reach the product is not a number, and is no change
    change = s[:-1] * s[1:] < 0
    if np.any(change.sum(axis=0) != 1) or np.isnan(s[: int(change.argmax(axis=0).max()) + 2]).any():
        raise NumericalError(
            f"{type(machine).__name__}",
            "does not cross one singular tilt at each roll between the pole and 90°.",
            "Choose another radius of the hemisphere or another height of its pole.",
        )
    first = change.argmax(axis=0)
    low, high = grid[first], grid[first + 1]
    sign = np.sign(s[0])
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        before = np.sign(signed(machine, tilted(machine, middle, roll, radius))) == sign
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return Ring(roll, 0.5 * (low + high), float(sign[0]), radius)


def pole_side(machine: ThreeLegs, dataset: xr.Dataset) -> NDArray[np.bool_]:
    """Which points of a stiffness map are held on the pole's side of the ring.

    Parameters
    ----------
    machine : ThreeLegs
    dataset : Dataset
        Of `stiffness_map`, with the roll chosen at each point.

    Returns
    -------
    (points,) of bool
        Without meaning where no roll counts.
    """
    normal = dataset["normal"].to_numpy()
    roll = np.nan_to_num(dataset["roll"].to_numpy())
    poses = Poses.of(dataset["position"].to_numpy(), tangent_rotation(normal, roll))
    home = float(np.sign(signed(machine, machine.home())))
    return np.asarray(np.sign(signed(machine, poses)) == home)
