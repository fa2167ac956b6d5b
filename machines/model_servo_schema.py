"""The tables of the model file that state the controllers of drives."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from strutwork import units
from strutwork.machines.model_fields import Direction, Name, Quantity, Size, Table
from strutwork.machines.servos import MOST_ORDER

Rate = Annotated[float, Quantity(units.RATE, above=0.0)]
Time = Annotated[float, Quantity(units.TIME, above=0.0)]


class ServoTable(Table):
    """The controller of a drive."""

    joint: Name | None = None
    joints: tuple[Name, ...] | None = None
    direction: Direction
    position_gain: Rate
    velocity_gain: Annotated[float, Quantity(units.DAMPING, above=0.0)] | None = None
    motor_velocity_gain: Annotated[float, Quantity(units.ROTATIONAL_DAMPING, above=0.0)] | None = (
        None
    )
    integral_time: Time | None = None
    pitch: Size | None = None
    ratio: Annotated[float, Quantity(units.NUMBER, above=0.0)] | None = None
    motor_inertia: Annotated[float, Quantity(units.INERTIA, low=0.0)] | None = None
    motor_mass: Annotated[float, Quantity(units.MASS, low=0.0)] | None = None
    velocity_feed_forward: Annotated[float, Quantity(units.NUMBER, low=0.0, high=1.0)] = 0.0
    delay: Annotated[float, Quantity(units.TIME, low=0.0)] = 0.0
    pade_order: Annotated[int, Field(strict=True, ge=1, le=MOST_ORDER)] = 2
    encoder: Literal["motor", "load"] = "motor"
