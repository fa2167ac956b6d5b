"""Closed loops of a machine's drives: poles, margins and stiffness with the servos in the loop."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.coupled import AnyDamping
from strutwork.fea.driven_modes import DrivenModes, driven_modes, without_motors
from strutwork.fea.motor_shapes import Motor
from strutwork.fea.port_states import Observed, PortStates, port_states
from strutwork.fea.ports import Port
from strutwork.fea.state_space import StateSpace
from strutwork.machines.servos import Servo
from strutwork.msa.structure import PlacedStructure
from strutwork.servo.connection import Connection, connection
from strutwork.servo.least import LeastStiffness, least_stiffness
from strutwork.servo.loop_poles import LoopPole, loop_poles
from strutwork.servo.margins import Margins, loop_margins

Array = NDArray[Any]


class UnstableLoopError(NumericalError):
    """A closed loop that does not decay: it has no stiffness."""


@dataclass(frozen=True)
class DriveMargins:
    """Margins of the loops of one drive, the loops of the other drives closed.

    Parameters
    ----------
    servo : Servo
    velocity : Margins
        Of the velocity loop, with the position loop of the drive open.
    position : Margins
        Of the position loop, with the velocity loop closed.
    """

    servo: Servo
    velocity: Margins
    position: Margins


@dataclass(frozen=True)
class ClosedLoop:
    """A structure at one pose whose drives are controlled.

    Parameters
    ----------
    connected : Connection
    closed : StateSpace
        As `Connection.closed`, all loops closed.
    locked : PortStates or None
        Forces to displacements at the ports with the motors held; None where nothing moves then.
    """

    connected: Connection
    closed: StateSpace
    locked: PortStates | None

    def __repr__(self) -> str:
        state = "stable" if self.stable else "unstable"
        return f"<ClosedLoop: {len(self.servos)} drives, {len(self.closed.a)} states, {state}>"

    @property
    def servos(self) -> tuple[Servo, ...]:
        """Controllers of the drives."""
        return self.connected.servos

    @property
    def ports(self) -> tuple[Port, ...]:
        """Where the structure is loaded and observed."""
        return self.connected.ports

    @cached_property
    def poles(self) -> tuple[LoopPole, ...]:
        """Poles by rising frequency, the upper one of each pair."""
        return loop_poles(self.closed, self._parts())

    @property
    def unstable(self) -> tuple[LoopPole, ...]:
        """Poles that do not decay."""
        return tuple(pole for pole in self.poles if not pole.stable)

    @property
    def stable(self) -> bool:
        """Whether every motion decays."""
        return not self.unstable

    @property
    def slowest(self) -> LoopPole:
        """The pole that decays most slowly, or grows fastest."""
        return max(self.poles, key=lambda pole: pole.value.real)

    @cached_property
    def margins(self) -> tuple[DriveMargins, ...]:
        """Margins of every drive's loops."""
        return tuple(
            DriveMargins(
                servo,
                loop_margins(self.connected.velocity_loop(i)),
                loop_margins(self.connected.position_loop(i)),
            )
            for i, servo in enumerate(self.servos)
        )

    @cached_property
    def tool(self) -> StateSpace:
        """Displacements at the ports by the forces there, with the drives in the loop."""
        return self.connected.tool(self.closed)

    def receptance(self, frequencies: ArrayLike) -> Array:
        """Receptance with the drives in the loop, complex, (f, o, o), m/N and the like.

        Parameters
        ----------
        frequencies : (f,)
            Hz.

        Raises
        ------
        UnstableLoopError
            A loop that does not decay.
        """
        self.require_stable()
        return self.tool.response(frequencies)

    def least(self, band: tuple[float, float]) -> tuple[LeastStiffness, ...]:
        """Least dynamic stiffness of every port with the drives in the loop.

        Parameters
        ----------
        band : (float, float)
            Hz.

        Raises
        ------
        UnstableLoopError
            A loop that does not decay.
        """
        self.require_stable()
        return least_stiffness(self.tool, band)

    def least_locked(self, band: tuple[float, float]) -> tuple[LeastStiffness, ...] | None:
        """Least dynamic stiffness of every port with the motors held; None of a rigid machine.

        Parameters
        ----------
        band : (float, float)
            Hz.
        """
        return None if self.locked is None else least_stiffness(self.locked, band)

    def require_stable(self) -> None:
        """Check that every motion decays.

        Raises
        ------
        UnstableLoopError
            Names the pole that grows fastest, and what swings in it.
        """
        if not self.unstable:
            return
        worst = self.slowest
        raise UnstableLoopError(
            "closed loop",
            f"is unstable: {worst.part} grows at {worst.frequency:.4g} Hz, with a damping ratio "
            f"of {worst.damping:.3g}. It has no dynamic stiffness.",
            "Lower the gains of the velocity and position loops, raise the integral time or "
            "shorten the delay.",
        )

    def _parts(self) -> list[str]:
        """What each state of the closed loop belongs to."""
        modes = self.connected.plant.modes
        own = [f"mode {i + 1} ({f:.4g} Hz held)" for i, f in enumerate(modes.frequencies)]
        own += [f"drive {servo}" for servo in self.servos]
        late = [f"dashpot {i + 1}" for i in range(modes.late.shape[1])]
        controls = [f"drive {name.rpartition(' of ')[2]}" for name in self.connected.control.states]
        return [*own, *late, *own, *controls]


def closed_loop(
    placed: PlacedStructure,
    servos: Sequence[Servo],
    ports: Sequence[Port],
    damping: AnyDamping,
    *,
    modes: int | None = None,
    highest: float | None = None,
) -> ClosedLoop:
    """Close the loops of drives around a structure at one pose.

    Drives without a controller hold, or are as elastic as the model says. A driven direction
    with a stiffness is a transmission between motor and joint; without one, the motor is rigidly
    connected. The inertia of a motor acts on the motion of its joint: what the frame does to the
    rotor's own spin is neglected.

    Parameters
    ----------
    placed : PlacedStructure
        One pose.
    servos : sequence of Servo
    ports : sequence of Port
        Where stiffness is asked for.
    damping : damping of any kind
        Of the structure with the motors held.
    modes : int, optional
        Number of flexible modes to keep.
    highest : float, optional
        Where `modes` is not given: keep those up to this frequency, Hz.

    Returns
    -------
    ClosedLoop

    Raises
    ------
    ModelError
        No servo or port, several poses, a drive that is not driven, moves nothing or has no
        inertia, a port that cannot move or floats, no mass.
    """
    if not servos:
        raise ModelError(
            "servos",
            "are missing: no drive has a controller.",
            "Add [[servos]] to the model file, with joint, direction and gains.",
        )
    if not ports:
        raise ModelError("ports", "are missing.", "Name at least one port.")
    motors = [Motor(s.joint, s.direction, s.inertia) for s in servos]
    return loop_of(driven_modes(placed, motors, damping, modes, highest), servos, ports)


def loop_of(found: DrivenModes, servos: Sequence[Servo], ports: Sequence[Port]) -> ClosedLoop:
    """Closed loops around coordinates at hand.

    Errors as `closed_loop`.

    Parameters
    ----------
    found : DrivenModes
        Its motors are those of the servos, in their order.
    servos : sequence of Servo
    ports : sequence of Port
    """
    connected = connection(found, servos, ports)
    held = without_motors(found)
    locked = None
    if len(held.frequencies):
        locked = port_states(held, list(ports), [Observed(port) for port in ports])
    return ClosedLoop(connected, connected.closed(), locked)
