"""The strain energy of modes part by part, where doubles have lost it in the assembled matrix.

In a sum of stiff and soft parts the soft ones lose digits; the lowest modes live of them. The work
of a shape, taken part by part in extended precision, gives Rayleigh's quotient ψᵀ K ψ / ψᵀ M ψ,
whose error is the square of the shape's (Parlett 1998, section 1.4).
"""

from __future__ import annotations

import numpy as np

from strutwork.errors import NumericalError
from strutwork.fea.geometric import geometric_stiffness
from strutwork.fea.reduction import Reduced
from strutwork.msa.assembly import Array, System, system_of
from strutwork.msa.nodal import unbalanced

#: What the last digits of every stiffness may do to the work of a mode, as a share of it, up to
#: which doubles are trusted.
SURE = 1e-8

#: Error of ω² before Rayleigh's quotient above which modes are withheld: after it, the square.
TRUSTED = 1e-3


def with_true_work(reduced: Reduced, vectors: Array, square: Array) -> tuple[Array, Array]:
    """Modes of unit strain energy, that of the parts where the assembled one is in doubt.

    Parameters
    ----------
    reduced : Reduced
    vectors : (p, c, m)
        ψ with ψᵀ K ψ = 1.
    square : (p, m)
        1/ω², s², descending.

    Returns
    -------
    vectors, square : (p, c, m) and (p, m)
        The same, corrected in place.

    Raises
    ------
    NumericalError
        Modes whose strain energy is not known to `TRUSTED`: states the pose.
    """
    diagonal = np.einsum("pii->pi", reduced.stiffness)
    noise = np.finfo(float).eps * np.einsum("pi,pim->pm", np.abs(diagonal), vectors**2)
    doubtful = noise > SURE
    for pose in np.flatnonzero(doubtful.any(axis=1)):
        modes = np.flatnonzero(doubtful[pose])
        one = reduced.system.placed[[pose]]
        work = _work(system_of(one), reduced.basis[[pose]] @ vectors[[pose]][..., modes])[0]
        worst = float(np.abs(work - 1.0).max())
        if not worst <= TRUSTED:
            where = f" at pose {pose}" if len(square) > 1 else ""
            raise NumericalError(
                "modes",
                f"the strain energy of the lowest is accurate to {worst:.2g} only{where}: the "
                "modes are withheld.",
                "Stiffnesses differ too much: make the stiffest parts rigid, or support what is "
                "hardly held.",
            )
        vectors[pose][:, modes] /= np.sqrt(work)
        square[pose, modes] /= work
        order = np.argsort(-square[pose], kind="stable")
        vectors[pose], square[pose] = vectors[pose][:, order], square[pose, order]
    return vectors, square


def _work(system: System, unknowns: Array) -> Array:
    """Twice the strain energy of shapes (p, n, m) and what a preload adds, (p, m)."""
    moved = unknowns.astype(np.longdouble)
    poses, _, count = moved.shape
    nothing = np.zeros((poses, len(system.row_labels), count), dtype=np.longdouble)
    left, _, _ = unbalanced(system, moved, nothing, np.zeros_like(moved), nothing)
    work = -(moved * left).sum(axis=1)
    if system.placed.stiffening is not None:
        work = work + (unknowns * (geometric_stiffness(system) @ unknowns)).sum(axis=1)
    return np.asarray(work, dtype=float)
