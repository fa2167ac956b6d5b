"""The tables of a design file."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StrictFloat, StrictInt

from strutwork.machines.model_fields import Name, Size, Table
from strutwork.machines.model_motion_schema import WorkspaceTable
from strutwork.machines.model_schema import Displacement
from strutwork.studies.study_schema import ParameterTable, Quantity, VibrationTable

Amount = StrictFloat | StrictInt


class ObjectiveTable(Table):
    """A quantity to make as small or as large as possible."""

    quantity: Name
    goal: Literal["minimise", "maximise"] | None = None


class ConstraintTable(Table):
    """Limits of a quantity."""

    quantity: Name
    at_least: Quantity | None = None
    at_most: Quantity | None = None


class CostPartTable(Table):
    """What a parameter costs."""

    name: Name
    amount: Amount
    per: Quantity = 1.0


class CostTable(Table):
    """Cost as a linear function of mass and parameters."""

    fixed: Amount = 0.0
    per_kg: Amount = 0.0
    currency: Name = ""
    parameters: tuple[CostPartTable, ...] = ()


class SearchTable(Table):
    """How, and how long, is searched."""

    method: Literal["evolution", "gradient", "both"] = "evolution"
    starts: Annotated[int, Field(strict=True, ge=1)] = 3
    population: Annotated[int, Field(strict=True, ge=4)] = 48
    generations: Annotated[int, Field(strict=True, ge=1)] = 40
    seed: Annotated[int, Field(strict=True, ge=0)] = 0


class PoseTable(Displacement):
    """A pose of the tool."""


class HemisphereTable(Table):
    """Check points on a hemisphere whose pole is home."""

    radius: Size = 4e-3
    lattice: Annotated[int, Field(strict=True, ge=1, le=1000)] = 10
    rolls: Annotated[int, Field(strict=True, ge=1, le=10_000)] = 24
    joint_ranges: tuple[Name, ...] | None = None
    condition_limit: Annotated[float, Field(gt=1.0)] = 100.0


class DesignTable(Table):
    """The entire file."""

    machine: Annotated[str, Field(min_length=1, max_length=500)]
    parameters: tuple[ParameterTable, ...]
    objectives: tuple[ObjectiveTable, ...]
    constraints: tuple[ConstraintTable, ...] = ()
    search: SearchTable = SearchTable()
    cost: CostTable = CostTable()
    workspace: WorkspaceTable | None = None
    poses: tuple[PoseTable, ...] = ()
    hemisphere: HemisphereTable | None = None
    vibration: VibrationTable = VibrationTable()
