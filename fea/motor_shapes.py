"""Motors of drives: where they push, and the shape the structure takes when one has moved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import isfinite
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.ports import STILL
from strutwork.fea.reduction import AllLockedError, Reduced, reduce_system
from strutwork.kinematics import DIRECTIONS, Joint, State
from strutwork.msa.assembly import System, system_of
from strutwork.msa.structure import PlacedStructure, rigid_map
from strutwork.names import choices

Array = NDArray[Any]


@dataclass(frozen=True)
class Motor:
    """The motor of one driven joint direction, its inertia brought to the joint.

    Where the direction has a stiffness, that is the transmission between motor and joint; else
    the motor turns with the joint.

    Parameters
    ----------
    joint, direction : str
    inertia : float
        Of the motor and what turns with it, at the joint: kg, or kg·m² of a rotation.

    Raises
    ------
    ModelError
        A negative inertia.
    """

    joint: str
    direction: str
    inertia: float = 0.0

    def __post_init__(self) -> None:
        if not (isfinite(self.inertia) and self.inertia >= 0):
            raise ModelError(
                f"motor {self}", f"has the inertia {self.inertia!r}.", "Give zero or more."
            )

    def __str__(self) -> str:
        return f"{self.joint}:{self.direction}"


def motor_rows(system: System, motors: Sequence[Motor]) -> tuple[Array, Array]:
    """Motion of the joints by the unknowns, (q, n), and stiffnesses of the transmissions, (q,).

    The stiffness is zero where motor and joint are one, N/m or N·m/rad.

    Parameters
    ----------
    system : System
        At one pose.
    motors : sequence of q Motor

    Raises
    ------
    ModelError
        An unknown joint, a direction that is not driven, one named twice.
    """
    linkage = system.placed.structure.linkage
    rows = np.zeros((len(motors), system.topology.size))
    springs = np.zeros(len(motors))
    seen: set[tuple[str, str]] = set()
    for i, motor in enumerate(motors):
        joint = _driven(linkage.joints, motor)
        if (motor.joint, motor.direction) in seen:
            raise ModelError(f"motor {motor}", "is named twice.", "Name each drive once.")
        seen.add((motor.joint, motor.direction))
        axis = DIRECTIONS.index(motor.direction)
        along = system.joint_frames[0, linkage.joint_index[motor.joint]][:, axis]
        first, second = (node_row(system, node, along) for node in joint.between)
        rows[i] = second - first
        if joint.states[axis] is State.ELASTIC:
            springs[i] = joint.stiffness_matrix[axis, axis]
    return rows, springs


def node_row(system: System, node: str, direction: Array) -> Array:
    """Motion of a node along a direction by the unknowns, (n,).

    Parameters
    ----------
    system : System
        At one pose.
    node : str
        A mesh node.
    direction : (6,)
        Global axes, no unit.

    Raises
    ------
    ModelError
        An unknown node.
    """
    structure = system.placed.structure
    if node not in structure.mesh_index:
        raise ModelError(f"node {node}", "is not in the structure.", "Name one of its nodes.")
    index = structure.mesh_index[node]
    row = np.zeros(system.topology.size)
    vertex = structure.vertex_of_node[index]
    if vertex >= 0:
        row[6 * vertex : 6 * vertex + 6] = direction @ rigid_map(system.placed.arms[0, index])
    return row


def _driven(joints: Sequence[Joint], motor: Motor) -> Joint:
    known = {joint.name: joint for joint in joints}
    drives = [f"{j.name}:{d}" for j in joints for d in j.driven]
    if motor.joint not in known:
        raise ModelError(
            f"motor {motor}",
            f'names the unknown joint "{motor.joint}".',
            choices("Drives", str(motor), drives),
        )
    joint = known[motor.joint]
    if motor.direction not in joint.driven:
        raise ModelError(
            f"motor {motor}",
            "is in a direction that is not driven.",
            f'Add driven = ["{motor.direction}"] to the joint. {choices("Drives", "", drives)}',
        )
    if joint.matrix is not None:
        raise ModelError(
            f"motor {motor}",
            "drives a bushing with a full matrix: its transmission is not one spring.",
            "Give the joint a stiffness by direction, and the matrix to a bushing beside it.",
        )
    return joint


def free_shapes(placed: PlacedStructure, motors: Sequence[Motor]) -> Array | None:
    """Shapes (n, q) without strain in which one motor has moved by one unit and the others stand.

    None where the structure does not move so: it braces its drives, or they one another.

    Parameters
    ----------
    placed : PlacedStructure
        One pose.
    motors : sequence of q Motor
    """
    try:
        reduced = _released(placed, motors)
    except AllLockedError:
        return None
    rows, _ = motor_rows(system_of(placed), motors)
    basis, rigid = reduced.basis[0], reduced.rigid[0]
    shape, missing = _without_strain(rows @ (basis @ rigid), rigid)
    return None if np.abs(missing).max() > STILL else np.asarray(basis @ shape)


def strained_shapes(placed: PlacedStructure, motors: Sequence[Motor]) -> Array:
    """As `free_shapes`, (n, q), with some strain where it must be.

    Parameters
    ----------
    placed : PlacedStructure
        One pose.
    motors : sequence of q Motor
        Whose directions have no stiffness.

    Raises
    ------
    ModelError
        Motors that cannot move one by one.
    """
    try:
        reduced = _released(placed, motors)
    except AllLockedError as error:
        raise ModelError(
            f"motor {motors[0]}",
            "moves nothing: the structure is locked even if the drive is released.",
            "Check the joints and supports beside it.",
        ) from error
    rows, _ = motor_rows(system_of(placed), motors)
    basis, rigid = reduced.basis[0], reduced.rigid[0]
    shape, missing = _without_strain(rows @ (basis @ rigid), rigid)
    diagonal = np.einsum("ii->i", reduced.stiffness[0])
    scale = 1.0 / np.sqrt(np.where(diagonal > 0, diagonal, diagonal.max(initial=1.0)))
    pushed = np.linalg.pinv((rows @ basis) * scale, rcond=STILL)
    shape = shape + scale[:, None] * (pushed @ missing)
    left = np.abs(rows @ (basis @ shape) - np.eye(len(motors)))
    if left.max() > 1e-6:
        worst = motors[int(left.max(axis=0).argmax())]
        raise ModelError(
            f"motor {worst}",
            "cannot move while the other motors stand: the drives hold one another.",
            "Give the redundant drives a stiffness in their driven directions: that of their "
            "transmissions.",
        )
    return np.asarray(basis @ shape)


def _without_strain(moved: Array, rigid: Array) -> tuple[Array, Array]:
    """Rigid-body motions that move one motor each, and what they leave of its unit."""
    free = np.linalg.pinv(moved, rcond=STILL) if moved.size else np.zeros(moved.T.shape)
    return rigid @ free, np.eye(len(moved)) - moved @ free


def _released(placed: PlacedStructure, motors: Sequence[Motor]) -> Reduced:
    """The structure without its preload, whose drives let go."""
    structure = placed.structure
    joints = list(structure.linkage.joints)
    for motor in motors:
        i = structure.linkage.joint_index[motor.joint]
        joint = joints[i]
        joints[i] = replace(
            joint,
            driven=tuple(d for d in joint.driven if d != motor.direction),
            stiffness={d: k for d, k in joint.stiffness.items() if d != motor.direction},
        )
    linkage = replace(structure.linkage, joints=tuple(joints))
    return reduce_system(
        system_of(PlacedStructure(replace(structure, linkage=linkage), placed.placement))
    )
