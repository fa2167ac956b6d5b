"""Tool motions that a mechanism has beside a pose and not at it, to second order."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.row_rates import row_rates
from strutwork.kinematics.rows import ConstraintRows, body_references

Array = NDArray[Any]

#: Share of the rows' largest singular value below which they hold nothing.
HELD = 1e-10


def lost_twists(
    passive: ConstraintRows, null: Array, standing: Array, body: int, columns: Array
) -> Array:
    """Twists of the tool that begin to be possible when the mechanism moves.

    Along a motion q of all bodies the rows A q = 0 keep holding when A q̇ = −Ȧ(q) q. For two
    motions, α with a standing tool and any β, the mixed part of that gives by how much the
    tool's twist in α changes as the mechanism moves along β.

    Parameters
    ----------
    passive : ConstraintRows
        At p poses.
    null : (p, n, m)
        Motions that the passive rows allow, on (v, L ω) of all bodies, m; columns may be zero.
    standing : (p, n, k)
        Those of them in which the tool stands, m; columns may be zero.
    body : int
        The tool's.
    columns : (p, n)
        Factors 1 and L of the bodies' twists, no unit and m.

    Returns
    -------
    twists : (p, 6, k m)
        On (v, L ω); they may hold parts that the tool can make at the pose itself.
    """
    rows = passive.on_bodies() / columns[:, None, :]
    solve = np.linalg.pinv(rows, rcond=HELD)[:, 6 * body : 6 * body + 6]
    used = np.flatnonzero(np.abs(standing).max(axis=(0, 1)) > 0)
    any_motion = np.flatnonzero(np.abs(null).max(axis=(0, 1)) > 0)
    result = []
    for i in used:
        a = standing[:, :, i] / columns
        for j in any_motion:
            b = null[:, :, j] / columns
            mixed = (drift(passive, a + b) - drift(passive, a - b)) / 4.0
            # in units of the machine: motions are made of columns of unit size
            scale = columns[:, -1]
            result.append(-np.einsum("pij,pj->pi", solve, mixed) * scale[:, None])
    if not result:
        return np.zeros((len(null), 6, 1))
    return np.stack(result, axis=-1)


def drift(passive: ConstraintRows, twists: Array) -> Array:
    """Ȧ(q) q of every row for twists (p, n) of the bodies about their references, (p, r).

    Parameters
    ----------
    passive : ConstraintRows
        At p poses.
    twists : (p, n)
        Of the bodies about their references, m and rad per unit of the motion.
    """
    references = body_references(passive.linkage, passive.placement)
    return np.asarray(np.einsum("prn,pn->pr", row_rates(passive, references, twists), twists))
