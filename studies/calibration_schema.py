"""The tables of a calibration file."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, StrictBool, StrictInt

from strutwork import units
from strutwork.machines.model_fields import (
    Force,
    Frequency,
    Moment,
    Name,
    Quantity,
    Ratio,
    Size,
    Slope,
    Table,
)
from strutwork.machines.model_motion_schema import AngleSpan, LengthSpan
from strutwork.machines.model_schema import Displacement
from strutwork.studies.study_schema import Path
from strutwork.studies.study_schema import Quantity as Value

#: Lines of a measured response that are used at most, where the file does not say.
LINES = 200

Share = Annotated[float, Quantity(units.NUMBER, above=0.0)]
Count = Annotated[int, Field(strict=True, ge=1, le=1000)]
Modes = tuple[Annotated[StrictInt, Field(ge=1, le=1000)], ...]


def _listed(value: Any) -> Any:
    """One scatter for all, or a list."""
    return value if isinstance(value, list) else [value]


class UnknownTable(Table):
    """A number of the machine that is to be found."""

    path: Path | tuple[Path, ...]
    guess: Value | None = None
    range: tuple[Value, Value] | None = None
    prior: Share | None = None
    relative: StrictBool = False
    scale: Literal["log", "linear"] | None = None
    name: Name | None = None


class PoseTable(Displacement):
    """Where the tool stood."""


class FrequenciesTable(Table):
    """Measured natural frequencies at a pose."""

    name: Name | None = None
    pose: PoseTable = PoseTable()
    values: tuple[Frequency, ...] | None = None
    file: Path | None = None
    modes: Modes | None = None
    points: dict[Name, Name] = Field(default_factory=dict)
    scatter: Annotated[tuple[Frequency, ...], BeforeValidator(_listed)] | None = None
    relative_scatter: Share | None = None


class FrfTable(Table):
    """Measured responses of a universal file at a pose."""

    name: Name | None = None
    file: Path
    pose: PoseTable = PoseTable()
    points: dict[Name, Name] = Field(default_factory=dict)
    band: tuple[Frequency, Frequency]
    lines: Annotated[int, Field(strict=True, ge=2, le=100_000)] = LINES
    scatter: Share
    modal_ratio: Ratio | None = None
    units: dict[Name, Name] = Field(default_factory=dict)


class LoadTable(Table):
    """A load at a node, global axes."""

    node: Name
    x: Force = 0.0
    y: Force = 0.0
    z: Force = 0.0
    rx: Moment = 0.0
    ry: Moment = 0.0
    rz: Moment = 0.0


class DeflectionsTable(Table):
    """Measured displacements under a load at a pose."""

    name: Name | None = None
    pose: PoseTable = PoseTable()
    load: LoadTable
    displacements: dict[Name, PoseTable]
    scatter: Size | None = None
    angular_scatter: Slope | None = None


class CandidateFrequencies(Table):
    """Frequencies that could be measured at every candidate pose."""

    modes: Count
    relative_scatter: Share


class CandidateDeflections(Table):
    """Displacements that could be measured at every candidate pose."""

    load: LoadTable
    at: tuple[Name, ...]
    scatter: Size | None = None
    angular_scatter: Slope | None = None


class CandidateFrf(Table):
    """Responses that could be measured at every candidate pose."""

    input: Name
    outputs: tuple[Name, ...]
    band: tuple[Frequency, Frequency]
    lines: Annotated[int, Field(strict=True, ge=2, le=10_000)] = 50
    scatter: Share
    modal_ratio: Ratio | None = None


class CandidatesTable(Table):
    """Poses of which the best are chosen, and what is measured at each."""

    x: LengthSpan | None = None
    y: LengthSpan | None = None
    z: LengthSpan | None = None
    rx: AngleSpan | None = None
    ry: AngleSpan | None = None
    rz: AngleSpan | None = None
    frequencies: CandidateFrequencies | None = None
    deflections: CandidateDeflections | None = None
    frf: CandidateFrf | None = None


class FitTable(Table):
    """How the best values are searched."""

    starts: Annotated[int, Field(strict=True, ge=1, le=1000)] = 6
    seed: Annotated[int, Field(strict=True, ge=0)] = 0


class CalibrationTable(Table):
    """The entire file."""

    machine: Annotated[str, Field(min_length=1, max_length=500)]
    parameters: tuple[UnknownTable, ...]
    frequencies: tuple[FrequenciesTable, ...] = ()
    frf: tuple[FrfTable, ...] = ()
    deflections: tuple[DeflectionsTable, ...] = ()
    candidates: CandidatesTable | None = None
    fit: FitTable = FitTable()
