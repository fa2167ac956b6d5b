"""Directions in which the locked joints let the tool move.

The compliance at the tool is a sum over the elastic parts. Whatever their stiffness, its range
is the set of twists that the locked directions allow: T N, with N the null space of the
constraint rows and T the map to the tool. So the rank of the compliance is a matter of geometry,
and is decided where the rows are, not from digits of the compliance.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.csgraph import connected_components

from strutwork.errors import ModelError
from strutwork.kinematics.mobility import RANK_TOLERANCE
from strutwork.kinematics.placement import COINCIDENCE
from strutwork.msa.assembly import System, system_of

Array = NDArray[Any]

#: Entries of a projector that are smaller are rounding: translation and rotation do not couple.
UNCOUPLED = 1e-12


@dataclass(frozen=True)
class MovableDirections:
    """Twists of the tool that the locked directions permit.

    Parameters
    ----------
    basis : (p, 6, 6)
        Orthonormal columns in scaled twists, m, rotations multiplied by `length`; zero columns
        where a pose has fewer.
    length : (p,)
        m; reach of the joints that hold the tool.
    """

    basis: Array
    length: Array

    def __repr__(self) -> str:
        return f"<MovableDirections: {len(self.length)} poses, ranks {np.unique(self.rank)}>"

    def __getitem__(self, index: Any) -> MovableDirections:
        """The poses selected by `index`."""
        return MovableDirections(self.basis[index], self.length[index])

    @property
    def rank(self) -> NDArray[np.intp]:
        """Number of independent directions, (p,)."""
        return np.asarray(np.any(self.basis, axis=1).sum(axis=-1), dtype=np.intp)

    @property
    def scale(self) -> Array:
        """Scaled twist per twist, (p, 6)."""
        return twist_scale(self.length)

    def working_part(self, wrench: Array) -> Array:
        """The part of a wrench that can do work, (p, 6); the joints take the rest alone.

        Parameters
        ----------
        wrench : (6,)
            At the tool, N and N·m.
        """
        scaled = wrench / self.scale
        kept = np.einsum("pik,pk->pi", self.basis, np.einsum("pik,pi->pk", self.basis, scaled))
        size = np.linalg.norm(scaled, axis=-1, keepdims=True)
        idle = np.linalg.norm(kept, axis=-1, keepdims=True) <= UNCOUPLED * size
        return np.asarray(np.where(idle, 0.0, kept) * self.scale)

    def projected(self, compliance: Array) -> Array:
        """Compliance without what rounding adds in directions that cannot move, (p, 6, 6).

        Formed as a Gram product, so that what rounding is left in an entry is small beside its own
        row and column, not only beside the largest entry.

        Parameters
        ----------
        compliance : (p, 6, 6)
            At the tool, m/N, 1/N, rad/(N·m).
        """
        outer = self.scale[:, :, None] * self.scale[:, None, :]
        core = np.swapaxes(self.basis, -1, -2) @ (compliance * outer) @ self.basis
        values, vectors = np.linalg.eigh((core + np.swapaxes(core, -1, -2)) / 2.0)
        factor = self.basis @ (vectors * np.sqrt(np.maximum(values, 0.0))[:, None, :])
        factor = factor / self.scale[:, :, None]
        return np.asarray(factor @ np.swapaxes(factor, -1, -2))


def twist_scale(length: Array) -> Array:
    """Scales of a twist, (..., 6): one for translations, `length` for rotations.

    Parameters
    ----------
    length : (...)
        m.
    """
    turn = np.asarray(length, dtype=float)[..., None]
    return np.concatenate([np.ones((*turn.shape[:-1], 3)), np.repeat(turn, 3, axis=-1)], axis=-1)


def movable_directions(system: System) -> MovableDirections:
    """Find the twists that the locked directions leave the tool, at every pose.

    Only the rows that reach the tool over rigid clusters matter: a beam or an elastic joint
    between two clusters lets them move apart.

    Parameters
    ----------
    system : System
        With a tool.

    Returns
    -------
    MovableDirections
    """
    length = tool_length(system)
    held = _holding(system)
    basis = np.zeros((system.poses, 6, 6))
    if held.vertex < 0 and held.work < 0:
        return MovableDirections(basis, length)
    if not held.rows.size:
        return MovableDirections(basis + np.eye(6), length)
    rows = (
        _local_rows(system, held) / np.tile(twist_scale(length), (1, len(held.vertices)))[:, None]
    )
    size = np.linalg.norm(rows, axis=-1, keepdims=True)
    rows = rows / np.where(size == 0, 1.0, size)
    _, values, right = np.linalg.svd(rows, full_matrices=False)
    right = right * (values > RANK_TOLERANCE * values[:, :1])[..., None]
    if held.work < 0:
        at = 6 * int(np.searchsorted(held.vertices, held.vertex))
        # rows of the projector on what the constraints allow that belong to the tool
        allowed = -np.swapaxes(right[..., at : at + 6], -1, -2) @ right
        allowed[:, range(6), range(at, at + 6)] += 1.0
    else:
        moves = _relative(system, held, length)
        allowed = moves - (moves @ np.swapaxes(right, -1, -2)) @ right
    left, moved, _ = np.linalg.svd(allowed, full_matrices=False)
    basis = left * (moved > RANK_TOLERANCE)[:, None, :]
    return MovableDirections(_uncoupled(basis), length)


def _relative(system: System, held: _Holding, length: Array) -> Array:
    """The tool's scaled twist relative to the workpiece by those of the clusters, (p, 6, 6 v)."""
    load = system.tool_load()
    scale = twist_scale(length)
    result = np.zeros((system.poses, len(held.vertices), 6, 6))
    for vertex in (held.vertex, held.work):
        if vertex >= 0:
            own = np.swapaxes(load[:, 6 * vertex : 6 * vertex + 6], -1, -2)
            at = int(np.searchsorted(held.vertices, vertex))
            result[:, at] = scale[:, :, None] * own / scale[:, None, :]
    return np.moveaxis(result, 1, 2).reshape(system.poses, 6, -1)


