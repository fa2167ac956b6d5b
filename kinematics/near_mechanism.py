"""Motions that are locked only by the last digits of coordinates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.joint import State
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.mobility import RANK_TOLERANCE, FreeMotion, free_motions
from strutwork.kinematics.placement import Placement
from strutwork.kinematics.rigid_graph import decompose
from strutwork.kinematics.rigid_spaces import rigid_graph
from strutwork.kinematics.rows import characteristic_length, constraint_rows

Array = NDArray[Any]

#: Resistance below which a motion is nearly free: coordinates of three digits agree to half a
#: thousandth, and a loop that they alone lock resists by no more.
NEAR = 1e-3

#: Such a motion stands apart: it resists less than this share of the next one in its block.
APART = 0.05


@dataclass(frozen=True)
class NearMechanism:
    """A motion that is nearly free.

    Parameters
    ----------
    motion : FreeMotion
        As if it were free.
    share : float
        Singular value of the rows in that motion, as a share of the largest: by how much, per
        unit of motion, the joints of the loop disagree.
    description : str
        The same in words.
    """

    motion: FreeMotion
    share: float
    description: str


def near_motions(linkage: Linkage, placement: Placement) -> tuple[NearMechanism, ...]:
    """Motions that would be free if coordinates agreed exactly, at a single pose.

    Elastic directions count as locked, and drives as held. The singular values of each block of
    the linkage's graph are looked at by themselves, so that no unrelated part changes them.

    Parameters
    ----------
    linkage : Linkage
    placement : Placement

    Returns
    -------
    motions : tuple of NearMechanism
        The least resisted first.
    """
    length = characteristic_length(placement)
    rows = constraint_rows(linkage, placement)
    blocks = decompose(rigid_graph(rows, length))
    found = []
    moves = linkage.states() == State.FREE
    for block, below in zip(blocks.blocks, blocks.below, strict=True):
        # a block with fewer rows than unknowns has motions that are free, not nearly so
        values = block.values / block.values.max(initial=1e-300)
        for k in _near(values):
            twists = blocks.motion(block, below, block.right[k])
            twists[:, 3:] *= length
            null = twists.reshape(-1, 1) / np.abs(twists).max()
            # what the motion moves only by its own disagreement is left out of its name
            null[np.abs(null) < NEAR] = 0.0
            motion = free_motions(linkage, placement, null, length, moves)[0]
            found.append(_named(motion, float(values[k])))
    return tuple(sorted(found, key=lambda near: near.share))


def _near(values: Array) -> NDArray[np.intp]:
    """Indices of values between rounding and `NEAR` that a gap parts from the rest."""
    low = np.flatnonzero((values > RANK_TOLERANCE) & (values < NEAR))
    if not len(low) or (low[0] > 0 and values[low[0]] > APART * values[low[0] - 1]):
        return low[:0]
    return low


def _named(motion: FreeMotion, share: float) -> NearMechanism:
    text = (
        f"nearly free: {motion.description}. Only a disagreement of {share:.1g} between the "
        "joints of the loop locks it, as when coordinates have few digits; the smaller it is, "
        "the larger are the forces there."
    )
    return NearMechanism(motion, share, text)
