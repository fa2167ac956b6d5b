"""What a drawing of a machine by its nodes, lines and joints shows, as data."""

from __future__ import annotations

from typing import Any

from strutwork.kinematics import Mechanism, Placement


def drawing_data(machine: Mechanism, placement: Placement) -> dict[str, Any]:
    """Nodes, lines and joints of a machine at one pose, SI."""
    linkage = machine.linkage
    return {
        "unit": "m",
        "nodes": dict(zip(linkage.nodes, placement.positions.tolist(), strict=True)),
        "lines": [list(pair) for pair in machine.skeleton()],
        "joints": {
            j.name: {"type": j.type, "between": list(j.between), "axes_as_columns": f.tolist()}
            for j, f in zip(linkage.joints, placement.frames, strict=True)
        },
        "tool": linkage.tool,
    }
