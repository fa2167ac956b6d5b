"""State space of a structure between any ports: nodes and motors of drives."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.coupled import AnyDamping
from strutwork.fea.driven_modes import DrivenModes, driven_modes
from strutwork.fea.motor_shapes import Motor, node_row
from strutwork.fea.ports import STILL, Port
from strutwork.fea.state_space import StateSpace
from strutwork.msa.assembly import System
from strutwork.msa.rigid_map import rigid_map
from strutwork.msa.structure import PlacedStructure

Array = NDArray[Any]

#: What is observed at a port.
Quantity = Literal["displacement", "velocity", "acceleration"]

#: Where a structure is pushed or observed.
Place = Port | Motor


@dataclass(frozen=True)
class Observed:
    """What is observed at a node or a motor.

    Parameters
    ----------
    place : Port or Motor
    quantity : "displacement", "velocity" or "acceleration"
        m, m/s, m/s², or of a rotation.

    Raises
    ------
    ModelError
        Another quantity.
    """

    place: Place
    quantity: Quantity = "displacement"

    def __post_init__(self) -> None:
        if self.quantity not in ("displacement", "velocity", "acceleration"):
            raise ModelError(
                f"output {self.place}",
                f'is of the unknown quantity "{self.quantity}".',
                "Choose displacement, velocity or acceleration.",
            )

    def __str__(self) -> str:
        name = _name(self.place)
        return name if self.quantity == "displacement" else f"{self.quantity} of {name}"


@dataclass(frozen=True, repr=False)
class PortStates(StateSpace):
    """State space of a structure, as `StateSpace`, and what it leaves out.

    Parameters
    ----------
    a, b, c, d : arrays
        As `StateSpace`, in SI units.
    inputs, outputs, states : tuple of str
        Their names.
    modes : DrivenModes
        The coordinates.
    given : (i, l)
        Modes left out at the inputs, 1/√(N/m).
    seen : (o, l)
        Modes left out at the outputs, 1/√(N/m).
    """

    modes: DrivenModes
    given: Array
    seen: Array

    @property
    def kept(self) -> str:
        """Which modes it has, in words."""
        found = self.modes
        if not found.left_out.shape[1]:
            return f"all {found.count} modes"
        last = 0.5 / (np.pi * np.sqrt(found.left_out_square.max()))
        return (
            f"{len(found.frequencies)} of {found.count} modes and the static part of the others, "
            f"the lowest of which is at {last:.4g} Hz"
        )

    def truncation(self, frequency: float) -> float:
        """Bound of the error of a receptance up to a frequency, by the modes left out.

        As a share of the static compliance that the modes give between the same ports, the
        largest over all pairs; exact but for the damping that couples modes, and infinite from
        the first mode left out on. Of displacements; a velocity also lacks the rate of the
        static part.

        Parameters
        ----------
        frequency : float
            Hz.
        """
        share = (2.0 * np.pi * frequency) ** 2 * self.modes.left_out_square
        if not len(share):
            return 0.0
        if share.max() >= 1.0:
            return float("inf")
        missed = np.abs(self.seen) @ (share / (1.0 - share) * np.abs(self.given)).T
        k, size = len(self.modes.frequencies), len(self.modes.mass)
        stiff = (2.0 * np.pi * self.modes.frequencies) ** 2
        forces = self.modes.mass @ self.b[-size:]
        whole = np.abs(self.d) + np.abs(self.c[:, :k] / stiff) @ np.abs(forces[:k])
        found = np.divide(missed, whole, out=np.zeros_like(missed), where=missed > 0)
        return float(found.max(initial=0.0))


def state_space(
    placed: PlacedStructure,
    inputs: Sequence[Place],
    outputs: Sequence[Place | Observed],
    damping: AnyDamping,
    *,
    modes: int | None = None,
    highest: float | None = None,
    motors: Sequence[Motor] = (),
) -> PortStates:
    """State space of a structure at one pose.

    The states are the coordinates of the modes and their rates. Motors among the ports, and
    those of `motors`, are free to move; all other drives hold, or are as elastic as the model
    says. With all modes kept it is the structure itself; else the modes left out answer
    statically.

    Parameters
    ----------
    placed : PlacedStructure
        One pose.
    inputs : sequence of Port or Motor
        Forces and moments, or those of motors at the joint.
    outputs : sequence of Port, Motor or Observed
        Motions; displacements where nothing else is said.
    damping : damping of any kind
    modes : int, optional
        Number of flexible modes to keep.
    highest : float, optional
        Where `modes` is not given: keep those up to this frequency, Hz.
    motors : sequence of Motor
        Further drives that are free.

    Returns
    -------
    PortStates

    Raises
    ------
    ModelError
        No ports, several poses, a port that cannot move, a drive that has no mass to move, an
        acceleration of what has no mass.
    """
    if not inputs or not outputs:
        raise ModelError("ports", "are missing.", "Name at least one input and one output.")
    watched = [o if isinstance(o, Observed) else Observed(o) for o in outputs]
    places = [*inputs, *(o.place for o in watched)]
    free = tuple(dict.fromkeys([*motors, *(p for p in places if isinstance(p, Motor))]))
    return port_states(driven_modes(placed, free, damping, modes, highest), inputs, watched)


def port_states(
    found: DrivenModes, inputs: Sequence[Place], outputs: Sequence[Observed]
) -> PortStates:
    """State space from coordinates at hand.

    Errors as `state_space`.

    Parameters
    ----------
    found : DrivenModes
    inputs : sequence of Port or Motor
    outputs : sequence of Observed
    """
    size, late = len(found.mass), found.late.shape[1]
    given = [_rows(found, place) for place in inputs]
    force = np.stack([g.moved for g in given], axis=1)
    late_force = np.stack([g.late for g in given], axis=1)
    inverse = _inverse_mass(found)
    drop = np.linalg.inv(found.late_damping) if late else np.zeros((0, 0))
    # ẏ of the delayed motions by (y, z, ẏ) and the forces
    late_rate = np.concatenate([np.zeros((late, size)), -drop, -drop @ found.late_pull], axis=1)
    late_given = drop @ late_force
    pull = found.late_pull.T
    own = np.concatenate(
        [-inverse @ found.stiffness, np.zeros((size, late)), -inverse @ found.damping], axis=1
    )
    own = own - inverse @ pull @ late_rate
    a = np.concatenate(
        [np.concatenate([np.zeros((size, size + late)), np.eye(size)], axis=1), late_rate, own]
    )
    b = np.concatenate(
        [np.zeros((size, len(inputs))), late_given, inverse @ (force - pull @ late_given)]
    )
    c, d = [], []
    for output in outputs:
        row = _rows(found, output.place)
        if output.quantity == "displacement":
            c.append(np.concatenate([row.moved, row.late, np.zeros(size)]))
            d.append([row.prompt @ g.prompt for g in given])
        elif output.quantity == "velocity":
            at_once = np.concatenate([np.zeros(size + late), row.moved])
            c.append(at_once + row.late @ late_rate)
            d.append(row.late @ late_given)
        else:
            if late and np.abs(row.late).max() > 0:
                raise ModelError(
                    f"output {output}",
                    "is of a motion that has a dashpot and no mass.",
                    "Give it a mass, or observe its velocity.",
                )
            c.append(row.moved @ a[size + late :])
            d.append(row.moved @ b[size + late :])
    own_names = [f"mode {i + 1}" for i in range(len(found.frequencies))]
    own_names += [f"rigid {i + 1}" for i in range(size - len(own_names) - len(found.motors))]
    own_names += [f"motor {m}" for m in found.motors]
    rests = [np.atleast_2d(_rest(found, p)) for p in (*inputs, *(o.place for o in outputs))]
    return PortStates(
        a,
        b,
        np.array(c),
        np.array(d, dtype=float),
        tuple(_force_name(place) for place in inputs),
        tuple(str(output) for output in outputs),
        (
            *own_names,
            *(f"dashpot {i + 1}" for i in range(late)),
            *(f"rate of {name}" for name in own_names),
        ),
        found,
        np.concatenate(rests[: len(inputs)]),
        np.concatenate(rests[len(inputs) :]),
    )


@dataclass(frozen=True)
class _Row:
    """A port in the coordinates, the delayed motions and those that follow at once."""

    moved: Array
    late: Array
    prompt: Array


def _rows(found: DrivenModes, place: Place) -> _Row:
    if isinstance(place, Motor):
        moved = np.zeros(len(found.mass))
        moved[len(found.mass) - len(found.motors) + _index(found, place)] = 1.0
        return _Row(moved, np.zeros(found.late.shape[1]), np.zeros(found.prompt.shape[1]))
    row = port_row(found.system, place)
    if not port_moves(found, place):
        raise ModelError(
            f"port {place}",
            "does not move: its node is held in that direction.",
            "Choose another node or direction.",
        )
    return _Row(row @ found.shapes, row @ found.late, row @ found.prompt)


def port_moves(found: DrivenModes, port: Port) -> bool:
    """Whether a port can move at all.

    Parameters
    ----------
    found : DrivenModes
    port : Port

    Raises
    ------
    ModelError
        An unknown node.
    """
    row = port_row(found.system, port)
    for shapes in (found.shapes, found.late, found.prompt):
        # columns have sizes of their own: a mode moves by metres per √(N m), a motor by its way
        size = np.linalg.norm(row) * np.linalg.norm(shapes, axis=0)
        if np.any(np.abs(row @ shapes) > STILL * size):
            return True
    return False


def port_row(system: System, port: Port) -> Array:
    """Motion of a port by the unknowns, (n,).

    Parameters
    ----------
    system : System
        At one pose, with n unknowns.
    port : Port
    """
    row = node_row(system, port.node, port.vector)
    if port.against is not None:
        vector = port.vector
        if port.carried:
            # the workpiece carries the point at which the tool is
            placed = system.placed
            index = placed.structure.mesh_index
            arm = placed.positions[0, index[port.node]] - placed.positions[0, index[port.against]]
            vector = rigid_map(arm).T @ vector
        row = row - node_row(system, port.against, vector)
    return row


def _rest(found: DrivenModes, place: Place) -> Array:
    """Modes left out at a place, (l,)."""
    if isinstance(place, Motor):
        return np.zeros(found.left_out.shape[1])
    return np.asarray(port_row(found.system, place) @ found.left_out)


def _index(found: DrivenModes, motor: Motor) -> int:
    for i, known in enumerate(found.motors):
        if (known.joint, known.direction) == (motor.joint, motor.direction):
            return i
    raise ModelError(f"motor {motor}", "is held.", "Name it among the motors that are free.")


def _inverse_mass(found: DrivenModes) -> Array:
    """M⁻¹, with coordinates of different units brought to one size first."""
    diagonal = np.diag(found.mass)
    own = len(diagonal) - len(found.motors)
    if found.motors:
        # of a motor's inertia what the modes do not already carry
        coupled = found.mass[:own, own:]
        rest = found.mass[own:, own:] - coupled.T @ coupled
        size = np.sqrt(np.abs(np.diag(found.mass)[own:]))
        scaled = rest / np.outer(size, size) if np.all(size > 0) else np.zeros_like(rest)
        values, vectors = np.linalg.eigh(scaled)
        if values.min(initial=1.0) <= 1e-12:
            worst = found.motors[int(np.abs(vectors[:, 0]).argmax())]
            raise ModelError(
                f"motor {worst}",
                "has no inertia, and its transmission's stiffness is between it and the machine's "
                "mass."
                if np.all(size > 0)
                else "moves nothing that has a mass.",
                "Give the motor its inertia.",
            )
        inner = np.linalg.inv(scaled) / np.outer(size, size)
        top = np.eye(own) + coupled @ inner @ coupled.T
        side = -coupled @ inner
        return np.block([[top, side], [side.T, inner]])
    return np.eye(own)


def _name(place: Place) -> str:
    return f"motor {place}" if isinstance(place, Motor) else str(place)


def _force_name(place: Place) -> str:
    return f"force at {_name(place)}"
