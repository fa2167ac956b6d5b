"""The serial five-axis machine of Son 2002: three slides and a head of two rotary axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from math import radians
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import Linkage, Placement, Poses, angle, rotation_x, rotation_y
from strutwork.kinematics.frames import rotation_z
from strutwork.machines import serial_five_axis_parts as parts
from strutwork.machines.dimensions import check_positive, check_proportions
from strutwork.machines.limits import Limit, joint_limits
from strutwork.machines.variant import Variant
from strutwork.msa.materials import Material
from strutwork.msa.sections import Section, box
from strutwork.msa.structure import Structure

Array = NDArray[Any]

Axes = Literal["ac", "ab"]

#: Tilt at home of the head that is singular upright, rad; our choice. Section 4.4.1 turns the
#: surface about x for the same reason and does not say how far.
HOME_TILT = radians(30.0)

#: Our choice, as for the struts of `MitSS1`.
STEEL = Material.isotropic(200e9, 0.3, 7850.0, name="steel")

#: Our choice: the thesis prints no section of it.
COLUMN = box(0.200, 0.200, 0.015, name="box 200 x 200 x 15")
RAM = box(0.120, 0.120, 0.012, name="box 120 x 120 x 12")

_LENGTHS = ("tool_length", "neck_length", "column_distance", "saddle_depth", "rail_depth")
_STIFFNESSES = (
    *("slide_drive_stiffness", "guide_stiffness", "guide_tilting_stiffness"),
    *("rotary_drive_stiffness", "bearing_stiffness", "bearing_tilting_stiffness"),
)
_MASSES = ("carriage_mass", "saddle_mass", "fork_mass", "housing_mass", "spindle_mass")


@dataclass(frozen=True, kw_only=True)
class SerialFiveAxis:
    """Slides X, Z and Y one on the other, two rotary axes at the ram's end, and the spindle.

    A column runs along x, a saddle on it along z, a ram in the saddle along y. From the ram's end
    a neck hangs down to the pivot, where both rotary axes and the tool's meet. "ac" (the vertical
    type of section 2.1.2) turns about z, then about the fork's x; the tool's axis, from its tip
    upwards, is (sin a sin c, −sin a cos c, cos a). "ab" (the horizontal type) turns about x, then
    about the fork's y; the axis is (sin b, −sin a cos b, cos a cos b).

    Tip and axis of the tool, five coordinates, settle the five machine axes. The sixth, the turn
    about the tool's axis, is the spindle's, which is driven too: with it the tool moves in all
    directions, and a tool along the first rotary axis is a serial singularity of the linkage.

    The thesis compares such machines and prints no dimension of one: figures 2, 9 and 14 are
    skeletons. Their axes are its; every length, section, stiffness and mass is our choice, of a
    machine of about the envelope of the MIT-SS-1, 0.9 by 1.0 by 1.5 m.

    Parameters
    ----------
    axes : "ac" or "ab"
        The two rotary axes, from the ram to the spindle.
    tool_length : float
        From the tool tip to the pivot, m.
    neck_length : float
        From the pivot up to the ram's axis, m.
    column_distance : float
        From the column's axis along y to the pivot at the middle of the ram's stroke, m.
    saddle_depth : float
        From the column's axis to where the saddle holds the ram, m.
    rail_depth : float
        Of the column's rails under the tool tip at home, m.
    slide_drive_stiffness : float
        Of a slide along its way, N/m.
    guide_stiffness, guide_tilting_stiffness : float
        Of a slide across it, N/m, and about each axis, N m/rad.
    rotary_drive_stiffness : float
        Of a rotary axis about itself, N m/rad.
    bearing_stiffness, bearing_tilting_stiffness : float
        Of a rotary axis in each direction, N/m, and across it, N m/rad.
    carriage_mass, saddle_mass, fork_mass, housing_mass : float
        kg, beside those of the beams; the first at the column's foot, the last with its motor.
    spindle_mass : float
        kg. Of the spindle that the thesis chooses for the MIT-SS-1 (section 9).
    material, column, ram : Material, Section, Section
        The neck is of the ram's section. What of the ram stands behind the saddle is left out.
    elements : int
        Beam elements of column, ram and neck each.

    Raises
    ------
    ModelError
        A length, stiffness or mass that is not positive, or axes that are neither.
    """

    axes: Axes = "ac"
    tool_length: float = 0.200
    neck_length: float = 0.200
    column_distance: float = 0.600
    saddle_depth: float = 0.120
    rail_depth: float = 0.200
    slide_drive_stiffness: float = 100e6
    guide_stiffness: float = 1000e6
    guide_tilting_stiffness: float = 20e6
    rotary_drive_stiffness: float = 1e6
    bearing_stiffness: float = 800e6
    bearing_tilting_stiffness: float = 4e6
    carriage_mass: float = 20.0
    saddle_mass: float = 25.0
    fork_mass: float = 10.0
    housing_mass: float = 10.0
    spindle_mass: float = 7.1
    material: Material = STEEL
    column: Section = COLUMN
    ram: Section = RAM
    elements: int = 1

    def __post_init__(self) -> None:
        if self.axes not in parts.ROTARY:
            raise ModelError(
                "SerialFiveAxis.axes",
                f"is {self.axes!r}.",
                'Choose "ac" or "ab", from the ram to the spindle.',
            )
        check_positive(self, (*_LENGTHS, *_STIFFNESSES, *_MASSES))
        check_proportions("SerialFiveAxis", {name: getattr(self, name) for name in _LENGTHS})
        at_home = self.place(self.home())
        if not at_home.reachable:
            raise ModelError(
                "SerialFiveAxis",
                f"cannot stand at home: {at_home.reason(())}.",
                "Put the column farther away, or the saddle nearer to it.",
            )

    @cached_property
    def linkage(self) -> Linkage:
        """A chain of seven bodies; every joint is driven."""
        slides = parts.slide_joints(
            self.slide_drive_stiffness, self.guide_stiffness, self.guide_tilting_stiffness
        )
        turns = parts.rotary_joints(
            self.axes,
            self.rotary_drive_stiffness,
            self.bearing_stiffness,
            self.bearing_tilting_stiffness,
        )
        return Linkage(parts.nodes(), parts.bodies(), (*slides, *turns), parts.TOOL)

    @cached_property
    def structure(self) -> Structure:
        """The linkage with flexible column, ram and neck; saddle, head and spindle are rigid."""
        return Structure(
            self.linkage,
            beams=parts.beams(self.material, self.column, self.ram, self.elements),
            masses=parts.masses(
                self.carriage_mass,
                self.saddle_mass,
                self.fork_mass,
                self.housing_mass,
                self.spindle_mass,
                self.tool_length,
            ),
        )

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        """Ranges of the joints: our choice."""
        return joint_limits(self.linkage)

    @cached_property
    def home_tilt(self) -> float:
        """Turn a at home, rad: zero where the upright tool is not singular."""
        return HOME_TILT if self.axes == "ac" else 0.0

    def home(self) -> Poses:
        """Tool tip at the origin, on the workpiece; tilted about x by `home_tilt`."""
        return Poses(np.zeros(3), rotation_x(self.home_tilt))

    def head(self, first: ArrayLike, second: ArrayLike) -> tuple[Array, Array]:
        """Rotations of the fork, and of the housing with the tool's axis as z, (..., 3, 3).

        Parameters
        ----------
        first, second : (...)
            Turns of the two rotary axes, rad: c and a, or a and b.
        """
        if self.axes == "ac":
            fork = rotation_z(first)
            return fork, fork @ rotation_x(second)
        fork = rotation_x(first)
        return fork, fork @ rotation_y(second)

    def turns(self, tool_axis: ArrayLike) -> tuple[Array, Array]:
        """Turns of the two rotary axes that lay the tool along an axis, rad, (...) each.

        Of the two that do, "ac" takes a ≥ 0 and "ab" |b| ≤ 90°. Along the first rotary axis
        its turn is free, and is zero here.

        Parameters
        ----------
        tool_axis : (..., 3)
            From the tip upwards, of any length: no unit.
        """
        q = np.asarray(tool_axis)
        x, y, z = q[..., 0], q[..., 1], q[..., 2]
        if self.axes == "ac":
            # 0 − y and not −y: of an upright tool this is no negative zero, whose angle is 180°
            return angle(x, 0.0 - y), angle(np.sqrt(x * x + y * y), z)
        return angle(0.0 - y, z), angle(x, np.sqrt(y * y + z * z))

    def skeleton(self) -> Sequence[tuple[str, str]]:
        """Pairs of nodes that a drawing connects by a line."""
        return parts.lines()

    def place(self, poses: Poses) -> Placement:
        """Inverse kinematics, closed form, batch first.

        Analytic in the pose, which may carry a complex step, but for a tool along the first
        rotary axis.

        Parameters
        ----------
        poses : Poses
            Of the tool, (...).

        Returns
        -------
        Placement
            Values: the slides, m, zero with the upright tool's tip at the origin; the rotary
            axes and the spindle, rad. Poses at which column or ram would have no length are
            marked with a reason; their positions are finite and without meaning.
        """
        axis = poses.rotation[..., 2]
        first, second = self.turns(axis)
        fork, housing = self.head(first, second)
        within = np.swapaxes(housing, -1, -2) @ poses.rotation
        spin = angle(within[..., 1, 0], within[..., 0, 0])
        pivot = poses.position + self.tool_length * axis
        end = pivot + np.array([0.0, 0.0, self.neck_length])
        x, y, z = pivot[..., 0], pivot[..., 1], pivot[..., 2]
        placed = {
            parts.FOOT: _point(x, -self.column_distance, -self.rail_depth),
            parts.BACK: _point(x, -self.column_distance, end[..., 2]),
            parts.FRONT: _point(x, self.saddle_depth - self.column_distance, end[..., 2]),
            parts.END: end,
            parts.PIVOT: pivot,
            parts.TOOL: poses.position,
        }
        short = {
            "the saddle is at the foot of the column or below it": (
                end[..., 2].real <= -self.rail_depth
            ),
            "the ram's end is in the saddle or behind it": (
                end[..., 1].real <= self.saddle_depth - self.column_distance
            ),
        }
        masks = np.stack(list(short.values()), axis=-1)
        values = np.stack([x, z - self.tool_length, y, first, second, spin], axis=-1)
        return Placement(
            np.stack([placed[parts.place_of(n)] for n in self.linkage.nodes], axis=-2),
            self._frames(fork, housing),
            values,
            tuple((j.name, j.driven[0]) for j in self.linkage.joints),
            np.where(masks.any(axis=-1), masks.argmax(axis=-1) + 1, 0).astype(np.int8),
            tuple(short),
            self._turned(fork, housing, poses.rotation),
        )

    def _frames(self, fork: Array, housing: Array) -> Array:
        """Joint axes, (..., 6, 3, 3): z is the axis of each, x and y move with its first body."""
        x, y, z = np.eye(3)
        along_x, along_y = np.stack([y, z, x], axis=-1), np.stack([z, x, y], axis=-1)
        # of the ram, which the saddle's joint has as its first body
        ram = np.stack([x, z, -y], axis=-1)
        first, second = (
            (np.eye(3), fork @ along_x) if self.axes == "ac" else (along_x, fork @ along_y)
        )
        frames = [along_x, np.eye(3), ram, first, second, housing]
        return np.stack([np.broadcast_to(f, fork.shape) for f in frames], axis=-3)

    def _turned(self, fork: Array, housing: Array, tool: Array) -> Array:
        """Rotations of the bodies from where head and tool stand upright, (..., 6, 3, 3)."""
        by_name = {parts.FORK: fork, parts.HOUSING: housing, parts.SPINDLE: tool}
        each = [by_name.get(name, np.eye(3)) for name in self.linkage.body_names]
        return np.stack([np.broadcast_to(r, tool.shape) for r in each], axis=-3)


def _point(x: Array, y: float, z: Array | float) -> Array:
    """Points, (..., 3), of which some coordinates are one number."""
    return np.stack([x, np.full_like(x, y), np.zeros_like(x) + z], axis=-1)


def models_by_head() -> tuple[Variant, ...]:
    """The machine with either head."""
    words: dict[Axes, str] = {
        "ac": "rotary axes C, then A: the vertical type, singular with the tool upright",
        "ab": "rotary axes A, then B: the horizontal type, singular at b = ±90°",
    }
    return tuple(Variant(w, text, partial(SerialFiveAxis, axes=w)) for w, text in words.items())
