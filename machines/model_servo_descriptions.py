"""What each key of the tables [[servos]] means, in a line: for the schema that editors read."""

from __future__ import annotations

#: Meaning of each key but the joints.
SERVO: dict[str, str] = {
    "direction": "driven direction",
    "position_gain": "gain K_v of the position loop",
    "velocity_gain": "gain of the velocity loop of a linear motor, at the joint",
    "motor_velocity_gain": "gain of the velocity loop of a motor that turns, at the motor",
    "integral_time": "integral time of the velocity loop; without it, no integral action",
    "pitch": "travel of a sliding drive per turn of its motor",
    "ratio": "turns of the motor per turn of a rotary drive; 1 by default",
    "motor_inertia": "inertia of the motor and what turns with it, at the motor",
    "motor_mass": "mass that a linear motor moves and no body of the file has",
    "velocity_feed_forward": "share of the demanded velocity that is fed forward",
    "delay": "time from the measurement to the force",
    "pade_order": "order of the Padé approximation of the delay",
    "encoder": "where the position is measured; the velocity is that of the motor",
}
