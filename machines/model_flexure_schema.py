"""The tables of the model file that describe flexures."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from strutwork import units
from strutwork.machines.model_fields import Modulus, Name, Quantity, Size, Table


class FlexureTable(Table):
    """What all flexures have."""

    material: Name
    thickness: Size
    width: Size
    bending: Literal["beam", "plate"] | None = None
    allowable_stress: Modulus | None = None
    stress_concentration: Annotated[float, Quantity(units.NUMBER, low=1.0)] | None = None


class CircularNotchTable(FlexureTable):
    """A notch hinge of two circular notches."""

    shape: Literal["circular_notch"]
    radius: Size
    height: Size | None = None


class EllipticNotchTable(FlexureTable):
    """A notch hinge of two elliptic notches."""

    shape: Literal["elliptic_notch"]
    semi_axis_x: Size
    semi_axis_y: Size
    height: Size | None = None


class LeafTable(FlexureTable):
    """A leaf spring."""

    shape: Literal["leaf"]
    length: Size


class CrossSpringTable(FlexureTable):
    """A cross-spring pivot."""

    shape: Literal["cross_spring"]
    length: Size
    angle: Annotated[float, Quantity(units.ANGLE, above=0.0)] | None = None
    crossing: Annotated[float, Quantity(units.NUMBER, low=0.0, high=1.0)] = 0.5
    leaves: Literal[2, 3] = 2
    spacing: Size | None = None


AnyFlexureTable = Annotated[
    CircularNotchTable | EllipticNotchTable | LeafTable | CrossSpringTable,
    Field(discriminator="shape"),
]
