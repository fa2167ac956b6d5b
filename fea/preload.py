"""Preload: the stiffness that the forces of a load case add to a structure."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import replace
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelWarning
from strutwork.fea.geometric import segment_parts
from strutwork.fea.geometric_beam import POINTS, beam_geometric_stiffness, gauss_points
from strutwork.fea.geometric_joints import (
    Part,
    cluster_parts,
    element_parts,
    joint_parts,
    spring_parts,
)
from strutwork.kinematics import DIRECTIONS
from strutwork.msa.assembly import System, system_of
from strutwork.msa.loads import LoadCase
from strutwork.msa.point_mass import mass_forces
from strutwork.msa.solve import Method, StaticSolution, solve
from strutwork.msa.stiffening import Stiffening
from strutwork.msa.structure import PlacedStructure
from strutwork.msa.undetermined import undetermined

Array = NDArray[Any]

#: A node, the force on it (p, 3) in global axes, and where beside it that acts, (3,) or (p, 3), m.
Force = tuple[str, Array, Array | tuple[float, float, float]]

#: A joint force below this share of the largest is none.
LOADED = 1e-9

#: Joints that a warning names before it only counts them.
NAMED = 8

NOWHERE = (0.0, 0.0, 0.0)


def preloaded(
    placed: PlacedStructure, case: LoadCase, method: Method | None = None
) -> PlacedStructure:
    """The structure with the geometric stiffness of a load case.

    The forces come from the linear static solution; their second-order work is the stiffness:
    of the section forces along every beam, of all forces on rigid bodies off their reference
    node, of joints whose axes turn, of springs. Loads keep their direction; moments turn half with
    what they act on, so that the stiffness is symmetric. Elements of other kinds stiffen as though
    rigid.

    Parameters
    ----------
    placed : PlacedStructure
        At a batch of poses.
    case : LoadCase
    method : str, optional
        Of `strutwork.msa.solve`.

    Returns
    -------
    PlacedStructure
        Its modes and frequency responses are those under the preload; its statics is unchanged.

    Raises
    ------
    StrutworkError
        As `strutwork.msa.solve`.

    Warns
    -----
    ModelWarning
        Rigid joints share a force of the case among themselves: names them.
    """
    bare = replace(placed, stiffening=None)
    system = system_of(bare)
    solution = solve(system.placed, [case], method)
    _warn_of_shared(system, solution, case)
    parts = tuple(_parts(system, solution, case))
    batch = placed.batch
    shaped = tuple((n, at, m.reshape((*batch, *m.shape[1:]))) for n, at, m in parts)
    return replace(placed, stiffening=Stiffening(case.name, shaped))


def _warn_of_shared(system: System, solution: StaticSolution, case: LoadCase) -> None:
    """Warn of preload forces that rigid parts leave open: stiffness would follow a mere choice."""
    forces = np.abs(solution.joint_forces[..., 0]).reshape(system.poses, -1, 6)
    if not forces.size:
        return
    largest = np.nanmax(forces, axis=(1, 2), initial=0.0)[:, None, None]
    open_ = undetermined(system.placed).reshape(forces.shape) & (forces > LOADED * largest)
    joints = system.placed.structure.linkage.joints
    shared = []
    for joint, row in zip(joints, open_.any(axis=0), strict=True):
        if row.any():
            names = (d for d, shares in zip(DIRECTIONS, row, strict=True) if shares)
            shared.append(f"{joint.name} in {', '.join(names)}")
    if not shared:
        return
    more = f" and {len(shared) - NAMED} more" if len(shared) > NAMED else ""
    warnings.warn(
        f"preload {case.name}: the forces of {'; '.join(shared[:NAMED])}{more} are not determined: "
        "rigid joints share them. The least forces in balance stiffen the structure, and the "
        "frequencies are those of this choice. Give these joints a stiffness or more freedom.",
        ModelWarning,
        stacklevel=3,
    )


def _parts(system: System, solution: StaticSolution, case: LoadCase) -> Iterator[Part]:
    displacements = solution.displacements[..., 0]
    joint_forces = solution.joint_forces[..., 0]
    if system.placed.structure.beams:
        yield from segment_parts(system, _beam_parts(system, solution, case))
    yield from joint_parts(system, joint_forces)
    yield from spring_parts(system, displacements)
    yield from element_parts(system, displacements)
    yield from cluster_parts(system, _moments(system, solution, case))


def _beam_parts(system: System, solution: StaticSolution, case: LoadCase) -> Array:
    """Geometric stiffness of the beam elements in local axes, (p, s, 12, 12).

    Section forces follow from those at the beam's first end and the loads along it by
    equilibrium, so that a divided beam is as many short ones.
    """
    structure = system.placed.structure
    length, axes = system.placed.beam_geometry
    beam = structure.segments[:, 0]
    pieces = np.array([b.elements for b in structure.beams])
    order = np.concatenate([np.arange(n) for n in pieces])
    first = solution.beam_forces[..., 0, :, 0]
    per_length = system.per_length_loads(case)
    loads = np.zeros((system.poses, len(structure.beams), 2, 3))
    if per_length is not None:
        loads = np.swapaxes(axes @ np.swapaxes(per_length, -1, -2), -1, -2)
    near, change = loads[:, :, 0], loads[:, :, 1] - loads[:, :, 0]
    forces = np.empty((system.poses, len(beam), POINTS, 6))
    for i, point in enumerate(gauss_points()[0]):
        x = length[:, beam] * ((order + point) / pieces[beam])
        share = (x / length[:, beam])[..., None]
        x = x[..., None]
        n = -first[:, beam, :3] - near[:, beam] * x - change[:, beam] * x * share / 2
        area = -first[:, beam, :3] * x - near[:, beam] * x**2 / 2
        area = area - change[:, beam] * x**2 * share / 6
        m = -first[:, beam, 3:]
        # m' = −e₁ × n
        m = m + np.stack([np.zeros_like(area[..., 0]), area[..., 2], -area[..., 1]], axis=-1)
        forces[:, :, i] = np.concatenate([n, m], axis=-1)
    properties = np.moveaxis(system.placed.numbers.stiffness, -1, 0)
    return beam_geometric_stiffness((length / pieces)[:, beam], properties[..., beam], forces)


def _moments(system: System, solution: StaticSolution, case: LoadCase) -> Array:
    """S = Σ f rᵀ of all forces on every cluster about its reference node, (p, v, 3, 3)."""
    structure = system.placed.structure
    index, vertex = structure.mesh_index, structure.vertex_of_node
    result = np.zeros((system.poses, structure.vertex_count + 1, 3, 3))
    forces = chain(
        _load_forces(system, case),
        _part_forces(system, solution),
        _element_forces(system, solution),
    )
    for name, force, offset in forces:
        node = index[name]
        arm = system.placed.arms[:, node] + np.asarray(offset)
        # ground's −1 is the row at the end, which nobody reads
        result[:, vertex[node]] += force[..., :, None] * arm[..., None, :]
    return result[:, :-1]


def _load_forces(system: System, case: LoadCase) -> Iterator[Force]:
    """Loads on nodes and masses; those along beams act through the beams' ends."""
    placed, structure = system.placed, system.placed.structure
    for node, wrench in case.wrenches:
        yield node, np.broadcast_to(np.asarray(wrench[:3]), (system.poses, 3)), NOWHERE
    if case.gravity is None:
        return
    pull = np.asarray(case.gravity, dtype=float)
    yield from mass_forces(placed, pull)
    for element in structure.elements:
        if hasattr(element, "mass"):
            fall = np.tile(np.append(pull, np.zeros(3)), len(element.nodes))
            weights = (element.mass(placed) @ fall).reshape(-1, len(element.nodes), 6)
            for i, name in enumerate(element.nodes):
                yield name, np.broadcast_to(weights[:, i, :3], (system.poses, 3)), NOWHERE


