"""Static displacements of a held solid."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.factorize import factorize
from strutwork.fea.solid_matrices import SolidMatrices
from strutwork.fea.solid_supports import Supports, require_held, supports

Array = NDArray[Any]

#: Largest error of a solution, as a share of its largest displacement, that is let pass. A residual
#: beside the load would refuse sound answers of slender solids, whose cells carry far more than it.
CERTAIN = 1e-6


@dataclass(frozen=True, repr=False)
class SolidStatic:
    """Static solution of a solid, one column for each load case.

    Parameters
    ----------
    matrices : SolidMatrices
    displacements : (3n, m)
        m.
    reactions : (3n, m)
        Forces of the supports on the solid, zero elsewhere, N.
    strain_energy : (m,)
        J.
    error : float
        Largest, of the cases, as a share of the case's largest displacement.
    solver : str
        Which factorisation ran.
    """

    matrices: SolidMatrices
    displacements: Array
    reactions: Array
    strain_energy: Array
    error: float
    solver: str

    def __repr__(self) -> str:
        return (
            f"SolidStatic({self.matrices.solid.name}: {self.displacements.shape[1]} load cases, "
            f"{self.matrices.size} degrees of freedom, largest displacement "
            f"{np.abs(self.displacements).max(initial=0.0):.4g} m, error {self.error:.1e}, "
            f"{self.solver})"
        )

    def at_nodes(self, case: int = 0) -> Array:
        """Displacement of each node in a load case, m, (n, 3).

        Parameters
        ----------
        case : int
            Its place among the load cases.
        """
        return np.asarray(self.displacements[:, case].reshape(-1, 3))

    def mean_over(self, patch: str) -> Array:
        """Mean displacement of a patch, weighted by area, m, (3, m).

        Parameters
        ----------
        patch : str
        """
        nodes, areas = self.matrices.patch(patch)
        there = self.displacements.reshape(len(self.matrices.points), 3, -1)[nodes]
        return np.asarray(np.einsum("n,ncm->cm", areas / areas.sum(), there))

    def to_dict(self) -> dict[str, Any]:
        """Scalars of the solution, for reports."""
        return {
            "degrees_of_freedom": self.matrices.size,
            "largest_displacement_m": np.abs(self.displacements).max(axis=0).tolist(),
            "strain_energy_J": self.strain_energy.tolist(),
            "error": self.error,
            "solver": self.solver,
        }


def solve_solid(
    matrices: SolidMatrices,
    loads: Array,
    held: Supports | Mapping[str, str | Mapping[str, float | ArrayLike]],
    solver: str | None = None,
) -> SolidStatic:
    """Displacements under loads and displaced supports, K u = f.

    Parameters
    ----------
    matrices : SolidMatrices
    loads : (3n,) or (3n, m)
        N.
    held : Supports or mapping
        As for `strutwork.fea.solid_supports.supports`: directions, or displacements in m, one
        number or (k,) for k nodes. Displaced supports act in every load case.
    solver : str or None
        Which factorisation (`strutwork.fea.factorize`); by default the best installed.

    Returns
    -------
    SolidStatic

    Raises
    ------
    ModelError
        Loads of the wrong shape or not finite.
    MechanismError
        The supports let the solid move; names the rigid motions that are free.
    NumericalError
        The stiffness is singular otherwise, or the error is above `CERTAIN`.
    """
    forces = _checked(matrices, loads)
    known = held if isinstance(held, Supports) else supports(matrices, held)
    require_held(matrices, known.dofs)
    free = np.ones(matrices.size, dtype=bool)
    free[known.dofs] = False
    displacements = np.zeros_like(forces)
    displacements[known.dofs] = known.values[:, None]
    right = (forces - matrices.stiffness @ displacements)[free]
    name, size = "none", 0.0
    if free.any():
        inner = sp.csc_array(matrices.stiffness[free][:, free])
        factor = factorize(inner, solver)
        name = factor.name
        found = factor.solve(right)
        # one step of refinement takes off what a factorisation without pivoting leaves; a second
        # shows what is left
        found = found + factor.solve(right - inner @ found)
        correction = factor.solve(right - inner @ found)
        displacements[free] = found + correction
        size = _share(correction, displacements)
        if not size <= CERTAIN:
            raise NumericalError(
                f"solid {matrices.solid.name}",
                f"its static solution is accurate to {size:.1e} of its largest displacement only.",
                (
                    "Check for parts that meet only at a node or along an edge, or for very flat "
                    "cells."
                ),
            )
    internal = matrices.stiffness @ displacements
    reactions = np.zeros_like(forces)
    reactions[known.dofs] = (internal - forces)[known.dofs]
    energy = 0.5 * np.einsum("nm,nm->m", displacements, internal)
    return SolidStatic(matrices, displacements, reactions, energy, size, name)


def _checked(matrices: SolidMatrices, loads: Array) -> Array:
    forces = np.asarray(loads, dtype=float)
    forces = forces[:, None] if forces.ndim == 1 else forces
    if forces.ndim != 2 or len(forces) != matrices.size or not np.isfinite(forces).all():
        raise ModelError(
            f"solid {matrices.solid.name}",
            f"its loads have the shape {np.shape(loads)} or are not finite.",
            f"Give {matrices.size} forces for each load case.",
        )
    return forces


def _share(correction: Array, displacements: Array) -> float:
    """Largest correction of a case beside its largest displacement; NaN is kept."""
    off = np.abs(correction).max(axis=0, initial=0.0)
    largest = np.abs(displacements).max(axis=0, initial=0.0)
    return float(np.divide(off, largest, out=off.copy(), where=largest > 0).max(initial=0.0))
