"""The Hexel hexapod in 3-D."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import Placement
from strutwork.machines import HexelHexapod
from strutwork.machines.six_legs import LEGS, TOOL, foot, leg, seat
from strutwork.reports.figures.shapes import ball, cylinder, mesh, plate
from strutwork.reports.figures.solid import (
    DrawnJoint,
    joint_traces,
    path,
    scene,
    segments,
    straight,
    triad,
)

Array = NDArray[Any]

#: Sizes that matter for the drawing alone, m.
CYLINDER, ROD, SYMBOL, PLATE, TABLE = 0.022, 0.013, 0.03, 0.02, 0.35

CAMERA = {"eye": {"x": 1.1, "y": -1.9, "z": 0.6}, "center": {"x": 0, "y": 0, "z": -0.16}}


def hexapod_view(machine: HexelHexapod, placement: Placement) -> dict[str, Any]:
    """Fixed platform, telescopic legs, moving platform, joints by type, tool and table.

    Parameters
    ----------
    machine : HexelHexapod
    placement : Placement
        Single pose.

    Returns
    -------
    dict
        A plotly figure; lengths in mm.
    """
    at = dict(zip(machine.linkage.nodes, placement.positions, strict=True))
    tool = at[TOOL]
    feet = np.array([at[foot(i)] for i in LEGS])
    seats = np.array([at[seat(i)] for i in (1, 3, 5)])
    axis = seats.mean(axis=0) - tool
    axis = axis / np.linalg.norm(axis)
    across = seats[1] - seats[0]
    x = -(across - (across @ axis) * axis) / np.linalg.norm(across - (across @ axis) * axis)
    rotation = np.stack([x, np.cross(axis, x), axis], axis=-1)
    corners = TABLE * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) / 2
    traces = [
        path(np.concatenate([feet, feet[:1]]), "fixed platform", "#7b8794", 8),
        mesh(
            [
                cylinder(at[leg(i, "head")], at[leg(i, "slide")], CYLINDER, f"leg {i}: cylinder")
                for i in LEGS
            ],
            "cylinder",
            "#8fa1b3",
        ),
        mesh(
            [cylinder(at[leg(i, "rod")], at[leg(i, "end")], ROD, f"leg {i}: rod") for i in LEGS],
            "rod",
            "#3d4854",
        ),
        mesh([plate(seats, PLATE, "moving platform, rigid")], "moving platform", "#c9b458"),
        segments([(seats.mean(axis=0), tool)], "tool", "#3d4854", 7),
        *joint_traces(_joints(machine, placement, at), SYMBOL),
        mesh([ball(tool, 0.012, "tool centre point")], "tool centre point", "#a02c2c"),
        mesh([plate(corners, 0.01, "work table, z = 0")], "work table", "#d5dae1"),
        *triad(tool, rotation, 0.15),
    ]
    figure = scene(traces)
    figure["layout"]["scene"]["camera"] = CAMERA
    return figure


def _joints(machine: HexelHexapod, placement: Placement, at: dict[str, Array]) -> list[DrawnJoint]:
    drawn = []
    for joint, frame in zip(machine.linkage.joints, placement.frames, strict=True):
        point = at[joint.between[0]]
        arrows = (straight(point, frame[:, 2], SYMBOL),) if joint.driven else ()
        drawn.append(DrawnJoint(joint.name, joint.type, point, frame, arrows))
    return drawn
