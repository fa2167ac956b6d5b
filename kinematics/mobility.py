"""Mobility and redundancy of a linkage, from its constraint rows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinematics.joint import DIRECTIONS, State
from kinematics.linkage import Linkage
from kinematics.placement import Placement, check_coincidence
from kinematics.rows import (
    ConstraintRows,
    body_references,
    characteristic_length,
    constraint_rows,
)
from strutwork.errors import ModelError

Array = NDArray[Any]

#: Singular values below this share of the largest count as zero.
RANK_TOLERANCE = 1e-8


@dataclass(frozen=True)
class FreeMotion:
    """A motion that no joint resists.

    Parameters
    ----------
    twists : (b, 6)
        Twist of every moving body at its reference point; largest displacement scaled to one.
    nodes : (n, 6)
        Displacement and rotation of every node in that motion.
    joints : tuple of (joint name, direction)
        Joint directions that move.
    description : str
        The same in words.
    """

    twists: Array
    nodes: Array
    joints: tuple[tuple[str, str], ...]
    description: str


@dataclass(frozen=True)
class SelfStress:
    """A set of joint forces in balance without any load.

    Parameters
    ----------
    forces : mapping of (joint name, direction) to float
        N or N·m; the largest is one, moments compared at the characteristic length.
    joints : tuple of str
        The joints that take part.
    """

    forces: dict[tuple[str, str], float]
    joints: tuple[str, ...]


@dataclass(frozen=True)
class Mobility:
    """What `mobility` found.

    Parameters
    ----------
    mobility : int
        Degrees of freedom with the driven directions free.
    mobility_locked : int
        Degrees of freedom with the driven directions held.
    redundant : int
        Constraint rows beyond the rank, driven directions held.
    gruebler : int
        Grübler's count, bodies times six less rows, driven free: what a count without
        geometry would say.
    motions : tuple of FreeMotion
        A basis of the motions left when the drives are held.
    driven_motions : tuple of FreeMotion
        A basis of the motions with the drives free.
    self_stress : tuple of SelfStress
        A basis of the states of self-stress, drives held.
    """

    mobility: int
    mobility_locked: int
    redundant: int
    gruebler: int
    motions: tuple[FreeMotion, ...]
    driven_motions: tuple[FreeMotion, ...]
    self_stress: tuple[SelfStress, ...]

    def __repr__(self) -> str:
        return (
            f"<Mobility: {self.mobility} dof ({self.mobility_locked} with the drives held), "
            f"{self.redundant} redundant constraints, Grübler {self.gruebler}>"
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain numbers and strings."""
        return {
            "mobility": self.mobility,
            "mobility_locked": self.mobility_locked,
            "redundant_constraints": self.redundant,
            "gruebler": self.gruebler,
            "mechanisms": [m.description for m in self.motions],
            "self_stress_states": [list(s.joints) for s in self.self_stress],
        }


def mobility(linkage: Linkage, placement: Placement) -> Mobility:
    """Count and name the motions and the redundant constraints at one pose.

    The linkage is taken as rigid: elastic directions count as locked. Rank decides, not
    Grübler's count, so that linkages with special geometry come out right.

    Parameters
    ----------
    linkage : Linkage
    placement : Placement
        A single pose (no batch axes, or a batch of one).

    Returns
    -------
    Mobility

    Raises
    ------
    ModelError
        More than one pose, or joints whose nodes do not coincide.
    """
    placement = _single(placement)
    check_coincidence(linkage, placement)
    driven = linkage.driven_mask()
    resists = linkage.elastic_or_locked()
    length = characteristic_length(placement)
    held = constraint_rows(linkage, placement, resists)
    free = constraint_rows(linkage, placement, resists & ~driven)
    columns = 6 * len(linkage.body_names)
    held_rows, held_size = _scaled(held, length)
    rank_held, null_held, left = _spaces(held_rows)
    rank_free, null_free, _ = _spaces(_scaled(free, length)[0])
    states = linkage.states()
    return Mobility(
        mobility=columns - rank_free,
        mobility_locked=columns - rank_held,
        redundant=len(held) - rank_held,
        gruebler=columns - len(free),
        motions=free_motions(linkage, placement, null_held, length, states == State.FREE),
        driven_motions=free_motions(
            linkage, placement, null_free, length, (states == State.FREE) | driven
        ),
        self_stress=_self_stress(held, left, held_size, length),
    )


def free_motions(
    linkage: Linkage,
    placement: Placement,
    null: Array,
    length: float,
    moves: NDArray[np.bool_],
) -> tuple[FreeMotion, ...]:
    """Name the motions spanned by `null`, (6 b, k), whose rotations are scaled by `length`."""
    basis = sparse_basis(null)
    return tuple(
        _motion(linkage, placement, basis[:, k].reshape(-1, 6), length, moves)
        for k in range(basis.shape[1])
    )


