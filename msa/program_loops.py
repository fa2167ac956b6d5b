"""The part of an elimination program that says how dependent coordinates follow from others."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics import State
from strutwork.msa.elimination import ints
from strutwork.msa.loops import Loop
from strutwork.msa.program import LoopProgram, SpreadProgram
from strutwork.msa.topology import Topology

Array = NDArray[Any]


class Following(dict[int, list[tuple[int, int]]]):
    """For every dependent coordinate the independent ones, each with its loop entry."""

    def reached(self, coordinates: Iterable[int]) -> list[int]:
        """Independent coordinates that move what the coordinates move, sorted.

        Parameters
        ----------
        coordinates : iterable of int
            Dependent or independent.
        """
        found: set[int] = set()
        for c in coordinates:
            found |= {i for i, _ in self[c]} if c in self else {c}
        return sorted(found)


def following(loops: tuple[Loop, ...]) -> Following:
    """What the dependent coordinates of the loops follow from.

    Parameters
    ----------
    loops : tuple of Loop
    """
    result, start = Following(), 0
    for loop in loops:
        for dependent in loop.dependent:
            result[dependent] = [(c, start + i) for i, c in enumerate(loop.independent)]
            start += len(loop.independent)
    return result


def loop_program(
    topology: Topology,
    loops: tuple[Loop, ...],
    touching: dict[int, dict[int, tuple[int, int]]],
    scale: Array,
    length: float,
) -> LoopProgram:
    """Rows, columns and entries of the loops, in the order of the loops.

    Parameters
    ----------
    topology : Topology
    loops : tuple of Loop
        With coordinates at their places in the elimination.
    touching : dict of int to dict of int to (int, int)
        For every closing joint the coordinates that move its sides: 1 where one moves the first,
        the second.
    scale : (c,)
        Coordinate per scaled coordinate: 1 of a translation, 1/length of a rotation, 1/m.
    length : float
        m, makes rotations comparable with translations.
    """
    linkage = topology.structure.linkage
    states, index = linkage.states(), linkage.node_index
    joints = [j for loop in loops for j in loop.joints]
    directions = {j: np.flatnonzero(states[j] == State.LOCKED) for j in joints}
    columns = [{c: k for k, c in enumerate((*p.dependent, *p.independent))} for p in loops]
    rows = [sum(len(directions[j]) for j in loop.joints) for loop in loops]
    touches = [
        (c, columns[b][c], ends)
        for b, loop in enumerate(loops)
        for j in loop.joints
        for c, ends in touching[j].items()
    ]
    return LoopProgram(
        nodes=ints([[index[n] for n in linkage.joints[j].between] for j in joints]).reshape(-1, 2),
        joint=ints(joints),
        row_start=_starts(len(directions[j]) for j in joints),
        row_direction=ints([d for j in joints for d in directions[j]]),
        row_scale=np.array([length if d >= 3 else 1.0 for j in joints for d in directions[j]]),
        touch_start=_starts(len(touching[j]) for j in joints),
        touch_coordinate=ints([c for c, _, _ in touches]),
        touch_column=ints([column for _, column, _ in touches]),
        touch_ends=ints([ends for _, _, ends in touches]).reshape(-1, 2),
        loop_joint=_starts(len(loop.joints) for loop in loops),
        dependent_start=_starts(len(loop.dependent) for loop in loops),
        dependent=ints([c for loop in loops for c in loop.dependent]),
        independent_start=_starts(len(loop.independent) for loop in loops),
        independent=ints([c for loop in loops for c in loop.independent]),
        store_start=_starts(r * len(c) for r, c in zip(rows, columns, strict=True)),
        entry_start=_starts(len(p.dependent) * len(p.independent) for p in loops),
        scale=np.asarray(scale, dtype=float),
        most_rows=max(rows, default=0),
        most_columns=max((len(c) for c in columns), default=0),
    )


def spread_program(
    follows: Following,
    touches: list[dict[int, tuple[int, int]]],
    reached: list[list[int]],
    slot: dict[tuple[int, int], int],
    elastic: dict[int, float],
    moves: list[int],
) -> SpreadProgram:
    """Where the strains, stiffnesses and loads of dependent coordinates go.

    Parameters
    ----------
    follows : Following
    touches : list of dict of int to (int, int)
        Of every beam element and link, the coordinates that move its ends.
    reached : list of list of int
        Independent coordinates behind each of the touches, sorted.
    slot : dict of (int, int) to int
        Slot of K by row and column.
    elastic : dict of int to float
        Stiffness of elastic coordinates, N/m or N·m/rad.
    moves : list of int
        Coordinates that move the tool's cluster or the workpiece's.
    """
    own, spread = [], []
    for touch, group in zip(touches, reached, strict=True):
        place = {c: k for k, c in enumerate(group)}
        own += [-1 if c in follows else place[c] for c in touch]
        spread += [[(place[i], e) for i, e in follows.get(c, [])] for c in touch]
    outer = [
        (slot[i, j], first, second, c, value)
        for c, value in elastic.items()
        for i, first in follows.get(c, [])
        for j, second in follows.get(c, [])
        if i >= j
    ]
    tool = [(c, i, e) for c in moves for i, e in follows.get(c, [])]
    return SpreadProgram(
        plain=ints([not any(c in follows for c in touch) for touch in touches]),
        width=ints([len(group) for group in reached]),
        own=ints(own),
        start=_starts(len(s) for s in spread),
        target=ints([place for s in spread for place, _ in s]),
        entry=ints([e for s in spread for _, e in s]),
        outer_slot=ints([one[0] for one in outer]),
        outer_first=ints([one[1] for one in outer]),
        outer_second=ints([one[2] for one in outer]),
        outer_coordinate=ints([one[3] for one in outer]),
        outer_value=np.array([one[4] for one in outer], dtype=float),
        tool_from=ints([c for c, _, _ in tool]),
        tool_to=ints([i for _, i, _ in tool]),
        tool_entry=ints([e for _, _, e in tool]),
    )


def _starts(counts: Iterable[int]) -> NDArray[np.int64]:
    return ints(np.cumsum([0, *counts]))
