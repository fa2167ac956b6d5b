"""Derivatives of receptances between any two ports, along a whole line of frequencies.

With Z(ω) x = f of a symmetric Z, H = gᵀx and ∂H/∂p = −yᵀ (∂Z/∂p) x, where y answers g. The
derivatives of stiffness, mass and damping are taken once on the independent coordinates of a pose
and serve all its lines.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.fea.coupled import AnyDamping, PartDamping, damped_matrices
from strutwork.fea.damping import ModalRatio, Rayleigh
from strutwork.fea.eigen import Eigen, solve_eigen
from strutwork.fea.ports import Port
from strutwork.fea.reduction import Reduced, reduce_system
from strutwork.msa.assembly import system_of
from strutwork.msa.changes import PlacedChange
from strutwork.msa.part_forms import Fields, FormBuilder
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]

#: An output and an input.
Pair = tuple[Port, Port]


def receptance_sensitivity(
    placed: PlacedStructure,
    changes: Sequence[PlacedChange],
    pairs: Sequence[Pair],
    frequencies: ArrayLike,
    damping: AnyDamping,
) -> tuple[Array, Array]:
    """Receptances at one pose and their derivatives.

    Parameters
    ----------
    placed : PlacedStructure
        At one pose, with a batch axis of one or none.
    changes : sequence of g PlacedChange
        At the same pose; none may move a part.
    pairs : sequence of q (Port, Port)
        Output and input of each receptance.
    frequencies : (f,)
        Hz, above zero.
    damping : damping of any kind
        Held as it is; loss factors of materials and dashpots of joints follow the parameters.

    Returns
    -------
    receptance : (q, f)
        Complex, m/N and the like.
    rates : (g, q, f)
        Per unit of each parameter, m/N and the like.

    Raises
    ------
    ModelError
        A preload, a parameter that moves parts, coordinates tied by ratios, or a port that does
        not move.
    NumericalError
        A resonance without damping.
    """
    system = system_of(placed)
    builder = FormBuilder(system, changes)
    if placed.stiffening is not None or builder.moves or system.locked_rows.tied is not None:
        raise ModelError(
            "receptance",
            "has no analytical derivative under a preload, with couplings, or for a parameter "
            "that moves parts.",
            "Take differences of it.",
        )
    reduced = reduce_system(system)
    eigen = solve_eigen(reduced)
    matrices = damped_matrices(reduced, eigen, damping)
    omega = 2.0 * np.pi * np.asarray(frequencies, dtype=float)[:, None, None]
    ports = list(dict.fromkeys(port for pair in pairs for port in pair))
    loads = np.stack([port.on(reduced)[0] for port in ports], axis=-1)
    k, m, c, d = (
        x[0] for x in (matrices.stiffness, matrices.mass, matrices.viscous, matrices.structural)
    )
    dynamic = (k + 1j * d)[None] + 1j * omega * c - omega**2 * m
    x = np.linalg.solve(dynamic, np.broadcast_to(loads, (len(omega), *loads.shape)).astype(complex))
    out, given = ([ports.index(pair[i]) for pair in pairs] for i in (0, 1))
    response = np.einsum("cq,fcq->qf", loads[:, out], x[:, :, given])
    y, x = x[:, :, out], x[:, :, given]
    if not changes:
        return response, np.zeros((0, *response.shape), dtype=complex)
    return response, -_work(builder, reduced, eigen, damping, omega[:, 0, 0], y, x)


def _work(
    builder: FormBuilder,
    reduced: Reduced,
    eigen: Eigen,
    damping: AnyDamping,
    omega: Array,
    y: Array,
    x: Array,
) -> Array:
    """yᵀ (∂Z/∂p) x, (g, q, f)."""
    structure = builder.system.placed.structure
    parts = damping if isinstance(damping, PartDamping) else None
    background = damping.background if isinstance(damping, PartDamping) else damping
    loss = joint_loss = None
    if parts is not None:
        loss = np.full(len(structure.beams), 1.0 if parts.materials else 0.0)
        joint_loss = np.array([parts.joints.get(j.name, 0.0) for j in structure.linkage.joints])
    basis = reduced.basis[:1]
    held = np.zeros((1, len(builder.system.row_labels), reduced.size))
    forms = builder.forms(Fields(basis, held), mass=True, loss=loss, joint_loss=joint_loss)

    def between(form: Array) -> Array:
        return np.stack(
            [np.einsum("fcq,fcq->qf", y, np.einsum("cd,fdq->fcq", one[0], x)) for one in form]
        )

    stiffness, mass = between(forms.stiffness), between(forms.mass)
    total = stiffness - omega**2 * mass
    if parts is not None:
        total = total + 1j * between(forms.structural)
        total = total + (1j * omega * between(forms.viscous) if parts.dashpots else 0.0)
    if isinstance(background, Rayleigh):
        total = total + 1j * omega * (background.alpha * mass + background.beta * stiffness)
    elif isinstance(background, ModalRatio):
        viscous = _modal(forms.stiffness[:, 0], forms.mass[:, 0], reduced, eigen, y, x)
        total = total + 1j * omega * background.ratio * viscous
    elif background is not None:
        total = total + 1j * background.structural * stiffness
    return np.asarray(total)


def _modal(
    stiffness: Array, mass: Array, reduced: Reduced, eigen: Eigen, y: Array, x: Array
) -> Array:
    """yᵀ (∂C/∂p) x of C = 2 M √(M⁻¹K), (g, q, f): a function of a matrix.

    Between modes r and s of frequencies ω, C changes by 2 (k + ω_r ω_s m)/(ω_r + ω_s), with k and m
    what the parameter changes in stiffness and mass between them (Daleckii and Krein 1965).
    """
    finite = eigen.finite[0]
    omega = eigen.circular[0][finite]
    shapes = eigen.flexibility[0][:, finite] * omega
    rigid = eigen.rigid[0][:, np.any(eigen.rigid[0], axis=0)]
    shapes = np.concatenate([rigid, shapes], axis=1)
    omega = np.concatenate([np.zeros(rigid.shape[1]), omega])
    k, m = (shapes.T @ form @ shapes for form in (stiffness, mass))
    total = omega[:, None] + omega
    weight = np.divide(2.0, total, out=np.zeros_like(total), where=total > 0)
    along = weight * (k + np.outer(omega, omega) * m)
    push = shapes.T @ reduced.mass[0]
    a, b = (np.einsum("rc,fcq->frq", push, z) for z in (y, x))
    return np.stack([np.einsum("frq,frq->qf", a, np.einsum("rs,fsq->frq", e, b)) for e in along])
