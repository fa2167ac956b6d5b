"""The MIT-SS-1 in 3-D."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import Placement
from strutwork.machines import MitSS1
from strutwork.machines import mit_ss1_parts as parts
from strutwork.reports.figures.shapes import Shape, ball, box, cylinder, mesh, plate
from strutwork.reports.figures.solid import DrawnJoint, joint_traces, scene, straight, triad

Array = NDArray[Any]

#: Sizes that matter for the drawing alone, m.
BEARING_RADIUS, PIN_RADIUS, BEARING_WIDTH = 0.0175, 0.0075, 0.012
RAIL_REACH, RAIL_SIDE, BLOCK = 0.12, 0.03, (0.07, 0.03, 0.09)
HOUSING_THICKNESS, SYMBOL = 0.06, 0.02

#: From outside, towards the granite.
CAMERA = {
    "eye": {"x": 0.9, "y": 2.1, "z": 0.8},
    "center": {"x": 0, "y": 0, "z": -0.12},
}


def planar_machine_view(machine: MitSS1, placement: Placement) -> dict[str, Any]:
    """Rails, blocks, struts, bearings, spindle housing and tool at one pose.

    Parameters
    ----------
    machine : MitSS1
    placement : Placement
        Single pose.

    Returns
    -------
    dict
        A plotly figure; lengths in mm.
    """
    figure = scene(planar_machine_traces(machine, placement))
    figure["layout"]["scene"]["camera"] = CAMERA
    return figure


def planar_machine_traces(
    machine: MitSS1, placement: Placement, rails: tuple[float, float, float] | None = None
) -> list[dict[str, Any]]:
    """What `planar_machine_view` shows, as traces.

    Parameters
    ----------
    machine : MitSS1
    placement : Placement
        Single pose.
    rails : (y, low, high), optional
        Where the rails stand, m; default behind the blocks, as far as these are drawn to travel.
    """
    at = dict(zip(machine.linkage.nodes, placement.positions, strict=True))
    tool = at[parts.TOOL]
    corners = np.array([at[parts.strut(i, "housing", "end")] for i in parts.STRUTS])
    axis = corners[2] - (corners[0] + corners[1]) / 2
    axis = axis / np.linalg.norm(axis)
    rotation = np.stack([np.cross([0.0, 1.0, 0.0], axis), [0.0, 1.0, 0.0], axis], axis=-1)
    spindle = cylinder(tool + 0.03 * axis, corners[2] + 0.02 * axis, 0.03, "spindle housing")
    return [
        mesh(_rails(at, rails or _travel(machine, at)), "guide", "#7b8794"),
        mesh(_struts(machine, placement, at), "strut, flexible", "#8fa1b3", opacity=0.75),
        mesh(
            [plate(corners, HOUSING_THICKNESS, "spindle housing, rigid"), spindle],
            "spindle housing",
            "#c9b458",
        ),
        mesh(_pins(at), "pin in its two bearings", "#0072b2"),
        *joint_traces(_blocks(machine, placement, at), SYMBOL),
        mesh([cylinder(tool, tool + 0.03 * axis, 0.004, "tool")], "tool", "#3d4854"),
        mesh([ball(tool, 0.007, "tool centre point")], "tool centre point", "#a02c2c"),
        *triad(tool, rotation, 0.07),
    ]


def _travel(machine: MitSS1, at: dict[str, Array]) -> tuple[float, float, float]:
    """The guides' place on the granite's side, as far as the blocks are drawn to travel."""
    heights = [at[parts.rail(i)][2] for i in parts.STRUTS]
    y = machine.bearing_planes[0] - 2.2 * RAIL_SIDE
    return y, min(heights) - RAIL_REACH, max(heights) + RAIL_REACH


def _rails(at: dict[str, Array], where: tuple[float, float, float]) -> list[Shape]:
    y, low, high = where
    return [
        box(
            np.array([at[parts.rail(i)][0], y, (low + high) / 2]),
            np.eye(3),
            (RAIL_SIDE, RAIL_SIDE, high - low),
            f"rail {i}, on the granite",
        )
        for i in parts.STRUTS
    ]


def _struts(machine: MitSS1, placement: Placement, at: dict[str, Array]) -> list[Shape]:
    index = machine.linkage.joint_index
    found = []
    for i, length in zip(parts.STRUTS, machine.strut_lengths, strict=True):
        ends = [at[parts.strut(i, end, "end")] for end in parts.ENDS]
        frame = placement.frames[index[parts.strut(i, "block", "near")]]
        sizes = (length, *machine.section.outline[:2])
        label = f"strut {i}: {machine.section.name} mm, {1e3 * length:.4g} mm"
        found.append(box((ends[0] + ends[1]) / 2, frame, sizes, label))
    return found


def _pins(at: dict[str, Array]) -> list[Shape]:
    half = np.array([0.0, BEARING_WIDTH / 2, 0.0])
    found = []
    for i in parts.STRUTS:
        for end in parts.ENDS:
            near, far = (at[parts.strut(i, end, side)] for side in parts.SIDES)
            found.append(cylinder(near - half, far + half, PIN_RADIUS, f"strut {i}: {end} pin"))
            for side, point in zip(parts.SIDES, (near, far), strict=True):
                label = f"strut {i}: {side} bearing of the {end} pin"
                found.append(cylinder(point - half, point + half, BEARING_RADIUS, label))
    return found


def _blocks(machine: MitSS1, placement: Placement, at: dict[str, Array]) -> list[DrawnJoint]:
    """The driven blocks, drawn behind the near bearings."""
    index = machine.linkage.joint_index
    found = []
    for i in parts.STRUTS:
        frame = placement.frames[index[parts.guide(i)]]
        point = at[parts.strut(i, "block", "near")] - np.array([0.0, BLOCK[1], 0.0])
        arrow = straight(point, frame[:, 2], SYMBOL)
        found.append(DrawnJoint(parts.guide(i), "prismatic", point, frame, (arrow,)))
    return found
