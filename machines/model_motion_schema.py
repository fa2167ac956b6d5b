"""The tables of the model file that say how a machine moves."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from strutwork.machines.model_fields import (
    Angle,
    Direction,
    ForceLimit,
    Length,
    MomentLimit,
    Name,
    Number,
    Size,
    Slope,
    Speed,
    Table,
    TurningSpeed,
)

#: Points along one direction of a workspace at most.
MAX_POINTS = 10_000


class LimitsTable(Table):
    """Range of joint coordinates by direction."""

    x: tuple[Length, Length] | None = None
    y: tuple[Length, Length] | None = None
    z: tuple[Length, Length] | None = None
    rx: tuple[Angle, Angle] | None = None
    ry: tuple[Angle, Angle] | None = None
    rz: tuple[Angle, Angle] | None = None


class TaskTable(Table):
    """What the tool is to do: directions in which it moves."""

    directions: tuple[Direction, ...]


class LengthSpan(Table):
    """Places along an axis."""

    from_: Annotated[Length, Field(alias="from")]
    to: Length
    points: Annotated[int, Field(strict=True, ge=2, le=MAX_POINTS)] = 5


class AngleSpan(Table):
    """Turns about an axis."""

    from_: Annotated[Angle, Field(alias="from")]
    to: Angle
    points: Annotated[int, Field(strict=True, ge=2, le=MAX_POINTS)] = 5


class WorkspaceTable(Table):
    """Poses that maps and reports look at: each value with each."""

    x: LengthSpan | None = None
    y: LengthSpan | None = None
    z: LengthSpan | None = None
    rx: AngleSpan | None = None
    ry: AngleSpan | None = None
    rz: AngleSpan | None = None


class CouplingTable(Table):
    """Two joint coordinates that follow each other."""

    name: Name
    between: tuple[Name, Name]
    ratio: Number | None = None
    per_turn: Length | None = None


class DriveTable(Table):
    """What drives can do."""

    joint: Name | None = None
    joints: tuple[Name, ...] | None = None
    direction: Direction
    speed: Speed | None = None
    turning_speed: TurningSpeed | None = None
    force: ForceLimit | None = None
    torque: MomentLimit | None = None
    resolution: Size | None = None
    angular_resolution: Slope | None = None
