"""Derivatives of natural frequencies, and of the exact minimum of the dynamic stiffness.

A mode φ with φᵀMφ = 1 and the multipliers λ that hold its constraint rows A gives
∂ω²/∂p = φᵀ(∂K/∂p − ω² ∂M/∂p)φ + 2 λᵀ(∂A/∂p)φ (Fox and Kapoor 1968). Of a frequency that occurs
several times these are the eigenvalues of the matrix between its modes.

The least dynamic stiffness 1/|H(ω*)| moves only with H, not with ω*: at a minimum inside the band
the slope along ω is zero, and at its ends ω* stays (the envelope theorem). H = fᵀx with Z x = f, Z
symmetric, so that ∂H/∂p = −xᵀ(∂Z/∂p)x.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.coupled import AnyDamping, PartDamping, damped_matrices, part_matrices
from strutwork.fea.damping import ModalRatio, Rayleigh
from strutwork.fea.eigen import Eigen, solve_eigen
from strutwork.fea.least_stiffness import least_dynamic_stiffness
from strutwork.fea.modes import lowest
from strutwork.fea.ports import Port
from strutwork.fea.reduction import Reduced, reduce_system
from strutwork.msa.assembly import System, system_of
from strutwork.msa.changes import PlacedChange
from strutwork.msa.constraints import orthonormal_rows, scales
from strutwork.msa.mass import mass_matrix
from strutwork.msa.part_forms import Fields, FormBuilder, Forms
from strutwork.msa.structure import PlacedStructure
from strutwork.msa.tool_load_rates import tool_load_rates

Array = NDArray[Any]

#: Squares of frequencies that differ by less, as a share, belong to one frequency.
SAME = 1e-6


@dataclass(frozen=True)
class FrequencySensitivity:
    """Natural frequencies and their derivatives at p poses.

    Parameters
    ----------
    parameters : tuple of g str
    frequencies : (p, m)
        Hz, ascending; zero for rigid-body modes.
    rates : (g, p, m)
        Hz per unit of each parameter. Of a frequency that occurs several times: of the branches
        into which the parameter splits it, ascending.
    repeated : (p, m) of bool
        Frequencies that occur several times.
    """

    parameters: tuple[str, ...]
    frequencies: Array
    rates: Array
    repeated: NDArray[np.bool_]

    def __repr__(self) -> str:
        return (
            f"<FrequencySensitivity: {len(self.parameters)} parameters, "
            f"{self.frequencies.shape[1]} modes, {len(self.frequencies)} poses>"
        )


def frequency_sensitivity(
    placed: PlacedStructure, changes: Sequence[PlacedChange], count: int = 6
) -> FrequencySensitivity:
    """Lowest natural frequencies with their derivatives, from one eigensolution.

    Parameters
    ----------
    placed : PlacedStructure
        At poses (...); made one batch axis of p poses.
    changes : sequence of PlacedChange
        At the same poses, one axis.
    count : int
        Number of modes, rigid-body modes included.

    Returns
    -------
    FrequencySensitivity

    Raises
    ------
    ModelError
        A preload, no mass, every direction locked.
    MechanismError, NumericalError
        As `strutwork.fea.modes`.
    """
    system = _unloaded(placed)
    reduced = reduce_system(system)
    eigen = solve_eigen(reduced)
    # one more than asked for: the last may be one of a pair
    frequencies, vectors = lowest(eigen, count + 1)
    known = np.isfinite(frequencies)
    square = (2.0 * np.pi * np.where(known, frequencies, 0.0)) ** 2
    shapes = reduced.basis @ vectors
    builder = FormBuilder(system, changes)
    force = system.stiffness @ shapes - mass_matrix(system) @ shapes * square[:, None, :]
    fields = Fields(shapes, _multipliers(system, -force, builder.moves))
    forms = builder.forms(fields, mass=True)
    g, p = len(changes), system.poses
    rates = np.zeros((g, p, count))
    repeated = np.zeros((p, count), dtype=bool)
    for pose in range(p):
        for cluster in _clusters(square[pose], known[pose]):
            inner = np.array(cluster)
            mean = square[pose, inner].mean()
            block = forms.elastic[:, pose][:, inner[:, None], inner]
            block = block - mean * forms.mass[:, pose][:, inner[:, None], inner]
            change = np.linalg.eigvalsh((block + np.swapaxes(block, -1, -2)) / 2.0)
            kept = inner[inner < count]
            repeated[pose, kept] = len(inner) > 1
            # a rigid-body mode stays one
            if mean > 0:
                rates[:, pose, kept] = change[:, : len(kept)] / (8.0 * np.pi**2) / _hertz(mean)
    rates = np.where(known[None, :, :count], rates, np.nan)
    return FrequencySensitivity(
        tuple(c.name for c in changes), frequencies[:, :count], rates, repeated
    )


def _hertz(square: float) -> float:
    return float(np.sqrt(square) / (2.0 * np.pi))


def _clusters(square: Array, known: NDArray[np.bool_]) -> list[list[int]]:
    """Modes of one frequency together."""
    found: list[list[int]] = []
    for i in np.flatnonzero(known).tolist():
        if found and square[i] - square[found[-1][0]] <= SAME * square[i]:
            found[-1].append(i)
        else:
            found.append([i])
    return found


def _unloaded(placed: PlacedStructure) -> System:
    if placed.stiffening is not None:
        raise ModelError(
            "preload",
            "acts on the structure: what a parameter does to the preload's own forces is not "
            "differentiated.",
            "Take the derivatives without the preload.",
        )
    system = system_of(placed)
    system.placed.check()
    return system


def _multipliers(system: System, unbalanced: Array, moves: bool) -> Array:
    """λ of Aᵀλ = the force that is left, (p, r, m); zero where no row moves."""
    shape = (system.poses, len(system.row_labels), unbalanced.shape[-1])
    if not moves and system.locked_rows.tied is None:
        return np.zeros(shape)
    rows = orthonormal_rows(system)
    return rows.multipliers(rows.basis @ (unbalanced * scales(system)[..., None]))


@dataclass(frozen=True)
class DynamicSensitivity:
    """The least dynamic stiffness at a port and its derivatives at p poses.

    Parameters
    ----------
    port : Port
    parameters : tuple of g str
    value : (p,)
        N/m or N·m/rad.
    frequency : (p,)
        Where it is reached, Hz.
    rates : (g, p)
        N/m or N·m/rad per unit of each parameter.
    """

    port: Port
    parameters: tuple[str, ...]
    value: Array
    frequency: Array
    rates: Array

    def __repr__(self) -> str:
        return (
            f"<DynamicSensitivity: {self.port}, {len(self.parameters)} parameters, "
            f"{len(self.value)} poses>"
        )


def dynamic_sensitivity(
    placed: PlacedStructure,
    changes: Sequence[PlacedChange],
    port: Port,
    damping: AnyDamping,
    band: tuple[float, float],
) -> DynamicSensitivity:
    """Exact minimum of the driving-point dynamic stiffness with its derivatives.

    Parameters
    ----------
    placed : PlacedStructure
        At poses (...); made one batch axis of p poses.
    changes : sequence of PlacedChange
        At the same poses, one axis.
    port : Port
        Of the tool, as `tool_port` makes it.
    damping : damping of any kind
        Held as it is; loss factors of materials and dashpots of joints follow the parameters.
    band : (float, float)
        Hz.

    Returns
    -------
    DynamicSensitivity

    Raises
    ------
    ModelError
        A preload, a port elsewhere than at the tool; else as `least_dynamic_stiffness`.
    NumericalError
        As `least_dynamic_stiffness`.
    """
    system = _unloaded(placed)
    linkage = system.placed.structure.linkage
    if (port.node, port.against) != (linkage.tool, linkage.against):
        raise ModelError(
            f"port {port}",
            f"is not that of the tool{linkage.relative_to}.",
            "Take the derivatives at the port that `tool_port` makes.",
        )
    values, places, rates = [], [], []
    for pose in range(system.poses):
        one = system.placed[pose : pose + 1]
        least = least_dynamic_stiffness(system.placed[pose], port, port, damping, band)
        some = [_at_pose(change, pose) for change in changes]
        change = _receptance_rates(system_of(one), some, port, damping, least.frequency)
        values.append(least.value)
        places.append(least.frequency)
        rates.append(-(least.value**2) * change)
    return DynamicSensitivity(
        port,
        tuple(c.name for c in changes),
        np.array(values),
        np.array(places),
        np.stack(rates, axis=-1),
    )


def _at_pose(change: PlacedChange, pose: int) -> PlacedChange:
    if change.above is None or change.below is None:
        return change
    some = slice(pose, pose + 1)
    return PlacedChange(change.change, change.above[some], change.below[some])


def _receptance_rates(
    system: System,
    changes: Sequence[PlacedChange],
    port: Port,
    damping: AnyDamping,
    frequency: float,
) -> Array:
    """∂|H|/∂p at one pose and frequency, (g,)."""
    reduced = reduce_system(system)
    eigen = solve_eigen(reduced)
    omega = 2.0 * np.pi * frequency
    matrices = damped_matrices(reduced, eigen, damping)
    dynamic = (
        matrices.stiffness
        + 1j * (matrices.structural + omega * matrices.viscous)
        - omega**2 * matrices.mass
    )[0]
    load = port.on(reduced)[0]
    x = np.linalg.solve(dynamic, load)
    response = load @ x
    background = damping.background if isinstance(damping, PartDamping) else damping
    parts = damping if isinstance(damping, PartDamping) else None
    builder = FormBuilder(system, changes)
    moved = reduced.basis[0] @ x
    columns = np.stack([moved.real, moved.imag], axis=-1)[None]
    held = np.zeros((1, len(system.row_labels), 2))
    modal = background if isinstance(background, ModalRatio) else None
    if builder.moves or system.locked_rows.tied is not None:
        left = _left_over(system, reduced, eigen, port, damping, omega, x)
        held = _multipliers(system, np.stack([left.real, left.imag], axis=-1)[None], moves=True)
    loss = joint_loss = None
    if parts is not None:
        structure = system.placed.structure
        loss = np.full(len(structure.beams), 1.0 if parts.materials else 0.0)
        joint_loss = np.array([parts.joints.get(j.name, 0.0) for j in structure.linkage.joints])
    forms = builder.forms(Fields(columns, held), mass=True, loss=loss, joint_loss=joint_loss)
    stiffness, rows, mass, structural, viscous = _complex(forms)
    eta = 0.0 if background is None else background.structural
    total = (1.0 + 1j * eta) * stiffness + rows - omega**2 * mass
    if parts is not None:
        total = total + 1j * structural + (1j * omega * viscous if parts.dashpots else 0.0)
    if isinstance(background, Rayleigh):
        total = total + 1j * omega * (background.alpha * mass + background.beta * stiffness)
    if modal is not None:
        total = total + 1j * omega * _modal_rates(builder, reduced, eigen, x, modal.ratio)
    turned = tool_load_rates(system, changes)
    if turned is not None:
        total = total - 2.0 * (turned[:, 0] @ port.vector) @ moved
    return np.asarray((np.conj(response) * -total).real / abs(response))


def _complex(forms: Forms) -> list[Array]:
    """xᵀ(∂·/∂p)x of a complex field from the forms of its two real parts, (g,) each."""
    found = []
    for form in (forms.stiffness, forms.rows, forms.mass, forms.structural, forms.viscous):
        own = form[:, 0]
        found.append(own[:, 0, 0] - own[:, 1, 1] + 1j * (own[:, 0, 1] + own[:, 1, 0]))
    return found


def _modal_rates(
    builder: FormBuilder, reduced: Reduced, eigen: Eigen, x: Array, ratio: float
) -> Array:
    """xᵀ(∂C/∂p)x of C = 2ζ M √(M⁻¹K), (g,): a function of a matrix (Daleckii and Krein 1965).

    Between modes r and s of frequencies ω, C changes by 2ζ (k + ω_r ω_s m)/(ω_r + ω_s), with k and
    m what the parameter changes in stiffness and mass between them. Rigid-body modes have none.
    """
    finite = eigen.finite[0]
    shapes = eigen.flexibility[0][:, finite] * eigen.circular[0][finite]
    omega = eigen.circular[0][finite]
    rigid = eigen.rigid[0][:, np.any(eigen.rigid[0], axis=0)]
    shapes = np.concatenate([rigid, shapes], axis=1)
    omega = np.concatenate([np.zeros(rigid.shape[1]), omega])
    system = builder.system
    whole = (reduced.basis[0] @ shapes)[None]
    force = system.stiffness @ whole - mass_matrix(system) @ whole * omega**2
    fields = Fields(whole, _multipliers(system, -force, builder.moves))
    forms = builder.forms(fields, mass=True)
    share = shapes.T @ reduced.mass[0] @ x
    total = omega[:, None] + omega
    weight = np.divide(
        np.outer(share, share), total, out=np.zeros(total.shape, dtype=complex), where=total > 0
    )
    along = forms.elastic[:, 0] + np.outer(omega, omega) * forms.mass[:, 0]
    return np.asarray(2.0 * ratio * np.einsum("grs,rs->g", along, weight))


def _left_over(
    system: System,
    reduced: Reduced,
    eigen: Eigen,
    port: Port,
    damping: AnyDamping,
    omega: float,
    x: Array,
) -> Array:
    """What the constraint rows carry: load less the force of the structure, (n,), complex."""
    background = damping.background if isinstance(damping, PartDamping) else damping
    moved = reduced.basis[0] @ x
    stiff, heavy = system.stiffness[0] @ moved, mass_matrix(system)[0] @ moved
    eta = 0.0 if background is None else background.structural
    force = (1.0 + 1j * eta) * stiff - omega**2 * heavy
    if isinstance(background, Rayleigh):
        force = force + 1j * omega * (background.alpha * heavy + background.beta * stiff)
    elif isinstance(background, ModalRatio):
        finite = eigen.finite[0]
        shapes = eigen.flexibility[0][:, finite] * eigen.circular[0][finite]
        share = eigen.circular[0][finite] * (shapes.T @ reduced.mass[0] @ x)
        pushed = mass_matrix(system)[0] @ (reduced.basis[0] @ (shapes @ share))
        force = force + 2j * omega * background.ratio * pushed
    if isinstance(damping, PartDamping):
        viscous, structural = part_matrices(system, damping)
        force = force + 1j * (structural[0] + omega * viscous[0]) @ moved
    load: Array = system.tool_load()[0] @ port.vector
    return np.asarray(load - force)
