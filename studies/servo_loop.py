"""Closed loops and state spaces of a machine, by the names that its user knows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from strutwork.errors import ModelError
from strutwork.fea import ModalRatio, Port
from strutwork.fea.coupled import AnyDamping
from strutwork.fea.driven_modes import driven_modes
from strutwork.fea.motor_shapes import Motor
from strutwork.fea.port_states import Observed, Place, PortStates, port_moves, state_space
from strutwork.fea.ports import tool_ports
from strutwork.fea.validity import warn_beyond
from strutwork.machines.model import Model
from strutwork.machines.servos import Servo
from strutwork.msa import PlacedStructure
from strutwork.servo.closed_loop import ClosedLoop, loop_of
from strutwork.studies.covering_band import band_of
from strutwork.studies.model_damping import model_damping

#: Modes are kept up to this many times the end of the band, and up to this frequency, Hz, at
#: least: the phase of a loop crosses −180° beyond the band that is asked for.
REACH, FARTHEST = 2.0, 2000.0

#: Ends of a band where no mode says one, Hz.
LOWEST, HIGHEST = 1.0, 1000.0


@dataclass(frozen=True)
class LoopQuestion:
    """What is asked of the controlled drives of a machine.

    Parameters
    ----------
    servos : tuple of Servo
    ports : tuple of Port
        Where stiffness is asked for; those that cannot move are left out if `some` is true.
    damping : damping of any kind or None
    band : (float, float)
        Hz.
    modes : int or None
        Number of flexible modes that are kept; None for those up to `REACH` times the band and
        up to `FARTHEST`.
    some : bool
        Whether ports that cannot move are left out.
    """

    servos: tuple[Servo, ...]
    ports: tuple[Port, ...]
    damping: AnyDamping | None
    band: tuple[float, float]
    modes: int | None = None
    some: bool = False

    def ask(self, placed: PlacedStructure) -> ClosedLoop:
        """The closed loops at one pose.

        Parameters
        ----------
        placed : PlacedStructure

        Raises
        ------
        StrutworkError
            No damping; else as `strutwork.servo.closed_loop`.

        Warns
        -----
        ValidityWarning
            The band goes beyond what a superelement holds to.
        """
        warn_beyond(placed, self.band[1])
        motors = [Motor(s.joint, s.direction, s.inertia) for s in self.servos]
        damping = self.damping or ModalRatio(0.0)
        highest = max(REACH * self.band[1], FARTHEST)
        found = driven_modes(placed, motors, damping, self.modes, highest)
        if self.damping is None and len(found.frequencies):
            raise ModelError(
                "damping",
                "is missing: without it the response is unbounded at a resonance.",
                "Add exactly one to the model file, as in [damping] with modal_ratio = 0.01 "
                "(or loss_factor, or rayleigh), or give --modal-ratio or --loss-factor.",
            )
        ports = self.ports
        if self.some:
            ports = tuple(port for port in ports if port_moves(found, port)) or ports
        return loop_of(found, self.servos, ports)


def loop_question(
    model: Model,
    servos: Sequence[Servo] = (),
    ports: Sequence[Port] = (),
    *,
    damping: AnyDamping | None = None,
    band: tuple[float, float] | None = None,
    modes: int | None = None,
) -> LoopQuestion:
    """What is asked where the user says little.

    Parameters
    ----------
    model : Model
    servos : sequence of Servo
        The model's own where there is none.
    ports : sequence of Port
        The tool along x, y and z, as far as it can move, where there is none.
    damping : damping of any kind, optional
        The model's own otherwise.
    band : (float, float), optional
        Hz; from 1 Hz to where the modes explain the static compliance otherwise.
    modes : int, optional
        Number of flexible modes that are kept.

    Raises
    ------
    ModelError
        No controllers, no tool, no mass.
    """
    used = tuple(servos) or model.servos
    if not used:
        raise ModelError(
            "servos",
            "are missing: no drive has a controller.",
            "Add [[servos]] to the model file, with joint, direction and gains, or give a file "
            "of them with --servos; docs/how-to/servo.md describes them.",
        )
    if not ports:
        model.require_tool()
    where = tuple(ports) or tool_ports(model.structure.linkage)
    damping = damping or model_damping(model)
    if band is None:
        band = _band(model, used, where, some=not ports)
    return LoopQuestion(used, where, damping, band, modes, not ports)


def machine_loop(model: Model, servos: Sequence[Servo] = (), **options: object) -> ClosedLoop:
    """Closed loops of a machine where it stands.

    Parameters
    ----------
    model : Model
    servos : sequence of Servo
        The model's own where there is none.
    **options
        Of `loop_question`: ports, damping, band, modes.

    Raises
    ------
    StrutworkError
        As `loop_question` and `LoopQuestion.ask`.
    """
    return loop_question(model, servos, **options).ask(model.vibrating)  # type: ignore[arg-type]


def machine_state_space(
    model: Model,
    inputs: Sequence[str | Place],
    outputs: Sequence[str | Place | tuple[str | Place, str]],
    *,
    damping: AnyDamping | None = None,
    modes: int | None = None,
) -> PortStates:
    """State space of a machine between ports, where it stands.

    Parameters
    ----------
    model : Model
    inputs : sequence of str, Port or Motor
        "NODE:x" for a force at a node, "motor JOINT:z" for one of a drive, which it frees.
    outputs : sequence of str, Port, Motor or pairs of one with a quantity
        Displacements, or "velocity" or "acceleration" of a pair.
    damping : damping of any kind, optional
        The model's own otherwise.
    modes : int, optional
        Number of flexible modes that are kept; all of them otherwise.

    Raises
    ------
    StrutworkError
        No damping; a name that is no port; else as `strutwork.fea.port_states.state_space`.
    """
    found = damping or model_damping(model)
    if found is None:
        raise ModelError("damping", "is missing.", "Add [damping], or give the machine a damping.")
    watched = []
    for output in outputs:
        place, quantity = output if isinstance(output, tuple) else (output, "displacement")
        watched.append(Observed(_place(model, place), quantity))  # type: ignore[arg-type]
    pushed = [_place(model, place) for place in inputs]
    return state_space(model.vibrating, pushed, watched, found, modes=modes)


def _place(model: Model, named: str | Place) -> Place:
    if not isinstance(named, str):
        return named
    word, _, rest = named.partition(" ")
    if word != "motor":
        return Port.parse(named, tuple(model.structure.mesh_index))
    joint, _, direction = rest.rpartition(":")
    inertia = {(s.joint, s.direction): s.inertia for s in model.servos}
    return Motor(joint, direction, inertia.get((joint, direction), 0.0))


def _band(
    model: Model, servos: Sequence[Servo], ports: Sequence[Port], *, some: bool
) -> tuple[float, float]:
    motors = [Motor(s.joint, s.direction, s.inertia) for s in servos]
    found = driven_modes(model.vibrating, motors, ModalRatio(0.0))
    if some:
        ports = [port for port in ports if port_moves(found, port)]
    if not len(found.frequencies) or not ports:
        return LOWEST, HIGHEST
    own = band_of(model.vibrating, ports)
    return (LOWEST, HIGHEST) if own is None else (min(LOWEST, own.low), own.high)
