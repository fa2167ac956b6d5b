"""The Hexel hexapod as Son 2002 describes it: six telescopic legs under a hexagonal ceiling."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import radians
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, Poses, angle, rotation_x
from strutwork.kinematics.frames import cross, dot, frame, gathered, turned
from strutwork.machines.dimensions import check_proportions
from strutwork.machines.legs import square_root
from strutwork.machines.limits import Limit, joint_limits
from strutwork.machines.pose_grid import PoseGrid
from strutwork.msa.structure import Structure

Array = NDArray[Any]

TOOL = "tool"
PLATFORM = "platform"
LEGS = (1, 2, 3, 4, 5, 6)

#: Height of the tool tip over the work table in sections 2.2 and 6.2, m.
LEVEL = 0.4
#: Reach in x, m, and tilt about x, rad, to either side, of figures 3 to 5.
REACH, TILT = 0.1, radians(35.0)
#: The same of the stiffness map, whose axes are legible in Fig. 29-(b).
MAP_REACH, MAP_TILT = 0.2, radians(40.0)


def foot(i: int) -> str:
    """Node of the fixed platform where a leg hangs."""
    return f"base{i}"


def seat(i: int) -> str:
    """Node of the moving platform in the middle of a leg's ball."""
    return f"{PLATFORM}/P{i}"


def leg(i: int, part: str) -> str:
    """Node of a leg, "head", "slide", "rod" or "end"; name of its "universal", "ram" or "ball"."""
    return f"leg{i}/{part}"


