"""What a structure can do, in sentences: freedoms of its tool, what is left, what is redundant."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS, FreeMotion
from strutwork.machines.extent import model_size
from strutwork.machines.model import Model
from strutwork.names import listed, visible
from strutwork.reports.alike import grouped
from strutwork.reports.model_check import ModelCheck
from strutwork.reports.numbers import count

Array = NDArray[Any]

#: A direction takes no part in a motion below this share of its largest; turns count at the
#: structure's size.
NO_PART = 1e-6

#: More joints than these are counted, not named.
NAMED = 6


def freedom_sentences(found: ModelCheck) -> list[str]:
    """The short answer of a check, a sentence an entry; what is wrong stands last.

    Parameters
    ----------
    found : ModelCheck

    Returns
    -------
    list of str
    """
    counts, tool = found.mobility, found.model.tool
    said = []
    if counts.driven_motions:
        said.append(f"With the drives free {freedom_words(found.model, counts.driven_motions)}.")
    if counts.mobility_locked:
        what = "motion is" if counts.mobility_locked == 1 else "motions are"
        said.append(
            f"With the drives held, {counts.mobility_locked} {what} left: add a constraint or a "
            "drive, or hold it with a spring."
        )
    elif found.drives:
        said.append("The drives hold it." if tool is None else "The drives hold the tool.")
    else:
        said.append("Its joints hold it.")
    joints = list(dict.fromkeys(joint for state in counts.self_stress for joint in state.joints))
    if counts.redundant:
        what = "constraint is" if counts.redundant == 1 else "constraints are"
        said.append(
            f"{counts.redundant} {what} redundant: manufacturing errors lock forces into "
            f"{visible(listed(joints)) if len(joints) <= NAMED else f'{len(joints)} joints'}."
        )
    else:
        said.append("No constraint is redundant: manufacturing errors lock in no forces.")
    return said


def freedom_words(model: Model, motions: Sequence[FreeMotion]) -> str:
    """What the tool can do in any combination of some motions, as the rest of a sentence.

    Parameters
    ----------
    model : Model
    motions : sequence of FreeMotion
        Independent ones, at least one.

    Returns
    -------
    str
        As in "the tool has 2 freedoms: x and y; 1 further motion leaves it where it is".
    """
    if model.tool is None:
        return f"it has {count(len(motions), 'freedom')}, and no tool is named"
    node = model.structure.linkage.node_index[model.tool]
    names = tool_freedoms(np.array([m.nodes[node] for m in motions]), model_size(model))
    words = "the tool has no freedom"
    if names:
        words = f"the tool has {count(len(names), 'freedom')}: {listed(names)}"
    rest = len(motions) - len(names)
    if rest:
        further = "further motion" if names else "motion"
        words += f"; {count(rest, further)} {'leaves' if rest == 1 else 'leave'} it where it is"
    return words


def joint_words(motion: FreeMotion) -> str:
    """The joints that move in a motion, alike ones together.

    Parameters
    ----------
    motion : FreeMotion

    Returns
    -------
    str
        As in "drive1 to drive6 (6) in z; column in rx, ry".
    """
    directions: dict[str, list[str]] = {}
    for joint, direction in motion.joints:
        directions.setdefault(joint, []).append(direction)
    found = grouped({joint: [", ".join(some)] for joint, some in directions.items()})
    return "; ".join(f"{g.label} in {g.cells[0]}" for g in found)


def tool_freedoms(twists: Array, length: float) -> list[str]:
    """The independent motions of the tool by name, those that follow in brackets.

    Parameters
    ----------
    twists : (b, 6)
        Of the tool in each of the free motions: m, rad, global axes.
    length : float
        m, at which turns are compared with displacements.

    Returns
    -------
    list of str
        As many as the tool's freedoms; "x", or "x (with ry)" where the tool turns as it moves.
    """
    rows = np.array(twists, dtype=float).reshape(-1, 6) * ([1.0] * 3 + [length] * 3)
    size = np.abs(rows).max(initial=0.0)
    if size == 0.0:
        return []
    _, values, basis = np.linalg.svd(rows / size, full_matrices=False)
    rows = basis[values > NO_PART * values[0]]
    names, used = [], np.zeros(len(rows), dtype=bool)
    for column in range(6):
        # Gauss and Jordan: a direction that a later one can make good is not named twice
        candidates = np.where(used, 0.0, np.abs(rows[:, column]))
        pivot = int(np.argmax(candidates))
        if candidates[pivot] < NO_PART:
            continue
        used[pivot] = True
        rows[pivot] /= rows[pivot, column]
        others = np.arange(len(rows)) != pivot
        rows[others] -= np.outer(rows[others, column], rows[pivot])
        names.append((column, pivot))
    return [_named(column, rows[pivot]) for column, pivot in names]


def _named(column: int, row: Array) -> str:
    follow = [d for i, d in enumerate(DIRECTIONS) if i != column and abs(row[i]) > NO_PART]
    own = DIRECTIONS[column]
    return f"{own} (with {', '.join(follow)})" if follow else own
