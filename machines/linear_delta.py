"""The linear Delta of Corbel 2008: three carriages on parallel rails, six rods, no rotation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from math import sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, Poses, angle, axes_frame
from strutwork.kinematics.frames import cross, dot, frame, gathered, vector
from strutwork.machines.dimensions import OR_RIGID, check_positive, check_proportions
from strutwork.machines.legs import square_root
from strutwork.machines.limits import Limit, joint_limits
from strutwork.msa.beam import Beam
from strutwork.msa.materials import Material
from strutwork.msa.sections import Section, tube
from strutwork.msa.springs import PointMass
from strutwork.msa.structure import Structure

Array = NDArray[Any]

TOOL = "tool"
PLATFORM = "platform"
LEGS = (1, 2, 3)
#: The two rods of a parallelogram, against and along the tangent.
SIDES = ("a", "b")

#: From the axis to the rails, one row a leg (eq. 3: its a_i is a point of the plate less that of
#: the rail).
OUTWARD = np.array([[-sqrt(0.75), -0.5, 0.0], [0.0, 1.0, 0.0], [sqrt(0.75), -0.5, 0.0]])
#: Across them, level: along a parallelogram's short sides.
TANGENT = np.cross([0.0, 0.0, 1.0], OUTWARD)

#: Handbook values; the paper prints no material. Ours.
STEEL = Material.isotropic(210e9, 0.3, 7850.0, name="steel")
TUBE = tube(0.030, 0.022, name="tube 30/22")

#: Elements of a rotation may differ by this much from one that does not turn.
LEVEL = 1e-9


def leg(i: int, part: str) -> str:
    """Node or joint of a leg.

    Parameters
    ----------
    i : int
    part : str
        "rail", "carriage", "slide"; "top", "root", "end" and a side.
    """
    return f"leg{i}/{part}"


def seat(i: int, side: str) -> str:
    """Node of the platform in the middle of a rod's ball.

    Parameters
    ----------
    i : int
        Of the leg.
    side : str
        Of the parallelogram.
    """
    return f"{PLATFORM}/P{i}{side}"


@dataclass(frozen=True, kw_only=True)
class LinearDelta:
    """Driven prismatic joint, then a parallelogram of two rods, in each leg (section II-B).

    Each rod stands between a universal joint at the carriage and a ball at the platform: six rods
    and three drives, nothing held twice. z runs along the rails towards the tool; the carriages
    are behind the platform, where the paper has room for the measuring device.

    Parameters
    ----------
    base_radius, platform_radius : float
        R_b and R_TP, m (Corbel 2008, Table I). The kinematics knows their difference ΔR only.
    rod_length : float
        L, m (Table I).
    rod_spacing : float
        d: the two rods of a parallelogram apart, m (Table I).
    workspace_side : float
        Of the cube about home that the tool moves in, m (Fig. 5). The carriages' stroke is what
        it needs: none is printed.
    drive_stiffness : float or None
        Of a drive along its rail, N/m; None: rigid. Assumed, 120 N/µm: a ball screw of usual size.
    platform_mass, carriage_mass : float
        kg. Assumed.
    material : Material
        Of the rods. Assumed.
    section : Section
        Of the rods. Assumed: the paper wants them stiff enough for cutting forces and prints none.

    Raises
    ------
    ModelError
        A dimension or stiffness that is not positive or out of proportion, or rods too short for
        the workspace.
    """

    base_radius: float = 0.540
    platform_radius: float = 0.060
    rod_length: float = 0.800
    rod_spacing: float = 0.075
    workspace_side: float = 0.300
    drive_stiffness: float | None = 120e6
    platform_mass: float = 6.0
    carriage_mass: float = 8.0
    material: Material = STEEL
    section: Section = TUBE

    def __post_init__(self) -> None:
        lengths = ("base_radius", "platform_radius", "rod_length", "rod_spacing", "workspace_side")
        masses = ("platform_mass", "carriage_mass")
        check_positive(self, (*lengths, *masses))
        check_proportions("LinearDelta", {name: getattr(self, name) for name in lengths})
        check_positive(self, ["drive_stiffness"], OR_RIGID)
        if self.reach <= 0.0:
            raise ModelError(
                "LinearDelta.base_radius",
                f"is not larger than the platform's radius of {self.platform_radius:g} m.",
                "Place the rails farther out.",
            )
        half = self.workspace_side / 2.0
        if self.rod_length <= self.reach + sqrt(2.0) * half:
            raise ModelError(
                "LinearDelta.rod_length",
                f"is {self.rod_length:g} m, too short for rails {self.reach:g} m beyond the "
                f"platform's joints and a workspace of {self.workspace_side:g} m.",
                "Make the rods longer, or the workspace or base_radius smaller.",
            )

    @property
    def reach(self) -> float:
        """ΔR, m."""
        return self.base_radius - self.platform_radius

    def rise(self, level: Array) -> tuple[Array, NDArray[np.bool_]]:
        """The platform ahead of each carriage, (..., 3), m, and where rods do not reach, (..., 3).

        Parameters
        ----------
        level : (..., 3)
            Place of the tool, m.
        """
        across = level[..., None, :2] - self.reach * OUTWARD[:, :2]
        square = across[..., 0] ** 2 + across[..., 1] ** 2
        return square_root(self.rod_length**2 - square, self.rod_length)

    @cached_property
    def stroke(self) -> tuple[float, float]:
        """Range of the carriages along their rails, m: what the workspace needs, no more."""
        half = self.workspace_side / 2.0
        corners = np.array(list(product((-half, half), (-half, half), (0.0,))))
        # a rod is steepest where its leg's rail is nearest, flattest at a corner
        near = np.clip(self.reach * OUTWARD, -half, half)
        flattest, steepest = self.rise(corners)[0].min(), self.rise(near)[0].max()
        return -half - float(steepest), half - float(flattest)

    @cached_property
    def linkage(self) -> Linkage:
        """Ground, three carriages, six rods and the platform."""
        drive = {} if self.drive_stiffness is None else {"z": self.drive_stiffness}
        pairs = [(i, s) for i in LEGS for s in SIDES]
        bodies = (
            Body(GROUND, tuple(leg(i, "rail") for i in LEGS)),
            Body(PLATFORM, (TOOL, *(seat(i, s) for i, s in pairs))),
            *(
                Body(f"carriage{i}", (leg(i, "carriage"), *(leg(i, f"top-{s}") for s in SIDES)))
                for i in LEGS
            ),
            *(Body(f"rod{i}{s}", (leg(i, f"root-{s}"), leg(i, f"end-{s}"))) for i, s in pairs),
        )
        joints = []
        for i in LEGS:
            joints.append(
                Joint(
                    leg(i, "slide"),
                    "prismatic",
                    (leg(i, "rail"), leg(i, "carriage")),
                    drive,
                    driven=("z",),
                    limits={"z": self.stroke},
                )
            )
            for s in SIDES:
                top, root, end = (leg(i, f"{part}-{s}") for part in ("top", "root", "end"))
                joints += [
                    Joint(leg(i, f"universal-{s}"), "universal", (top, root)),
                    Joint(leg(i, f"ball-{s}"), "spherical", (end, seat(i, s))),
                ]
        return Linkage(tuple(n for b in bodies for n in b.nodes), bodies, tuple(joints), TOOL)

    @cached_property
    def structure(self) -> Structure:
        """The linkage with flexible rods; carriages and platform are rigid."""
        beams = tuple(
            Beam(
                leg(i, f"rod-{s}"),
                (leg(i, f"root-{s}"), leg(i, f"end-{s}")),
                self.material,
                self.section,
                elements=2,
            )
            for i in LEGS
            for s in SIDES
        )
        across = self.platform_mass * self.platform_radius**2 / 4.0
        disc = ((across, 0.0, 0.0), (0.0, across, 0.0), (0.0, 0.0, 2.0 * across))
        cube = self.carriage_mass * self.rod_spacing**2 / 6.0
        block = ((cube, 0.0, 0.0), (0.0, cube, 0.0), (0.0, 0.0, cube))
        masses = (
            PointMass(TOOL, self.platform_mass, disc),
            *(PointMass(leg(i, "carriage"), self.carriage_mass, block) for i in LEGS),
        )
        return Structure(self.linkage, beams, masses=masses)

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        """The carriages' strokes; ranges of the passive joints are not printed."""
        return joint_limits(self.linkage)

    def home(self) -> Poses:
        """The middle of the workspace, where z is zero."""
        return Poses.of([0.0, 0.0, 0.0])

    def skeleton(self) -> Sequence[tuple[str, str]]:
        """Pairs of nodes that a drawing connects by a line."""
        around = [seat(i, s) for i in LEGS for s in SIDES]
        return (
            *((leg(i, f"root-{s}"), leg(i, f"end-{s}")) for i in LEGS for s in SIDES),
            *((leg(i, "top-a"), leg(i, "top-b")) for i in LEGS),
            *zip(around, around[1:] + around[:1], strict=True),
        )

    def place(self, poses: Poses) -> Placement:
        """Inverse kinematics, batch first: q_i = z − √(L² − |a_i|²) (eqs. 1 to 4, squared).

        Analytic in the position, which may carry a complex step.

        Parameters
        ----------
        poses : Poses
            Of the tool, (...).

        Returns
        -------
        Placement
            Values: of each leg its carriage's place along the rail, m, and of each rod the turn
            of its universal joint about the tangent and then across it, rad. Poses that turn the
            platform, or that rods do not reach, are marked; their positions are finite and
            without meaning.
        """
        tool = poses.position
        rise, missing = self.rise(tool)
        carriage = vector(
            self.base_radius * OUTWARD[:, 0],
            self.base_radius * OUTWARD[:, 1],
            tool[..., None, 2] - rise,
        )
        plate = tool[..., None, :] + self.platform_radius * OUTWARD
        line = plate - carriage
        line = line / np.sqrt(dot(line, line))[..., None]
        outward, along = dot(line, OUTWARD), dot(line, TANGENT)
        lean = angle(outward, line[..., 2])
        sway = angle(-along, np.sqrt(outward * outward + line[..., 2] ** 2))
        positions = {TOOL: tool}
        frames: list[Array] = []
        values: list[Array] = []
        names: list[tuple[str, str]] = []
        for k, i in enumerate(LEGS):
            rail = np.broadcast_to(axes_frame([0.0, 0.0, 1.0], OUTWARD[k]), (*tool.shape, 3))
            yoke = self._yoke(line[..., k, :], TANGENT[k])
            # z along the rod, so that its length is a direction of its ball
            ball = axes_frame(line[..., k, :], TANGENT[k])
            positions |= {leg(i, part): carriage[..., k, :] for part in ("rail", "carriage")}
            frames.append(rail)
            values.append(carriage[..., k, 2])
            names.append((leg(i, "slide"), "z"))
            for side, sign in zip(SIDES, (-0.5, 0.5), strict=True):
                aside = sign * self.rod_spacing * TANGENT[k]
                positions |= {
                    leg(i, f"{part}-{side}"): carriage[..., k, :] + aside
                    for part in ("top", "root")
                }
                end = plate[..., k, :] + aside
                positions |= {leg(i, f"end-{side}"): end, seat(i, side): end}
                frames += [yoke, ball]
                values += [lean[..., k], sway[..., k]]
                names += [(leg(i, f"universal-{side}"), d) for d in ("rz", "rx")]
        status, reasons = self._faults(poses, missing)
        return Placement(
            gathered([positions[n] for n in self.linkage.nodes], 1),
            gathered(frames, 2),
            gathered(values, 0),
            tuple(names),
            status,
            reasons,
        )

    @staticmethod
    def _yoke(line: Array, tangent: Array) -> Array:
        """Axes of a universal joint, (..., 3, 3): first along the carriage's tangent."""
        first = np.broadcast_to(tangent, line.shape)
        second = cross(first, line)
        second = second / np.sqrt(dot(second, second))[..., None]
        return frame(second, cross(first, second), first)

    def _faults(
        self, poses: Poses, missing: NDArray[np.bool_]
    ) -> tuple[NDArray[np.int8], tuple[str, ...]]:
        turns = np.abs(poses.rotation.real - np.eye(3)).max(axis=(-2, -1)) > LEVEL
        masks = np.concatenate([turns[..., None], missing], axis=-1)
        reasons = (
            "the platform is rotated, which its parallelograms do not allow",
            *(f"leg {i}: its rods are too short" for i in LEGS),
        )
        return np.where(masks.any(axis=-1), masks.argmax(axis=-1) + 1, 0).astype(np.int8), reasons
