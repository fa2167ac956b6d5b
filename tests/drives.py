"""Drives of one and two masses as model files, and what is known of them in closed form."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from strutwork.fea import ModalRatio, Port
from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model
from strutwork.machines.servos import Servo
from strutwork.servo import ClosedLoop, closed_loop

MASS, MOTOR, SPRING = 40.0, 25.0, 2e7

#: A carriage on a rigid slide; with SPRING between motor and carriage where it is elastic.
SLIDE = """
title = "Carriage on a slide"
[nodes]
bed = [0, 0, 0]
carriage = [0, 0, 0]
[[masses]]
node = "carriage"
mass = 40
[[joints]]
name = "slide"
type = "prismatic"
between = ["bed", "carriage"]
axis = [1, 0, 0]
driven = ["z"]
{elastic}
[[supports]]
node = "bed"
fixed = "all"
[tool]
tcp = "carriage"
{more}
"""


def slide(*, elastic: bool = False, dashpot: float = 0.0, more: str = "") -> Model:
    """The carriage."""
    lines = f"stiffness = {{ z = {SPRING} }}" if elastic else ""
    if dashpot:
        lines += f"\ndamping = {{ z = {dashpot} }}"
    return parse_model(SLIDE.format(elastic=lines, more=more))


def servo(**changed: object) -> Servo:
    """A controller for it."""
    plain = {"position_gain": 50.0, "velocity_gain": 6e3, "inertia": MOTOR, "integral_time": 0.02}
    return Servo("slide", "z", **(plain | changed))  # type: ignore[arg-type]


def looped(model: Model, control: Servo, ratio: float = 0.0) -> ClosedLoop:
    """Closed about the carriage, along its slide."""
    port = Port("carriage", "x")
    return closed_loop(model.placed, [control], [port], ModalRatio(ratio))


def cascade(control: Servo) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Numerator and denominator of the velocity controller, without its delay."""
    gain, time = control.velocity_gain, control.integral_time
    if time is None:
        return np.array([gain]), np.array([1.0])
    return gain * np.array([1.0, 1.0 / time]), np.array([1.0, 0.0])
