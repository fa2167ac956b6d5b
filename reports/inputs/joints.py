"""Joints, springs and drives of a model."""

from __future__ import annotations

from math import degrees

import numpy as np

from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.joint import Joint, State
from strutwork.machines.model import Model
from strutwork.reports.axis_words import axis_words
from strutwork.reports.content import Column
from strutwork.reports.inputs.echo import NONE, Echo, number

_ALL = "all"


def joints(model: Model) -> Echo:
    """Type, axis and every direction of each joint; supports come after the joints."""
    linkage = model.structure.linkage
    held = {joint: node for node, joint in model.supports.items()}
    frames = np.asarray(model.placement.frames)
    columns = (
        Column("joint", "", False),
        Column("type", "", False),
        Column("its z axis", "", False),
        Column("free", "", False),
        Column("driven", "", False),
        Column("stiffness", "N/µm and N·m/rad", False),
        Column("damping", "N·s/m and N·m·s/rad", False),
        Column("limits", "mm and deg", False),
    )
    shown, exact = {}, {}
    for joint, frame in zip(linkage.joints, frames, strict=True):
        name = f"support of {held[joint.name]}" if joint.name in held else joint.name
        shown[name] = [
            "support" if joint.name in held else _type(joint),
            axis_words(frame[:, 2]),
            _free(joint),
            ", ".join(joint.driven) or NONE,
            _stiffness(joint),
            by_direction(joint.damping, 1.0, 1.0),
            _limits(model, joint),
        ]
        matrix = joint.stiffness_matrix
        exact[name] = [
            joint.type,
            *joint.between,
            *frame[:, 2].tolist(),
            *frame[:, 0].tolist(),
            " ".join(joint.driven),
            *(s.name.lower() for s in joint.states),
            *(float(matrix[i, i]) or None for i in range(6)),
            *(joint.damping.get(d) for d in DIRECTIONS),
        ]
    heads = (
        "joint",
        "type",
        "first_node",
        "second_node",
        *(f"axis_{a}" for a in "xyz"),
        *(f"second_axis_{a}" for a in "xyz"),
        "driven",
        *(f"state_{d}" for d in DIRECTIONS),
        *(f"stiffness_{d}_{'N_m_per_rad' if d[0] == 'r' else 'N_per_m'}" for d in DIRECTIONS),
        *(f"damping_{d}_{'N_m_s_per_rad' if d[0] == 'r' else 'N_s_per_m'}" for d in DIRECTIONS),
    )
    caption = (
        "Joints at home, directions in the joint's own axes; directions that are not free are held"
    )
    return Echo("joints", caption, columns, shown, heads, exact, loose=(1, 6))


def springs(model: Model) -> Echo:
    """Springs to ground or between two nodes."""
    found = model.structure.springs
    columns = (
        Column("spring", "", False),
        Column("between", "", False),
        Column("stiffness", "N/µm and N·m/rad", False),
    )
    shown = {
        s.name: [
            " and ".join(s.nodes) if len(s.nodes) == 2 else f"{s.nodes[0]} and the ground",
            by_direction(s.stiffness, 1e-6, 1.0),
        ]
        for s in found
    }
    exact = {s.name: ["; ".join(s.nodes), *(s.stiffness.get(d) for d in DIRECTIONS)] for s in found}
    heads = (
        "spring",
        "nodes",
        *(f"stiffness_{d}_{'N_m_per_rad' if d[0] == 'r' else 'N_per_m'}" for d in DIRECTIONS),
    )
    return Echo("springs", "Springs", columns, shown, heads, exact, loose=(0,))


def drives(model: Model) -> Echo:
    """What the drives can do, where the model says it."""
    columns = (
        Column("drive", "", False),
        Column("moves", "", False),
        Column("largest speed", "", False),
        Column("largest force or torque", "", False),
        Column("resolution", "", False),
    )
    shown, exact = {}, {}
    for drive in model.drives:
        turns = drive.direction.startswith("r")
        shown[drive.joint] = [
            f"turns about {drive.direction[1]}" if turns else f"moves along {drive.direction}",
            _unit(drive.speed, degrees(1.0) if turns else 1e3, "deg/s" if turns else "mm/s"),
            _unit(drive.force, 1.0, "N·m" if turns else "N"),
            _unit(drive.resolution, 1e6, "µrad" if turns else "µm"),
        ]
        exact[drive.joint] = [drive.direction, drive.speed, drive.force, drive.resolution]
    heads = ("drive", "direction", "speed_SI", "force_SI", "resolution_SI")
    return Echo("drives", "Limits of the drives", columns, shown, heads, exact)


def by_direction(values: object, slide: float, turn: float) -> str:
    """Values by direction in words, equal ones together: `x, y 250; z 80`."""
    together: dict[str, list[str]] = {}
    for direction, value in dict(values).items():  # type: ignore[call-overload]
        text = number(float(value), turn if direction.startswith("r") else slide)
        together.setdefault(text, []).append(direction)
    return "; ".join(f"{', '.join(ds)} {text}" for text, ds in together.items()) or NONE


def _type(joint: Joint) -> str:
    if joint.pitch is None:
        return joint.type
    return f"{joint.type}, {number(joint.pitch, 1e3)} mm per turn"


def _free(joint: Joint) -> str:
    free = [d for d, s in zip(DIRECTIONS, joint.states, strict=True) if s == State.FREE]
    return _ALL if len(free) == 6 else ", ".join(free) or "none"


def _stiffness(joint: Joint) -> str:
    if joint.matrix is not None:
        diagonal = np.diag(joint.stiffness_matrix)
        some = {d: k for d, k in zip(DIRECTIONS, diagonal, strict=True) if k}
        return f"{by_direction(some, 1e-6, 1.0)}, of a full matrix"
    return by_direction(joint.stiffness, 1e-6, 1.0)


def _limits(model: Model, joint: Joint) -> str:
    found = [m for m in model.limits if m.joint == joint.name]
    words = []
    for limit in found:
        factor = 1e3 if limit.coordinate in {"x", "y", "z"} else degrees(1.0)
        low, high = number(limit.low, factor), number(limit.high, factor)
        words.append(f"{limit.coordinate} {low} to {high}")
    return "; ".join(words) or NONE


def _unit(value: float | None, factor: float, unit: str) -> str:
    return NONE if value is None else f"{number(value, factor)} {unit}"
