"""The Alizade machine as Azulay et al. 2014 compare it."""

from __future__ import annotations

from dataclasses import dataclass
from math import radians

import numpy as np

from strutwork.kinematics import Body, Joint, angle, axes_frame
from strutwork.kinematics.frames import dot
from strutwork.machines.legs import Leg, LegPlacement
from strutwork.machines.radial import Radial
from strutwork.machines.three_legs import ThreeLegs


@dataclass(frozen=True, kw_only=True)
class Alizade3PRPS(ThreeLegs):
    """Circular P, R about the tangent, P along the link, S in each leg (Azulay 2014, section 4).

    The link changes its length between a hinge on the carriage and the platform. The drives are
    θ, the carriage's angle, and the distance from the hinge to the joint centre.

    The link is a strut of constant length that passes the hinge and is held at its tail, where
    the drive is: a cylinder that turns with the hinge reaches back to it.

    Parameters
    ----------
    middle_length : float
        Distance from hinge to joint centre at the middle of the stroke, m (Table 3, section 4).
    stroke : float
        m (Table 3), half to each side of the middle.
    strut_length : float
        Length of the flexible strut, m. Calibrated to Table 4: 281 mm is the middle length
        and one stroke.
    pole_height : float
        m. Not in the paper; calibrated to Table 4.
    ball_neutral : float
        As `ThreeLegs`, rad.
    """

    middle_length: float = 0.216
    stroke: float = 0.065
    strut_length: float = 0.281
    pole_height: float = 0.118
    ball_neutral: float = radians(10.0)

    @property
    def lengths(self) -> tuple[str, ...]:
        """Fields that must be positive."""
        return (*super().lengths, "middle_length", "stroke", "strut_length")

    @property
    def leg(self) -> Leg:
        """Template of a leg."""
        drive = {} if self.drive_stiffness is None else {"z": self.drive_stiffness}
        half = self.stroke / 2
        return Leg(
            nodes=("centre", "carriage", "root", "cylinder", "tail", "end"),
            bodies=(
                Body("carriage", ("centre", "carriage")),
                Body("cylinder", ("root", "cylinder")),
                Body("strut", ("tail", "end")),
            ),
            joints=(
                self.guide("centre"),
                Joint("hinge", "revolute", ("carriage", "root"), limits={"rz": self.hinge_range}),
                Joint(
                    "slide",
                    "prismatic",
                    ("cylinder", "tail"),
                    drive,
                    driven=("z",),
                    limits={"z": (self.middle_length - half, self.middle_length + half)},
                ),
                self.ball,
            ),
            beams=(self.beam("strut", "tail", "end"),),
            lines=(("root", "cylinder"), ("tail", "end")),
        )

    def place_legs(self, seats: Radial) -> LegPlacement:
        """Length and elevation of the line from the hinge to the joint centre.

        Parameters
        ----------
        seats : Radial
            Joint centres on the platform.
        """
        hinge = seats.at(self.base_radius, 0.0)
        span = seats.points - hinge
        square = dot(span, span)
        none = np.asarray(square.real < 1e-18)
        length = np.sqrt(np.where(none, 1.0, square))
        link = np.where(none[..., None], -seats.outward, span / length[..., None])
        tail = seats.points - self.strut_length * link
        elevation = angle(
            np.where(none, 0.0, seats.height), np.where(none, 1.0, self.base_radius - seats.radius)
        )
        return LegPlacement(
            positions={
                "centre": np.zeros_like(seats.points),
                "carriage": hinge,
                "root": hinge,
                "cylinder": tail,
                "tail": tail,
                "end": seats.points,
            },
            frames={
                "guide": seats.guide_frame,
                "hinge": seats.hinge_frame,
                "slide": axes_frame(link, seats.tangent),
            },
            values={
                ("guide", "rz"): seats.angle,
                ("hinge", "rz"): elevation,
                ("slide", "z"): length,
            },
            link=link,
            elevation=elevation,
            faults={"its joint centre lies on the hinge": none},
        )
