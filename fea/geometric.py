"""Geometric stiffness: what an axial force in a beam adds across it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import characteristic_lengths
from strutwork.msa.assembly import System, system_of
from strutwork.msa.beam import to_global
from strutwork.msa.solve import StaticSolution
from strutwork.msa.stiffening import Stiffening
from strutwork.msa.structure import PlacedStructure, rigid_map

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
        As `Beam.properties`: N, N·m² and m².

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
    """Mean axial force of every beam element in a load case, N, tension positive, (..., s).

    The mean of the two ends of the whole beam; `strutwork.fea.preloaded` takes what acts along it
    too.

    Parameters
    ----------
    solution : StaticSolution
    case : str
        One of its load cases.
    """
    if case not in solution.cases:
        raise ModelError("preload", f'no case "{case}".', "Cases: " + ", ".join(solution.cases))
    forces = solution.beam_forces[..., solution.cases.index(case)]
    mean = (forces[..., 1, 0] - forces[..., 0, 0]) / 2.0
    return np.asarray(mean[..., solution.placed.structure.segments[:, 0]])


def pulled(placed: PlacedStructure, axial: Array) -> PlacedStructure:
    """The structure with the geometric stiffness of given axial forces in its beams, and no more.

    Parameters
    ----------
    placed : PlacedStructure
    axial : (..., s)
        Axial force in every beam element, N, tension positive.

    Raises
    ------
    ModelError
        Axial forces of another number of elements, or not finite.
    """
    system = system_of(placed)
    structure = placed.structure
    if axial.shape[-1] != len(structure.segments):
        raise ModelError(
            "preload",
            f"has {axial.shape[-1]} axial forces for {len(structure.segments)} beam elements.",
            "Take it from fea.axial_forces of the same structure.",
        )
    if not np.all(np.isfinite(axial)):
        raise ModelError("preload", "is not finite.", "Give axial forces in N.")
    flat = np.broadcast_to(axial, (*placed.batch, axial.shape[-1])).reshape(system.poses, -1)
    length, _ = system.placed.beam_geometry
    beam = structure.segments[:, 0]
    pieces = np.array([b.elements for b in structure.beams], dtype=float)
    properties = np.moveaxis(placed.numbers.stiffness, -1, 0)
    local = local_geometric_stiffness((length / pieces)[:, beam], properties[..., beam])
    parts = segment_parts(system, local * flat[..., None, None])
    shaped = tuple((n, at, m.reshape((*placed.batch, 12, 12))) for n, at, m in parts)
    return replace(placed, stiffening=Stiffening("axial forces", shaped))


def segment_parts(system: System, local: Array) -> Iterator[tuple[str, NDArray[np.intp], Array]]:
    """Matrices of the beam elements at their mesh nodes.

    Yields the name, the mesh nodes (2,) and the matrix in global axes (p, 12, 12).

    Parameters
    ----------
    system : System
        At p poses, with s beam elements.
    local : (p, s, 12, 12)
        In local axes, N/m, N, N·m/rad.
    """
    placed, structure = system.placed, system.placed.structure
    _, axes = placed.beam_geometry
    parts = to_global(axes[:, structure.segments[:, 0]], local)
    offsets = placed.segment_offsets
    if np.any(offsets):
        carry = np.zeros((*offsets.shape[:-2], 12, 12))
        for k in (0, 1):
            carry[..., 6 * k : 6 * k + 6, 6 * k : 6 * k + 6] = rigid_map(offsets[..., k, :])
        parts = np.swapaxes(carry, -1, -2) @ parts @ carry
    for s, (beam_index, a, b) in enumerate(structure.segments):
        yield f"beam {structure.beams[beam_index].name}", np.array([a, b]), parts[:, s]


def geometric_stiffness(system: System) -> Array:
    """Geometric stiffness of a placed structure's preload on its unknowns, dense, (p, n, n).

    Parameters
    ----------
    system : System
        At p poses, with n unknowns.
    """
    matrix = np.zeros((system.poses, system.topology.size, system.topology.size))
    if system.placed.stiffening is not None:
        for _, nodes, part in system.placed.stiffening.contributions():
            system.add_part(matrix, nodes, part)
    return matrix


def largest_work(system: System) -> Array:
    """Largest entry of the geometric stiffness of any part, scaled unknowns, (p,), N/m.

    Parameters
    ----------
    system : System
        At p poses.
    """
    largest = np.zeros(system.poses)
    if system.placed.stiffening is not None:
        turn = 1.0 / characteristic_lengths(system.placed.placement)
        for _, nodes, part in system.placed.stiffening.contributions():
            scale = np.ones((system.poses, 6))
            scale[:, 3:] = turn[:, None]
            scale = np.tile(scale, len(nodes))
            size = np.abs(part) * scale[:, :, None] * scale[:, None, :]
            largest = np.maximum(largest, size.max(axis=(1, 2)))
    return largest
