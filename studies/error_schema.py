"""The tables of an errors file."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import Field, StrictBool
from pydantic_core import PydanticCustomError

from strutwork import units
from strutwork.machines.model_fields import (
    Acceleration,
    Direction,
    Force,
    Frequency,
    Length,
    Moment,
    Name,
    Point,
    Quantity,
    Size,
    Slope,
    Table,
    TurningSpeed,
    Vector,
)
from strutwork.machines.model_motion_schema import WorkspaceTable
from strutwork.machines.model_schema import ToleranceTable
from strutwork.studies.calibration_schema import PoseTable
from strutwork.units import Dimension

#: Entries of a table, points of a spectrum, and moments of a drift at most.
MOST, POINTS, MOMENTS = 1000, 10_000, 1000

_KELVIN = re.compile(r"(?<![A-Za-z])K(?![A-Za-z])")

TEMPERATURE = Dimension("a difference of temperature", "K", "2 K", (0, 0, 0))
GRADIENT = Dimension("a gradient of temperature", "K/m", "5 K/m", (-1, 0, 0))
EXPANSION = Dimension("a coefficient of expansion", "1/K", "11.5 um/m/K", (0, 0, 0))
CONDUCTIVITY = Dimension("a thermal conductivity", "W/m/K", "50 W/m/K", (1, 1, -3))
FILM = Dimension("a coefficient of heat transfer", "W/m^2/K", "10 W/m^2/K", (0, 1, -3))
FLUX = Dimension("a flow of heat per area", "W/m^2", "200 W/m^2", (0, 1, -3))
PER_KELVIN = (EXPANSION, CONDUCTIVITY, FILM)
ACCELERATION_DENSITY = Dimension(
    "a spectral density of acceleration", "(m/s^2)^2/Hz", "1e-6 (m/s^2)^2/Hz", (2, 0, -3)
)


@dataclass(frozen=True)
class Thermal(Quantity):
    """A quantity with K in its unit, which the other units do not know.

    Parameters
    ----------
    dimension : Dimension
    low, above, high, below : float, optional
        As of a `Quantity`, any unit.
    """

    def read(self, value: object) -> float:
        """Value in SI units, K among them.

        Parameters
        ----------
        value : float or str
            A number in SI, or text with its unit, in which K stands once.
        """
        if isinstance(value, str):
            found = list(_KELVIN.finditer(value))
            before = value[: found[0].start()].rstrip() if found else ""
            over = before.endswith("/") or before.rfind("/(") > before.rfind(")")
            if len(found) != 1 or over != (self.dimension in PER_KELVIN):
                raise PydanticCustomError(
                    "unit",
                    "{problem}",
                    {
                        "problem": f"{units.shown(value)} is not {self.dimension.name}.",
                        "remedy": f"Give a number in {self.dimension.unit}, or a string with its "
                        f'unit: "{self.dimension.example}".',
                    },
                )
            value = _KELVIN.sub("1", value)
        return super().read(value)


Change = Annotated[float, Thermal(TEMPERATURE)]
Spread = Annotated[float, Thermal(TEMPERATURE, low=0.0)]
Gradient = Annotated[float, Thermal(GRADIENT)]
Coefficient = Annotated[float, Thermal(EXPANSION)]
Conductivity = Annotated[float, Thermal(CONDUCTIVITY, above=0.0)]
Film = Annotated[float, Thermal(FILM, above=0.0)]
Flux = Annotated[float, Quantity(FLUX)]
Power = Annotated[float, Quantity(units.POWER)]
Time = Annotated[float, Quantity(units.TIME, above=0.0)]
Moment0 = Annotated[float, Quantity(units.TIME, low=0.0)]
Density = Annotated[float, Quantity(ACCELERATION_DENSITY, low=0.0)]
Step = Annotated[float, Quantity(units.LENGTH, low=0.0)]
Turn = Annotated[float, Quantity(units.ANGLE, low=0.0)]
Stiff = Annotated[float, Quantity(units.STIFFNESS, above=0.0)]
StiffTurn = Annotated[float, Quantity(units.ROTATIONAL_STIFFNESS, above=0.0)]
Names = Annotated[tuple[Name, ...], Field(max_length=MOST)]


class ProfileTable(Table):
    """A change of temperature along an axis."""

    axis: Vector
    places: Annotated[tuple[Length, ...], Field(min_length=2, max_length=POINTS)]
    changes: Annotated[tuple[Change, ...], Field(min_length=2, max_length=POINTS)]


class HeatedSurfaceTable(Table):
    """Part of a solid's surface with a temperature or a flow of heat."""

    node: Name | None = None
    patch: Name | None = None
    box: tuple[Point, Point] | None = None
    normal: Vector | None = None
    change: Change | None = None
    film: Film | None = None
    surroundings: Change = 0.0
    flux: Flux = 0.0
    power: Power = 0.0


