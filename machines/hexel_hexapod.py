"""The Hexel hexapod as Son 2002 describes it: six telescopic legs under a hexagonal ceiling."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import radians
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import Poses, rotation_x
from strutwork.machines.dimensions import LENGTH, OR_RIGID, check_positive, check_proportions
from strutwork.machines.limits import Limit, joint_limits
from strutwork.machines.pose_grid import PoseGrid
from strutwork.machines.six_legs import LEGS, TOOL, SixLegs, foot, leg, seat
from strutwork.msa.structure import Structure

Array = NDArray[Any]

#: Height of the tool tip over the work table in sections 2.2 and 6.2, m.
LEVEL = 0.4
#: Reach in x, m, and tilt about x, rad, to either side, of figures 3 to 5.
REACH, TILT = 0.1, radians(35.0)
#: The same of the stiffness map, whose axes are legible in Fig. 29-(b).
MAP_REACH, MAP_TILT = 0.2, radians(40.0)


@dataclass(frozen=True, kw_only=True)
class HexelHexapod(SixLegs):
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
        check_positive(self, lengths, LENGTH)
        check_proportions("HexelHexapod", {name: getattr(self, name) for name in lengths})
        check_positive(self, ["leg_stiffness"], OR_RIGID)
        home = self.place(self.home())
        if not home.reachable:
            raise ModelError(
                "HexelHexapod",
                f"cannot stand at home: {home.reason(())}.",
                "Raise the fixed platform, or lower the platform's joints.",
            )

    #: The tool hangs.
    side = -1.0

    @property
    def ram_stiffness(self) -> Mapping[str, float]:
        """Along the leg."""
        return {} if self.leg_stiffness is None else {"z": self.leg_stiffness}

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
        """Poses with the tool tip at (x, 0, z), tilted by a about x; broadcast.

        Parameters
        ----------
        x : (...)
            m.
        a : (...)
            rad.
        z : (...)
            m, over the work table.
        """
        x, a, z = np.broadcast_arrays(*(np.asarray(v, dtype=float) for v in (x, a, z)))
        return Poses(np.stack([x, np.zeros_like(x), z], axis=-1), rotation_x(a))

    def home(self) -> Poses:
        """Tool upright in the middle, 0.4 m over the table (section 2.2)."""
        return self.poses(0.0)

    def pose_grid(self, steps: int = 10) -> PoseGrid:
        """Fig. 29-(b), 0.4 m over the table: 2 · steps + 1 places along x, as many tilts a.

        Parameters
        ----------
        steps : int
            To each side of the middle.
        """
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
