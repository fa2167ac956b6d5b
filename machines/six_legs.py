"""Six telescopic legs between a fixed base and a platform: what such machines share."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, Poses, angle
from strutwork.kinematics.frames import cross, dot, frame, gathered, turned
from strutwork.machines.legs import square_root

Array = NDArray[Any]

TOOL = "tool"
PLATFORM = "platform"
LEGS = (1, 2, 3, 4, 5, 6)


def foot(i: int) -> str:
    """Node of the base where a leg stands or hangs.

    Parameters
    ----------
    i : int
        Of the leg.
    """
    return f"base{i}"


def seat(i: int) -> str:
    """Node of the moving platform in the middle of a leg's ball.

    Parameters
    ----------
    i : int
        Of the leg.
    """
    return f"{PLATFORM}/P{i}"


def leg(i: int, part: str) -> str:
    """Node or joint of a leg.

    Parameters
    ----------
    i : int
    part : str
        Node "head", "slide", "rod" or "end", joint "universal", "ram" or "ball".
    """
    return f"leg{i}/{part}"


class SixLegs(ABC):
    """Universal joint, driven prismatic joint and ball in each leg; a base class, no machine.

    A machine adds where its legs begin and end, and what they are made of.
    """

    #: Along z, where the platform is seen from the base: 1 above, −1 below.
    side: ClassVar[float]

    @property
    @abstractmethod
    def feet(self) -> Array:
        """Where the legs begin on the base, (6, 3), m."""

    @property
    @abstractmethod
    def seats(self) -> Array:
        """Where they end on the platform, in the tool's axes, (6, 3), m."""

    @property
    def ram_stiffness(self) -> Mapping[str, float]:
        """Of the prismatic joints, by direction; none: rigid."""
        return {}

    @property
    def ram_limits(self) -> Mapping[str, tuple[float, float]]:
        """Range of the legs' lengths, m; none: not known."""
        return {}

    def slide_at(self, length: Array) -> Array:
        """How far from a leg's foot its two parts meet, (...), m: in the middle.

        Parameters
        ----------
        length : (...)
            Of the leg, m.
        """
        return 0.5 * length

    @cached_property
    def linkage(self) -> Linkage:
        """Ground, platform, and a cylinder and a rod a leg."""
        bodies = (
            Body(GROUND, tuple(foot(i) for i in LEGS)),
            Body(PLATFORM, (TOOL, *(seat(i) for i in LEGS))),
            *(Body(f"cylinder{i}", (leg(i, "head"), leg(i, "slide"))) for i in LEGS),
            *(Body(f"rod{i}", (leg(i, "rod"), leg(i, "end"))) for i in LEGS),
        )
        joints = [
            joint
            for i in LEGS
            for joint in (
                Joint(leg(i, "universal"), "universal", (foot(i), leg(i, "head"))),
                Joint(
                    leg(i, "ram"),
                    "prismatic",
                    (leg(i, "slide"), leg(i, "rod")),
                    self.ram_stiffness,
                    driven=("z",),
                    limits=self.ram_limits,
                ),
                Joint(leg(i, "ball"), "spherical", (leg(i, "end"), seat(i))),
            )
        ]
        return Linkage(tuple(n for b in bodies for n in b.nodes), bodies, tuple(joints), TOOL)

    def place(self, poses: Poses) -> Placement:
        """Inverse kinematics: lengths and directions of the legs, batch first.

        Analytic in the pose, which may carry a complex step.

        Parameters
        ----------
        poses : Poses
            Of the tool, (...).

        Returns
        -------
        Placement
            Values: of each leg the swing of its universal joint about the base's tangent and
            then across it, rad, and its length, m. Poses whose joint centres are on the wrong
            side of the base are marked; their positions are finite and without meaning.
        """
        ends = poses.position[..., None, :] + turned(poses.rotation, self.seats)
        span = ends - self.feet
        beyond = self.side * span[..., 2].real <= 0.0
        length, _ = square_root(dot(span, span), 1.0)
        axis = np.array([0.0, 0.0, self.side])
        line = np.where(beyond[..., None], axis, span / length[..., None])
        tangent, inward = self._tangent, self._inward
        ahead, aside = self.side * line[..., 2], self.side * dot(line, inward)
        swing = angle(aside, ahead)
        sway = angle(-dot(line, tangent), np.sqrt(ahead * ahead + aside * aside))
        ball = np.broadcast_to(np.eye(3), (*span.shape[:-1], 3, 3))
        yoke, ram = self._frames(line)
        frames = [part[..., k, :, :] for k in range(len(LEGS)) for part in (yoke, ram, ball)]
        meeting = self.feet + self.slide_at(length)[..., None] * line
        positions = {TOOL: poses.position}
        for k, i in enumerate(LEGS):
            top = np.broadcast_to(self.feet[k], poses.position.shape)
            positions |= {foot(i): top, leg(i, "head"): top}
            positions |= {seat(i): ends[..., k, :], leg(i, "end"): ends[..., k, :]}
            positions |= {leg(i, part): meeting[..., k, :] for part in ("slide", "rod")}
        names = [
            pair
            for i in LEGS
            for pair in (
                (leg(i, "universal"), "rz"),
                (leg(i, "universal"), "rx"),
                (leg(i, "ram"), "z"),
            )
        ]
        values = [part[..., k] for k in range(len(LEGS)) for part in (swing, sway, length)]
        where = "above" if self.side > 0 else "below"
        return Placement(
            gathered([positions[n] for n in self.linkage.nodes], 1),
            gathered(frames, 2),
            gathered(values, 0),
            tuple(names),
            np.where(beyond.any(axis=-1), beyond.argmax(axis=-1) + 1, 0).astype(np.int8),
            tuple(f"leg {i}: its joint on the platform is not {where} the fixed one" for i in LEGS),
        )

    @cached_property
    def _inward(self) -> Array:
        """From each foot towards the machine's axis, (6, 3)."""
        level = self.feet * np.array([1.0, 1.0, 0.0])
        return np.asarray(-level / np.linalg.norm(level, axis=-1, keepdims=True))

    @cached_property
    def _tangent(self) -> Array:
        """First axis of the universal joints, level and across `_inward`, (6, 3)."""
        return np.cross(np.array([0.0, 0.0, 1.0]), self._inward)

    def _frames(self, line: Array) -> tuple[Array, Array]:
        """Axes of universal and prismatic joints, (..., 6, 3, 3); `line` points along the leg."""
        first = np.broadcast_to(self._tangent, line.shape)
        second = cross(first, line)
        second = second / np.sqrt(dot(second, second))[..., None]
        # of a universal joint z moves with the first body, here the base, and x with the second
        yoke = frame(second, cross(first, second), first)
        return yoke, frame(second, cross(line, second), line)
