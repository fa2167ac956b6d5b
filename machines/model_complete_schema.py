"""The tables of the model file with those that few files have."""

from __future__ import annotations

from pydantic import Field

from strutwork.machines import model_schema
from strutwork.machines.model_bearing_schema import BearingTable
from strutwork.machines.model_fields import Name
from strutwork.machines.model_flexure_schema import AnyFlexureTable
from strutwork.machines.model_process_schema import ProcessTable
from strutwork.machines.model_servo_schema import ServoTable
from strutwork.machines.model_solid_schema import ShapeTable, SolidTable


class ModelTable(model_schema.ModelTable):
    """The whole file."""

    flexures: dict[Name, AnyFlexureTable] = Field(default_factory=dict)
    solids: tuple[SolidTable, ...] = ()
    shapes: tuple[ShapeTable, ...] = ()
    servos: tuple[ServoTable, ...] = ()
    process: ProcessTable | None = None
    bearings: dict[Name, BearingTable] = Field(default_factory=dict)