def tool_length(system: System) -> Array:
    """Length that makes rotations of the tool comparable with its translations, (p,), m.

    The farthest joint or rigid cluster that holds the tool; where all stand at the tool itself,
    translations and rotations do not mix and any length does.

    Parameters
    ----------
    system : System
        At p poses.
    """
    held = _holding(system)
    structure = system.placed.structure
    positions = system.placed.positions
    if max(held.vertex, held.work) < 0 or not held.rows.size:
        return np.ones(system.poses)
    joint, _ = system.row_owner
    index, joints = structure.linkage.node_index, structure.linkage.joints
    nodes = {index[joints[j].between[0]] for j in joint[held.rows]}
    nodes |= {int(structure.reference_nodes[v]) for v in held.vertices}
    tool = positions[:, structure.mesh_index[str(structure.linkage.tool)]]
    reach = np.linalg.norm(positions[:, sorted(nodes)] - tool[:, None], axis=-1).max(axis=-1)
    return np.asarray(np.where(reach > COINCIDENCE, reach, 1.0))


def always_movable(system: System) -> bool:
    """Whether the tool can move in all six directions at every pose, whatever the coordinates.

    True where the clusters that rows join to the tool form a tree without ground: then no row
    can depend on another, and the tool may go anywhere with the others following. Relative to a
    workpiece either of the two may be the one that can go anywhere, if no row joins them.

    Parameters
    ----------
    system : System
    """
    held = _holding(system)
    if held.work < 0:
        return _goes_anywhere(system, held)
    sides = [_held_at(system, vertex) for vertex in (held.vertex, held.work)]
    if held.vertex in sides[1].vertices:
        return False
    return any(_goes_anywhere(system, side) for side in sides)


