"""Closed loops: which joint coordinates follow from which others.

The rows that close loops are solved for as many coordinates as they have rank, preferably such as
do not move the tool: then every leg closes on its own. The choice is made once per structure, on
some of its poses; at each pose the kernel solves the rows anew and says whether the choice is good
there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.msa.assembly import System, system_of
from strutwork.msa.null_space import closing_rows, joint_coordinates

Array = NDArray[Any]

#: Poses on which the choice is made.
SAMPLES = 16

#: Largest product of unknowns and rows for which it is made; larger structures are solved sparse.
LARGEST_ROWS = 400_000

#: What a column must keep beside those chosen, in scaled rows: at first, and at the end.
CLEAR, LEAST = 1e-3, 1e-7


@dataclass(frozen=True)
class Loop:
    """Closing joints that share dependent coordinates.

    Parameters
    ----------
    joints : tuple of int
    dependent, independent : tuple of int
        Coordinates that the rows determine, and those that determine them.
    """

    joints: tuple[int, ...]
    dependent: tuple[int, ...]
    independent: tuple[int, ...]


def closed_loops(
    touching: dict[int, list[int]],
    sample: System,
    length: float,
    scale: Array,
    at_tool: list[int],
) -> tuple[Loop, ...]:
    """Choose the dependent coordinates.

    Parameters
    ----------
    touching : dict of int to list of int
        Coordinates that the rows of each closing joint contain.
    sample : System
        Poses to choose on.
    length : float
        m, makes rotations comparable with translations.
    scale : (c,)
        Coordinate per scaled coordinate: 1 of a translation, 1/length of a rotation, 1/m.
    at_tool : list of int
        Coordinates that move the tool.
    """
    _, direction = sample.row_owner
    turns = direction[closing_rows(sample)] >= 3
    # rotations as displacements at the length: entries of order one, and rounding stays small
    rows = _sampled_rows(sample) * scale * np.where(turns, length, 1.0)[:, None]
    every = np.arange(rows.shape[-1])
    legs = every[~np.isin(every, at_tool)]
    chosen: set[int] = set()
    for allowed, least in ((legs, CLEAR), (every, CLEAR), (every, LEAST)):
        chosen |= _eliminate(rows, allowed, least)
    loops: list[tuple[set[int], set[int]]] = []
    for joint, coordinates in touching.items():
        joints, dependent = {joint}, chosen.intersection(coordinates)
        apart = []
        for other in loops:
            if other[1] & dependent:
                joints |= other[0]
                dependent |= other[1]
            else:
                apart.append(other)
        loops = [*apart, (joints, dependent)]
    return tuple(
        Loop(
            tuple(sorted(joints)),
            tuple(sorted(dependent)),
            tuple(sorted({c for j in joints for c in touching[j]} - dependent)),
        )
        for joints, dependent in loops
    )


def _sampled_rows(system: System) -> Array:
    """Closing rows on the coordinates at some of the poses, (s, r, c)."""
    pick = np.unique(np.linspace(0, system.poses - 1, SAMPLES).astype(int))
    part = system_of(system.placed[pick])
    basis, _ = joint_coordinates(part, np.zeros((part.poses, len(part.row_labels), 0)))
    return np.asarray(part.rows[:, closing_rows(part)] @ basis)


def _eliminate(rows: Array, allowed: NDArray[np.intp], least: float) -> set[int]:
    """Choose columns as long as the next keeps `least`; takes them out of the rows, in place."""
    found: set[int] = set()
    while allowed.size and rows.shape[1]:
        size = np.linalg.norm(rows[..., allowed], axis=1)
        # one singular pose among the samples must not decide
        best = int(np.median(size, axis=0).argmax())
        if not np.median(size[:, best]) > least:
            return found
        c = int(allowed[best])
        found.add(c)
        unit = rows[..., c] / np.maximum(size[:, best], 1e-300)[:, None]
        rows -= unit[..., None] * np.einsum("sr,src->sc", unit, rows)[:, None, :]
        rows[..., c] = 0.0
    return found
