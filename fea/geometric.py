"""Geometric stiffness: what an axial force in a beam adds across it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from msa.assembly import System
from msa.beam import to_global
from msa.solve import StaticSolution
from msa.structure import rigid_map
from strutwork.errors import ModelError

Array = NDArray[Any]


def local_geometric_stiffness(length: Array, properties: Array) -> Array:
    """Geometric stiffness of beams per unit of axial force, tension positive, local axes.

    ∫ N' Nᵀ' dx with the static shape functions, which contain the shear flexibility Φ
    (Przemieniecki 1968, section 15.2), by four Gauss points, exact.

    Parameters
    ----------
    length : (...)
        m.
    properties : (6, ...)
        As `Beam.properties`.

    Returns
    -------
    stiffness : (..., 12, 12)
        1/m and the like.
    """
    result = np.zeros((*length.shape, 12, 12))
    points, weights = np.polynomial.legendre.leggauss(4)
    for v, r, shear, sign in ((1, 5, properties[5], 1.0), (2, 4, properties[4], -1.0)):
        phi = shear / length**2
        block = np.zeros((*length.shape, 4, 4))
        for x, weight in zip((points + 1) / 2, weights / 2, strict=True):
            slope = np.stack(
                [
                    (6 * x**2 - 6 * x - phi) / length,
                    1 - 4 * x + 3 * x**2 + phi / 2 * (1 - 2 * x),
                    (6 * x - 6 * x**2 + phi) / length,
                    3 * x**2 - 2 * x - phi / 2 * (1 - 2 * x),
                ],
                axis=-1,
            )
            share = (weight * length / (1 + phi) ** 2)[..., None, None]
            block += share * slope[..., :, None] * slope[..., None, :]
        dofs = np.array([v, r, v + 6, r + 6])
        signs = np.array([1.0, sign, 1.0, sign])
        result[..., dofs[:, None], dofs] = block * np.outer(signs, signs)
    return result


def axial_forces(solution: StaticSolution, case: str) -> Array:
    """Mean axial force of every beam element in a load case, N, tension positive, (..., s)."""
    if case not in solution.cases:
        raise ModelError("preload", f'no case "{case}".', "Cases: " + ", ".join(solution.cases))
    forces = solution.beam_forces[..., solution.cases.index(case)]
    mean = (forces[..., 1, 0] - forces[..., 0, 0]) / 2.0
    return np.asarray(mean[..., solution.placed.structure.segments[:, 0]])


def geometric_contributions(
    system: System, axial: Array
) -> Iterator[tuple[str, NDArray[np.intp], Array]]:
    """Geometric stiffness of the beam elements: name, mesh nodes (2,), (p, 12, 12).

    Parameters
    ----------
    system : System
    axial : (p, s)
        Axial force in every beam element, N, tension positive.

    Raises
    ------
    ModelError
        Axial forces of another number of elements, or not finite.
    """
    if axial.shape[1:] != (len(system.placed.structure.segments),):
        raise ModelError(
            "preload",
            f"has {axial.shape[-1]} axial forces for "
            f"{len(system.placed.structure.segments)} beam elements.",
            "Take it from fea.axial_forces of the same structure.",
        )
    if not np.all(np.isfinite(axial)):
        raise ModelError("preload", "is not finite.", "Give axial forces in N.")
    placed, structure = system.placed, system.placed.structure
    length, axes = placed.beam_geometry
    beam = structure.segments[:, 0]
    pieces = np.array([b.elements for b in structure.beams], dtype=float)
    properties = np.array([b.properties for b in structure.beams]).reshape(-1, 6).T
    local = local_geometric_stiffness((length / pieces)[:, beam], properties[:, beam])
    parts = to_global(axes[:, beam], local * axial[..., None, None])
    offsets = placed.segment_offsets
    if np.any(offsets):
        carry = np.zeros((*offsets.shape[:-2], 12, 12))
        for k in (0, 1):
            carry[..., 6 * k : 6 * k + 6, 6 * k : 6 * k + 6] = rigid_map(offsets[..., k, :])
        parts = np.swapaxes(carry, -1, -2) @ parts @ carry
    for s, (beam_index, a, b) in enumerate(structure.segments):
        yield f"beam {structure.beams[beam_index].name}", np.array([a, b]), parts[:, s]


def geometric_stiffness(system: System, axial: Array) -> Array:
    """Geometric stiffness of a structure on its unknowns, dense, (p, n, n).

    Parameters, errors as `geometric_contributions`.
    """
    matrix = np.zeros((system.poses, system.topology.size, system.topology.size))
    for _, nodes, part in geometric_contributions(system, axial):
        system.add_part(matrix, nodes, part)
    return matrix
