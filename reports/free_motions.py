"""Free motions in few words: what the tool does in them, and which joints move."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from strutwork.kinematics import FreeMotion
from strutwork.machines.extent import model_size
from strutwork.machines.model import Model
from strutwork.names import listed
from strutwork.reports.alike import grouped
from strutwork.reports.freedom_words import tool_freedoms
from strutwork.reports.numbers import count


def tool_words(model: Model, motions: Sequence[FreeMotion]) -> str:
    """What the tool can do in any combination of some motions, in one sentence; empty of none."""
    if not motions:
        return ""
    if model.tool is None:
        return f"{count(len(motions), 'independent motion')}."
    row = model.structure.linkage.node_index[model.tool]
    names = tool_freedoms(np.array([m.nodes[row] for m in motions]), model_size(model))
    words = f"The tool moves in {listed(names)}" if names else "The tool stays where it is"
    left = len(motions) - len(names)
    if left:
        verb = "moves" if left == 1 else "move"
        words += f"; {count(left, 'further motion')} {verb} parts but not the tool"
    return f"{words}."


def joint_words(motion: FreeMotion) -> str:
    """The joints that move, alike ones together."""
    directions: dict[str, list[str]] = {}
    for joint, direction in motion.joints:
        directions.setdefault(joint, []).append(direction)
    found = grouped({joint: [", ".join(some)] for joint, some in directions.items()})
    return "; ".join(f"{g.label} in {g.cells[0]}" for g in found)
