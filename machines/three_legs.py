"""What the machines of Azulay et al. 2014 share: three legs on one circular guide.

The legs stand at 120° on a platform that is rigid; each begins with a carriage on the guide and
ends in a spherical joint. A machine adds its leg: topology, and inverse kinematics from the
joint centre on the platform.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import pi, radians
from typing import Any, Literal, Self

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, Poses, angle, axes_frame
from strutwork.kinematics.frames import cross, dot, gathered, turned
from strutwork.machines.dimensions import LENGTH, OR_RIGID, check_positive, check_proportions
from strutwork.machines.legs import CENTRE, SEAT, Leg, LegPlacement, full, seat
from strutwork.machines.limits import Limit, joint_limits
from strutwork.machines.radial import Radial
from strutwork.msa.beam import Beam
from strutwork.msa.materials import Material
from strutwork.msa.sections import Section, tube
from strutwork.msa.structure import Structure

Array = NDArray[Any]

#: AISI 1018 with handbook values; the paper names the steel only.
AISI_1018 = Material.isotropic(205e9, 0.29, 7870.0, name="AISI 1018")

TUBE_19_14 = tube(0.019, 0.014, name="tube 19/14")

PLATFORM = "platform"
TOOL = "tool"

#: Coordinate of a spherical joint: angle of the link from its neutral direction.
SWING = "swing"


@dataclass(frozen=True, kw_only=True)
class ThreeLegs(ABC):
    """Common dimensions and behaviour; a base class, not a machine.

    Parameters
    ----------
    pole_height : float
        Height of the workpiece's pole above the guide, m: where the tool stands at home. The
        paper does not give it.
    base_radius : float
        Radius R_b of the circular guide, m (Azulay 2014, Table 3).
    platform_radius : float
        Radius R_p of the joint centres on the platform, m (Table 3). The tool centre point is
        their centre.
    guide_stiffness : float or None
        Drive stiffness along the guide, N/m (section 3.3.1: 3 N/µm); None holds it rigidly.
    drive_stiffness : float or None
        The same of the second drive of a leg along its axis, N/m.
    material : Material
        AISI 1018 (section 3.3.1).
    section : Section
        Tube 19/14 mm (section 3.3.1).
    shear : bool
        Timoshenko beams. The default is Euler-Bernoulli: the paper lists bending and axial
        deformation only.
    platform_joint : "spherical" or "clamped"
        "clamped" fixes the last link's rotation in the platform. It is not the machine, whose
        joints are spherical; it is the model that the paper's Tables 2 and 4 suggest. Use it
        for statics only.
    hinge_range : (float, float)
        Range of the passive revolute joint, the elevation of the last link, rad (Table 3).
    ball_range : float
        Largest angle of the last link from its neutral direction in the platform, rad
        (Table 3: ±70°).
    ball_neutral : float
        The neutral direction points from the joint centre away from the platform's centre and
        this angle below the platform's plane, rad. The paper does not give it; each machine has
        the one that lets it tilt farthest (our choice).
    guide_drive : "turning" or "sliding"
        How the drive along the guide yields. "turning": the carriage follows the guide, so
        it turns as it slides. "sliding": it moves along the tangent and does not turn, as a
        spring at one node of a structural model does; with "clamped" it is the model that the
        paper's tables suggest.
    """

    pole_height: float
    base_radius: float = 0.162
    platform_radius: float = 0.018
    guide_stiffness: float | None = 3e6
    drive_stiffness: float | None = 3e6
    material: Material = AISI_1018
    section: Section = TUBE_19_14
    shear: bool = False
    platform_joint: Literal["spherical", "clamped"] = "spherical"
    hinge_range: tuple[float, float] = field(default=(radians(5.0), radians(70.0)))
    ball_range: float = radians(70.0)
    ball_neutral: float = 0.0
    guide_drive: Literal["turning", "sliding"] = "turning"

    def __post_init__(self) -> None:
        check_positive(self, self.lengths, LENGTH)
        check_proportions(
            type(self).__name__, {name: getattr(self, name) for name in self.dimensions}
        )
        for name, words in (
            ("platform_joint", ("spherical", "clamped")),
            ("guide_drive", ("turning", "sliding")),
        ):
            if getattr(self, name) not in words:
                raise ModelError(
                    f"{type(self).__name__}.{name}",
                    f"is {getattr(self, name)!r}.",
                    f'Choose "{words[0]}" or "{words[1]}".',
                )
        check_positive(self, ("guide_stiffness", "drive_stiffness"), OR_RIGID)
        at_home = self.place_legs(self.radial(self.home().position + self.seats))
        for reason, legs in at_home.faults.items():
            if legs.any():
                raise ModelError(
                    type(self).__name__,
                    f"cannot stand at home: {reason}.",
                    "Change the link length, the radii or the height of the pole.",
                )

    @property
    def lengths(self) -> tuple[str, ...]:
        """Fields that must be positive."""
        return ("base_radius", "platform_radius", "pole_height")

    @property
    def dimensions(self) -> tuple[str, ...]:
        """Those of `lengths` that are sizes of the machine and in proportion to one another."""
        return self.lengths

    @property
    @abstractmethod
    def leg(self) -> Leg:
        """Template of a leg, without the joint at the platform's end of the last link."""

    @abstractmethod
    def place_legs(self, seats: Radial) -> LegPlacement:
        """Inverse kinematics of the legs from their joint centres on the platform.

        Parameters
        ----------
        seats : Radial
            Joint centres on the platform.
        """

    def beam(self, name: str, first: str, second: str) -> Beam:
        """A beam of the machine's tube.

        Parameters
        ----------
        name : str
        first, second : str
            Its nodes.
        """
        return Beam(name, (first, second), self.material, self.section, shear=self.shear)

    def guide(self, node: str) -> Joint:
        """The drive along the circular guide: a revolute joint at the guide's centre.

        Parameters
        ----------
        node : str
            Of the carriage.
        """
        elastic = {}
        if self.guide_stiffness is not None:
            # joint axes at the centre are outward, tangent, up: y moves the carriage along the
            # tangent and does not turn it
            elastic = (
                {"rz": self.guide_stiffness * self.base_radius**2}
                if self.guide_drive == "turning"
                else {"y": self.guide_stiffness}
            )
        return Joint("guide", "revolute", (CENTRE, node), elastic, driven=("rz",))

    @property
    def ball(self) -> Joint:
        """The joint between the last link's node `end` and the platform."""
        kind = "spherical" if self.platform_joint == "spherical" else "fixed"
        return Joint("ball", kind, ("end", SEAT))

    @cached_property
    def legs(self) -> tuple[Leg, ...]:
        """The three legs with their names in the machine."""
        return tuple(self.leg.numbered(i) for i in (1, 2, 3))

    @cached_property
    def linkage(self) -> Linkage:
        """Bodies and joints."""
        seats = tuple(seat(i) for i in (1, 2, 3))
        return Linkage(
            nodes=(CENTRE, TOOL, *seats, *(n for leg in self.legs for n in leg.nodes)),
            bodies=(
                Body(GROUND, (CENTRE,)),
                Body(PLATFORM, (TOOL, *seats)),
                *(b for leg in self.legs for b in leg.bodies),
            ),
            joints=tuple(j for leg in self.legs for j in leg.joints),
            tool=TOOL,
        )

    @cached_property
    def structure(self) -> Structure:
        """The linkage with its flexible links."""
        return Structure(
            self.linkage,
            beams=tuple(b for leg in self.legs for b in leg.beams),
            rigid=tuple(b for leg in self.legs for b in leg.rigid),
        )

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        """Joint ranges, for `strutwork.machines.check_limits`; of the spherical joints last."""
        return (
            *joint_limits(self.linkage),
            *(Limit(full(i, "ball"), SWING, 0.0, self.ball_range, "spherical") for i in (1, 2, 3)),
        )

    @cached_property
    def seats(self) -> Array:
        """Joint centres in the platform's axes, (3, 3), m."""
        turn = np.arange(3) * (2.0 * pi / 3.0)
        flat = np.stack([np.cos(turn), np.sin(turn), np.zeros(3)], axis=-1)
        return self.platform_radius * flat

    @cached_property
    def neutral(self) -> Array:
        """Neutral directions of the last links, away from the platform, in its axes, (3, 3)."""
        outward = self.seats / self.platform_radius
        down = np.array([0.0, 0.0, -np.sin(self.ball_neutral)])
        return np.asarray(outward * np.cos(self.ball_neutral) + down)

    def radial(self, points: Array) -> Radial:
        """Joint centres on the platform as the legs see them.

        Parameters
        ----------
        points : (..., 3, 3)
            One for each leg, m.
        """
        return Radial.of(points)

    def apparent(self) -> Self:
        """The model that the paper's Tables 2 and 4 suggest: links clamped at the platform."""
        return replace(self, platform_joint="clamped", guide_drive="sliding")

    def home(self) -> Poses:
        """The tool at the workpiece's pole, level, its x axis along the base's."""
        return Poses.of([0.0, 0.0, self.pole_height])

    def skeleton(self) -> Sequence[tuple[str, str]]:
        """Pairs of nodes that a drawing connects by a line."""
        seats = [seat(i) for i in (1, 2, 3)]
        sides = list(zip(seats, seats[1:] + seats[:1], strict=True))
        return [*(line for leg in self.legs for line in leg.lines), *sides]

    def place(self, poses: Poses) -> Placement:
        """Inverse kinematics, batch first.

        Joint ranges are not looked at: `strutwork.machines.check_limits` does. Every operation is
        analytic, so that poses may carry a complex step.

        Parameters
        ----------
        poses : Poses
            Of the tool, (...).

        Returns
        -------
        Placement
            Poses that no assembly of the legs can take are marked with a reason.
        """
        points = poses.position[..., None, :] + turned(poses.rotation, self.seats)
        radial = self.radial(points)
        legs = self.place_legs(radial)
        nodes = {CENTRE: np.zeros_like(poses.position), TOOL: poses.position}
        frames: dict[str, Array] = {}
        values: dict[tuple[str, str], Array] = {}
        swing = self._swing(poses.rotation, legs.link)
        ball = axes_frame(legs.link, radial.tangent, "ball")
        for i in range(3):
            number = i + 1
            nodes[seat(number)] = points[..., i, :]
            nodes |= {full(number, n): p[..., i, :] for n, p in legs.positions.items()}
            frames |= {full(number, j): f[..., i, :, :] for j, f in legs.frames.items()}
            frames[full(number, "ball")] = ball[..., i, :, :]
            values |= {(full(number, j), d): v[..., i] for (j, d), v in legs.values.items()}
            values[full(number, "ball"), SWING] = swing[..., i]
        faults = {"its joint centre lies on the axis of the guide": radial.on_axis, **legs.faults}
        status, reasons = _status(faults)
        return Placement(
            gathered([nodes[n] for n in self.linkage.nodes], 1),
            gathered([frames[j.name] for j in self.linkage.joints], 2),
            gathered(list(values.values()), 0),
            tuple(values),
            status,
            reasons,
        )

    def _swing(self, rotation: Array, link: Array) -> Array:
        """Angle of each last link from its neutral direction, rad, (..., 3)."""
        neutral = turned(rotation, self.neutral)
        across = cross(neutral, -link)
        return angle(np.sqrt(dot(across, across)), -dot(neutral, link))


def _status(
    faults: Mapping[str, NDArray[np.bool_]],
) -> tuple[NDArray[np.int8], tuple[str, ...]]:
    """Code of the first fault of each pose, and the reasons the codes stand for."""
    masks = gathered([mask[..., i] for mask in faults.values() for i in range(3)], 0)
    reasons = tuple(f"leg {i}: {reason}" for reason in faults for i in (1, 2, 3))
    first = np.where(masks.any(axis=-1), masks.argmax(axis=-1) + 1, 0)
    return first.astype(np.int8), reasons
