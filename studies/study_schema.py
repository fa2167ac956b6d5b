"""The tables of a study file."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, StrictBool, StrictFloat, StrictInt, StrictStr

from strutwork.machines.model_fields import Frequency, Name, Table
from strutwork.machines.model_motion_schema import MAX_POINTS, WorkspaceTable
from strutwork.studies.parameter import POINTS

#: A number in SI, or text with its unit: its dimension is that of the path.
Quantity = StrictFloat | StrictInt | StrictStr

Path = Annotated[str, Field(min_length=1, max_length=300)]


class ParameterTable(Table):
    """Numbers of the machine that change together."""

    path: Path | tuple[Path, ...]
    values: tuple[Quantity, ...] = ()
    range: tuple[Quantity, Quantity] | None = None
    points: Annotated[int, Field(strict=True, ge=2, le=MAX_POINTS)] = POINTS
    relative: StrictBool = False
    log: StrictBool = False
    name: Name | None = None
    distribution: Literal["normal", "lognormal", "uniform", "truncated"] | None = None
    mean: Quantity | None = None
    scatter: Quantity | None = None
    independent: StrictBool = False


class SampleTable(Table):
    """How the values are combined."""

    kind: Literal["grid", "list", "sobol", "latin-hypercube", "random", "saltelli"] | None = None
    count: Annotated[int, Field(strict=True, ge=1)] | None = None
    seed: Annotated[int, Field(strict=True, ge=0)] = 0
    second_order: StrictBool = False


class VibrationTable(Table):
    """What is asked of vibration."""

    band: tuple[Frequency, Frequency] | None = None
    count: Annotated[int, Field(strict=True, ge=1, le=100)] = 6


class StudyTable(Table):
    """The entire file."""

    machine: Annotated[str, Field(min_length=1, max_length=500)]
    parameters: tuple[ParameterTable, ...]
    sample: SampleTable = SampleTable()
    answers: tuple[Name, ...] = ("stiffness",)
    reductions: tuple[Name, ...] = ()
    workspace: WorkspaceTable | None = None
    vibration: VibrationTable = VibrationTable()
