"""Modes by what moves: shares of given patterns of motion in the modes of a structure."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from fea.modes import Modes
from msa.assembly import system_of
from msa.mass import mass_matrix
from strutwork.errors import ModelError

Array = NDArray[Any]


def pattern_shares(found: Modes, patterns: Array) -> Array:
    """How much of each pattern each mode holds: (φᵀMψ)² / (ψᵀMψ).

    The modal assurance criterion in the metric of the mass, one for a pattern that is a mode.
    Over all modes the shares of a pattern add to one; a pattern that translates a part of the
    structure gives effective masses as shares of the part's mass.

    Parameters
    ----------
    found : Modes
        m of them, of one pose.
    patterns : (q, n, 6)
        Motion of every mesh node; nodes of a rigid body move as one.

    Returns
    -------
    (q, m)

    Raises
    ------
    ModelError
        Several poses, or a pattern in which nothing heavy moves.
    """
    if found.placed.batch != ():
        raise ModelError("modes", "of several poses.", "Choose one: modes(placed[i], …).")
    system = system_of(found.placed)
    reference = found.placed.structure.reference_nodes
    mass = mass_matrix(system)[0]
    wanted = patterns[:, reference].reshape(len(patterns), -1)
    shapes = found.shapes[:, reference].reshape(len(found.shapes), -1)
    size = np.einsum("qi,ij,qj->q", wanted, mass, wanted)
    if not np.all(size > 0):
        raise ModelError(
            f"pattern {int(np.argmin(size))}", "moves no mass.", "Choose nodes that carry mass."
        )
    return np.asarray((wanted @ mass @ shapes.T) ** 2 / size[:, None])


def matched(shares: Array) -> NDArray[np.intp]:
    """A mode of its own for every pattern, such that the shares' sum is largest, (q,).

    Parameters
    ----------
    shares : (q, m)
    """
    _, columns = linear_sum_assignment(-shares)
    return np.asarray(columns, dtype=np.intp)


def moving_pattern(nodes: Mapping[str, int], moving: Mapping[str, Array], count: int) -> Array:
    """A pattern from the motions of some nodes, the others still, (n, 6).

    Parameters
    ----------
    nodes : mapping of str to int
        Rows by node name.
    moving : mapping of str to (6,)
    count : int
        n.
    """
    pattern = np.zeros((count, 6))
    for name, motion in moving.items():
        pattern[nodes[name]] = motion
    return pattern
