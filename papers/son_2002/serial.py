"""The serial machines' heads (section 2.1.2), and reversals over a flat surface (chapter 4)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.fea import modes
from strutwork.kinematics import Placement, Poses, jacobians
from strutwork.kinematics.drive_fields import FormulaField, MotionField
from strutwork.kinematics.reversals import Reversals, reversals
from strutwork.kinematics.task_surfaces import Plane
from strutwork.machines import HexelHexapod, Machine, MovingBridge, SerialFiveAxis
from strutwork.machines.load import machine_model
from strutwork.machines.serial_five_axis import Axes
from strutwork.msa import axis_stiffness_free, tool_compliance
from strutwork.msa.mass import total_mass

Array = NDArray[Any]

#: The heads in words.
HEADS: Mapping[Axes, str] = MappingProxyType({"ac": "A–C", "ab": "A–B"})

#: Reach of the flat surface to either side, m, and points along it, for each machine that is
#: looked at; assumed. The hexapod's is wide enough for what the thesis has outside its work.
HALF, POINTS = 0.1, 9
HEXAPOD_HALF, HEXAPOD_POINTS = 0.4, 17
BRIDGE_GRID = ((0.18, 13), (0.10, 3))


def at_turns(machine: SerialFiveAxis, first: ArrayLike, second: ArrayLike) -> Poses:
    """Poses with the tool tip at the origin and the rotary axes at given turns, rad."""
    _, housing = machine.head(*np.broadcast_arrays(first, second))
    return Poses(np.zeros(housing.shape[:-1]), housing)


def axis_rates(machine: SerialFiveAxis, placement: Placement) -> Array:
    """Rates of the tool's axis per rate of the two rotary axes, (..., 3, 2).

    Found from the joints: of the machine's Jacobian the turning part, across the tool's axis. The
    thesis has them as eqs 9 and 10.
    """
    found = jacobians(machine.linkage, placement)
    rotary = [k for k, (name, _) in enumerate(found.driven) if name.startswith("axis ")]
    turning = found.forward[..., 3:, :][..., rotary]
    spindle = machine.linkage.joint_index["spindle"]
    axis = placement.frames[..., spindle, :, 2]
    return np.stack([np.cross(turning[..., k], axis) for k in range(2)], axis=-1)


def axis_speeds(machine: SerialFiveAxis, placement: Placement) -> Array:
    """Largest and least speed of the tool's axis at rotary rates of size one, (..., 2).

    The singular values of `axis_rates`: zero where the two axes move it one way only.
    """
    return np.asarray(np.linalg.svd(axis_rates(machine, placement), compute_uv=False))


@dataclass(frozen=True)
class Head:
    """One of the two serial machines.

    Parameters
    ----------
    axes : "ac" or "ab"
    tilt : (91,)
        Of the tool from upright, rad: a of "ac", b of "ab".
    least : (91,)
        Least speed of the tool's axis there, see `axis_speeds`.
    apart : float
        Largest difference of both speeds from 1 and |sin a|, or 1 and |cos b|.
    stiffness : (3,)
        At the tool at home, 1/C_ii along x, y, z, N/m.
    frequency : float
        Lowest at home, Hz.
    mass : float
        kg.
    """

    axes: Axes
    tilt: Array
    least: Array
    apart: float
    stiffness: Array
    frequency: float
    mass: float

    def __repr__(self) -> str:
        return f"<Head {self.axes}: {self.frequency:.4g} Hz at home>"


@cache
def heads() -> tuple[Head, ...]:
    """Both machines, A–C first."""
    return tuple(_head(axes) for axes in HEADS)


def _head(axes: Axes) -> Head:
    machine = SerialFiveAxis(axes=axes)
    tilt = np.radians(np.arange(91.0))
    speeds = axis_speeds(machine, machine.place(at_turns(machine, 0.3, tilt)))
    formula = np.sin(tilt) if axes == "ac" else np.cos(tilt)
    placed = machine.structure.at(machine.place(machine.home()))
    return Head(
        axes,
        tilt,
        speeds[:, 1],
        float(np.abs(speeds - np.stack([np.ones(91), formula], axis=-1)).max()),
        axis_stiffness_free(tool_compliance(placed))[:3],
        float(modes(placed, 1).frequencies[0]),
        float(total_mass(placed)),
    )


def flat_reversals(machine: Machine, half: float = HALF, points: int = POINTS) -> Reversals:
    """Drives over a flat surface, level, whose tool keeps its direction at home (section 4.4)."""
    model = machine_model(machine, "")
    axis = np.linspace(-half, half, points)
    return reversals(MotionField(model.motion, Plane(("x", "y")), machine.place), axis, axis)


def bridge_reversals(machine: MovingBridge) -> Reversals:
    """The same of the planar machine with a slide along y, as far as all struts reach along x.

    The rates come from the joints' rows, the placements from the closed form: the motion solver
    takes minutes where the tool has fewer than six freedoms.
    """

    def gradient(points: Array) -> Array:
        place = np.concatenate([points, np.zeros((len(points), 1))], axis=-1)
        upright = np.broadcast_to(np.eye(3), (len(points), 3, 3))
        placement = machine.place(Poses(place, upright))
        good = placement.reachable
        found = np.full((len(points), len(machine.linkage.driven), 2), np.nan)
        found[good] = jacobians(machine.linkage, placement[good]).inverse[..., :2]
        return found

    drives = tuple(f"{joint}:{direction}" for joint, direction in machine.linkage.driven)
    across, along = (np.linspace(-half, half, n) for half, n in BRIDGE_GRID)
    return reversals(FormulaField(drives, gradient), across, along)


@dataclass(frozen=True)
class FlatRow:
    """What a machine's drives do over a flat surface.

    Parameters
    ----------
    machine, printed, found, where : str
        In words; `printed` is the thesis's count.
    places : tuple of float
        Distances of points from the machine's axis, or x of lines, mm.
    """

    machine: str
    printed: str
    found: str
    where: str
    places: tuple[float, ...] = ()


@cache
def flat_rows() -> tuple[FlatRow, ...]:
    """Serial machines, hexapod, and the planar machine with its fourth axis, all from joints."""
    return (*(_serial_row(axes) for axes in HEADS), _planar_row(), _hexapod_row())


def _serial_row(axes: Axes) -> FlatRow:
    found = flat_reversals(SerialFiveAxis(axes=axes)).singular
    count = sum(len(d.points) + len(d.lines) for d in found)
    return FlatRow(f"serial, {HEADS[axes]}", "none", "none" if count == 0 else str(count), "–")


def _planar_row() -> FlatRow:
    """Lines of the drives that stand still on them while all struts reach; and where others are."""
    machine = MovingBridge()
    found = bridge_reversals(machine)
    inside = [float(line[:, 0].mean()) for d in found.singular for line in d.lines]
    # a block stands still along x where its strut stands upright
    upright = machine.rails - machine.seats[:, 0]
    places = ", ".join(f"{1e3 * x:.1f}" for x in upright).replace("-", "−")
    reached = ", ".join(f"{1e3 * x:.1f}" for x in inside).replace("-", "−")
    return FlatRow(
        "MIT-SS-1, with a slide along y",
        "none",
        "no point; a line for each block, where its strut stands upright",
        f"x = {places} mm; all struts reach only that at {reached} mm, which is outside the "
        "nominal workspace",
        tuple(1e3 * float(x) for x in upright),
    )


def _hexapod_row() -> FlatRow:
    found = flat_reversals(HexelHexapod(), HEXAPOD_HALF, HEXAPOD_POINTS).singular
    points = [p for d in found for p in d.points]
    strong = sum(p.kind == "strong" for p in points)
    away = tuple(1e3 * float(np.linalg.norm(p.place)) for p in points)
    return FlatRow(
        "Hexel hexapod",
        "6, none in the usual workspace",
        f"{len(points)}, " + ("all" if strong == len(points) else f"{strong} of them") + " strong",
        f"{min(away):.2f} mm from the middle" + ("" if np.ptp(away) < 0.01 else " and more"),
        away,
    )
