"""Drives and structure connected: all loops closed, or one opened."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.driven_modes import DrivenModes
from strutwork.fea.motor_shapes import Motor
from strutwork.fea.port_states import Observed, PortStates, port_row, port_states
from strutwork.fea.ports import STILL, Port
from strutwork.fea.state_space import StateSpace
from strutwork.kinematics import DIRECTIONS, State
from strutwork.machines.servos import Servo
from strutwork.servo.cascade import controllers

Array = NDArray[Any]


@dataclass(frozen=True)
class Connection:
    """A structure with the controllers of its drives.

    The structure's inputs are the forces of the q motors, then those at the ports; its outputs
    are the measured positions, the motors' velocities, then displacements at the ports.

    Parameters
    ----------
    servos : tuple of Servo
    ports : tuple of Port
    plant : PortStates
    control : StateSpace
    """

    servos: tuple[Servo, ...]
    ports: tuple[Port, ...]
    plant: PortStates
    control: StateSpace

    def __repr__(self) -> str:
        return f"<Connection: {len(self.servos)} drives, {self.plant!r}>"

    def closed(self, without_position: int | None = None, without: int | None = None) -> StateSpace:
        """The closed loops.

        Inputs are added to the demanded velocity of each motor, then forces at the ports;
        outputs are measured positions, velocities, displacements at the ports.

        Parameters
        ----------
        without_position : int, optional
            The drive whose position loop is open.
        without : int, optional
            The drive both of whose loops are open.
        """
        q = len(self.servos)
        position = np.array([servo.position_gain for servo in self.servos])
        velocity = np.ones(q)
        for opened in (without_position, without):
            if opened is not None:
                position[opened] = 0.0
        if without is not None:
            velocity[without] = 0.0
        plant, control = self.plant, self.control
        seen = -position[:, None] * plant.c[:q] - velocity[:, None] * plant.c[q : 2 * q]
        at_once = -position[:, None] * plant.d[:q, q:]
        push = plant.b[:, :q]
        a = np.block(
            [
                [plant.a + push @ control.d @ seen, push @ control.c],
                [control.b @ seen, control.a],
            ]
        )
        b = np.block(
            [
                [push @ control.d, plant.b[:, q:] + push @ control.d @ at_once],
                [control.b, control.b @ at_once],
            ]
        )
        c = np.concatenate([plant.c, np.zeros((len(plant.c), len(control.a)))], axis=1)
        return StateSpace(
            a,
            b,
            c,
            plant.d,
            (*(f"velocity demanded of {s}" for s in self.servos), *plant.inputs[q:]),
            plant.outputs,
            (*plant.states, *control.states),
        )

    def velocity_loop(self, drive: int) -> StateSpace:
        """The velocity loop of a drive opened at its error, its position loop open too.

        Parameters
        ----------
        drive : int
        """
        q = len(self.servos)
        return _one(self.closed(without=drive), q + drive, drive, 1.0)

    def position_loop(self, drive: int) -> StateSpace:
        """The position loop of a drive opened at the velocity it demands.

        Parameters
        ----------
        drive : int
        """
        gain = self.servos[drive].position_gain
        return _one(self.closed(without_position=drive), drive, drive, gain)

    def tool(self, closed: StateSpace) -> StateSpace:
        """Displacements at the ports by the forces there.

        Parameters
        ----------
        closed : StateSpace
            As `closed`.
        """
        q = len(self.servos)
        return StateSpace(
            closed.a,
            closed.b[:, q:],
            closed.c[2 * q :],
            closed.d[2 * q :, q:],
            closed.inputs[q:],
            closed.outputs[2 * q :],
            closed.states,
        )


def _one(system: StateSpace, output: int, given: int, gain: float) -> StateSpace:
    return StateSpace(
        system.a,
        system.b[:, given : given + 1],
        gain * system.c[output : output + 1],
        gain * system.d[output : output + 1, given : given + 1],
        system.inputs[given : given + 1],
        system.outputs[output : output + 1],
        system.states,
    )


def connection(found: DrivenModes, servos: Sequence[Servo], ports: Sequence[Port]) -> Connection:
    """Connect the controllers of drives to a structure.

    Parameters
    ----------
    found : DrivenModes
        Its motors are those of the servos, in their order.
    servos : sequence of Servo
    ports : sequence of Port
        Where the structure is loaded and observed.

    Raises
    ------
    ModelError
        A port that cannot move or floats, a motor without inertia.
    """
    motors = [Motor(s.joint, s.direction, s.inertia) for s in servos]
    measured = [_encoder(found, s, m) for s, m in zip(servos, motors, strict=True)]
    plant = port_states(
        _held(found, ports),
        [*motors, *ports],
        [
            *(Observed(place) for place in measured),
            *(Observed(motor, "velocity") for motor in motors),
            *(Observed(port) for port in ports),
        ],
    )
    return Connection(tuple(servos), tuple(ports), plant, controllers(tuple(servos)))


def _encoder(found: DrivenModes, servo: Servo, motor: Motor) -> Motor | Port:
    """Where the position is measured; a motor that is one with its joint is both."""
    placed = found.system.placed
    joint = placed.structure.linkage.joints[placed.structure.linkage.joint_index[servo.joint]]
    axis = DIRECTIONS.index(servo.direction)
    if servo.encoder == "motor" or joint.states[axis] is not State.ELASTIC:
        return motor
    index = placed.structure.linkage.joint_index[servo.joint]
    along = found.system.joint_frames[0, index][:, axis]
    return Port(joint.between[1], tuple(float(v) for v in along), against=joint.between[0])


def _held(found: DrivenModes, ports: Sequence[Port]) -> DrivenModes:
    """Without rigid-body modes: a part that spins freely answers no port.

    Raises
    ------
    ModelError
        A rigid-body mode that moves a port.
    """
    k = len(found.frequencies)
    count = len(found.mass) - k - len(found.motors)
    if not count:
        return found
    size = np.abs(found.shapes[:, k : k + count]).max()
    for port in ports:
        if (
            np.abs(port_row(found.system, port) @ found.shapes[:, k : k + count]).max()
            > STILL * size
        ):
            raise ModelError(
                f"port {port}",
                "is moved by a rigid-body mode that no drive holds.",
                "Support the structure, or drive the joint that lets it move.",
            )
    keep = np.r_[0:k, k + count : len(found.mass)]
    both = np.ix_(keep, keep)
    return replace(
        found,
        shapes=found.shapes[:, keep],
        mass=found.mass[both],
        damping=found.damping[both],
        stiffness=found.stiffness[both],
        late_pull=found.late_pull[:, keep],
    )
