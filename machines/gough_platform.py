"""The measuring Gough platform of Corbel 2008: six telescopes with length encoders."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import pi, radians
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import Poses
from strutwork.machines.dimensions import check_positive, check_proportions
from strutwork.machines.limits import Limit, joint_limits
from strutwork.machines.six_legs import LEGS, TOOL, SixLegs, foot, leg, seat
from strutwork.msa.beam import Beam
from strutwork.msa.materials import Material
from strutwork.msa.sections import Section, rod, tube
from strutwork.msa.springs import PointMass
from strutwork.msa.structure import Structure

Array = NDArray[Any]

#: Handbook values; the paper prints no material. Ours.
STEEL = Material.isotropic(210e9, 0.3, 7850.0, name="steel")

#: Of the part of a leg at the base and of that at the plate. Ours: slender, since the paper
#: wants the device light.
CYLINDER = tube(0.020, 0.016, name="tube 20/16")
ROD = rod(0.012, name="rod 12")


@dataclass(frozen=True, kw_only=True)
class GoughPlatform(SixLegs):
    """Six legs that measure their lengths and drive nothing (Corbel 2008, section II-C).

    Base and plate carry the joints in pairs, either side of three lines at 120°; those of the
    plate are turned by 60° against those of the base, so that each leg of a pair goes to
    another pair of the plate. Legs stand on balls that magnets hold; their spin about their own
    lines measures nothing, and here a universal joint at the base holds it. Encoders stand where
    another machine has its drives: its Jacobian relates the tool to the lengths, and its
    stiffness is that of telescopes clamped at their lengths, while the device itself follows
    without force.

    z points from the base to the plate and on to the tool.

    Parameters
    ----------
    base_radius, plate_radius : float
        r_b and r_TP, m (Table II).
    base_pair, plate_pair : float
        α_b and α_TP: angle between the two joints of a pair, seen from the centre, rad
        (Table II, whose columns are garbled; this order is the one that meets the leg range).
    plate_turn : float
        Of the plate's lines against the base's, rad. Read from Fig. 3's arrangement: at 60°
        the legs meet the printed leg range.
    plate_height : float
        Of the plate over the base at home, the middle of the workspace, m. Not printed; chosen
        so that the shortest leg over the workspace is the printed shortest one.
    workspace_side : float
        Of the cube that the plate's centre moves in, m (Fig. 5).
    shortest_leg, longest_leg : float
        m (section IV-C).
    tool : (float, float, float)
        From the plate's centre to the tool centre point, in the plate's axes, m. The paper's box
        of tools is not legible: the plate's centre here.
    cylinder_length : float
        Of the part of a leg at the base, m. Assumed.
    plate_mass : float
        kg. Assumed.
    material : Material
        Assumed.
    cylinder, rod : Section
        Assumed.

    Raises
    ------
    ModelError
        A dimension that is not positive or out of proportion, leg ranges that are none, or a
        home pose that cannot be taken.
    """

    base_radius: float = 0.375
    plate_radius: float = 0.075
    base_pair: float = radians(6.0)
    plate_pair: float = radians(40.0)
    plate_turn: float = radians(60.0)
    plate_height: float = 0.7735
    workspace_side: float = 0.3
    shortest_leg: float = 0.634
    longest_leg: float = 1.080
    tool: tuple[float, float, float] = (0.0, 0.0, 0.0)
    cylinder_length: float = 0.55
    plate_mass: float = 1.0
    material: Material = STEEL
    cylinder: Section = CYLINDER
    rod: Section = ROD

    #: The platform is over the base.
    side = 1.0

    def __post_init__(self) -> None:
        lengths = (
            *("base_radius", "plate_radius", "plate_height", "workspace_side"),
            *("shortest_leg", "longest_leg", "cylinder_length"),
        )
        check_positive(self, (*lengths, "plate_mass"))
        check_proportions("GoughPlatform", {name: getattr(self, name) for name in lengths})
        for name in ("base_pair", "plate_pair"):
            value = getattr(self, name)
            if not 0.0 < value < 2.0 * pi / 3.0:
                raise ModelError(
                    f"GoughPlatform.{name}",
                    f"is {value!r}.",
                    "Give an angle between 0 and 120 degrees, rad.",
                )
        if not self.cylinder_length < self.shortest_leg < self.longest_leg:
            raise ModelError(
                "GoughPlatform",
                f"its cylinders of {self.cylinder_length:g} m do not fit legs of "
                f"{self.shortest_leg:g} to {self.longest_leg:g} m.",
                "Make cylinder_length the least of the three and longest_leg the largest.",
            )
        home = self.place(self.home())
        short = (
            home.values[[home.names.index((leg(i, "ram"), "z")) for i in LEGS]].min()
            < self.cylinder_length
        )
        if not home.reachable or short:
            raise ModelError(
                "GoughPlatform",
                "cannot stand at home: a leg is shorter than its cylinder.",
                "Raise plate_height.",
            )

    @property
    def ram_limits(self) -> Mapping[str, tuple[float, float]]:
        """Shortest and longest leg, m."""
        return {"z": (self.shortest_leg, self.longest_leg)}

    def slide_at(self, length: Array) -> Array:
        """At the end of the cylinder, whatever the leg's length: (...), m.

        Parameters
        ----------
        length : (...)
            Of the leg, m.
        """
        return np.broadcast_to(np.asarray(self.cylinder_length, length.dtype), length.shape)

    @cached_property
    def structure(self) -> Structure:
        """The linkage with slender telescopes; base and plate are rigid."""
        beams = []
        for i in LEGS:
            ends = (leg(i, "head"), leg(i, "slide")), (leg(i, "rod"), leg(i, "end"))
            beams += [
                Beam(leg(i, "cylinder"), ends[0], self.material, self.cylinder),
                Beam(leg(i, "piston"), ends[1], self.material, self.rod),
            ]
        across = self.plate_mass * self.plate_radius**2 / 4.0
        disc = ((across, 0.0, 0.0), (0.0, across, 0.0), (0.0, 0.0, 2.0 * across))
        x, y, z = self.tool
        mass = PointMass(TOOL, self.plate_mass, disc, offset=(-x, -y, -z))
        return Structure(self.linkage, tuple(beams), masses=(mass,))

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        """Ranges of the legs' lengths; the balls' are not printed."""
        return joint_limits(self.linkage)

    @cached_property
    def feet(self) -> Array:
        """Joint centres of the base, (6, 3), m: legs 1 and 2 at the first line, and so on."""
        lines = np.repeat(np.arange(3) * (2.0 * pi / 3.0), 2)
        turn = lines + np.tile([-0.5, 0.5], 3) * self.base_pair
        return _circle(self.base_radius, turn, np.zeros(3))

    @cached_property
    def seats(self) -> Array:
        """Joint centres of the plate in the tool's axes, (6, 3), m."""
        lines = np.arange(3) * (2.0 * pi / 3.0) + self.plate_turn
        # the second leg of a pair of the base and the first of the next meet at a line
        after = np.repeat(lines, 2) + np.tile([-0.5, 0.5], 3) * self.plate_pair
        return _circle(self.plate_radius, np.roll(after, 1), -np.asarray(self.tool))

    def home(self) -> Poses:
        """The plate level in the middle of the workspace."""
        return self.at_plate(np.array([0.0, 0.0, self.plate_height]))

    def at_plate(self, centre: Array) -> Poses:
        """Level poses by the place of the plate's centre.

        Parameters
        ----------
        centre : (..., 3)
            m.
        """
        return Poses.of(np.asarray(centre) + np.asarray(self.tool))

    def skeleton(self) -> Sequence[tuple[str, str]]:
        """Pairs of nodes that a drawing connects by a line."""
        return (
            *((leg(i, "head"), leg(i, "slide")) for i in LEGS),
            *((leg(i, "rod"), leg(i, "end")) for i in LEGS),
            *((foot(i), foot(i % 6 + 1)) for i in LEGS),
            *((seat(i), seat(i % 6 + 1)) for i in LEGS),
            *((seat(i), TOOL) for i in (1, 3, 5)),
        )


def _circle(radius: float, turn: Array, centre: Array) -> Array:
    flat = np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], axis=-1)
    return np.asarray(radius * flat + centre)
