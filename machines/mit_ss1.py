"""The MIT-SS-1 of Son 2002: the planar 3-PRR part of a five-axis milling machine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import radians
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import Linkage, Placement, Poses, angle, rotation_y
from strutwork.machines import mit_ss1_parts as parts
from strutwork.machines.dimensions import LENGTH, OR_RIGID, check_positive, check_proportions
from strutwork.machines.legs import square_root
from strutwork.machines.limits import Limit, joint_limits
from strutwork.machines.pose_grid import PoseGrid
from strutwork.msa.materials import Material
from strutwork.msa.sections import Section, rectangle
from strutwork.msa.structure import Structure

Array = NDArray[Any]

#: Our choice; the thesis names no material of the struts.
STEEL = Material.isotropic(200e9, 0.3, 7850.0, name="steel")

#: Our choice: 30 mm in the plane, 160 mm along the pins.
PLATE_30_160 = rectangle(0.030, 0.160, name="plate 30 x 160")

#: Nominal workspace in x, m (section 6.1, Fig. 28; the shift by 0.01 m: section 6.4).
NOMINAL_X = (-0.06, 0.04)
#: Nominal tilt to either side, rad (section 9.2.1).
NOMINAL_TILT = radians(30.0)

#: The tool may stand off the struts' plane by this much, m and rad: rounding.
PLANE = 1e-9


@dataclass(frozen=True, kw_only=True)
class MitSS1:
    """Three moving blocks on vertical guides, three struts of fixed length, a spindle housing.

    Everything moves in the x-z plane and every pin lies along y. Blocks stand at x = −w₁, w₂, w₃
    and slide along z, which is driven; the joints on the housing are (−r, 0, t), (r, 0, t) and
    (0, 0, t + p) in the tool's axes, whose origin is the tool tip. The tool stands in the middle
    between the two bearings of the pins. The scan of Appendix B has lost the sign of w₁.

    Each pin turns in two bearings, half of `pin_width` to either side: "near" on the granite's
    side (negative y), "far" outside. Both are elastic, so that the over-constraint of the
    planar machine shows as forces in them.

    The two serial axes under the workpiece stand in `strutwork.machines.WorkTable`.

    Parameters
    ----------
    guide_distances : (3,) of float
        w₁, w₂, w₃, m (Son 2002, Appendix B).
    strut_lengths : (3,) of float
        l₁, l₂, l₃ between the pins, m (Appendix B).
    joint_height : float
        t: lower joints above the tool tip, m (Appendix B).
    joint_radius : float
        r: lower joints beside the tool axis, m (Appendix B).
    joint_rise : float
        p: third joint above the lower ones, m (Appendix B).
    pin_width : float
        Distance of a pin's two bearings, m. Our choice: the middle of the 140 to 220 mm that a
        pin's shaft and a strut share (section 8.2).
    radial_stiffness : float or None
        Of one bearing, N/m; None: rigid. Calibrated: with the strut between them two pairs make
        255 N/µm (eq. 51), and 1/Cxx at the tool reaches 150 N/µm, the highest
        tick of Fig. 29-(a).
    axial_stiffness : float or None
        Of one bearing, N/m; None: rigid. Calibrated: two in series make the 9.55 N/µm of the
        reconstructed Table 2, see `strutwork.machines.StrutAssembly`.
    block_radial_stiffness, block_axial_stiffness : float or None
        Of one bearing in a moving block, N/m; None: as in the housing.
    preload_factor : float
        Stiffness of the far bearings, where the preload nuts sit with little interference (section
        11), over that of the near ones: a ratio.
    drive_stiffness : float or None
        Of a block's drive, N/m. None holds it rigidly, as section 6.2 takes it.
    guide_stiffness : float or None
        k_tr, of a block's guide along x, N/m. None: rigid; the thesis prints no value.
    struts : "beams" or "rigid"
    pins : "bearings" or "revolute"
        "revolute" makes each pin one ideal joint: for mobility, since nothing then limits the
        assembly forces but the struts.
    material, section : Material, Section
        Of the struts. Our choice: the thesis gives neither. The section's y lies in the plane,
        its z along the pins.
    elements : int
        Beam elements per strut.
    housing_mass : float
        kg, without a spindle, in the middle of the three joints. Calibrated: 118.3 kg of struts
        and housing, of which a spindle of 7.1 kg is about 6 % (section 9.1), parted so that the
        frequencies of section 9.2.2 can be met.
    housing_inertia : float
        kg m², about every axis. Calibrated: the tilting stiffness of 31.65 kN m/rad at 79.2 Hz
        (eq. 65).
    strut_mass : float
        Of each strut with its shafts and bearings, kg. Calibrated with `housing_mass`; what the
        beam does not weigh stands at its ends. Blocks have no mass: the drives hold them.

    Raises
    ------
    ModelError
        A length or stiffness that is not positive, an unknown choice, or struts that do not
        reach the housing at home.
    """

    guide_distances: tuple[float, float, float] = (0.2975, 0.3075, 0.1575)
    strut_lengths: tuple[float, float, float] = (0.400, 0.400, 0.475)
    joint_height: float = 0.150
    joint_radius: float = 0.095
    joint_rise: float = 0.095
    pin_width: float = 0.180
    radial_stiffness: float | None = 285e6
    axial_stiffness: float | None = 19.1e6
    block_radial_stiffness: float | None = None
    block_axial_stiffness: float | None = None
    preload_factor: float = 1.0
    drive_stiffness: float | None = None
    guide_stiffness: float | None = None
    struts: Literal["beams", "rigid"] = "beams"
    pins: Literal["bearings", "revolute"] = "bearings"
    material: Material = STEEL
    section: Section = PLATE_30_160
    elements: int = 1
    housing_mass: float = 30.0
    housing_inertia: float = 0.1278
    strut_mass: float = 29.4

    def __post_init__(self) -> None:
        for name in ("guide_distances", "strut_lengths"):
            values = getattr(self, name)
            if np.shape(values) != (3,) or not all(np.isfinite(v) and v > 0 for v in values):
                raise ModelError(
                    f"MitSS1.{name}", f"is {values!r}.", "Give three positive lengths, m."
                )
        single = ("joint_height", "joint_radius", "joint_rise", "pin_width")
        check_positive(self, single, LENGTH)
        sizes = {
            f"{name}[{k}]": value
            for name in ("guide_distances", "strut_lengths")
            for k, value in enumerate(getattr(self, name))
        }
        check_proportions("MitSS1", sizes | {name: getattr(self, name) for name in single})
        for name in (
            *("radial_stiffness", "axial_stiffness", "block_radial_stiffness"),
            *("block_axial_stiffness", "drive_stiffness", "guide_stiffness"),
        ):
            check_positive(self, [name], OR_RIGID)
        check_positive(self, ("housing_mass", "housing_inertia", "strut_mass", "preload_factor"))
        for name, words in (("struts", ("beams", "rigid")), ("pins", ("bearings", "revolute"))):
            if getattr(self, name) not in words:
                raise ModelError(
                    f"MitSS1.{name}",
                    f"is {getattr(self, name)!r}.",
                    f'Choose "{words[0]}" or "{words[1]}".',
                )
        at_home = self.place(self.home())
        if not at_home.reachable:
            raise ModelError(
                "MitSS1",
                f"cannot stand at home: {at_home.reason(())}.",
                "Change the struts' lengths or the distances of the guides.",
            )

    @cached_property
    def linkage(self) -> Linkage:
        """Bodies and joints: three guides, then the bearings, strut by strut."""
        joints = parts.pin_joints()
        if self.pins == "bearings":
            joints = parts.bearing_joints(self._bearing)
        guides = parts.guide_joints(self.drive_stiffness, self.guide_stiffness)
        return Linkage(parts.nodes(), parts.bodies(), (*guides, *joints), parts.TOOL)

    @cached_property
    def structure(self) -> Structure:
        """The linkage with its flexible struts; blocks and housing are rigid."""
        middle = self.joint_height + self.joint_rise / 3.0
        housing = parts.housing_mass(self.housing_mass, self.housing_inertia, middle)
        masses = (housing, *parts.end_masses(self._end_masses))
        if self.struts == "rigid":
            return Structure(self.linkage, masses=masses)
        beams = parts.beams(self.material, self.section, self.elements)
        return Structure(self.linkage, beams=beams, rigid=parts.shafts(), masses=masses)

    def _bearing(self, end: str, side: str) -> dict[str, float]:
        """Stiffness of a bearing by direction, N/m; rigid directions are left out."""
        radial, axial = self.radial_stiffness, self.axial_stiffness
        if end == "block":
            radial = self.block_radial_stiffness or radial
            axial = self.block_axial_stiffness or axial
        factor = self.preload_factor if side == "far" else 1.0
        named = {"x": radial, "y": radial, "z": axial}
        return {d: factor * k for d, k in named.items() if k is not None}

    @property
    def _end_masses(self) -> list[float]:
        """What each strut weighs beside its beam, kg."""
        if self.struts == "rigid":
            return [self.strut_mass] * 3
        line = (self.material.density or 0.0) * self.section.area
        rest = [self.strut_mass - line * length for length in self.strut_lengths]
        if min(rest) < 0:
            raise ModelError(
                "MitSS1.strut_mass",
                f"is {self.strut_mass:g} kg, less than the {self.strut_mass - min(rest):.3g} kg "
                "of a strut's beam.",
                "Raise it, or choose a lighter section or material.",
            )
        return rest

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        """Joint ranges: none, the thesis prints none."""
        return joint_limits(self.linkage)

    @cached_property
    def seats(self) -> Array:
        """Joints on the housing in the tool's axes, (3, 3), m."""
        r, t, p = self.joint_radius, self.joint_height, self.joint_rise
        return np.array([[-r, 0.0, t], [r, 0.0, t], [0.0, 0.0, t + p]])

    @cached_property
    def rails(self) -> Array:
        """Where the guides stand along x, (3,), m."""
        return np.array([-1.0, 1.0, 1.0]) * self.guide_distances

    @property
    def bearing_planes(self) -> tuple[float, float]:
        """Where the near and far bearings stand along y, m; the near ones are the datum."""
        return -self.pin_width / 2.0, self.pin_width / 2.0

    @staticmethod
    def poses(x: ArrayLike, z: ArrayLike = 0.0, b: ArrayLike = 0.0) -> Poses:
        """Poses in the plane; broadcast.

        Parameters
        ----------
        x, z : (...)
            Place of the tool tip, m.
        b : (...)
            Tilt about y, rad.
        """
        x, z, b = np.broadcast_arrays(
            np.asarray(x, dtype=float), np.asarray(z, dtype=float), np.asarray(b, dtype=float)
        )
        return Poses(np.stack([x, np.zeros_like(x), z], axis=-1), rotation_y(b))

    def home(self) -> Poses:
        """Tool upright, its tip at the origin."""
        return self.poses(0.0)

    def pose_grid(self, steps: int = 10) -> PoseGrid:
        """The nominal workspace at height zero: 2 · steps + 1 places along x, as many tilts b.

        Parameters
        ----------
        steps : int
            To each side of the middle.
        """
        x, b = (
            np.linspace(*ends, 2 * steps + 1) for ends in (NOMINAL_X, (-NOMINAL_TILT, NOMINAL_TILT))
        )
        return PoseGrid(self.poses(x).position, rotation_y(b), b, "b")

    def skeleton(self) -> Sequence[tuple[str, str]]:
        """Pairs of nodes that a drawing connects by a line."""
        return parts.lines()

    def place(self, poses: Poses) -> Placement:
        """Inverse kinematics, eqs 40 to 45 with the blocks above the housing, batch first.

        Analytic in the pose, which may carry a complex step; what of it lies outside the plane
        moves no drive.

        Parameters
        ----------
        poses : Poses
            Of the tool, (...).

        Returns
        -------
        Placement
            Values: the blocks' heights θ, m, and the turns of the pins about y, rad. Poses out
            of the plane or out of reach are marked with a reason; their positions are finite
            and without meaning.
        """
        points = poses.position[..., None, :] + np.einsum(
            "...ij,kj->...ki", poses.rotation, self.seats
        )
        x, z = points[..., 0], points[..., 2]
        lengths = np.asarray(self.strut_lengths)
        across = self.rails - x
        rise, missing = square_root(lengths**2 - across * across, float(lengths.max()))
        height = z + rise
        lean = angle(across, rise)
        tilt = angle(poses.rotation[..., 0, 2], poses.rotation[..., 2, 2])
        positions = self._positions(poses.position, x, z, height)
        values: dict[tuple[str, str], Array] = {}
        for k, i in enumerate(parts.STRUTS):
            values[parts.guide(i), "z"] = height[..., k]
        for k, i in enumerate(parts.STRUTS):
            turns = {"block": lean[..., k], "housing": tilt - lean[..., k]}
            for end, turn in turns.items():
                if self.pins == "revolute":
                    values[parts.pin(i, end), "rz"] = turn
                else:
                    values |= {(parts.strut(i, end, s), "rz"): turn for s in parts.SIDES}
        status, reasons = _status(poses, missing)
        return Placement(
            np.stack([positions[n] for n in self.linkage.nodes], axis=-2),
            self._frames(across, rise),
            np.stack(list(values.values()), axis=-1),
            tuple(values),
            status,
            reasons,
        )

    def _positions(self, tool: Array, x: Array, z: Array, height: Array) -> dict[str, Array]:
        """Position of every node, (..., 3), m."""
        near, far = self.bearing_planes
        planes = {"near": near, "far": far, "end": 0.0}
        result = {parts.TOOL: tool}
        for k, i in enumerate(parts.STRUTS):
            lower = {name: _point(x[..., k], y, z[..., k]) for name, y in planes.items()}
            rail = np.broadcast_to(self.rails[k], height.shape[:-1])
            upper = {name: _point(rail, y, height[..., k]) for name, y in planes.items()}
            result[parts.rail(i)] = result[parts.block(i, "slide")] = upper["end"]
            for name in planes:
                result[parts.strut(i, "block", name)] = upper[name]
                result[parts.strut(i, "housing", name)] = lower[name]
            for side in parts.SIDES:
                result[parts.block(i, side)] = upper[side]
                result[parts.seat(i, side)] = lower[side]
        return result

    def _frames(self, across: Array, rise: Array) -> Array:
        """Joint axes, (..., j, 3, 3): guides global; pins z along y, x down the strut."""
        size = np.sqrt(across * across + rise * rise)
        x = _point(-across / size, 0.0, -rise / size)
        z = np.broadcast_to(np.array([0.0, 1.0, 0.0]), x.shape)
        pins = np.stack([x, np.cross(z, x), z], axis=-1)
        guides = np.broadcast_to(np.eye(3), pins.shape)
        each = (len(self.linkage.joints) - len(parts.STRUTS)) // len(parts.STRUTS)
        return np.concatenate([guides, np.repeat(pins, each, axis=-3)], axis=-3)


def _point(x: Array, y: float, z: Array) -> Array:
    """Points, (..., 3), of coordinates of which y is one number."""
    return np.stack([x, np.full_like(x, y), z], axis=-1)


def _status(poses: Poses, missing: NDArray[np.bool_]) -> tuple[NDArray[np.int8], tuple[str, ...]]:
    """Code of the first fault of each pose, and the reasons the codes stand for."""
    turned = poses.rotation[..., 1].real - np.array([0.0, 1.0, 0.0])
    faults = {
        "the tool is outside the plane y = 0 in which the machine moves": (
            np.abs(poses.position[..., 1].real) > PLANE
        ),
        "the tool is rotated about an axis other than y": np.abs(turned).max(axis=-1) > PLANE,
    }
    for k, i in enumerate(parts.STRUTS):
        reason = f"strut {i}: its joint on the housing is farther from the guide than it reaches"
        faults[reason] = missing[..., k]
    masks = np.stack(list(faults.values()), axis=-1)
    first = np.where(masks.any(axis=-1), masks.argmax(axis=-1) + 1, 0)
    return first.astype(np.int8), tuple(faults)