class TemperatureTable(Table):
    """Parts whose temperature changes."""

    name: Name | None = None
    part: Name | None = None
    parts: Names | None = None
    material: Name | None = None
    change: Change = 0.0
    spread: Spread = 0.0
    gradient_y: Gradient = 0.0
    gradient_z: Gradient = 0.0
    gradient: tuple[Gradient, Gradient, Gradient] = (0.0, 0.0, 0.0)
    at: Point | None = None
    profile: ProfileTable | None = None
    surfaces: Annotated[tuple[HeatedSurfaceTable, ...], Field(max_length=MOST)] = ()
    time_constant: Time | None = None
    expansion: Coefficient | None = None


class CuttingTable(Table):
    """A force of the cut on the tool."""

    name: Name
    force: tuple[Force, Force, Force] = (0.0, 0.0, 0.0)
    moment: tuple[Moment, Moment, Moment] = (0.0, 0.0, 0.0)
    frequency: Frequency | None = None


class DriveTable(Table):
    """What is not perfect in drives."""

    joint: Name | None = None
    joints: Names | None = None
    direction: Direction
    resolution: Step | None = None
    angular_resolution: Turn | None = None
    backlash: Step | None = None
    angular_backlash: Turn | None = None
    servo_stiffness: Stiff | None = None
    angular_servo_stiffness: StiffTurn | None = None
    servo: StrictBool | None = None


class GroundTable(Table):
    """Vibration of the ground along one direction."""

    direction: Literal["x", "y", "z"]
    frequencies: Annotated[tuple[Frequency, ...], Field(max_length=POINTS)]
    density: Annotated[tuple[Density, ...], Field(max_length=POINTS)]


class ToolTable(Table):
    """What the displacement of the tool is relative to."""

    against: Name


class CountedTable(Table):
    """What of the model file counts."""

    tolerances: StrictBool = True
    gravity: StrictBool = True
    servos: StrictBool = True


class MillingTable(Table):
    """A milling cut whose forces displace the tool."""

    depth: Size
    speed: TurningSpeed
    feed_per_tooth: Size | None = None
    harmonics: Annotated[int, Field(strict=True, ge=1, le=50)] = 3


class GeometryCalibrationTable(Table):
    """A calibration of the geometry before the machine is used."""

    parameters: Names | None = None
    directions: Annotated[tuple[Direction, ...], Field(min_length=1, max_length=6)] = (
        "x",
        "y",
        "z",
    )
    poses: Annotated[int, Field(strict=True, ge=1, le=500)] | None = None
    at: Annotated[tuple[PoseTable, ...], Field(max_length=500)] = ()
    candidates: WorkspaceTable | None = None
    uncertainty: Size | None = None
    angular_uncertainty: Slope | None = None


class ErrorsTable(Table):
    """An errors file."""

    source: Annotated[str, Field(max_length=2000)] = ""
    gravity: tuple[Acceleration, Acceleration, Acceleration] | None = None
    tolerances: Annotated[tuple[ToleranceTable, ...], Field(max_length=MOST)] = ()
    milling: MillingTable | None = None
    calibration: GeometryCalibrationTable | None = None
    model: CountedTable = CountedTable()
    tool: ToolTable | None = None
    expansion: Annotated[dict[Name, Coefficient], Field(max_length=MOST, default_factory=dict)]
    conductivity: Annotated[dict[Name, Conductivity], Field(max_length=MOST, default_factory=dict)]
    time: Moment0 | None = None
    drift: Annotated[tuple[Moment0, ...], Field(max_length=MOMENTS)] = ()
    temperatures: Annotated[tuple[TemperatureTable, ...], Field(max_length=MOST)] = ()
    cutting: Annotated[tuple[CuttingTable, ...], Field(max_length=MOST)] = ()
    drives: Annotated[tuple[DriveTable, ...], Field(max_length=MOST)] = ()
    ground: Annotated[tuple[GroundTable, ...], Field(max_length=3)] = ()