def node_motion(linkage: Linkage, placement: Placement, twists: Array) -> Array:
    """Displacement and rotation of every node when the bodies move by `twists`, (n, 6)."""
    references = body_references(linkage, placement)
    result = np.zeros((len(linkage.nodes), 6))
    for i, body in enumerate(linkage.body_of_node):
        if body >= 0:
            arm = placement.positions[i] - references[body]
            result[i, :3] = twists[body, :3] + np.cross(twists[body, 3:], arm)
            result[i, 3:] = twists[body, 3:]
    return result


def sparse_basis(vectors: Array) -> Array:
    """Another basis of the columns' span with many zeros, so that parts can be told apart.

    Gauss-Jordan elimination with complete pivoting; each vector's largest entry is one.
    """
    rows = np.array(vectors.T, dtype=float)
    for k in range(len(rows)):
        pivot, j = divmod(int(np.abs(rows[k:]).argmax()), rows.shape[1])
        rows[[k, k + pivot]] = rows[[k + pivot, k]]
        rows[k] /= rows[k, j]
        others = np.arange(len(rows)) != k
        rows[others] -= np.outer(rows[others, j], rows[k])
    rows[np.abs(rows) < 1e-7] = 0.0
    largest = np.abs(rows).max(axis=1, initial=0.0)
    return np.asarray((rows / np.where(largest == 0, 1.0, largest)[:, None]).T)


def _single(placement: Placement) -> Placement:
    if placement.batch == ():
        return placement
    if np.prod(placement.batch) != 1:
        raise ModelError(
            "mobility", f"got {placement.batch} poses.", "Choose one pose: placement[i]."
        )
    return placement[(0,) * len(placement.batch)]


def _scaled(rows: ConstraintRows, length: float) -> tuple[Array, Array]:
    """Rows with rotations in units of displacement at `length`, of unit size; and their sizes."""
    matrix = rows.on_bodies().copy()
    matrix.reshape(len(rows), matrix.shape[1] // 6, 6)[..., 3:] /= length
    size = np.linalg.norm(matrix, axis=1)
    size = np.where(size == 0, 1.0, size)
    return matrix / size[:, None], size


def _spaces(matrix: Array) -> tuple[int, Array, Array]:
    """Rank, right null space (columns) and left null space (columns)."""
    if 0 in matrix.shape:
        return 0, np.eye(matrix.shape[1]), np.eye(matrix.shape[0])
    left, values, right = np.linalg.svd(matrix)
    rank = int(np.count_nonzero(values > RANK_TOLERANCE * values[0]))
    return rank, right[rank:].T, left[:, rank:]


def _motion(
    linkage: Linkage,
    placement: Placement,
    scaled: Array,
    length: float,
    moves: NDArray[np.bool_],
) -> FreeMotion:
    twists = scaled.copy()
    twists[:, 3:] /= length
    rows = constraint_rows(linkage, placement, moves)
    rates = rows.on_bodies() @ twists.ravel()
    size = np.where(rows.direction < 3, 1.0, length) * np.abs(rates)
    moving = size > 1e-6 * max(size.max(initial=0.0), 1e-30)
    named = tuple(
        (linkage.joints[j].name, DIRECTIONS[d])
        for j, d in zip(rows.joint[moving], rows.direction[moving], strict=True)
    )
    nodes = node_motion(linkage, placement, twists)
    bodies = [name for name, twist in zip(linkage.body_names, scaled, strict=True) if np.any(twist)]
    if named:
        listed = ", ".join(f"{joint} in {direction}" for joint, direction in named)
        text = f"moves at {listed}; bodies that move: {', '.join(bodies)}"
    else:
        text = f"no joint holds these bodies: {', '.join(bodies)}"
    return FreeMotion(twists, nodes, named, text)


def _self_stress(
    rows: ConstraintRows, left: Array, size: Array, length: float
) -> tuple[SelfStress, ...]:
    """States of self-stress from the left null space of rows divided by their sizes."""
    basis = sparse_basis(left)
    joints = rows.linkage.joints
    result = []
    for k in range(basis.shape[1]):
        column = basis[:, k] / size
        # moments are compared with forces at the arm `length`
        column = (
            column / np.where(rows.direction < 3, np.abs(column), np.abs(column) / length).max()
        )
        forces = {
            (joints[j].name, DIRECTIONS[d]): float(value)
            for value, j, d in zip(column, rows.joint, rows.direction, strict=True)
            if value
        }
        names = tuple(dict.fromkeys(joint for joint, _ in forces))
        result.append(SelfStress(forces, names))
    return tuple(result)