@dataclass(frozen=True, kw_only=True)
class HexelHexapod:
    """Universal joint, driven prismatic joint and ball in each of six legs; the tool hangs.

    The fixed platform is a hexagon of equal angles whose sides are w and d in turn, in the
    plane z = H over the work table, a long side along x. Two legs meet in each of three joint
    centres of the moving platform ("6 x 3 type"), which stand on a circle of radius r, t above
    the tool tip, and face the middles of the short sides. The drawing of Appendix A is missing;
    this reading meets the condition numbers of section 2.2 within 1 %.

    Parameters
    ----------
    long_side, short_side : float
        w and d of the fixed platform, m (Son 2002, Appendix A).
    joint_height : float
        t: joint centres above the tool tip, m (Appendix A).
    joint_radius : float
        r: joint centres beside the tool axis, m (Appendix A).
    base_height : float
        H: fixed platform over the work table, where z is zero, m (Appendix A).
    leg_stiffness : float or None
        Of a leg along its line, N/m, with its drive and joints; None: rigid. Our choice: the
        k_i of the MIT-SS-1's struts, so that the two machines compare; the thesis prints none.

    Raises
    ------
    ModelError
        A dimension or stiffness that is not positive, or a home pose that cannot be taken.
    """

    long_side: float = 0.66
    short_side: float = 0.25
    joint_height: float = 0.20
    joint_radius: float = 0.175
    base_height: float = 1.2
    leg_stiffness: float | None = 255e6

    def __post_init__(self) -> None:
        lengths = ("long_side", "short_side", "joint_height", "joint_radius", "base_height")
        for name in lengths:
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0):
                raise ModelError(
                    f"HexelHexapod.{name}", f"is {value!r}.", "Give a positive length, m."
                )
        check_proportions("HexelHexapod", {name: getattr(self, name) for name in lengths})
        k = self.leg_stiffness
        if k is not None and not (np.isfinite(k) and k > 0):
            raise ModelError(
                "HexelHexapod.leg_stiffness",
                f"is {k!r}.",
                "Give a positive number, N/m, or None for rigid.",
            )
        home = self.place(self.home())
        if not home.reachable:
            raise ModelError(
                "HexelHexapod",
                f"cannot stand at home: {home.reason(())}.",
                "Raise the fixed platform, or lower the platform's joints.",
            )

    @cached_property
    def linkage(self) -> Linkage:
        """Ground, platform, and a cylinder and a rod a leg."""
        axial = {} if self.leg_stiffness is None else {"z": self.leg_stiffness}
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
                    axial,
                    driven=("z",),
                ),
                Joint(leg(i, "ball"), "spherical", (leg(i, "end"), seat(i))),
            )
        ]
        return Linkage(tuple(n for b in bodies for n in b.nodes), bodies, tuple(joints), TOOL)

    @cached_property
    def structure(self) -> Structure:
        """The linkage: legs stretch along their lines, everything else is rigid."""
        return Structure(self.linkage)

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        """Joint ranges: none, the thesis prints none."""
        return joint_limits(self.linkage)

    @cached_property
    def feet(self) -> Array:
        """Where the legs hang, (6, 3), m: legs 1 and 2 at one short side, and so on."""
        turn = 2.0 * np.pi / 3.0 * np.arange(3) + np.pi / 6.0
        outward = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
        along = np.stack([-outward[:, 1], outward[:, 0]], axis=-1)
        # of a hexagon of equal angles: from its centre to a short side
        distance = (2.0 * self.long_side + self.short_side) / (2.0 * np.sqrt(3.0))
        half = self.short_side / 2.0
        corners = np.stack([distance * outward + s * half * along for s in (-1, 1)], axis=1)
        return np.concatenate([corners.reshape(6, 2), np.full((6, 1), self.base_height)], axis=1)

    @cached_property
    def seats(self) -> Array:
        """Joint centres on the platform in the tool's axes, (6, 3), m; two legs share each."""
        turn = np.repeat(2.0 * np.pi / 3.0 * np.arange(3) + np.pi / 6.0, 2)
        r = self.joint_radius
        return np.stack([r * np.cos(turn), r * np.sin(turn), np.full(6, self.joint_height)], -1)

    @staticmethod
    def poses(x: ArrayLike, a: ArrayLike = 0.0, z: ArrayLike = LEVEL) -> Poses:
        """Poses with the tool tip at (x, 0, z), m, tilted by a about x, rad; broadcast."""
        x, a, z = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, a, z)))
        return Poses(np.stack([x, np.zeros_like(x), z], axis=-1), rotation_x(a))

    def home(self) -> Poses:
        """Tool upright in the middle, 0.4 m over the table (section 2.2)."""
        return self.poses(0.0)

    def pose_grid(self, steps: int = 10) -> PoseGrid:
        """Fig. 29-(b), 0.4 m over the table: 2 · steps + 1 places along x, as many tilts a."""
        x, a = (np.linspace(-end, end, 2 * steps + 1) for end in (MAP_REACH, MAP_TILT))
        return PoseGrid(self.poses(x).position, rotation_x(a), a, "a")

    def skeleton(self) -> Sequence[tuple[str, str]]:
        """Pairs of nodes that a drawing connects by a line."""
        return (
            *((leg(i, "head"), leg(i, "slide")) for i in LEGS),
            *((leg(i, "rod"), leg(i, "end")) for i in LEGS),
            *((foot(i), foot(i % 6 + 1)) for i in LEGS),
            *((seat(i), seat(j)) for i, j in ((1, 3), (3, 5), (5, 1))),
            *((seat(i), TOOL) for i in (1, 3, 5)),
        )

    def place(self, poses: Poses) -> Placement:
        """Inverse kinematics: lengths and directions of the legs, batch first.

        Analytic in the pose, which may carry a complex step.

        Returns
        -------
        Placement
            Values: of each leg the swing of its universal joint about the base's tangent and
            then across it, rad, and its length, m. Poses whose joint centres are not below the
            fixed platform are marked; their positions are finite and without meaning.
        """
        ends = poses.position[..., None, :] + turned(poses.rotation, self.seats)
        span = ends - self.feet
        above = span[..., 2].real >= 0.0
        length, _ = square_root(dot(span, span), 1.0)
        down = np.array([0.0, 0.0, -1.0])
        line = np.where(above[..., None], down, span / length[..., None])
        tangent, inward = self._tangent, self._inward
        drop, aside = -line[..., 2], dot(line, inward)
        swing = angle(aside, drop)
        sway = angle(dot(line, tangent), np.sqrt(drop * drop + aside * aside))
        ball = np.broadcast_to(np.eye(3), (*span.shape[:-1], 3, 3))
        yoke, ram = self._frames(line)
        frames = [part[..., k, :, :] for k in range(len(LEGS)) for part in (yoke, ram, ball)]
        middle = self.feet + 0.5 * span
        positions = {TOOL: poses.position}
        for k, i in enumerate(LEGS):
            top = np.broadcast_to(self.feet[k], poses.position.shape)
            positions |= {foot(i): top, leg(i, "head"): top}
            positions |= {seat(i): ends[..., k, :], leg(i, "end"): ends[..., k, :]}
            positions |= {leg(i, part): middle[..., k, :] for part in ("slide", "rod")}
        names = [
            pair
            for i in LEGS
            for pair in (
                (leg(i, "universal"), "rx"),
                (leg(i, "universal"), "rz"),
                (leg(i, "ram"), "z"),
            )
        ]
        values = [part[..., k] for k in range(len(LEGS)) for part in (swing, sway, length)]
        return Placement(
            gathered([positions[n] for n in self.linkage.nodes], 1),
            gathered(frames, 2),
            gathered(values, 0),
            tuple(names),
            np.where(above.any(axis=-1), above.argmax(axis=-1) + 1, 0).astype(np.int8),
            tuple(f"leg {i}: its joint on the platform is not below the fixed one" for i in LEGS),
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
        """Axes of universal and prismatic joints, (..., 6, 3, 3); `line` points down the leg."""
        first = np.broadcast_to(self._tangent, line.shape)
        second = cross(first, line)
        second = second / np.sqrt(dot(second, second))[..., None]
        yoke = frame(first, cross(second, first), second)
        return yoke, frame(second, cross(line, second), line)
