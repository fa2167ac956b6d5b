"""Independent constraint rows, and motions that cost no energy."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import InconsistentConstraintsError
from strutwork.kinematics import body_references, characteristic_lengths, constraint_rows
from strutwork.kinematics.mobility import LARGE, RANK_TOLERANCE
from strutwork.kinematics.rigid_graph import decompose
from strutwork.kinematics.rigid_spaces import rigid_graph
from strutwork.msa.assembly import System
from strutwork.msa.structure import rigid_map

Array = NDArray[Any]
T = TypeVar("T")

#: Misfits of redundant rows may disagree by this share of the largest.
CONSISTENCY = 1e-9


@dataclass(frozen=True)
class Rows:
    """Constraint rows made orthonormal, in scaled unknowns.

    With D the scales of the unknowns and `a` the rows of A D made of unit size, a = U S Vᵀ.

    Parameters
    ----------
    basis : (p, r, n)
        Vᵀ, no unit; zero where the rank of a pose is smaller.
    values : (p, r)
        S⁻¹, no unit; zero where the rank is smaller.
    left : (p, r, r)
        U, no unit.
    size : (p, r)
        Size of the rows of A D before scaling: no unit, or 1/m of a locked rotation.
    rank : (p,)
    """

    basis: Array
    values: Array
    left: Array
    size: Array
    rank: NDArray[np.intp]

    def __getitem__(self, poses: Any) -> Rows:
        """The rows of the poses of an index."""
        parts = (self.basis, self.values, self.left, self.size, self.rank)
        return Rows(*(part[poses] for part in parts))

    def right_side(self, gaps: Array) -> Array:
        """Right-hand side of the orthonormal rows, (p, r, m).

        Parameters
        ----------
        gaps : (p, r, m)
            Misfits of the rows of A, m and rad.
        """
        scaled = gaps / self.size[..., None]
        return np.asarray(self.values[..., None] * (np.swapaxes(self.left, -1, -2) @ scaled))

    def multipliers(self, reduced: Array) -> Array:
        """Multipliers of the rows of A, the least ones in balance with `reduced`, (p, r, m).

        Parameters
        ----------
        reduced : (p, r, m)
            Multipliers of the orthonormal rows, N.
        """
        return np.asarray(self.left @ (self.values[..., None] * reduced)) / self.size[..., None]


def of_lone(system: System, name: str, made: Callable[[System], T]) -> T | None:
    """What the placement alone decides, of the one pose that all are; None where they differ.

    Parameters
    ----------
    system : System
    name : str
        By which it is kept.
    made : callable
        Makes it of a system at one pose.
    """
    lone = system.lone
    if lone is None:
        return None
    # a frozen dataclass keeps derived data in its __dict__, as cached_property does
    kept = lone.__dict__
    if name not in kept:
        kept[name] = made(lone)
    found: T = kept[name]
    return found


def scales(system: System) -> Array:
    """Scales D of the unknowns, (p, n): one for translations, 1/length for rotations, 1/m.

    Every pose has its own length, so that the forces of redundant joints, which depend on it, do
    not depend on the other poses of a batch.

    Parameters
    ----------
    system : System
        At p poses, with n unknowns.
    """
    turn = np.repeat(1.0 / characteristic_lengths(system.placed.placement)[:, None], 3, axis=1)
    block = np.concatenate([np.ones_like(turn), turn], axis=1)
    return np.tile(block, (1, system.topology.size // 6))


def orthonormal_rows(system: System) -> Rows:
    """Rank of the constraint rows and an orthonormal basis of them, per pose.

    Rank is decided on rows of unit size, at `strutwork.kinematics.mobility.RANK_TOLERANCE`.

    Parameters
    ----------
    system : System
    """
    one = of_lone(system, "_rows", orthonormal_rows)
    if one is not None:
        return one[np.zeros(system.poses, dtype=np.intp)]
    scaled = system.rows * scales(system)[:, None]
    size = np.linalg.norm(scaled, axis=-1)
    size = np.where(size == 0, 1.0, size)
    scaled = scaled / size[..., None]
    poses, r, n = scaled.shape
    if r == 0:
        return Rows(
            scaled,
            np.zeros((poses, 0)),
            np.zeros((poses, 0, 0)),
            size,
            np.zeros(poses, dtype=np.intp),
        )
    left, values, right = np.linalg.svd(scaled, full_matrices=False)
    if left.shape[-1] < r:
        pad = r - left.shape[-1]
        left = np.concatenate([left, np.zeros((poses, r, pad))], axis=-1)
        values = np.concatenate([values, np.zeros((poses, pad))], axis=-1)
        right = np.concatenate([right, np.zeros((poses, pad, n))], axis=-2)
    keep = values > RANK_TOLERANCE * values[:, :1]
    inverse = np.divide(1.0, values, out=np.zeros_like(values), where=keep)
    return Rows(right * keep[..., None], inverse, left, size, keep.sum(axis=-1))


def check_consistent(system: System, rows: Rows, gaps: Array) -> None:
    """Check that misfits of redundant rows do not contradict one another.

    Parameters
    ----------
    system : System
    rows : Rows
        From `orthonormal_rows`.
    gaps : (p, r, m)
        Misfits of the rows of A, m and rad.

    Raises
    ------
    InconsistentConstraintsError
        Names the joints of the rigid loop that cannot close.
    """
    if not np.any(gaps):
        return
    scaled = gaps / rows.size[..., None]
    met = rows.left @ ((rows.values > 0)[..., None] * (np.swapaxes(rows.left, -1, -2) @ scaled))
    miss = np.abs(met - scaled).max(axis=-1)
    if miss.max(initial=0.0) <= CONSISTENCY * np.abs(scaled).max():
        return
    pose = int(miss.max(axis=-1).argmax())
    worst = np.flatnonzero(miss[pose] > 0.01 * miss[pose].max())
    labels = [system.row_labels[i] for i in worst]
    raise InconsistentConstraintsError(
        f"joints {', '.join(dict.fromkeys(label.split(':')[0] for label in labels))}",
        f"the misfits of {', '.join(labels)} cannot all be met: these joints close a rigid loop, "
        "and forcing it would take an infinite force.",
        "Give one of the joints or bodies in the loop its real stiffness, or drop the misfit.",
    )


def rigid_rows(system: System) -> Array:
    """Rows of the rigidified structure on the twists of its bodies, (p, r, 6 b), of unit size.

    One row for every joint direction that resists, in the order of `constraint_rows`, then one
    for every direction of a spring; rotations in units of displacement at the pose's
    `characteristic_length`.

    Parameters
    ----------
    system : System
        At p poses, with b bodies.
    """
    structure, placement = system.placed.structure, system.placed.placement
    linkage = structure.linkage
    bodies = len(linkage.body_names)
    length = characteristic_lengths(placement)[:, None, None, None]
    references = body_references(linkage, placement)
    rows = [constraint_rows(linkage, placement).on_bodies(references)]
    owner, index = linkage.body_of_node, linkage.node_index
    for spring in structure.springs:
        row = np.zeros((system.poses, 6, 6 * bodies))
        for node, sign in zip(reversed(spring.nodes), (1.0, -1.0), strict=False):
            i = index[node]
            b = owner[i]
            if b >= 0:
                arm = placement.positions[:, i] - references[:, b]
                row[:, :, 6 * b : 6 * b + 6] += sign * rigid_map(arm)
        axes = np.swapaxes(system.placed.spring_axes(spring), -1, -2)
        rows.append((axes @ row)[:, spring.diagonal > 0])
    matrix = np.concatenate(rows, axis=1)
    matrix.reshape(*matrix.shape[:2], bodies, 6)[..., 3:] /= length
    size = np.linalg.norm(matrix, axis=-1, keepdims=True)
    return np.asarray(matrix / np.where(size == 0, 1.0, size))


def free_unknowns(system: System) -> Array:
    """Motions that cost no energy and break no constraint, (p, n, k), orthonormal in D⁻¹u.

    Computed on the rigidified linkage: as only rigid motion of an element costs no energy, such a
    motion moves every body as one and no locked, elastic or sprung direction. k is the largest
    number over the poses; missing ones are zero columns.

    Parameters
    ----------
    system : System
        At p poses, with n unknowns.
    """
    one = of_lone(system, "_free", free_unknowns)
    if one is not None:
        return np.repeat(one, system.poses, axis=0)
    structure = system.placed.structure
    linkage = structure.linkage
    bodies = len(linkage.body_names)
    if bodies == 0:
        return np.zeros((system.poses, 0, 0))
    references = body_references(linkage, system.placed.placement)
    if system.poses == 1 and max(bodies, len(linkage.joints)) > LARGE:
        twists = _large_free_twists(system)
    else:
        twists = _free_twists(system)
    k = twists.shape[-1]
    if k == 0:
        return np.zeros((system.poses, system.topology.size, 0))
    result = np.zeros((system.poses, structure.vertex_count, 6, k))
    mesh_owner = _mesh_owner(system)
    for v, node in enumerate(structure.reference_nodes):
        b = mesh_owner[node]
        if b < 0:
            continue
        arm = system.placed.positions[:, node] - references[:, b]
        result[:, v] = rigid_map(arm) @ twists[:, b]
    scaled = result.reshape(system.poses, -1, k) / scales(system)[..., None]
    left, sizes, _ = np.linalg.svd(scaled, full_matrices=False)
    return np.asarray(left * (sizes > 1e-12 * np.maximum(sizes[:, :1], 1e-30))[:, None, :])


def _free_twists(system: System) -> Array:
    """Free motions as twists of the bodies about their references, (p, b, 6, k)."""
    length = characteristic_lengths(system.placed.placement)[:, None, None, None]
    matrix = rigid_rows(system)
    if matrix.shape[1] < matrix.shape[2]:
        gap = matrix.shape[2] - matrix.shape[1]
        matrix = np.concatenate([matrix, np.zeros((system.poses, gap, matrix.shape[2]))], axis=1)
    _, values, right = np.linalg.svd(matrix, full_matrices=False)
    free = values <= RANK_TOLERANCE * np.maximum(values[:, :1], 1e-30)
    k = int(free.sum(axis=-1).max(initial=0))
    first = matrix.shape[-1] - k
    twists = np.swapaxes(right[:, first:] * free[:, first:, None], -1, -2)
    twists = twists.reshape(system.poses, matrix.shape[-1] // 6, 6, k).copy()
    twists[:, :, 3:] /= length
    return np.asarray(twists)


def _large_free_twists(system: System) -> Array:
    """The same for a large linkage at one pose, block by block of its graph."""
    placed = system.placed
    linkage, placement = placed.structure.linkage, placed.placement[0]
    graph = rigid_graph(constraint_rows(linkage, placement), float(1.0 / system.turn_scale[0]))
    owner, index = linkage.body_of_node, linkage.node_index
    parts = [(graph.axes, graph.points, np.stack([graph.first, graph.second], axis=1))]
    for spring in placed.structure.springs:
        nodes = [index[n] for n in spring.nodes]
        axes = np.swapaxes(np.broadcast_to(placed[0].spring_axes(spring), (6, 6)), 0, 1)
        axes = axes[spring.diagonal > 0]
        pair = np.array([owner[nodes[0]] if len(nodes) == 2 else -1, owner[nodes[-1]]])
        ones = np.ones((len(axes), 1))
        parts.append((axes, ones * placement.positions[nodes[-1]], (ones * pair).astype(np.intp)))
    axes, points, ends = (np.concatenate(part) for part in zip(*parts, strict=True))
    whole = replace(graph, axes=axes, points=points, first=ends[:, 0], second=ends[:, 1])
    return decompose(whole).null(RANK_TOLERANCE)[None]


def _mesh_owner(system: System) -> NDArray[np.intp]:
    """Body of every mesh node; nodes inside a beam belong to its body."""
    structure = system.placed.structure
    linkage = structure.linkage
    owner = np.full(len(structure.mesh_nodes), -1, dtype=np.intp)
    owner[: len(linkage.nodes)] = linkage.body_of_node
    for beam, first, second in structure.segments:
        start = owner[linkage.node_index[structure.beams[beam].nodes[0]]]
        owner[[first, second]] = start
    return owner
