"""Natural frequencies and mode shapes."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.eigen import Eigen, solve_eigen
from strutwork.fea.geometric import pulled
from strutwork.fea.participation import PRELOAD, effective_mass, energy_shares
from strutwork.fea.reduction import reduce_system
from strutwork.fea.sparse_modes import SPARSE_FROM, lanczos_suits, sparse_modes
from strutwork.fea.sparse_reduction import reduce_sparse
from strutwork.fea.validity import warn_beyond
from strutwork.msa.assembly import System, system_of
from strutwork.msa.mass import mass_matrix, sparse_mass
from strutwork.msa.structure import PlacedStructure
from strutwork.outcome import Outcome, solve_poses
from strutwork.stages import stage

Array = NDArray[Any]
Method = Literal["dense", "sparse"]

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
        Displacement and rotation of every mesh node, mass-normalised: φᵀ M φ = 1; 1/√kg and
        rad/(√kg·m).
    effective_mass : (..., m, 6)
        Per direction x y z rx ry rz, rotations about the centre of mass; kg and kg·m².
    total_mass : (..., 6)
        Total mass three times, and the moments of inertia about the centre of mass: the sum
        that the effective masses of all modes reach when nothing is held, kg and kg·m². What
        moves with a support alone is in it and takes part in no mode.
    rigid_body_modes : (...) of int
    energy_parts : tuple of str
        Parts that store strain energy.
    energy_shares : (..., m, q)
        Share of each part in the strain energy of a mode; they add to one, zero for
        rigid-body modes. Under a preload the last part is its own share, below zero where it
        presses.
    note : str
        Empty, or that fewer modes exist than were asked for.
    solver : str
        Which eigenvalue solver ran, with its factorisation.
    outcome : Outcome
        Which poses were solved, and why others were not; the numbers of those are NaN and they
        have no rigid-body modes.
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
    solver: str = "dense"
    outcome: Outcome = field(default_factory=lambda: Outcome.good(()))

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


def modes(
    placed: PlacedStructure,
    count: int = 10,
    preload: Array | None = None,
    method: Method | None = None,
) -> Modes:
    """Lowest modes of a structure at a batch of poses.

    Parameters
    ----------
    placed : PlacedStructure
    count : int
        Number of modes, rigid-body modes included.
    preload : (..., s) or None
        Axial force in every beam element, N, tension positive, in place of the preload that
        `strutwork.fea.preloaded` takes from a load case.
    method : "dense" or "sparse", optional
        All modes by LAPACK, or the lowest by shift-invert Lanczos. Default: sparse for a single
        pose with more than `SPARSE_FROM` independent coordinates.

    Returns
    -------
    Modes
        All modes there are, and a note, where fewer exist than asked.

    Raises
    ------
    ModelError
        A count below one, no mass, every direction locked, a free motion without mass, an
        unknown method or one that does not suit.
    NumericalError
        A preload under which the structure buckles or falls; names the critical share of it.
    MechanismError
        The stiffness is not positive beside the rigid-body modes. As the one before, at the
        single pose or at all of a batch; else `outcome` marks the poses.

    Warns
    -----
    ValidityWarning
        A frequency above the limit of a superelement.
    """
    found = searched_modes(placed, count, preload, method)
    known = found.frequencies[np.isfinite(found.frequencies)]
    warn_beyond(placed, float(known.max(initial=0.0)))
    return found


def searched_modes(
    placed: PlacedStructure,
    count: int = 10,
    preload: Array | None = None,
    method: Method | None = None,
) -> Modes:
    """As `modes`, without a warning on superelements: for those who show some of the modes only.

    Returns and errors as `modes`.

    Parameters
    ----------
    placed : PlacedStructure
    count : int
        Number of modes, rigid-body modes included.
    preload : (..., s) or None
        Axial force in every beam element, N, tension positive.
    method : "dense" or "sparse", optional
    """
    if count < 1:
        raise ModelError("modes", f"{count} modes asked for.", "Request at least one.")
    if method not in (None, "dense", "sparse"):
        raise ModelError("modes", f'unknown method "{method}".', "Choose dense or sparse.")
    if preload is not None:
        placed = pulled(placed, np.asarray(preload, dtype=float))
    system = system_of(placed)
    asked, count = count, min(count, max(system.topology.forest.count, 1))
    every: list[Array] = []
    solvers: list[str] = []

    def run(part: NDArray[np.intp]) -> None:
        some = system_of(system.placed[part])
        some.placed.check()
        found, solver = _solve(some, count, method)
        if not every:
            every.extend(_missing(array, system.poses) for array in found)
        for whole, array in zip(every, found, strict=True):
            whole[part] = array
        solvers.append(solver)

    with stage(f"finds {count} modes of {system.topology.forest.count:,} coordinates"):
        outcome = solve_poses(run, system.poses).require_some()
    frequencies, shapes, effective, total, shares, rigid = every
    solver = solvers[0]
    exist = int(np.isfinite(frequencies).sum(axis=-1).max())
    note = ""
    if exist < asked:
        note = f"{asked} modes were requested, but only {exist} exist."
        frequencies, shapes = frequencies[:, :exist], shapes[:, :exist]
        effective, shares = effective[:, :exist], shares[:, :exist]
    if not np.all(np.isfinite(shapes[outcome.solved])):
        raise NumericalError("mode shapes", "are not finite.", "Check masses and stiffnesses.")
    batch = placed.batch
    # parts have the same names at every pose; at one without an answer they may have no numbers
    one = system_of(system.placed[np.flatnonzero(outcome.solved)[:1]])
    names = tuple(dict.fromkeys(name for name, _, _ in one.contributions()))
    if placed.stiffening is not None:
        names = (*names, PRELOAD)

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
        solver,
        outcome.reshaped(batch),
    )


def _missing(array: Array, poses: int) -> Array:
    """An array for all poses that says nothing yet."""
    empty = np.nan if array.dtype.kind == "f" else 0
    return np.full((poses, *array.shape[1:]), empty, dtype=array.dtype)


def _solve(system: System, count: int, method: Method | None) -> tuple[list[Array], str]:
    """Frequencies, shapes, effective masses, total mass, rigid-body modes, energy shares."""
    large = system.poses == 1 and system.topology.forest.count > SPARSE_FROM
    if method == "sparse" or (method is None and large):
        reduced = reduce_sparse(system)
        if method == "sparse" or lanczos_suits(reduced, count):
            found = sparse_modes(reduced, count)
            unknowns = (reduced.basis @ found.vectors)[None]
            rigid = np.array([reduced.rigid.shape[1]], dtype=np.intp)
            summary = _summary(system, unknowns, found.frequencies[None], sparse_mass(system))
            return [*summary, rigid], found.solver
    parts = []
    for start in range(0, system.poses, CHUNK):
        part = system_of(system.placed[start : start + CHUNK])
        dense = reduce_system(part)
        frequencies, vectors = lowest(solve_eigen(dense), count)
        summary = _summary(part, dense.basis @ vectors, frequencies, mass_matrix(part))
        parts.append([*summary, dense.rigid_count])
    return [np.concatenate(arrays) for arrays in zip(*parts, strict=True)], "dense"


def _summary(
    system: System, unknowns: Array, frequencies: Array, mass: Array | sp.csc_array
) -> list[Array]:
    shapes = np.moveaxis(system.expand(unknowns), -1, 1)
    effective, total = effective_mass(system, unknowns, mass)
    return [frequencies, shapes, effective, total, energy_shares(system, unknowns, frequencies)]


def lowest(eigen: Eigen, count: int) -> tuple[Array, Array]:
    """Frequencies, Hz, (p, count) and mass-normalised vectors (p, c, count), rigid ones first.

    Where a pose has fewer modes the frequency is infinite and the vector zero.

    Parameters
    ----------
    eigen : Eigen
    count : int
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
