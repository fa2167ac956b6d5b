"""The table of the model file that states the cut for which a machine's stability is reported."""

from __future__ import annotations

from math import pi
from typing import Annotated, Literal

from pydantic import Field

from strutwork import units
from strutwork.machines.model_fields import (
    Modulus,
    Name,
    Quantity,
    Ratio,
    Size,
    Table,
    TurningSpeed,
    Vector,
)

#: Teeth of a cutter, and speeds of a span, at most.
MAX_TEETH, MAX_SPEEDS = 1000, 2000


class SpeedSpan(Table):
    """Spindle speeds."""

    from_: Annotated[TurningSpeed, Field(alias="from")]
    to: TurningSpeed
    points: Annotated[int, Field(strict=True, ge=3, le=MAX_SPEEDS)] = 51


class ProcessTable(Table):
    """A milling cut."""

    diameter: Size
    teeth: Annotated[int, Field(strict=True, ge=1, le=MAX_TEETH)]
    helix: Annotated[float, Quantity(units.ANGLE, low=0.0)] = 0.0
    lead: Annotated[float, Quantity(units.ANGLE, above=0.0)] = 0.5 * pi
    material: Name | None = None
    tangential: Modulus | None = None
    radial: Annotated[float, Quantity(units.PRESSURE, low=0.0)] = 0.0
    axial: Annotated[float, Quantity(units.PRESSURE, low=0.0)] = 0.0
    source: str = ""
    immersion: Annotated[float, Quantity(units.NUMBER, above=0.0, high=1.0)] = 1.0
    way: Literal["up", "down"] = "down"
    feed_per_tooth: Size = 1e-4
    axis: Vector = (0.0, 0.0, 1.0)
    feed: Vector = (1.0, 0.0, 0.0)
    speeds: SpeedSpan
    modal_ratio: Ratio | None = None