def _part_forces(system: System, solution: StaticSolution) -> Iterator[Force]:
    """Forces of beams and joints on their nodes."""
    structure = system.placed.structure
    for b, beam in enumerate(structure.beams):
        axes = system.placed.beam_geometry[1][:, b]
        for end in (0, 1):
            force = solution.beam_forces[:, b, end, :3, 0]
            offset = system.placed.beam_offsets[..., b, end, :]
            yield beam.nodes[end], -np.einsum("pij,pi->pj", axes, force), offset
    turned = (system.joint_frames @ solution.joint_forces[..., 0][..., None])[..., :3, 0]
    for j, joint in enumerate(structure.linkage.joints):
        for name, sign in zip(joint.between, (-1.0, 1.0), strict=True):
            yield name, sign * turned[:, j], NOWHERE


def _element_forces(system: System, solution: StaticSolution) -> Iterator[Force]:
    """Forces of springs and other elements on their nodes."""
    placed, structure = system.placed, system.placed.structure
    moved = solution.displacements[..., 0]
    index = structure.mesh_index
    for s, spring in enumerate(structure.springs):
        stretch = moved[:, index[spring.nodes[-1]], :3]
        if len(spring.nodes) == 2:
            stretch = stretch - moved[:, index[spring.nodes[0]], :3]
        turn = placed.spring_axes(spring)[..., :3, :3]
        k = placed.numbers.springs[..., s, None, :3]
        stiffness = turn * k @ np.swapaxes(turn, -1, -2)
        pull = (stiffness @ stretch[..., None])[..., 0]
        if len(spring.nodes) == 2:
            yield spring.nodes[0], pull, NOWHERE
        yield spring.nodes[-1], -pull, NOWHERE
    for element in structure.elements:
        nodes = [index[n] for n in element.nodes]
        u = moved[:, nodes].reshape(system.poses, -1, 1)
        pulls = (element.stiffness(placed) @ u).reshape(system.poses, len(nodes), 6)
        for i, name in enumerate(element.nodes):
            yield name, -pulls[:, i, :3], NOWHERE
