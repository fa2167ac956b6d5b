"""Mobility and redundancy of a linkage, from its constraint rows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.joint import DIRECTIONS, State
from strutwork.kinematics.linkage import Linkage
from strutwork.kinematics.placement import Placement, check_coincidence
from strutwork.kinematics.rigid_graph import decompose
from strutwork.kinematics.rigid_spaces import rigid_graph, stress_states
from strutwork.kinematics.rows import (
    ConstraintRows,
    body_references,
    characteristic_length,
    constraint_rows,
)
from strutwork.kinematics.sparse_basis import sparse_basis

Array = NDArray[Any]

#: Singular values below this share of the largest count as zero.
RANK_TOLERANCE = 1e-8

#: Bodies or joints above which rank and null spaces are found block by block of the graph.
LARGE = 40


@dataclass(frozen=True)
class FreeMotion:
    """A motion that no joint resists.

    Parameters
    ----------
    twists : (b, 6)
        Twist of every moving body at its reference point, m and rad; largest displacement scaled to
        one.
    nodes : (n, 6)
        Displacement and rotation of every node in that motion, m and rad.
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
    """A set of joint forces in equilibrium without any load.

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
    """Result of `mobility`.

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
    large = max(len(linkage.body_names), len(linkage.joints)) > LARGE
    spaces = _large_spaces if large else _small_spaces
    rank_held, null_held, states = spaces(held, length, True)
    rank_free, null_free = rank_held, null_held
    if len(free) < len(held):
        rank_free, null_free, _ = spaces(free, length, False)
    loose = linkage.states() == State.FREE
    return Mobility(
        mobility=columns - rank_free,
        mobility_locked=columns - rank_held,
        redundant=len(held) - rank_held,
        gruebler=columns - len(free),
        motions=free_motions(linkage, placement, null_held, length, loose),
        driven_motions=free_motions(linkage, placement, null_free, length, loose | driven),
        self_stress=tuple(_stress(held, rows, values, length) for rows, values in states),
    )


#: A state of self-stress: indices of rows, and their multipliers.
_State = tuple[NDArray[np.intp], Array]


def _small_spaces(
    rows: ConstraintRows, length: float, stressed: bool
) -> tuple[int, Array, list[_State]]:
    """Rank, motions (6 b, k) with rotations scaled, and states of self-stress."""
    matrix, size = _scaled(rows, length)
    rank, null, left = _spaces(matrix)
    if not stressed:
        return rank, sparse_basis(null), []
    columns = sparse_basis(left).T / size
    return rank, sparse_basis(null), [(np.flatnonzero(c), c[c != 0]) for c in columns]


def _large_spaces(
    rows: ConstraintRows, length: float, stressed: bool
) -> tuple[int, Array, list[_State]]:
    """The same for a large linkage, block by block."""
    blocks = decompose(rigid_graph(rows, length))
    null = blocks.null(RANK_TOLERANCE)
    null[:, 3:] *= length
    null = null.reshape(-1, null.shape[-1]) if null.size else np.zeros((null.size, 0))
    null = null / np.abs(null).max(axis=0, initial=1e-300)
    found = stress_states(blocks, RANK_TOLERANCE) if stressed else []
    return blocks.rank(RANK_TOLERANCE), null, found


def free_motions(
    linkage: Linkage,
    placement: Placement,
    null: Array,
    length: float,
    moves: NDArray[np.bool_],
) -> tuple[FreeMotion, ...]:
    """Name motions by the joint directions that move in them.

    Parameters
    ----------
    linkage : Linkage
        With b moving bodies.
    placement : Placement
        One pose, without batch axes.
    null : (6 b, k)
        The motions as columns, (v, L ω) of the bodies about their reference points, m.
    length : float
        L, m.
    moves : (j, 6) of bool
        Joint directions by which they may be named.
    """
    rows = constraint_rows(linkage, placement, moves)
    return tuple(_motion(rows, null[:, k].reshape(-1, 6), length) for k in range(null.shape[1]))


def node_motion(linkage: Linkage, placement: Placement, twists: Array) -> Array:
    """Displacement and rotation of every node when the bodies move by `twists`, (n, 6).

    Parameters
    ----------
    linkage : Linkage
        With n nodes and b moving bodies.
    placement : Placement
        One pose, without batch axes.
    twists : (b, 6)
        Of the bodies about their reference points, m and rad.
    """
    owner = linkage.body_of_node
    moves = owner >= 0
    result = np.zeros((len(linkage.nodes), 6))
    own = twists[owner[moves]]
    arms = placement.positions[moves] - body_references(linkage, placement)[owner[moves]]
    result[moves, :3] = own[:, :3] + np.cross(own[:, 3:], arms)
    result[moves, 3:] = own[:, 3:]
    return result


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


def _motion(rows: ConstraintRows, scaled: Array, length: float) -> FreeMotion:
    """Name one motion by the rows that it moves."""
    linkage = rows.linkage
    twists = scaled.copy()
    twists[:, 3:] /= length
    nodes = node_motion(linkage, rows.placement, twists)
    pairs = rows.nodes
    rates = (rows.axes * (nodes[pairs[:, 1]] - nodes[pairs[:, 0]])).sum(axis=-1)
    owner = linkage.body_of_node[pairs]
    rates[owner[:, 0] == owner[:, 1]] = 0.0
    size = np.where(rows.direction < 3, 1.0, length) * np.abs(rates)
    moving = size > 1e-6 * max(size.max(initial=0.0), 1e-30)
    named = tuple(
        (linkage.joints[j].name, DIRECTIONS[d])
        for j, d in zip(rows.joint[moving], rows.direction[moving], strict=True)
    )
    bodies = [name for name, twist in zip(linkage.body_names, scaled, strict=True) if np.any(twist)]
    if named:
        listed = ", ".join(f"{joint} in {direction}" for joint, direction in named)
        text = f"moves at {listed}; bodies that move: {', '.join(bodies)}"
    else:
        text = f"no joint holds these bodies: {', '.join(bodies)}"
    return FreeMotion(twists, nodes, named, text)


def _stress(
    rows: ConstraintRows, index: NDArray[np.intp], values: Array, length: float
) -> SelfStress:
    """A state of self-stress by its joints; the largest force or moment over `length` is one."""
    joint, direction = rows.joint[index], rows.direction[index]
    # moments are compared with forces at the arm `length`
    size = np.where(direction < 3, np.abs(values), np.abs(values) / length).max(initial=1e-300)
    joints = rows.linkage.joints
    forces = {
        (joints[j].name, DIRECTIONS[d]): float(value / size)
        for value, j, d in zip(values, joint, direction, strict=True)
    }
    return SelfStress(forces, tuple(dict.fromkeys(name for name, _ in forces)))
