"""The Glozman machine as Azulay et al. 2014 compare it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import radians
from typing import Self

import numpy as np

from strutwork.kinematics import Body, Joint, angle
from strutwork.machines.legs import Leg, LegPlacement, full, square_root
from strutwork.machines.limits import Limit
from strutwork.machines.radial import Radial
from strutwork.machines.three_legs import ThreeLegs


@dataclass(frozen=True, kw_only=True)
class Glozman3PRRS(ThreeLegs):
    """Circular P, R, middle link, R, last link, S in each leg (Azulay 2014, section 4).

    Both revolute joints turn about the tangent of the guide. The drives are θ, the carriage's
    angle, and the turn of the first revolute joint (the shoulder); the second one (the
    elbow) stands outside and above the straight line from shoulder to platform.

    Parameters
    ----------
    link_length : float
        Of each of the two links, m (section 4, Table 3).
    drive_stiffness : float or None
        Radial stiffness of the shoulder, N/m, whose turn is held rigidly. Calibrated: with
        the paper's 3 N/µm in this place Table 4 is met best; the paper does not say how a
        stiffness in N/µm acts on a turning drive. None: no radial flexibility.
    pole_height : float
        m. Not in the paper; calibrated to Table 4's order of the machines by Kzz, which holds
        with spherical joints for poles from 200 to 202 mm only: a lower pole leaves the elbow
        bent and the machine soft along z (0.5 N/µm at 174 mm), a higher one stretches the legs.
    apparent_pole_height : float
        m. The same for `apparent`, whose clamped links do not bend at the elbow alone.
    ball_neutral : float
        As `ThreeLegs`, rad.
    """

    link_length: float = 0.130
    pole_height: float = 0.201
    apparent_pole_height: float = 0.174
    ball_neutral: float = radians(20.0)

    @property
    def lengths(self) -> tuple[str, ...]:
        """Fields that must be positive."""
        return (*super().lengths, "link_length", "apparent_pole_height")

    def apparent(self) -> Self:
        """The model that the paper's Tables 2 and 4 suggest, at the pole that fits it."""
        return replace(super().apparent(), pole_height=self.apparent_pole_height)

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        """Joint ranges; the revolute joint's is that of the last link's elevation."""
        low, high = self.hinge_range
        elbows = (Limit(full(i, "elbow"), "elevation", low, high, "revolute") for i in (1, 2, 3))
        return (*elbows, *super().limits)

    @property
    def leg(self) -> Leg:
        """Template of a leg."""
        radial = {} if self.drive_stiffness is None else {"x": self.drive_stiffness}
        return Leg(
            nodes=("centre", "carriage", "shoulder", "bend", "root", "end"),
            bodies=(
                Body("carriage", ("centre", "carriage")),
                Body("first link", ("shoulder", "bend")),
                Body("link", ("root", "end")),
            ),
            joints=(
                self.guide("centre"),
                Joint("shoulder", "revolute", ("carriage", "shoulder"), radial, driven=("rz",)),
                Joint("elbow", "revolute", ("bend", "root")),
                self.ball,
            ),
            beams=(self.beam("first link", "shoulder", "bend"), self.beam("link", "root", "end")),
            lines=(("shoulder", "bend"), ("root", "end")),
        )

    def place_legs(self, seats: Radial) -> LegPlacement:
        """Two equal links: the elbow stands on the middle normal of shoulder and seat.

        Parameters
        ----------
        seats : Radial
            Joint centres on the platform.
        """
        inward, rise = self.base_radius - seats.radius, seats.height
        square = inward * inward + rise * rise
        none = np.asarray(square.real < 1e-18)
        half = np.where(none, self.link_length**2 / 2, square) / 4
        height, missing = square_root(self.link_length**2 - half, self.link_length)
        line = angle(np.where(none, 0.0, rise), np.where(none, 1.0, inward))
        bend = angle(height, np.sqrt(half))
        upper, elevation = line + bend, line - bend
        shoulder = seats.at(self.base_radius, 0.0)
        elbow = seats.at(
            self.base_radius - self.link_length * np.cos(upper), self.link_length * np.sin(upper)
        )
        link = seats.at(-np.cos(elevation), np.sin(elevation))
        return LegPlacement(
            positions={
                "centre": np.zeros_like(seats.points),
                "carriage": shoulder,
                "shoulder": shoulder,
                "bend": elbow,
                "root": elbow,
                "end": seats.points,
            },
            frames={
                "guide": seats.guide_frame,
                "shoulder": seats.hinge_frame,
                "elbow": seats.hinge_frame,
            },
            values={
                ("guide", "rz"): seats.angle,
                ("shoulder", "rz"): upper,
                ("elbow", "rz"): elevation - upper,
                ("elbow", "elevation"): elevation,
            },
            link=link,
            elevation=elevation,
            faults={
                "its joint centre is farther from the shoulder than the links reach": missing,
                "its joint centre lies on the shoulder": none,
            },
        )
