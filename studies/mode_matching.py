"""Modes by what moves: shares of given patterns of motion in the modes of a structure."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from strutwork.errors import ModelError
from strutwork.fea.modes import Modes
from strutwork.msa.assembly import system_of
from strutwork.msa.mass import mass_matrix

Array = NDArray[Any]


def pattern_shares(found: Modes, patterns: Array) -> Array:
    """How much of each pattern each mode holds: (φᵀMψ)² / (ψᵀMψ).

    The modal assurance criterion in the metric of the mass, one for a pattern that is a mode.
    Over all modes the shares of a pattern add to one; a pattern that translates a part of the
    structure gives effective masses as shares of the part's mass.

    Parameters
    ----------
    found : Modes
        m of them at every pose.
    patterns : (q, n, 6)
        Motion of every mesh node, m and rad of any size, the same at all poses; nodes of a rigid
        body move as one.

    Returns
    -------
    (..., q, m)

    Raises
    ------
    ModelError
        A pattern in which nothing heavy moves.
    """
    system = system_of(found.placed)
    reference = found.placed.structure.reference_nodes
    mass = mass_matrix(system)
    wanted = patterns[:, reference].reshape(len(patterns), -1)
    kept = found.shapes[..., reference, :]
    shapes = kept.reshape(system.poses, kept.shape[-3], -1)
    pushed = wanted @ mass
    size = np.einsum("pqi,qi->pq", pushed, wanted)
    if not np.all(size > 0):
        still = int(np.argwhere(size <= 0)[0, 1])
        raise ModelError(f"pattern {still}", "moves no mass.", "Choose nodes that carry mass.")
    shares = (pushed @ np.swapaxes(shapes, -1, -2)) ** 2 / size[..., None]
    return np.asarray(shares.reshape(*found.placed.batch, *shares.shape[1:]))


def matched(shares: Array) -> NDArray[np.intp]:
    """A mode of its own for every pattern, such that the shares' sum is largest, (q,).

    Parameters
    ----------
    shares : (q, m)
        `pattern_shares` of one pose, no unit.
    """
    _, columns = linear_sum_assignment(-shares)
    return np.asarray(columns, dtype=np.intp)
