"""The biglide of Chablat, Wenger and Majou 2003: two carriages, two parallelograms, one plane."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.kinematics import Linkage, Placement, Poses, angle
from strutwork.kinematics.frames import frame, gathered, vector
from strutwork.machines import biglide_parts as parts
from strutwork.machines.dimensions import OR_RIGID, check_positive, check_proportions
from strutwork.machines.legs import square_root
from strutwork.machines.limits import Limit, joint_limits
from strutwork.msa.materials import Material
from strutwork.msa.sections import Section, box
from strutwork.msa.springs import PointMass
from strutwork.msa.structure import Structure

Array = NDArray[Any]

#: Our choice; the paper names no material.
STEEL = Material.isotropic(210e9, 0.3, 7850.0, name="steel")

#: Our choice: 50 mm in the plane, 120 mm along the pins, since a plane machine carries what acts
#: across its plane by the bending of its rods.
ROD = box(0.050, 0.120, 0.005, name="box 50 x 120 x 5")

#: The tool may stand off the plane, and be turned, by this much, m and rad: rounding.
PLANE = 1e-9

#: What a pose of a leg, or of the tool, is refused for.
REACH = "its end is farther from the rail than its rod is long"
OFF = "the tool is outside the plane z = 0 in which the machine moves"
TURNED = "the tool is rotated, which the parallelograms prevent"


@dataclass(frozen=True, kw_only=True)
class Biglide:
    """Two carriages on crossed rails, each with a parallelogram to the platform (section 3.1).

    Rails lie along x and y, and everything moves in the x-y plane; every pin lies along z. The
    tool stands at the origin S where the rails would cross: there the rods are at right angles,
    each along its rail, and the machine is isotropic. The parallelograms keep the platform from
    turning. With the legs' length L, ρ₁ = x − √(L² − y²) and ρ₂ = y − √(L² − x²).

    The paper gives the legs' length of one, the rails and the parallelograms, and nothing of what
    makes the machine stiff or heavy: that is assumed, and so are the places of the pins, which do
    not matter to its motion.

    Parameters
    ----------
    leg_length : float
        L, m (section 3.3: one).
    pin_distance : float
        Between the two rods of a leg, m. Assumed.
    seat_distance : float
        Of the middle of a leg's pins from the tool, against its rail's direction, m. Assumed.
    drive_stiffness : float or None
        Of a carriage's drive, N/m; None holds it rigidly.
    carriage_mass, platform_mass : float
        kg, with drive or spindle. Assumed.
    material, section : Material, Section
        Of the rods. Assumed; the section's y lies in the plane, its z along the pins.

    Raises
    ------
    ModelError
        A length, stiffness or mass that is not positive, or lengths out of proportion.
    """

    leg_length: float = 1.0
    pin_distance: float = 0.20
    seat_distance: float = 0.15
    drive_stiffness: float | None = None
    carriage_mass: float = 20.0
    platform_mass: float = 30.0
    material: Material = STEEL
    section: Section = ROD

    def __post_init__(self) -> None:
        name = type(self).__name__
        check_positive(self, (*self.lengths, "carriage_mass", "platform_mass"))
        check_positive(self, ["drive_stiffness"], OR_RIGID)
        depths = {f"section, {k}": size for k, size in enumerate(self.section.outline)}
        check_proportions(name, {f: getattr(self, f) for f in self.lengths} | depths)

    @property
    def lengths(self) -> tuple[str, ...]:
        """Fields that must be positive and in proportion."""
        return ("leg_length", "pin_distance", "seat_distance")

    @property
    def turning(self) -> bool:
        """Whether a third leg turns the tool."""
        return False

    @cached_property
    def linkage(self) -> Linkage:
        """Bodies and joints."""
        bodies = parts.bodies(self.turning)
        return Linkage(
            tuple(n for b in bodies for n in b.nodes),
            bodies,
            tuple(parts.joints(self.turning, self.drive_stiffness)),
            parts.TOOL,
        )

    @cached_property
    def structure(self) -> Structure:
        """The linkage with its flexible rods; carriages and platform are rigid."""
        return Structure(
            self.linkage,
            beams=parts.beams(self.material, self.section),
            masses=(self._plate(parts.TOOL), *self._carriages(parts.LEGS)),
        )

    def _plate(self, node: str) -> PointMass:
        """The platform as a square plate, as wide as its pins are apart."""
        across = self.platform_mass * (2.0 * self.seat_distance) ** 2 / 12.0
        rows = ((across, 0.0, 0.0), (0.0, across, 0.0), (0.0, 0.0, 2.0 * across))
        return PointMass(node, self.platform_mass, rows)

    def _carriages(self, legs: Sequence[int]) -> tuple[PointMass, ...]:
        return tuple(PointMass(parts.carriage(i, "slide"), self.carriage_mass) for i in legs)

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        """Joint ranges: none, the paper bounds the velocity amplification instead."""
        return joint_limits(self.linkage)

    @staticmethod
    def poses(x: ArrayLike, y: ArrayLike = 0.0) -> Poses:
        """Poses in the plane; broadcast.

        Parameters
        ----------
        x, y : (...)
            Place of the tool, m.
        """
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        return Poses.of(np.stack([x, y, np.zeros_like(x)], axis=-1), np.eye(3))

    def home(self) -> Poses:
        """The tool at S."""
        return self.poses(0.0)

    def skeleton(self) -> Sequence[tuple[str, str]]:
        """Pairs of nodes that a drawing connects by a line."""
        return parts.lines(self.turning)

    def place(self, poses: Poses) -> Placement:
        """Inverse kinematics, each carriage behind the tool on its rail, batch first.

        Analytic in the pose, which may carry a complex step; what of it lies outside the motions
        of the machine moves no drive.

        Parameters
        ----------
        poses : Poses
            Of the tool, (...).

        Returns
        -------
        Placement
            Values: of each leg its carriage's place ρ on the rail, m, and the turns of its pins,
            rad. Poses out of the plane, turned or out of reach are marked with a reason; their
            positions are finite and without meaning.
        """
        positions, frames, values, faults = self._placed(poses)
        masks = np.stack(
            [np.broadcast_to(m, poses.position.shape[:-1]) for m in faults.values()], -1
        )
        first = np.where(masks.any(axis=-1), masks.argmax(axis=-1) + 1, 0)
        shape = poses.position.shape
        return Placement(
            gathered([np.broadcast_to(positions[n], shape) for n in self.linkage.nodes], 1),
            gathered([frames[j.name] for j in self.linkage.joints], 2),
            gathered(list(values.values()), 0),
            tuple(values),
            first.astype(np.int8),
            tuple(faults),
        )

    def _placed(
        self, poses: Poses
    ) -> tuple[dict[str, Array], dict[str, Array], dict[tuple[str, str], Array], dict[str, Array]]:
        """Nodes, joint axes, joint coordinates, and where a pose cannot be taken, by name."""
        tool, axes = poses.position, np.eye(3)[:2]
        positions: dict[str, Array] = {parts.TOOL: tool}
        frames: dict[str, Array] = {}
        values: dict[tuple[str, str], Array] = {}
        faults = self._faults(poses)
        for i in parts.LEGS:
            along, across = axes[i - 1], axes[2 - i]
            aside = tool[..., 2 - i]
            rise, missing = square_root(self.leg_length**2 - aside * aside, self.leg_length)
            faults[f"leg {i}: {REACH}"] = missing
            place = tool[..., i - 1] - rise
            slide = (place - self.seat_distance)[..., None] * along
            positions |= {parts.rail(i): slide, parts.carriage(i, "slide"): slide}
            middle = tool - self.seat_distance * along
            # about z, from the rail: a rod of leg 2 that leans towards x turns backwards
            turn = angle(aside if i == 1 else -aside, rise)
            line = rise[..., None] * along + aside[..., None] * across
            values[parts.guide(i), "z"] = place
            frames[parts.guide(i)] = _rail_frame(along, across, slide.shape)
            # axes move with a joint's first part: the carriage, then the rod
            lower = np.broadcast_to(_pin_frame(along), (*slide.shape, 3))
            upper = _pin_frame(line / self.leg_length)
            for r, sign in zip(parts.RODS, (0.5, -0.5), strict=True):
                shift = sign * self.pin_distance * across
                foot, end = parts.rod(i, r, "foot"), parts.rod(i, r, "end")
                positions |= {parts.carriage(i, r): slide + shift, foot: slide + shift}
                positions |= {end: middle + shift, parts.seat(i, r): middle + shift}
                values |= {(foot, "rz"): turn, (end, "rz"): -turn}
                frames |= {foot: lower, end: upper}
        return positions, frames, values, faults

    def _faults(self, poses: Poses) -> dict[str, Array]:
        """Where the tool stands as the platform cannot, by the reason."""
        turned = np.abs(poses.rotation.real - np.eye(3)).max(axis=(-1, -2))
        return {
            OFF: np.abs(poses.position[..., 2].real) > PLANE,
            TURNED: np.broadcast_to(turned > PLANE, poses.position.shape[:-1]),
        }


def _rail_frame(along: Array, across: Array, shape: tuple[int, ...]) -> Array:
    """Axes of a guide, (..., 3, 3): z along its rail."""
    axes = np.stack([across, np.cross(along, across), along], axis=-1)
    return np.broadcast_to(axes, (*shape, 3))


def _pin_frame(line: Array) -> Array:
    """Axes of pins along z whose x runs along the rods, (..., 3, 3)."""
    x, y = line[..., 0], line[..., 1]
    return frame(line, vector(-y, x, 0.0), vector(0.0 * x, 0.0, 1.0))
