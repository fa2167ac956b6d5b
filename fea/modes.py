"""Natural frequencies and mode shapes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fea.eigen import Eigen, solve_eigen
from fea.reduction import Reduced, reduce_system
from msa.assembly import system_of
from msa.mass import mass_properties
from msa.structure import PlacedStructure
from strutwork.errors import ModelError, NumericalError

Array = NDArray[Any]

#: Poses solved at once: keeps a stack of matrices within some megabytes.
CHUNK = 64


@dataclass(frozen=True)
class Modes:
    """Lowest modes, rigid-body modes first.

    Parameters
    ----------
    placed : PlacedStructure
    frequencies : (..., m)
        Hz, ascending; zero for rigid-body modes. Where a pose has fewer modes than asked, the
        last are infinite and their shapes zero.
    shapes : (..., m, n, 6)
        Displacement and rotation of every mesh node, mass-normalised: φᵀ M φ = 1; m/√kg.
    effective_mass : (..., m, 6)
        Per direction x y z rx ry rz, rotations about the centre of mass; kg and kg·m².
    total_mass : (..., 6)
        Diagonal of the rigid-body mass about the centre of mass: the sum that the effective
        masses of all modes reach when nothing is held, kg and kg·m².
    rigid_body_modes : (...) of int
    energy_parts : tuple of str
        Parts that store strain energy.
    energy_shares : (..., m, q)
        Share of each part in the strain energy of a mode; they add to one, zero for
        rigid-body modes.
    note : str
        Empty, or that fewer modes exist than were asked for.
    """

    placed: PlacedStructure
    frequencies: Array
    shapes: Array
    effective_mass: Array
    total_mass: Array
    rigid_body_modes: NDArray[np.intp]
    energy_parts: tuple[str, ...]
    energy_shares: Array
    note: str = ""

    def __repr__(self) -> str:
        first = self.frequencies.reshape(-1, self.frequencies.shape[-1])[0][:4]
        return (
            f"<Modes: {self.frequencies.shape[-1]} modes, batch {self.placed.batch}, first "
            f"{', '.join(f'{f:.4g}' for f in first)} Hz>"
        )

    def to_dict(self) -> dict[str, Any]:
        """Lists of a single pose; shapes by node name."""
        if self.placed.batch != ():
            raise ModelError("modes", "of several poses.", "Choose one: modes(placed[i], …).")
        nodes = self.placed.structure.linkage.nodes
        return {
            "frequencies": self.frequencies.tolist(),
            "rigid_body_modes": int(self.rigid_body_modes),
            "shapes": [
                {name: shape[i].tolist() for i, name in enumerate(nodes)} for shape in self.shapes
            ],
            "effective_mass": self.effective_mass.tolist(),
            "total_mass": self.total_mass.tolist(),
        }


def modes(placed: PlacedStructure, count: int = 10, preload: Array | None = None) -> Modes:
    """Lowest modes of a structure at a batch of poses.

    Parameters
    ----------
    placed : PlacedStructure
    count : int
        Number of modes, rigid-body modes included.
    preload : (..., s) or None
        Axial force in every beam element, N, tension positive, from `fea.axial_forces`: adds
        the geometric stiffness.

    Returns
    -------
    Modes
        All modes there are, and a note, where fewer exist than asked.

    Raises
    ------
    ModelError
        A count below one, no mass, or every direction locked.
    MechanismError
        A preload that makes the structure buckle is a NumericalError; a motion without mass
        that nothing resists a ModelError.
    """
    if count < 1:
        raise ModelError("modes", f"{count} modes asked for.", "Ask for at least one.")
    system = system_of(placed)
    parts = []
    for start in range(0, system.poses, CHUNK):
        part = system_of(system.placed[start : start + CHUNK])
        geometric = None
        if preload is not None:
            from fea.geometric import geometric_stiffness  # noqa: PLC0415 - only when preloaded

            flat = np.asarray(preload, dtype=float).reshape(system.poses, -1)
            geometric = geometric_stiffness(part, flat[start : start + CHUNK])
        parts.append(_modes(reduce_system(part, geometric), count))
    joined = [np.concatenate(arrays) for arrays in zip(*parts, strict=True)]
    frequencies, shapes, effective, total, rigid, shares = joined
    exist = int(np.isfinite(frequencies).sum(axis=-1).max())
    note = ""
    if exist < count:
        note = f"{count} modes were asked for and {exist} exist: these are all there are."
        frequencies, shapes = frequencies[:, :exist], shapes[:, :exist]
        effective, shares = effective[:, :exist], shares[:, :exist]
    if not np.all(np.isfinite(shapes)):
        raise NumericalError("mode shapes", "are not finite.", "Check masses and stiffnesses.")
    batch = placed.batch
    names = tuple(dict.fromkeys(name for name, _, _ in system_of(placed).contributions()))

    def shaped(array: Array) -> Array:
        return array.reshape((*batch, *array.shape[1:]))

    return Modes(
        placed,
        shaped(frequencies),
        shaped(shapes),
        shaped(effective),
        shaped(total),
        shaped(rigid),
        names,
        shaped(shares),
        note,
    )


def _modes(reduced: Reduced, count: int) -> tuple[Array, ...]:
    eigen = solve_eigen(reduced)
    frequencies, vectors = lowest(eigen, reduced, count)
    system = reduced.system
    unknowns = reduced.basis @ vectors
    shapes = np.moveaxis(system.expand(unknowns), -1, 1)
    effective, total = _effective_mass(reduced, vectors)
    shares = _energy_shares(reduced, unknowns, frequencies)
    return frequencies, shapes, effective, total, reduced.rigid_count, shares


def lowest(eigen: Eigen, reduced: Reduced, count: int) -> tuple[Array, Array]:
    """Frequencies, Hz, (p, count) and mass-normalised vectors (p, c, count), rigid ones first.

    Where a pose has fewer modes the frequency is infinite and the vector zero.
    """
    circular = np.where(eigen.finite, eigen.circular, 0.0)
    flexible = eigen.flexibility * circular[:, None, :]
    rigid = eigen.rigid
    vectors = np.concatenate([rigid, flexible], axis=-1)
    values = np.concatenate(
        [
            np.where(np.any(rigid, axis=1), 0.0, np.inf),
            np.where(eigen.finite, circular / (2 * np.pi), np.inf),
        ],
        axis=-1,
    )
    if values.shape[1] < count:
        gap = count - values.shape[1]
        values = np.concatenate([values, np.full((len(values), gap), np.inf)], axis=1)
        vectors = np.concatenate([vectors, np.zeros((*vectors.shape[:2], gap))], axis=-1)
    order = np.argsort(values, axis=1, kind="stable")[:, :count]
    picked = np.take_along_axis(vectors, order[:, None, :], axis=-1)
    return np.take_along_axis(values, order, axis=1), picked


def _effective_mass(reduced: Reduced, vectors: Array) -> tuple[Array, Array]:
    """Effective masses (p, m, 6) and the rigid mass they add to (p, 6).

    Rigid motions about the centre of mass are brought to the coordinates as far as supports
    let them; what supports carry has no share in the vibration.
    """
    from msa.mass import mass_matrix  # noqa: PLC0415
    from msa.structure import rigid_map  # noqa: PLC0415

    system = reduced.system
    properties = mass_properties(system.placed)
    reference = system.placed.structure.reference_nodes
    arms = system.placed.positions[:, reference] - properties.centre[:, None, :]
    motion = rigid_map(arms).reshape(system.poses, -1, 6)
    participation = np.swapaxes(reduced.basis @ vectors, -1, -2) @ (mass_matrix(system) @ motion)
    total = np.einsum("pij,pij->pj", motion, mass_matrix(system) @ motion)
    return np.asarray(participation**2), np.asarray(total)


def _energy_shares(reduced: Reduced, unknowns: Array, frequencies: Array) -> Array:
    system = reduced.system
    u = system.expand(unknowns)
    energy: dict[str, Array] = {}
    for name, nodes, stiffness in system.contributions():
        at = u[:, nodes].reshape(system.poses, -1, u.shape[-1])
        energy[name] = energy.get(name, 0.0) + np.einsum("pim,pim->pm", at, stiffness @ at)
    stacked = np.stack(list(energy.values()), axis=-1)
    total = stacked.sum(axis=-1, keepdims=True)
    vibrates = (frequencies > 0) & np.isfinite(frequencies)
    return np.where(vibrates[..., None], stacked / np.where(total > 0, total, 1.0), 0.0)
