"""Free motions in few words: what the tool does in them, and which joints move."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from strutwork.kinematics import DIRECTIONS, FreeMotion
from strutwork.machines.model import Model
from strutwork.names import listed
from strutwork.reports.alike import grouped
from strutwork.reports.numbers import count

#: Singular values below this share of the largest are no motion of the tool.
STILL = 1e-7


def tool_words(model: Model, motions: Sequence[FreeMotion]) -> str:
    """What the tool can do in any combination of some motions, in one sentence; empty of none."""
    if not motions:
        return ""
    if model.tool is None:
        return f"{count(len(motions), 'independent motion')}."
    row = model.structure.linkage.node_index[model.tool]
    moves = np.array([motion.nodes[row] for motion in motions])
    _, sizes, ways = np.linalg.svd(moves)
    rank = int(np.count_nonzero(sizes > STILL * max(1.0, float(sizes.max(initial=0.0)))))
    span = ways[:rank]
    alone = [d for d, e in zip(DIRECTIONS, np.eye(6), strict=True) if _within(span, e)]
    mixed = rank - len(alone)
    left = len(motions) - rank
    said = []
    if alone:
        said.append(f"moves in {listed(alone)}")
    if mixed:
        others = [d for d in DIRECTIONS if d not in alone and _takes_part(span, d)]
        said.append(f"moves in {count(mixed, 'way')} that combine {listed(others)}")
    words = f"The tool {' and '.join(said)}" if said else "The tool stays where it is"
    if left:
        verb = "moves" if left == 1 else "move"
        words += f"; {count(left, 'further motion')} {verb} parts and not the tool"
    return f"{words}."


def joint_words(motion: FreeMotion) -> str:
    """The joints that move, alike ones together."""
    directions: dict[str, list[str]] = {}
    for joint, direction in motion.joints:
        directions.setdefault(joint, []).append(direction)
    found = grouped({joint: [", ".join(some)] for joint, some in directions.items()})
    return "; ".join(f"{g.label} in {g.cells[0]}" for g in found)


def _within(span: np.ndarray, direction: np.ndarray) -> bool:
    return bool(np.linalg.norm(span @ direction) > 1.0 - 1e-9)


def _takes_part(span: np.ndarray, direction: str) -> bool:
    return bool(np.abs(span[:, DIRECTIONS.index(direction)]).max(initial=0.0) > STILL)
