"""The tables of solids and of shapes in the model file."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from strutwork.machines.model_fields import Frequency, Length, Name, Point, Size, Table, Vector

#: More modes with the interfaces held are no reduction.
MAX_MODES = 600

FileName = Annotated[str, Field(min_length=1, max_length=500)]


class InterfaceTable(Table):
    """A patch of a solid's surface tied to a node."""

    node: Name
    patch: Name | None = None
    box: tuple[Point, Point] | None = None
    normal: Vector | None = None
    kind: Literal["average", "rigid"] = "average"


class SolidTable(Table):
    """A meshed solid, reduced to its interfaces."""

    name: Name
    mesh: FileName | None = None
    step: FileName | None = None
    surface: FileName | None = None
    shape: Literal["block", "l_frame", "tube"] | None = None
    unit: Literal["m", "mm"] | None = None
    cell: Size | None = None
    size: tuple[Size, Size, Size] | None = None
    envelope: tuple[Size, Size, Size] | None = None
    plate: Size | None = None
    base: Size | None = None
    inner_diameter: Size | None = None
    outer_diameter: Size | None = None
    length: Size | None = None
    material: Name | None = None
    materials: dict[Name, Name] | None = None
    order: Annotated[int, Field(strict=True, ge=1, le=2)] = 2
    cutoff: Frequency | None = None
    modes: Annotated[int, Field(strict=True, ge=1, le=MAX_MODES)] | None = None
    position: tuple[Length, Length, Length] = (0.0, 0.0, 0.0)
    axis: Vector = (0.0, 0.0, 1.0)
    second_axis: Vector | None = None
    interfaces: tuple[InterfaceTable, ...] = ()


class ShapeTable(Table):
    """The outline of a body, for interference."""

    body: Name
    surface: FileName
    name: Name | None = None
    unit: Literal["m", "mm"] | None = None
    position: tuple[Length, Length, Length] = (0.0, 0.0, 0.0)
    axis: Vector = (0.0, 0.0, 1.0)
    second_axis: Vector | None = None
