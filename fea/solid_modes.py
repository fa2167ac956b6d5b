"""Natural frequencies and mode shapes of a solid, free or held."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.large_modes import lowest_modes
from strutwork.fea.solid_matrices import SolidMatrices
from strutwork.fea.solid_supports import Supports, free_rigid_motions, supports

Array = NDArray[Any]


@dataclass(frozen=True, repr=False)
class SolidModes:
    """Modes of a solid.

    Parameters
    ----------
    matrices : SolidMatrices
    frequencies : (m,)
        Hz, ascending; rigid-body modes first with zero.
    shapes : (3n, m)
        Mass-normalised, 1/√kg.
    rigid_body_modes : int
    effective_mass : (m, 6)
        Share of each mode in rigid motion along x, y, z and about the centre of mass, kg and
        kg m².
    residual : float
        Largest of the flexible modes, as `strutwork.fea.large_modes.LargeModes` defines it, no
        unit.
    solver : str
        Which ran.
    """

    matrices: SolidMatrices
    frequencies: Array
    shapes: Array
    rigid_body_modes: int
    effective_mass: Array
    residual: float
    solver: str

    def __repr__(self) -> str:
        flexible = self.frequencies[self.rigid_body_modes :]
        told = ", ".join(f"{f:.6g}" for f in flexible[:4])
        return (
            f"SolidModes({self.matrices.solid.name}: {self.rigid_body_modes} rigid-body modes, "
            f"then {told}{', …' if len(flexible) > 4 else ''} Hz; {self.matrices.size} degrees of "
            f"freedom, {self.solver})"
        )

    def shape(self, mode: int) -> Array:
        """Displacement of each node in a mode, (n, 3), 1/√kg.

        Parameters
        ----------
        mode : int
            Counted from zero.
        """
        return np.asarray(self.shapes[:, mode].reshape(-1, 3))

    def to_dict(self) -> dict[str, Any]:
        """Numbers of the modes, for reports."""
        return {
            "frequencies_Hz": self.frequencies.tolist(),
            "rigid_body_modes": self.rigid_body_modes,
            "effective_mass": self.effective_mass.tolist(),
            "degrees_of_freedom": self.matrices.size,
            "residual": self.residual,
            "solver": self.solver,
        }


def solid_modes(
    matrices: SolidMatrices,
    count: int = 10,
    held: Supports | Mapping[str, Any] | None = None,
    solver: str | None = None,
) -> SolidModes:
    """Lowest modes.

    Supports are imposed by removing their degrees of freedom; the eigenproblem is that of
    `strutwork.fea.large_modes.lowest_modes`. Rigid-body modes are the exact rigid motions that the
    supports leave, and as many as the stiffness has.

    Parameters
    ----------
    matrices : SolidMatrices
    count : int
        Rigid-body modes included.
    held : Supports or mapping or None
        As for `strutwork.fea.solid_supports.supports`, all held still.
    solver : str or None
        As for `strutwork.fea.large_modes.lowest_modes`.

    Returns
    -------
    SolidModes

    Raises
    ------
    ModelError
        A count below one or above a third of the free degrees of freedom, displaced
        supports, a missing density.
    NumericalError
        No convergence, a residual that is not small, or parts that move without strain.
    """
    known = held if isinstance(held, Supports) else supports(matrices, held or {})
    part = f"solid {matrices.solid.name}"
    if known.values.any():
        raise ModelError(part, "its supports are displaced.", "Hold them still for modes.")
    free = np.setdiff1d(np.arange(matrices.size), known.dofs)
    if not 1 <= count <= len(free) // 3:
        raise ModelError(
            part,
            f"{count} modes are requested of {len(free)} free degrees of freedom.",
            f"Ask for 1 to {len(free) // 3}.",
        )
    motions = free_rigid_motions(matrices, known.dofs)
    stiffness, mass = (
        sp.csc_array(matrix[free][:, free]) for matrix in (matrices.stiffness, matrices.mass)
    )
    found = lowest_modes(stiffness, mass, count, floating=motions.shape[1] > 0, solver=solver)
    rigid = _orthonormal(matrices.rigid_modes()[free] @ motions, mass)[:, :count]
    still = int(np.count_nonzero(found.frequencies == 0.0))
    if still != rigid.shape[1]:
        raise NumericalError(
            part,
            f"{still} modes have no stiffness, but {rigid.shape[1]} rigid motions are free.",
            "Check for parts that meet only at a node or along an edge, or for very flat cells.",
        )
    shapes = np.zeros((matrices.size, count))
    shapes[free] = np.hstack([rigid, found.vectors[:, still:]])
    drive = matrices.rigid_modes(matrices.center_of_mass)
    effective = (shapes.T @ (matrices.mass @ drive)) ** 2
    residual = float(found.residuals[still:].max(initial=0.0))
    return SolidModes(matrices, found.frequencies, shapes, still, effective, residual, found.solver)


def _orthonormal(vectors: Array, mass: sp.csc_array) -> Array:
    """The vectors made orthonormal in M."""
    if vectors.shape[1] == 0:
        return vectors
    lower = np.linalg.cholesky(vectors.T @ (mass @ vectors))
    return np.asarray(np.linalg.solve(lower, vectors.T).T)
