"""Complex modes of structures whose damping couples the undamped ones."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fea.coupled import AnyDamping, DampedMatrices, damped_matrices
from fea.eigen import solve_eigen
from fea.reduction import reduce_system
from msa.assembly import system_of
from msa.structure import PlacedStructure
from strutwork.errors import ModelError

Array = NDArray[Any]


@dataclass(frozen=True)
class ComplexModes:
    """Damped modes of one pose.

    Parameters
    ----------
    frequencies : (m,)
        Undamped natural frequency |s| of each mode, Hz, ascending; zero for rigid-body modes.
    damping_ratios : (m,)
        ζ = −Re s / |s|; one where a mode is critically damped or beyond.
    eigenvalues : (m,)
        s, rad/s, with positive imaginary part where it oscillates.
    shapes : (m, n, 6)
        Complex shape at the mesh nodes, largest entry one.
    """

    frequencies: Array
    damping_ratios: Array
    eigenvalues: Array
    shapes: Array

    def __repr__(self) -> str:
        return f"<ComplexModes: {len(self.frequencies)} modes, Hz>"


def complex_modes(placed: PlacedStructure, damping: AnyDamping, count: int = 10) -> ComplexModes:
    """Damped modes of a structure at one pose.

    With viscous damping from the state-space problem of (K + sC + s²M) φ = 0; structural
    damping makes K complex, and of each pair of eigenvalues the one that decays is taken.

    Parameters
    ----------
    placed : PlacedStructure
        One pose.
    damping : damping of any kind
    count : int
        Number of modes.

    Returns
    -------
    ComplexModes

    Raises
    ------
    ModelError
        Several poses, a count below one, no mass.
    """
    if count < 1:
        raise ModelError("complex modes", f"{count} asked for.", "Ask for at least one.")
    system = system_of(placed)
    if system.poses != 1:
        raise ModelError("complex modes", f"of {system.poses} poses.", "Give one pose.")
    reduced = reduce_system(system)
    eigen = solve_eigen(reduced)
    matrices = damped_matrices(reduced, eigen, damping)
    # mass-normalised undamped modes as coordinates; motions without mass follow statically
    # and have no frequency
    shapes = np.concatenate(
        [
            eigen.rigid[0],
            (eigen.flexibility[0] * np.where(eigen.finite[0], eigen.circular[0], 0.0))[
                :, eigen.finite[0]
            ],
        ],
        axis=1,
    )
    massless = eigen.flexibility[0][:, ~eigen.finite[0]]
    values, vectors = _state_space(matrices, shapes, massless)
    order = np.argsort(np.abs(values), kind="stable")[:count]
    values, vectors = values[order], vectors[:, order]
    at_nodes = np.moveaxis(system.expand((reduced.basis[0] @ vectors)[None])[0], -1, 0)
    largest = np.abs(at_nodes).reshape(len(values), -1).argmax(axis=1)
    scale = at_nodes.reshape(len(values), -1)[np.arange(len(values)), largest]
    size = np.abs(values)
    rigid = size <= 1e-6 * max(size.max(initial=0.0), 1e-300)
    with np.errstate(invalid="ignore", divide="ignore"):
        ratios = np.where(rigid, 0.0, -values.real / size)
    return ComplexModes(
        np.where(rigid, 0.0, size / (2.0 * np.pi)),
        ratios,
        values,
        at_nodes / scale[:, None, None],
    )


def _state_space(matrices: DampedMatrices, shapes: Array, massless: Array) -> tuple[Array, Array]:
    basis = np.concatenate([shapes, massless], axis=1)
    whole = [
        basis.T @ m[0] @ basis
        for m in (matrices.stiffness + 1j * matrices.structural, matrices.viscous)
    ]
    stiffness, viscous = whole
    m = shapes.shape[1]
    if massless.shape[1]:
        stiffness, viscous, follow = _condensed(stiffness, viscous, m)
    else:
        follow = np.zeros((0, m))
    state = np.block([[np.zeros((m, m)), np.eye(m)], [-stiffness, -viscous]])
    values, vectors = np.linalg.eig(state)
    # one of each pair: the root in the upper half plane; an overdamped pair is two real roots
    scale = np.abs(values).max(initial=1.0)
    chosen = values.imag > -1e-9 * scale
    if np.any(matrices.structural):
        chosen &= values.real <= 1e-9 * scale
    values, vectors = values[chosen], vectors[:m, chosen]
    still = np.abs(values) <= 1e-7 * scale
    if still.any():
        # a rigid-body mode is a double root at zero: keep one of each pair
        first = np.flatnonzero(still)[: int(np.ceil(still.sum() / 2))]
        keep = np.concatenate([first, np.flatnonzero(~still)])
        values, vectors = values[keep], vectors[:, keep]
    full = np.concatenate([vectors, follow @ vectors], axis=0)
    return values, basis @ full


def _condensed(stiffness: Array, viscous: Array, m: int) -> tuple[Array, Array, Array]:
    """Leave out motions without mass, which follow the others statically."""
    inner = stiffness[m:, m:]
    follow = -np.linalg.solve(inner, stiffness[m:, :m])
    lift = np.concatenate([np.eye(m), follow], axis=0)
    return lift.T @ stiffness @ lift, lift.T @ viscous @ lift, follow
