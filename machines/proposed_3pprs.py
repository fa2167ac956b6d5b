"""The proposed 3xPPRS machine of Azulay et al. 2014."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from strutwork.kinematics import Body, Joint, angle, axes_frame
from strutwork.kinematics.frames import dot
from strutwork.machines.legs import Leg, LegPlacement, square_root
from strutwork.machines.radial import Radial
from strutwork.machines.three_legs import TUBE_19_14, ThreeLegs
from strutwork.machines.variant import Variant
from strutwork.msa.sections import Section


@dataclass(frozen=True, kw_only=True)
class Proposed3PPRS(ThreeLegs):
    """Circular P, radial P, R about the tangent, S in each leg (Azulay 2014, section 2).

    Links run from sliders outside the platform inward and up to it. The first link carries the
    slider: a cantilever from the carriage at R_b to the slider at d, as long as the slider
    stands from the guide. The drives are θ, the carriage's angle, and d, the slider's radius.

    The root in eq. 4 of the paper stands for d = √(Px² + Py²) + √(L² − Pz²), which alone
    agrees with its eq. 6.

    Parameters
    ----------
    link_length : float
        L, m (Tables 1 and 3; Table 2 also 0.196 and 0.236).
    stroke : float
        Range of d − R_b from zero, m (Table 1).
    pole_height : float
        m. Not in the paper; chosen so that Table 4 is met best (calibrated).
    shortest_first_link : float
        m. Where the slider stands nearer to the guide than this, the first link is modelled
        this long: a beam of no length has no stiffness matrix, and a much shorter one adds only
        rounding (our choice). One millimetre takes less than 0.3 % of the stiffness along any
        axis.
    first_link_length : float or None
        m. A first link of constant length, a ram that the slide moves as a whole and that is
        held this far inside the slider; None for one from the guide to the slider.
    first_link_section : Section or None
        Of the first links; None for the section of the links. The paper has one tube.
    """

    link_length: float = 0.216
    stroke: float = 0.065
    pole_height: float = 0.126
    shortest_first_link: float = 1e-3
    first_link_length: float | None = None
    first_link_section: Section | None = None

    @property
    def lengths(self) -> tuple[str, ...]:
        """Fields that must be positive."""
        constant = () if self.first_link_length is None else ("first_link_length",)
        return (*super().lengths, "link_length", "stroke", "shortest_first_link", *constant)

    @property
    def dimensions(self) -> tuple[str, ...]:
        """Sizes of the machine; the shortest beam is one of the model."""
        return tuple(name for name in self.lengths if name != "shortest_first_link")

    @property
    def leg(self) -> Leg:
        """Template of a leg."""
        drive = {} if self.drive_stiffness is None else {"z": self.drive_stiffness}
        travel = (self.base_radius, self.base_radius + self.stroke)
        return Leg(
            nodes=("centre", "carriage", "overhang", "slider", "root", "end"),
            bodies=(
                Body("first link", ("centre", "carriage", "overhang")),
                Body("link", ("root", "end")),
            ),
            joints=(
                self.guide("centre"),
                Joint(
                    "slide",
                    "prismatic",
                    ("overhang", "slider"),
                    drive,
                    driven=("z",),
                    limits={"z": travel},
                ),
                Joint("hinge", "revolute", ("slider", "root"), limits={"rz": self.hinge_range}),
                self.ball,
            ),
            beams=(
                replace(
                    self.beam("first link", "carriage", "overhang"),
                    section=self.first_link_section or self.section,
                ),
                self.beam("link", "root", "end"),
            ),
            rigid=(Body("carriage", ("centre", "carriage")),),
            lines=(("carriage", "overhang"), ("root", "end")),
        )

    def place_legs(self, seats: Radial) -> LegPlacement:
        """Eqs. 2 to 5 of the paper.

        Parameters
        ----------
        seats : Radial
            Joint centres on the platform.
        """
        reach, missing = square_root(self.link_length**2 - seats.height**2, self.link_length)
        slider = seats.radius + reach
        overhang = slider - self.base_radius
        short = np.abs(overhang.real) < self.shortest_first_link
        shortest = np.where(overhang.real < 0, -1.0, 1.0) * self.shortest_first_link
        root = slider - np.where(short, shortest, overhang)
        if self.first_link_length is not None:
            root = slider - self.first_link_length
        elevation = angle(np.where(missing, 0.0, seats.height), reach)
        foot = seats.at(slider, 0.0)
        link = seats.points - foot
        link = link / np.sqrt(dot(link, link))[..., None]
        return LegPlacement(
            positions={
                "centre": np.zeros_like(seats.points),
                "carriage": seats.at(root, 0.0),
                "overhang": foot,
                "slider": foot,
                "root": foot,
                "end": seats.points,
            },
            frames={
                "guide": seats.guide_frame,
                "slide": axes_frame(seats.outward, seats.tangent),
                "hinge": seats.hinge_frame,
            },
            values={
                ("guide", "rz"): seats.angle,
                ("slide", "z"): slider,
                ("hinge", "rz"): elevation,
            },
            link=link,
            elevation=elevation,
            faults={"its joint centre is higher above the guide than the link is long": missing},
        )


def _two_tubes(*, apparent: bool = False) -> Proposed3PPRS:
    made = Proposed3PPRS(first_link_section=TUBE_19_14)
    return made.apparent() if apparent else made


def models_with_two_tubes() -> tuple[Variant, ...]:
    """The machine of the static tables whose links and first links may have different tubes."""
    words = "with a tube for the first links and one for the links, both as printed"
    return (
        Variant("two-tubes", f"as static, {words}", _two_tubes),
        Variant("apparent-two-tubes", f"as apparent, {words}", partial(_two_tubes, apparent=True)),
    )
