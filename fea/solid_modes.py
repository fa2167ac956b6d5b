"""Natural frequencies and mode shapes of a solid, free or held."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from fea.factorize import Factor, factorize
from fea.solid_matrices import SolidMatrices
from fea.solid_supports import Supports, free_rigid_motions, supports
from strutwork.errors import ModelError, NumericalError

Array = NDArray[Any]
#: Largest relative error bound of ω² that is accepted.
RESIDUAL = 1e-6
#: Rigid motions have a stiffness below this share of that of a mode.
TWICE = 1e-9


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
        Largest ‖K⁻¹ M φ ω² − φ‖ in M of the flexible modes, a bound on the relative error of
        ω² against the discrete model.
    solver : str
        Which factorisation ran.
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
        """Displacement of each node in a mode, (n, 3)."""
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

    Lanczos' method with the inverse of the stiffness. A solid that floats is held at as many
    degrees of freedom as it has rigid motions, which leaves the deformation under balanced
    forces unchanged, and the rigid motions are kept out: no shift is needed. The iteration is
    repeated without what it found until nothing lower appears, so that copies of an equal
    frequency are not missed.

    Parameters
    ----------
    matrices : SolidMatrices
    count : int
        Rigid-body modes included.
    held : Supports or mapping or None
        As for `fea.solid_supports.supports`, all held still.
    solver : str or None
        Which factorisation (`fea.factorize`); by default the best installed.

    Returns
    -------
    SolidModes

    Raises
    ------
    ModelError
        A count below one or above a third of the free degrees of freedom, displaced
        supports, a missing density.
    NumericalError
        No convergence, or a residual that is not small.
    """
    known = held if isinstance(held, Supports) else supports(matrices, held or {})
    part = f"solid {matrices.solid.name}"
    if known.values.any():
        raise ModelError(part, "its supports are displaced.", "Hold them still for modes.")
    free = np.setdiff1d(np.arange(matrices.size), known.dofs)
    if not 1 <= count <= len(free) // 3:
        raise ModelError(
            part,
            f"{count} modes are asked of {len(free)} free degrees of freedom.",
            f"Ask for 1 to {len(free) // 3}.",
        )
    stiffness = sp.csc_array(matrices.stiffness[free][:, free])
    mass = sp.csc_array(matrices.mass[free][:, free])
    motions = free_rigid_motions(matrices, known.dofs)
    rigid = _orthonormal(matrices.rigid_modes()[free] @ motions, mass)
    wanted = count - rigid.shape[1]
    problem = _Inverse(part, mass, rigid, *_held_factor(stiffness, rigid, solver))
    values, vectors = problem.lowest(wanted) if wanted > 0 else (np.zeros(0), rigid[:, :0])
    residual = problem.residual(values, vectors)
    if not residual <= RESIDUAL:
        raise NumericalError(
            part,
            f"a mode's relative residual is {residual:.1e}.",
            "Look for parts that meet only at a node or along an edge, or for very flat cells.",
        )
    shapes = np.zeros((matrices.size, count))
    shapes[free] = np.hstack([rigid, vectors])[:, :count]
    frequencies = np.append(np.zeros(rigid.shape[1]), np.sqrt(values) / (2 * np.pi))[:count]
    drive = matrices.rigid_modes(matrices.center_of_mass)
    effective = (shapes.T @ (matrices.mass @ drive)) ** 2
    return SolidModes(
        matrices, frequencies, shapes, min(rigid.shape[1], count), effective, residual, problem.name
    )


def _orthonormal(vectors: Array, mass: sp.csc_array) -> Array:
    """The vectors made orthonormal in M."""
    if vectors.shape[1] == 0:
        return vectors
    lower = np.linalg.cholesky(vectors.T @ (mass @ vectors))
    return np.asarray(np.linalg.solve(lower, vectors.T).T)


def _held_factor(
    stiffness: sp.csc_array, rigid: Array, solver: str | None
) -> tuple[NDArray[np.intp], Factor]:
    """Degrees of freedom that remain when the rigid motions are held, and the factor on them."""
    keep = np.arange(stiffness.shape[0])
    if rigid.shape[1] == 0:
        return keep, factorize(stiffness, solver)
    _, pivots = sla.qr(rigid.T, mode="r", pivoting=True)
    keep = np.delete(keep, pivots[: rigid.shape[1]])
    return keep, factorize(sp.csc_array(stiffness[keep][:, keep]), solver)


@dataclass(frozen=True)
class _Inverse:
    """The inverse of the stiffness on motions that are M-orthogonal to the rigid ones."""

    part: str
    mass: sp.csc_array
    rigid: Array
    keep: NDArray[np.intp]
    factor: Factor

    @property
    def name(self) -> str:
        return self.factor.name

    def apply(self, forces: Array, known: Array) -> Array:
        """K⁻¹ f, without the parts of M-orthonormal `known` vectors."""
        balanced = forces - self.mass @ (known @ (known.T @ forces))
        result = np.zeros_like(balanced)
        result[self.keep] = self.factor.solve(balanced[self.keep])
        return np.asarray(result - known @ (known.T @ (self.mass @ result)))

    def lowest(self, count: int) -> tuple[Array, Array]:
        values, vectors = self._lanczos(count, self.rigid)
        for _ in range(count):
            known = np.hstack([self.rigid, vectors])
            if known.shape[1] + 1 >= self.mass.shape[0]:
                break
            value, vector = self._lanczos(1, known)
            if value[0] >= values[-1] * (1 - TWICE):
                break
            order = np.argsort(np.append(values, value))[:count]
            values = np.append(values, value)[order]
            vectors = np.hstack([vectors, vector])[:, order]
        return values, vectors

    def _lanczos(self, count: int, known: Array) -> tuple[Array, Array]:
        size = self.mass.shape[0]

        def inverse(right: Array) -> Array:
            return self.apply(np.asarray(right).ravel(), known)

        start = inverse(self.mass @ np.random.default_rng(1).normal(size=size))
        try:
            values, vectors = eigsh(
                self.mass,
                k=count,
                M=self.mass,
                sigma=0.0,
                OPinv=LinearOperator((size, size), matvec=inverse, dtype=float),
                v0=start,
                ncv=min(max(2 * count + 1, 20), size - 1),
            )
        except ArpackNoConvergence as error:
            raise NumericalError(
                self.part, "Lanczos' method did not converge.", "Ask for fewer or more modes."
            ) from error
        order = np.argsort(values)
        return values[order], vectors[:, order]

    def residual(self, values: Array, vectors: Array) -> float:
        if not len(values):
            return 0.0
        again = self.apply(self.mass @ (vectors * values), self.rigid) - vectors
        return float(np.sqrt(np.einsum("nm,nm->m", again, self.mass @ again)).max())
