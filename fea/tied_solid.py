"""A solid with its interfaces: coordinates, ports and static solutions with given port motions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.linalg as sla
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import MechanismError, ModelError, NumericalError
from strutwork.fea.factorize import factorize
from strutwork.fea.interface import TiedPatch
from strutwork.msa.structure import rigid_map

Array = NDArray[Any]

#: Largest error of a static solution, as a share of its largest displacement.
RESIDUAL = 1e-6


@dataclass(frozen=True)
class TiedSolid:
    """Matrices of a solid on free coordinates, rigid patches and fixed nodes eliminated.

    Parameters
    ----------
    name : str
    points : (n, 3)
        Field nodes, m.
    patches : tuple of TiedPatch
        k of them.
    recovery : (3 n, c) sparse
        Displacements of the field nodes from the coordinates.
    stiffness, mass : (c, c) sparse
        N/m and kg.
    ports : (c, 6 k) sparse
        B, no unit and rad/m: motions of the interface nodes are Bᵀ times the coordinates, and B
        spreads forces on them.
    rigid : (c, r)
        Rigid motions that nothing holds, m and rad of any size.
    """

    name: str
    points: Array
    patches: tuple[TiedPatch, ...]
    recovery: sp.csr_array
    stiffness: sp.csc_array
    mass: sp.csc_array
    ports: sp.csc_array
    rigid: Array

    def __repr__(self) -> str:
        return (
            f"<TiedSolid {self.name}: {self.stiffness.shape[0]} coordinates, "
            f"{len(self.patches)} interfaces, {self.rigid.shape[1]} rigid motions>"
        )


def tied_solid(
    name: str,
    points: Array,
    stiffness: sp.csc_array,
    mass: sp.csc_array,
    patches: Sequence[TiedPatch],
    fixed: NDArray[np.intp] | None = None,
) -> TiedSolid:
    """Eliminate rigid patches and fixed degrees of freedom.

    Parameters
    ----------
    name : str
    points : (n, 3)
        m.
    stiffness, mass : (3 n, 3 n) sparse
        N/m and kg, of degree of freedom 3 node + component.
    patches : sequence of TiedPatch
    fixed : (f,), optional
        Degrees of freedom held at zero.

    Raises
    ------
    ModelError
        Two rigid patches with a node in common, or one with a fixed node.
    """
    n = len(points)
    held = np.zeros(3 * n, dtype=bool)
    if fixed is not None:
        held[fixed] = True
    rigid = [p for p in patches if p.interface.kind == "rigid"]
    owner: dict[int, str] = {}
    for patch in rigid:
        for node in patch.nodes.tolist():
            if node in owner:
                raise ModelError(
                    f"interface {patch.interface.name}",
                    f"shares a mesh node with the rigid interface {owner[node]}.",
                    "Keep rigid patches apart, or make one of them average.",
                )
            owner[node] = patch.interface.name
        if held[_dofs(patch.nodes)].any():
            raise ModelError(
                f"interface {patch.interface.name}",
                "has fixed mesh nodes on its rigid patch.",
                "Fix the interface's node instead, by a support.",
            )
    slaves = np.zeros(3 * n, dtype=bool)
    for patch in rigid:
        slaves[_dofs(patch.nodes)] = True
    plain = np.flatnonzero(~held & ~slaves)
    count = len(plain) + 6 * len(rigid)
    parts = [sp.csr_array((np.ones(len(plain)), (plain, np.arange(len(plain)))), (3 * n, count))]
    for i, patch in enumerate(rigid):
        rows = np.repeat(_dofs(patch.nodes), 6)
        there = np.tile(len(plain) + 6 * i + np.arange(6), 3 * len(patch.nodes))
        parts.append(sp.csr_array((patch.rigid.ravel(), (rows, there)), (3 * n, count)))
    recovery = sp.csr_array(sum(parts[1:], parts[0]))
    turned = sp.csr_array(recovery.T)
    place = {p.interface.name: len(plain) + 6 * i for i, p in enumerate(rigid)}
    columns = [
        _unit_columns(count, place[p.interface.name])
        if p.interface.name in place
        else turned @ _spread(p, n)
        for p in patches
    ]
    ports = sp.hstack(columns) if columns else sp.csc_array((count, 0))
    return TiedSolid(
        name,
        points,
        tuple(patches),
        recovery,
        _symmetric(turned @ stiffness @ recovery),
        _symmetric(turned @ mass @ recovery),
        sp.csc_array(ports),
        _rigid_motions(points, held, plain, rigid),
    )


class StaticSolver:
    """Displacements of a tied solid under forces, with the interface nodes' motions given.

    K u = f + B μ, Bᵀu = q. One factorisation of K, held in a statically determinate way where
    the solid floats; what rigid motion remains is a handful of unknowns beside μ.

    Parameters
    ----------
    solid : TiedSolid
    solver : str, optional
        Of `factorize`.

    Raises
    ------
    ModelError
        A floating solid without an interface.
    NumericalError
        A singular stiffness.
    """

    def __init__(self, solid: TiedSolid, solver: str | None = None) -> None:
        self.solid = solid
        size, r = solid.rigid.shape
        if r and solid.ports.shape[1] == 0:
            raise ModelError(
                f"solid {solid.name}", "floats and has no interface.", "Give it an interface."
            )
        self._kept = _without(size, _determinate(solid.rigid))
        factor = factorize(sp.csc_array(solid.stiffness[self._kept][:, self._kept]), solver=solver)
        self.name = factor.name
        self._factor = factor
        self._attached = self._flexible(solid.ports.toarray())
        contact = solid.ports.T @ solid.rigid
        flexibility = solid.ports.T @ self._attached
        k = solid.ports.shape[1]
        matrix = np.zeros((k + r, k + r))
        # forces μ in units that make the flexibility of order one
        self._unit = 1.0 / max(float(np.abs(flexibility).max(initial=0.0)), 1e-300)
        matrix[:k, :k] = flexibility * self._unit
        matrix[:k, k:] = contact
        matrix[k:, :k] = contact.T
        self._small = sla.lu_factor(matrix) if k + r else None

    def _flexible(self, forces: Array) -> Array:
        result = np.zeros_like(forces)
        result[self._kept] = self._factor.solve(np.ascontiguousarray(forces[self._kept]))
        return result

    def solve(self, forces: Array, motions: Array | None = None) -> tuple[Array, Array]:
        """Displacements (c, m) and interface forces μ (6 k, m).

        Parameters
        ----------
        forces : (c, m)
            f, N.
        motions : (6 k, m), optional
            q, m and rad; default zero.
        """
        solid = self.solid
        k, r = solid.ports.shape[1], solid.rigid.shape[1]
        moved = self._flexible(forces)
        right = np.zeros((k + r, forces.shape[1]))
        right[:k] = -(solid.ports.T @ moved)
        if motions is not None:
            right[:k] += motions
        if self._small is None:
            return moved, right[:0]
        # the rigid block was left unscaled: forces are in units of `_unit`
        right[k:] = -(solid.rigid.T @ forces) / self._unit
        answer = sla.lu_solve(self._small, right)
        pushes = answer[:k] * self._unit
        return moved + self._attached @ pushes + solid.rigid @ answer[k:], pushes

    def constraint_modes(self) -> Array:
        """Displacements for a unit motion of every interface freedom, the others held, (c, 6 k).

        Raises
        ------
        NumericalError
            Solutions that are not certain to `RESIDUAL`.
        """
        solid = self.solid
        k = solid.ports.shape[1]
        shapes, pushes = self.solve(np.zeros((solid.stiffness.shape[0], k)), np.eye(k))
        # what is left of the balance, solved for again, is the error
        left = solid.ports @ pushes - solid.stiffness @ shapes
        correction, _ = self.solve(left)
        error = np.abs(correction).max(axis=0, initial=0.0)
        largest = np.abs(shapes).max(axis=0, initial=0.0)
        if not np.all(error <= RESIDUAL * largest):
            raise NumericalError(
                f"solid {solid.name}",
                f"its static solutions are accurate to {float(np.max(error / largest)):.2g} only.",
                "Check for badly shaped cells or stiffnesses that differ too much.",
            )
        return np.asarray(shapes + correction)


def _dofs(nodes: NDArray[np.intp]) -> NDArray[np.intp]:
    return np.asarray((3 * nodes[:, None] + np.arange(3)).ravel(), dtype=np.intp)


def _spread(patch: TiedPatch, n: int) -> sp.csr_array:
    """Forces on the mesh from a wrench at the node, (3 n, 6)."""
    rows = np.tile(_dofs(patch.nodes), 6)
    columns = np.repeat(np.arange(6), 3 * len(patch.nodes))
    return sp.csr_array((patch.average.ravel(), (rows, columns)), (3 * n, 6))


def _unit_columns(count: int, start: int) -> sp.csr_array:
    """Six unit columns from coordinate `start` on."""
    return sp.csr_array((np.ones(6), (start + np.arange(6), np.arange(6))), (count, 6))


def _symmetric(matrix: sp.csr_array) -> sp.csc_array:
    return sp.csc_array((matrix + matrix.T) / 2)


def _rigid_motions(
    points: Array, held: NDArray[np.bool_], plain: NDArray[np.intp], rigid: list[TiedPatch]
) -> Array:
    """Rigid motions of the coordinates that fixed nodes allow, (c, r), of size one."""
    centre = points.mean(axis=0)
    length = max(float(np.linalg.norm(points - centre, axis=1).max()), 1e-300)
    size = np.array([1.0] * 3 + [1.0 / length] * 3)
    every = rigid_map(points - centre)[:, :3].reshape(-1, 6) * size
    basis = np.eye(6)
    if held.any():
        _, values, right = np.linalg.svd(every[held], full_matrices=True)
        values = np.concatenate([values, np.zeros(6 - len(values))])
        basis = right[values <= 1e-9 * values[0]].T
    whole = np.concatenate(
        [every[plain], *(rigid_map(p.position - centre) * size for p in rigid)], axis=0
    )
    return np.asarray(whole @ basis)


def _determinate(rigid: Array) -> NDArray[np.intp]:
    """Coordinates that hold the rigid motions just once, by pivoting."""
    r = rigid.shape[1]
    if r == 0:
        return np.zeros(0, dtype=np.intp)
    _, corner, pivots = sla.qr(rigid.T, mode="economic", pivoting=True)
    if abs(corner[-1, r - 1]) < 1e-9 * abs(corner[0, 0]):
        raise MechanismError(
            "solid", "its rigid motions cannot be distinguished.", "Check that it is not one point."
        )
    return np.asarray(pivots[:r], dtype=np.intp)


def _without(size: int, dropped: NDArray[np.intp]) -> NDArray[np.intp]:
    keep = np.ones(size, dtype=bool)
    keep[dropped] = False
    return np.flatnonzero(keep)