def _goes_anywhere(system: System, held: _Holding) -> bool:
    if held.vertex < 0:
        return False
    pairs = _row_vertices(system)[held.rows]
    if pairs.shape[1] > 2 or np.any(pairs < 0):
        return False
    edges = {(int(min(p)), int(max(p))) for p in pairs if p[0] != p[1]}
    joints = {int(j) for j in system.row_owner[0][held.rows]}
    return len(edges) == len(joints) == len(held.vertices) - 1


@dataclass(frozen=True)
class _Holding:
    """The tool's cluster, clusters that rows join to it (sorted), those rows, the workpiece's."""

    vertex: int
    vertices: NDArray[np.intp]
    rows: NDArray[np.intp]
    work: int = -1


def _row_vertices(system: System) -> NDArray[np.intp]:
    """Clusters that every constraint row joins, (r, k), −1 for ground.

    Of one pose: the rows of a million would take gigabytes, and join the same clusters.
    """
    one = system if system.poses <= 1 else system_of(system.placed[:1])
    return one.row_blocks[0]


def _holding(system: System) -> _Holding:
    structure = system.placed.structure
    if structure.linkage.tool is None:
        raise ModelError("structure", "has no tool.", "Name the tool centre point's node.")
    vertex = int(structure.vertex_of_node[structure.mesh_index[structure.linkage.tool]])
    return _held_at(system, vertex, structure.workpiece_vertex)


def _held_at(system: System, vertex: int, work: int = -1) -> _Holding:
    structure = system.placed.structure
    moving = [v for v in (vertex, work) if v >= 0]
    if not moving:
        none = np.zeros(0, dtype=np.intp)
        return _Holding(vertex, none, none)
    pairs = _row_vertices(system)
    # one after another: a row that ties two joints joins the clusters of both
    chains = [pairs[:, [0, k]] for k in range(1, pairs.shape[1])] + [pairs[:, -2:]]
    inner = np.concatenate(chains)
    inner = inner[(inner >= 0).all(axis=1)]
    count = structure.vertex_count
    links = sp.coo_array((np.ones(len(inner)), (inner[:, 0], inner[:, 1])), shape=(count, count))
    _, label = connected_components(links, directed=False)
    vertices = np.flatnonzero(np.isin(label, label[moving]))
    # a row inside one cluster holds nothing
    acts = (pairs[:, ::2] != pairs[:, 1::2]).any(axis=1)
    rows = np.flatnonzero(np.isin(pairs, vertices).any(axis=1) & acts)
    return _Holding(vertex, vertices, rows, work)


def _local_rows(system: System, held: _Holding) -> Array:
    """The rows that hold the tool, on its clusters alone, (p, r, 6 v)."""
    pairs, values = system.row_blocks
    at = np.searchsorted(held.vertices, pairs[held.rows])
    result = np.zeros((system.poses, len(held.rows), len(held.vertices), 6))
    for side in range(pairs.shape[1]):
        moving = np.flatnonzero(pairs[held.rows, side] >= 0)
        result[:, moving, at[moving, side]] += values[:, held.rows[moving], side]
    return result.reshape(system.poses, len(held.rows), -1)


def _uncoupled(basis: Array) -> Array:
    """The basis with translations and rotations apart where they do not mix.

    Rounding would else leave a trace of translation in a pure rotation; beside nothing it looks
    like a motion of its own.
    """
    projector = basis @ np.swapaxes(basis, -1, -2)
    mixed = np.abs(projector[:, :3, 3:]).max(axis=(1, 2)) > UNCOUPLED
    apart = np.zeros_like(basis)
    for block in (slice(0, 3), slice(3, 6)):
        values, vectors = np.linalg.eigh(projector[:, block, block])
        apart[:, block, block] = vectors * (values > 0.5)[:, None, :]
    return np.where(mixed[:, None, None], basis, apart)
