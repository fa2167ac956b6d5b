"""Leg-wise condensation: legs do not know each other, so each is eliminated on its own.

Of the joint coordinates, those that the tool or a loop-closing row touches are kept; without
them the others fall apart into legs. Each leg is condensed to the kept coordinates, and only
those are solved together.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from strutwork.msa.assembly import System, system_of
from strutwork.msa.constraints import check_consistent, free_unknowns, orthonormal_rows, scales
from strutwork.msa.diagnosis import check_held, mechanism_error
from strutwork.msa.null_space import (
    closing_rows,
    constrained_minimum,
    joint_coordinates,
    multipliers,
    symmetric_product,
)
from strutwork.msa.trust import Unknowns, solve_trusted

Array = NDArray[Any]


def legs_of(stiffness: Array, kept: NDArray[np.bool_]) -> list[NDArray[np.intp]]:
    """Groups of coordinates that fall apart when the kept ones are removed, (k,) each.

    Parameters
    ----------
    stiffness : (p, c, c)
        On joint coordinates, N/m, N, N·m/rad; only where it is zero matters.
    kept : (c,)
    """
    inner = np.flatnonzero(~kept)
    if not len(inner):
        return []
    coupled = np.any(stiffness[:, inner[:, None], inner] != 0, axis=0)
    count, label = connected_components(coupled, directed=False)
    return [inner[label == leg] for leg in range(count)]


def solve_condensed(system: System, load: Array, gaps: Array) -> Unknowns:
    """Condense every leg to the kept coordinates, solve those, and go back.

    Returns and errors as `solve_saddle_point`.

    Parameters
    ----------
    system : System
    load : (p, n, m)
        F on the unknowns, N and N·m.
    gaps : (p, r, m)
        g, the misfits of the constraint rows, m and rad.
    """
    rows = orthonormal_rows(system)
    check_consistent(system, rows, gaps)
    free = free_unknowns(system)
    check_held(system, free, load)
    d = scales(system)[..., None]
    basis, _ = joint_coordinates(system, gaps[..., :0])
    closing = closing_rows(system)
    a = system.rows[:, closing]
    still = np.swapaxes(free / d, -1, -2)
    extra = np.concatenate([a @ basis, still @ basis], axis=1)
    stiffness = symmetric_product(basis, system.stiffness)
    kept = np.any(extra != 0, axis=(0, 1)) | _at_tool(system, basis)
    legs = legs_of(stiffness, kept)

    def inverse(force: Array, gap: Array, poses: Any) -> tuple[Array, Array]:
        part = system if isinstance(poses, slice) else system_of(system.placed[poses])
        moved = joint_coordinates(part, gap)[1]
        target = np.concatenate([gap[:, closing] - a[poses] @ moved, -still[poses] @ moved], axis=1)
        turned = np.swapaxes(basis[poses], -1, -2) @ (force - part.stiffness @ moved)
        condensed = _Condensed(part, stiffness[poses], extra[poses], kept, legs)
        displacements = moved + basis[poses] @ condensed.coordinates(turned, target)
        return displacements, multipliers(part, displacements, force)

    return solve_trusted(system, inverse, load, gaps)


@dataclass(frozen=True)
class _Condensed:
    """Joint coordinates of a system in legs."""

    system: System
    stiffness: Array
    extra: Array
    kept: NDArray[np.bool_]
    legs: list[NDArray[np.intp]]

    def coordinates(self, force: Array, target: Array) -> Array:
        """Condense every leg to the kept coordinates, solve those, and go back."""
        stiffness, kept = self.stiffness, self.kept
        reduced, reduced_force = stiffness[:, kept][:, :, kept], force[:, kept]
        solved = []
        for leg in self.legs:
            coupling = stiffness[:, leg][:, :, kept]
            right = np.concatenate([coupling, force[:, leg]], axis=-1)
            inner = _scaled_solve(self.system, stiffness[:, leg[:, None], leg], right)
            split = coupling.shape[-1]
            solved.append((inner[..., :split], inner[..., split:]))
            reduced = reduced - np.swapaxes(coupling, -1, -2) @ inner[..., :split]
            reduced_force = reduced_force - np.swapaxes(coupling, -1, -2) @ inner[..., split:]
        found = np.zeros_like(force)
        if kept.any():
            reduced = (reduced + np.swapaxes(reduced, -1, -2)) / 2.0
            found[:, kept] = constrained_minimum(
                self.system, reduced, self.extra[:, :, kept], reduced_force, target
            )
        for leg, (coupled, alone) in zip(self.legs, solved, strict=True):
            found[:, leg] = alone - coupled @ found[:, kept]
        return found


def _at_tool(system: System, basis: Array) -> NDArray[np.bool_]:
    """Coordinates that move the tool's cluster or the workpiece's; without a tool none."""
    structure = system.placed.structure
    result = np.zeros(basis.shape[-1], dtype=bool)
    if structure.linkage.tool is None:
        return result
    tool = int(structure.vertex_of_node[structure.linkage.node_index[structure.linkage.tool]])
    for vertex in (tool, structure.workpiece_vertex):
        if vertex >= 0:
            result |= np.any(basis[:, 6 * vertex : 6 * vertex + 6] != 0, axis=(0, 1))
    return result


def _scaled_solve(system: System, matrix: Array, right: Array) -> Array:
    diagonal = np.einsum("pii->pi", matrix)
    if np.any(diagonal <= 0):
        raise mechanism_error(system, int(np.argwhere((diagonal <= 0).any(axis=1))[0][0]))
    scale = 1.0 / np.sqrt(diagonal)[..., None]
    k = matrix * scale * np.swapaxes(scale, -1, -2)
    try:
        np.linalg.cholesky(k)
        solution = np.linalg.solve(k, right * scale)
        solution += np.linalg.solve(k, right * scale - k @ solution)
    except np.linalg.LinAlgError as error:
        raise mechanism_error(system, int(np.linalg.eigvalsh(k)[:, 0].argmin())) from error
    return np.asarray(solution * scale)
