"""The Eclipse as Azulay et al. 2014 compare it: three legs, six drives."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians, sqrt
from typing import Any

from numpy.typing import NDArray

from strutwork.kinematics import Body, Joint
from strutwork.machines.legs import Leg, LegPlacement, hinge_on_column
from strutwork.machines.radial import Radial
from strutwork.machines.three_legs import ThreeLegs

Array = NDArray[Any]


@dataclass(frozen=True, kw_only=True)
class Eclipse3PPRS(ThreeLegs):
    """Circular P, vertical P, R about the tangent, S in each leg (Azulay 2014, section 4).

    A column on each carriage lifts a hinge above the guide's radius; the link runs from there
    inward and up to the platform. The drives are θ, the carriage's angle, and the height of the
    hinge above the guide.

    The column is a cantilever of constant length: a ram that the slide moves as a whole, held at
    its foot, which the carriage carries wherever the ram stands.

    Parameters
    ----------
    link_length : float
        L, m (Table 3).
    column_length : float
        Free length of the column, m. Calibrated: the paper does not give it, and 58 mm
        meets Table 4 best.
    pole_height : float
        m. Free: it moves all hinges alike and changes no stiffness (our choice: the column's
        foot stands on the guide at home).
    stroke : float
        Range of the hinge's height, m (Table 3, which does not say from where; our choice: half
        to each side of home).
    ball_neutral : float
        As `ThreeLegs`, rad.
    """

    link_length: float = 0.216
    column_length: float = 0.058
    pole_height: float = 0.219
    stroke: float = 0.065
    ball_neutral: float = radians(50.0)

    @property
    def lengths(self) -> tuple[str, ...]:
        """Fields that must be positive."""
        return (*super().lengths, "link_length", "column_length", "stroke")

    @property
    def leg(self) -> Leg:
        """Template of a leg."""
        drive = {} if self.drive_stiffness is None else {"z": self.drive_stiffness}
        rise = sqrt(self.link_length**2 - (self.base_radius - self.platform_radius) ** 2)
        middle, half = self.pole_height - rise, self.stroke / 2
        return Leg(
            nodes=("centre", "carriage", "guideway", "foot", "top", "root", "end"),
            bodies=(
                Body("carriage", ("centre", "carriage", "guideway")),
                Body("column", ("foot", "top")),
                Body("link", ("root", "end")),
            ),
            joints=(
                self.guide("centre"),
                Joint(
                    "slide",
                    "prismatic",
                    ("guideway", "foot"),
                    drive,
                    driven=("z",),
                    limits={"z": (middle - half, middle + half)},
                ),
                Joint("hinge", "revolute", ("top", "root"), limits={"rz": self.hinge_range}),
                self.ball,
            ),
            beams=(self.beam("column", "foot", "top"), self.beam("link", "root", "end")),
            lines=(("carriage", "foot"), ("foot", "top"), ("root", "end")),
        )

    def place_legs(self, seats: Radial) -> LegPlacement:
        """The hinge stands below the joint centre; the link leans over the guide's plane.

        Parameters
        ----------
        seats : Radial
            Joint centres on the platform.
        """

        def along(top: Array, hinge: Array) -> dict[str, Array]:
            foot = seats.at(self.base_radius, top - self.column_length)
            carriage = seats.at(self.base_radius, 0.0)
            return {"carriage": carriage, "guideway": foot, "foot": foot, "top": hinge}

        return hinge_on_column(seats, self.base_radius, self.link_length, 1.0, along)
