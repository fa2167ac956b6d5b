"""The prototype of Azulay et al. 2014, section 5: a redundant reconfigurable 3xPPPRS machine."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import pi, radians
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import Body, Joint, angle
from strutwork.kinematics.frames import dot, frame
from strutwork.machines.azulay_dynamic import Platform
from strutwork.machines.legs import Leg, LegPlacement, full, seat, square_root
from strutwork.machines.limits import Limit, joint_limits
from strutwork.machines.radial import Radial
from strutwork.machines.three_legs import SWING, TOOL, ThreeLegs
from strutwork.msa.beam import Beam
from strutwork.msa.springs import PointMass
from strutwork.msa.structure import Structure

Array = NDArray[Any]

#: Our choice: room for three spherical joints around a spindle.
PLATFORM_DISC = Platform.steel_disc(radius=0.060, thickness=0.015)


@dataclass(frozen=True, kw_only=True)
class Prototype3PPPRS(ThreeLegs):
    """Curvilinear P, tangential P, radial P, R about the tangent, S in each leg.

    A stage on a curvilinear guide (THK HCR 15A+60/150R) is moved to a place and locked. On it
    stand two FB075 linear stages with HR8 ultrasonic motors (Nanomotion), the first along the
    guide's tangent and the second radial; a hinge and a link of fixed length lead to a spherical
    joint (Seiko Hephaist SRJ008C) under the platform. Nine drives move six freedoms, so the
    places of the three curvilinear stages are given, not solved for.

    The paper prints no numbers of this machine beside model numbers, and its Fig. 12 is not in
    the text: only the guide's radius, the links' steel and the motors' stiffness have a source.
    Everything else is our choice, and no published number stands beside the results.

    Parameters
    ----------
    base_radius : float
        m; read from the guide's model number, 150R.
    platform_radius : float
        m. Our choice, wider than the paper's machines to leave room for a spindle.
    pole_height : float
        m. Our choice: the radial stage stands about the middle of its range at home.
    guide_stiffness : float or None
        N/m; None, as the locked curvilinear stage has no stiffness printed.
    drive_stiffness : float or None
        Of both linear stages, N/m (section 3.3.1 for ultrasonic piezo actuators: 3 N/µm).
    stage_angles : (3,) of float
        Where the curvilinear stages stand, rad from the middles of their guides, which are
        120° apart: the redundant coordinates.
    guides : "driven" or "locked"
        Whether the curvilinear stages count among the drives (nine) or not (six). The same in
        statics and vibration; the Jacobian has one meaning with six.
    link_length : float
        m. Our choice: the paper's design length.
    stage_height : float
        Height of each linear stage, m; the hinge stands on both. Our choice.
    tangential_travel, radial_travel : float
        Range of the stages, m. Our choice.
    radial_middle : float
        Radius of the hinge in the middle of the radial stage's range, m. Our choice.
    guide_range : float
        Range of a curvilinear stage to each side, rad; the model number's 60 as the guide's
        angle, the length of the carriage not taken off.
    carriage_mass, stage_mass, table_mass : float
        kg; of a curvilinear stage with its plate, of a linear stage's fixed part and of its
        table. Our choice.
    spindle_mass : float
        kg, at the tool: "a simple commercial spindle". Our choice.
    platform : Platform
        A steel disc. Our choice.
    elements : int
        Beam elements per link.
    shear : bool
        Timoshenko beams. Our choice.
    ball_range : float
        Of the spherical joint to each side of its neutral direction, rad. Our choice.
    ball_neutral : float
        As `ThreeLegs`, rad. Our choice.
    """

    base_radius: float = 0.150
    platform_radius: float = 0.040
    pole_height: float = 0.220
    guide_stiffness: float | None = None
    shear: bool = True
    ball_range: float = radians(30.0)
    ball_neutral: float = radians(44.0)
    stage_angles: tuple[float, float, float] = (0.0, 0.0, 0.0)
    guides: Literal["driven", "locked"] = "driven"
    link_length: float = 0.216
    stage_height: float = 0.035
    tangential_travel: float = 0.050
    radial_travel: float = 0.050
    radial_middle: float = 0.195
    guide_range: float = radians(30.0)
    carriage_mass: float = 0.5
    stage_mass: float = 0.5
    table_mass: float = 0.3
    spindle_mass: float = 0.5
    platform: Platform = PLATFORM_DISC
    elements: int = 4

    def __post_init__(self) -> None:
        if self.guides not in ("driven", "locked"):
            raise ModelError(
                f"{type(self).__name__}.guides",
                f"is {self.guides!r}.",
                'Choose "driven" or "locked".',
            )
        if np.shape(self.stage_angles) != (3,) or not np.all(np.isfinite(self.stage_angles)):
            raise ModelError(
                f"{type(self).__name__}.stage_angles",
                f"are {self.stage_angles!r}.",
                "Give three angles, rad.",
            )
        super().__post_init__()

    @property
    def lengths(self) -> tuple[str, ...]:
        """Fields that must be positive."""
        return (
            *super().lengths,
            "link_length",
            "stage_height",
            "tangential_travel",
            "radial_travel",
            "radial_middle",
            "guide_range",
        )

    @property
    def dimensions(self) -> tuple[str, ...]:
        """Sizes of the machine; the range of the guide is an angle."""
        return tuple(name for name in self.lengths if name != "guide_range")

    @property
    def hinge_height(self) -> float:
        """Height of the hinges above the guide, m."""
        return 2.0 * self.stage_height

    def locked(self) -> Prototype3PPPRS:
        """The machine with its curvilinear stages locked where they stand: six drives."""
        return replace(self, guides="locked")

    def beam(self, name: str, first: str, second: str) -> Beam:
        """A beam of the machine's tube, divided.

        Parameters
        ----------
        name : str
        first, second : str
            Its nodes.
        """
        return replace(super().beam(name, first, second), elements=self.elements)

    def guide(self, node: str) -> Joint:
        """The curvilinear stage, a drive or locked.

        Parameters
        ----------
        node : str
            Of the carriage.
        """
        joint = super().guide(node)
        if self.guides == "locked":
            return Joint(joint.name, "revolute", joint.between, joint.stiffness, locks=("rz",))
        return replace(joint, limits={"rz": (-self.guide_range, self.guide_range)})

    @property
    def leg(self) -> Leg:
        """Template of a leg."""
        drive = {} if self.drive_stiffness is None else {"z": self.drive_stiffness}
        across, along = self.tangential_travel / 2, self.radial_travel / 2
        reach = (self.radial_middle - along, self.radial_middle + along)

        def stage(name: str, between: tuple[str, str], limits: tuple[float, float]) -> Joint:
            return Joint(name, "prismatic", between, drive, driven=("z",), limits={"z": limits})

        return Leg(
            nodes=("centre", "carriage", "way", "table", "radial way", "slider", "root", "end"),
            bodies=(
                Body("curvilinear stage", ("centre", "carriage", "way")),
                Body("tangential table", ("table", "radial way")),
                Body("radial table", ("slider",)),
                Body("link", ("root", "end")),
            ),
            joints=(
                self.guide("centre"),
                stage("tangential", ("way", "table"), (-across, across)),
                stage("radial", ("radial way", "slider"), reach),
                Joint("hinge", "revolute", ("slider", "root"), limits={"rz": self.hinge_range}),
                self.ball,
            ),
            beams=(self.beam("link", "root", "end"),),
            lines=(
                ("carriage", "way"),
                ("table", "radial way"),
                ("radial way", "slider"),
                ("root", "end"),
            ),
        )

    @cached_property
    def structure(self) -> Structure:
        """The linkage with flexible links, and the masses of stages, platform and spindle."""
        axes = (seat(1), seat(2), seat(3))
        carried = [
            PointMass(full(i, node), mass)
            for i in (1, 2, 3)
            for node, mass in (
                ("carriage", self.carriage_mass + self.stage_mass),
                ("table", self.table_mass + self.stage_mass),
                ("slider", self.table_mass),
            )
        ]
        platform = self.platform.point_mass(TOOL, 0.0, axes)
        spindle = PointMass(TOOL, self.spindle_mass)
        return replace(super().structure, masses=(*carried, platform, spindle))

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        """Joint ranges; those of the spherical joints last."""
        balls = (
            Limit(full(i, "ball"), SWING, 0.0, self.ball_range, "spherical") for i in (1, 2, 3)
        )
        return (*joint_limits(self.linkage), *balls)

    def radial(self, points: Array) -> Radial:
        """Joint centres in the axes of the curvilinear stages, which do not follow the platform.

        Parameters
        ----------
        points : (..., 3, 3)
            One for each leg, m.
        """
        deviation = np.asarray(self.stage_angles, dtype=float)
        turn = np.arange(3) * (2.0 * pi / 3.0) + deviation
        zero = np.zeros(3)
        outward = np.stack([np.cos(turn), np.sin(turn), zero], axis=-1)
        tangent = np.stack([-np.sin(turn), np.cos(turn), zero], axis=-1)
        return Radial(
            points,
            dot(points, outward),
            np.broadcast_to(deviation, points.shape[:-1]),
            points[..., 2],
            np.broadcast_to(outward, points.shape),
            np.broadcast_to(tangent, points.shape),
            np.zeros(points.shape[:-1], dtype=bool),
        )

    def place_legs(self, seats: Radial) -> LegPlacement:
        """The tangential stage goes abreast of the joint centre, the radial one behind it.

        Parameters
        ----------
        seats : Radial
            Joint centres on the platform.
        """
        rise = seats.height - self.hinge_height
        reach, missing = square_root(self.link_length**2 - rise * rise, self.link_length)
        abreast = dot(seats.points, seats.tangent)
        hinge = seats.radius + reach
        shift = abreast[..., None] * seats.tangent
        table = seats.at(self.base_radius, self.stage_height) + shift
        foot = seats.at(hinge, self.hinge_height) + shift
        link = seats.points - foot
        link = link / np.sqrt(dot(link, link))[..., None]
        elevation = angle(np.where(missing, 0.0, rise), reach)
        along_tangent = frame(seats.up, seats.outward, seats.tangent)
        along_radius = frame(seats.tangent, seats.up, seats.outward)
        return LegPlacement(
            positions={
                "centre": np.zeros_like(seats.points),
                "carriage": seats.at(self.base_radius, 0.0),
                "way": table,
                "table": table,
                "radial way": foot,
                "slider": foot,
                "root": foot,
                "end": seats.points,
            },
            frames={
                "guide": seats.guide_frame,
                "tangential": along_tangent,
                "radial": along_radius,
                "hinge": seats.hinge_frame,
            },
            values={
                ("guide", "rz"): seats.angle,
                ("tangential", "z"): abreast,
                ("radial", "z"): hinge,
                ("hinge", "rz"): elevation,
            },
            link=link,
            elevation=elevation,
            faults={
                "its joint centre is farther from the hinges' height than the link reaches": missing
            },
        )
