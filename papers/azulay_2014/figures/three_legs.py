"""A machine of the literature in 3-D."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import Placement
from strutwork.machines import ThreeLegs
from strutwork.machines.legs import seat
from strutwork.reports.figures.shapes import Shape, ball, cylinder, mesh, plate
from strutwork.reports.figures.solid import (
    DrawnJoint,
    joint_traces,
    path,
    scene,
    segments,
    straight,
    triad,
    turning,
)

Array = NDArray[Any]

SYMBOL = 0.015


def machine_view(machine: ThreeLegs, placement: Placement) -> dict[str, Any]:
    """Links, platform, joints by type, drives and tool at one pose.

    Parameters
    ----------
    machine : ThreeLegs
    placement : Placement
        Single pose.

    Returns
    -------
    dict
        A plotly figure; lengths in mm.
    """
    at = dict(zip(machine.linkage.nodes, placement.positions, strict=True))
    tool = at[machine.linkage.tool or ""]
    rotation = _platform_axes(at)
    turn = np.linspace(0.0, 2 * np.pi, 181)
    guide = machine.base_radius * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=-1)
    corners = np.array([at[seat(i)] for i in (1, 2, 3)])
    beams = {frozenset(b.nodes) for b in machine.structure.beams}
    rigid = [
        (at[a], at[b])
        for a, b in machine.skeleton()
        if frozenset((a, b)) not in beams and not np.allclose(at[a], at[b])
    ]
    traces = [
        path(guide, "circular guide", "#7b8794", 6),
        mesh(_tubes(machine, at), "flexible link", "#8fa1b3"),
        segments(rigid, "rigid link", "#3d4854", 5),
        mesh([plate(corners, 0.004, "platform, rigid")], "platform", "#c9b458"),
        *joint_traces(drawn_joints(machine, placement), SYMBOL),
        mesh([ball(tool, 0.006, "tool centre point")], "tool centre point", "#a02c2c"),
        *triad(tool, rotation, 0.045),
    ]
    return scene(traces)


def drawn_joints(machine: ThreeLegs, placement: Placement) -> list[DrawnJoint]:
    """The joints where a drawing shows them.

    A carriage's joint turns about the middle of the guide; it is drawn where the carriage is.
    """
    at = dict(zip(machine.linkage.nodes, placement.positions, strict=True))
    drawn = []
    for joint, frame in zip(machine.linkage.joints, placement.frames, strict=True):
        point = at[joint.between[1]]
        _leg, _, kind = joint.name.partition("/")
        if kind == "guide":
            point = machine.base_radius * frame[:, 0]
            start = np.arctan2(point[1], point[0])
            turn = start + np.linspace(-0.3, 0.3, 25)
            arc = (machine.base_radius + 1.6 * SYMBOL) * np.stack(
                [np.cos(turn), np.sin(turn), 0 * turn], axis=-1
            )
            along = np.stack([frame[:, 0], frame[:, 2], frame[:, 1]], axis=-1)
            drawn.append(DrawnJoint(joint.name, "circular", point, along, (arc,)))
            continue
        axis = frame[:, 2]
        paths = {
            "z": lambda p=point, a=axis: straight(p, a, SYMBOL),
            "rz": lambda p=point, a=axis: turning(p, a, SYMBOL),
        }
        driven = tuple(paths[d]() for d in joint.driven)
        drawn.append(DrawnJoint(joint.name, joint.type, point, frame, driven))
    return drawn


def _tubes(machine: ThreeLegs, at: dict[str, Array]) -> list[Shape]:
    """The beams at their true outer diameter."""
    tubes = []
    for beam in machine.structure.beams:
        start, end = (at[n] for n in beam.nodes)
        label = f"{beam.name}: {beam.section.name} mm, {1e3 * np.linalg.norm(end - start):.1f} mm"
        radius = max(beam.section.outline, default=SYMBOL) / 2
        tubes.append(cylinder(start, end, radius, label))
    return tubes


def _platform_axes(at: dict[str, Array]) -> Array:
    """Tool axes as columns, from the joint centres on the platform."""
    first, second, third = (at[seat(i)] for i in (1, 2, 3))
    x = first - (first + second + third) / 3
    x /= np.linalg.norm(x)
    z = np.cross(second - first, third - first)
    z /= np.linalg.norm(z)
    return np.stack([x, np.cross(z, x), z], axis=-1)
