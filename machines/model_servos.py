"""Controllers of drives from the tables of a model file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import pi

from strutwork.errors import ModelError
from strutwork.kinematics import Joint
from strutwork.machines.model_parts import unknown
from strutwork.machines.model_servo_schema import ServoTable
from strutwork.machines.servos import Servo


def servos_of(tables: Sequence[ServoTable], joints: Mapping[str, Joint]) -> tuple[Servo, ...]:
    """The controllers, one entry per driven direction.

    Parameters
    ----------
    tables : sequence of ServoTable
    joints : mapping of str to Joint
        Those of the file, by name.

    Raises
    ------
    ModelError
        An unknown joint, a direction that is not driven, one given twice, a gain or an inertia
        of another kind of motor.
    """
    found: dict[tuple[str, str], Servo] = {}
    for i, table in enumerate(tables):
        part = f"servos[{i}]"
        if (table.joint is None) == (table.joints is None):
            raise ModelError(part, "names no joint, or both joint and joints.", "Give one of them.")
        gain, inertia = _at_joint(part, table)
        for name in table.joints if table.joints is not None else (table.joint or "",):
            if name not in joints:
                raise unknown(part, "joint", name, joints)
            key = (name, table.direction)
            if table.direction not in joints[name].driven:
                raise ModelError(
                    part,
                    f"controls {name}:{table.direction}, which is not driven.",
                    f'Add driven = ["{table.direction}"] to the joint.',
                )
            if key in found:
                raise ModelError(part, f"gives {name}:{table.direction} twice.", "Give it once.")
            found[key] = Servo(
                *key,
                position_gain=table.position_gain,
                velocity_gain=gain,
                inertia=inertia,
                integral_time=table.integral_time,
                feed_forward=table.velocity_feed_forward,
                delay=table.delay,
                order=table.pade_order,
                encoder=table.encoder,
            )
    return tuple(found.values())


def _at_joint(part: str, table: ServoTable) -> tuple[float, float]:
    """Velocity gain and inertia, both brought to the joint."""
    turns = table.direction.startswith("r")
    rotary = turns or table.pitch is not None
    gain = table.motor_velocity_gain if rotary else table.velocity_gain
    kind = "motor that turns" if rotary else "linear motor"
    for name in (
        "velocity_gain" if rotary else "motor_velocity_gain",
        "motor_mass" if rotary else "motor_inertia",
        "pitch" if turns else "ratio",
    ):
        if getattr(table, name) is not None:
            remedy = {
                "velocity_gain": "Give motor_velocity_gain, in N*m*s/rad at the motor.",
                "motor_velocity_gain": "Give velocity_gain, in N*s/m, or the pitch of the screw.",
                "motor_mass": "Give motor_inertia.",
                "motor_inertia": "Give the pitch of the screw, or motor_mass.",
                "pitch": "Give ratio: turns of the motor per turn of the joint.",
                "ratio": "Give pitch: travel per turn of the motor, the gear included.",
            }[name]
            raise ModelError(part, f"gives {name} to a {kind}.", remedy)
    if gain is None:
        name = "motor_velocity_gain" if rotary else "velocity_gain"
        raise ModelError(part, f"has no {name}.", f"Give {name}, the gain of the velocity loop.")
    if not rotary:
        return gain, table.motor_mass or 0.0
    turn = 2.0 * pi / table.pitch if table.pitch is not None else table.ratio or 1.0
    return gain * turn**2, (table.motor_inertia or 0.0) * turn**2
