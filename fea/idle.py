"""Idle motions: rigid-body modes that strain nothing and leave the tool where it is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.msa.assembly import system_of
from strutwork.msa.constraints import free_unknowns
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]

#: Motions below this share of the largest are none.
STILL = 1e-9

#: Parts that a line names before it only counts them.
NAMED = 8


@dataclass(frozen=True)
class IdleMotion:
    """A free motion that no tool force drives.

    Parameters
    ----------
    parts : tuple of str
        The beams that move, and bodies that hold none.
    spins : bool
        No node is displaced: the parts turn about the line of their nodes.
    """

    parts: tuple[str, ...]
    spins: bool

    def __str__(self) -> str:
        return " and ".join(self.parts) + (" about its own axis" if self.spins else "")


def free_motions(placed: PlacedStructure) -> int:
    """Number of rigid-body modes of one pose.

    Parameters
    ----------
    placed : PlacedStructure
        At one pose.
    """
    return int(free_unknowns(system_of(placed)).shape[-1])


def idle_motions(placed: PlacedStructure) -> tuple[IdleMotion, ...]:
    """Idle motions of one pose: a rod that spins between two balls, an unused slide.

    Without a tool, those that displace no node at all.

    Parameters
    ----------
    placed : PlacedStructure
        At one pose.

    Raises
    ------
    ModelError
        Several poses.
    """
    system = system_of(placed)
    if system.poses != 1:
        raise ModelError("idle motions", f"of {system.poses} poses.", "Give one pose.")
    free = free_unknowns(system)
    if not free.shape[-1]:
        return ()
    structure = placed.structure
    linkage = structure.linkage
    reach = float(np.linalg.norm(np.ptp(placed.positions.reshape(-1, 3), axis=0))) or 1.0
    # displacement at each node of the linkage, rotations as displacements at the structure's size
    moved = system.expand(free)[0][: len(linkage.nodes)] * np.repeat([1.0, reach], 3)[:, None]
    moved = moved / np.abs(moved).max(axis=(0, 1))
    tool = linkage.tool
    ends = [node for node in (tool, linkage.against) if node is not None]
    seen = moved[:, :3] if tool is None else moved[[structure.mesh_index[node] for node in ends]]
    _, values, right = np.linalg.svd(seen.reshape(-1, moved.shape[-1]))
    rank = int(np.count_nonzero(values > STILL))
    # what floats as a whole is no idle part of something else
    floats = not np.any(linkage.body_of_node < 0)
    rows = _apart(right[rank:] @ moved.reshape(-1, moved.shape[-1]).T)
    motions = [row.reshape(-1, 6) for row in rows]
    return tuple(
        _named(placed, m) for m in motions if not (floats and np.all(np.any(m != 0, axis=1)))
    )


def idle_line(motions: tuple[IdleMotion, ...]) -> str:
    """One line that names idle motions; empty without any.

    Parameters
    ----------
    motions : tuple of IdleMotion
    """
    if not motions:
        return ""
    spins = [" and ".join(motion.parts) for motion in motions if motion.spins]
    others = [" and ".join(motion.parts) for motion in motions if not motion.spins]
    what = [
        f"{_some(names)} {verb if len(names) == 1 else verbs}"
        for names, verb, verbs in (
            (spins, "about its own axis", "each about its own axis"),
            (others, "as a whole", "each as a whole"),
        )
        if names
    ]
    several = len(motions) > 1
    return (
        f"{len(motions)} idle motion{'s' if several else ''}, which strain{'' if several else 's'} "
        f"nothing and leave{'' if several else 's'} the tool where it is: {'; '.join(what)}."
    )


def _some(names: list[str]) -> str:
    names = sorted(names)
    more = f" and {len(names) - NAMED} more" if len(names) > NAMED else ""
    return ", ".join(names[:NAMED]) + more + ","


def _apart(rows: Array) -> Array:
    """The same space by rows in reduced echelon form: motions of separate parts come apart."""
    rows = rows.copy()
    for k in range(len(rows)):
        row, column = divmod(int(np.abs(rows[k:]).argmax()), rows.shape[1])
        rows[[k, k + row]] = rows[[k + row, k]]
        rows[k] /= rows[k, column]
        others = np.arange(len(rows)) != k
        rows[others] -= np.outer(rows[others, column], rows[k])
        rows[np.abs(rows) < STILL] = 0.0
    return rows


def _named(placed: PlacedStructure, motion: Array) -> IdleMotion:
    structure = placed.structure
    linkage = structure.linkage
    moves = np.any(np.abs(motion) > STILL, axis=1)
    bodies = sorted({int(b) for b in linkage.body_of_node[moves] if b >= 0})
    parts: list[str] = []
    for body in bodies:
        beams = [
            beam.name
            for beam in structure.beams
            if linkage.body_of_node[linkage.node_index[beam.nodes[0]]] == body
        ]
        parts += beams or [linkage.body_names[body]]
    return IdleMotion(tuple(parts), not np.any(np.abs(motion[:, :3]) > STILL))
