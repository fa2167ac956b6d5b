"""What a field of the model file may hold: its dimension and its range."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field
from pydantic_core import PydanticCustomError, core_schema

from strutwork import units
from strutwork.errors import UnitError
from strutwork.names import is_hidden, visible
from strutwork.units import Dimension

#: How a quantity with a unit begins.
_NUMBER_FIRST = r"^\s*[-+]?(\d|\.\d)"


@dataclass(frozen=True)
class Quantity:
    """Marks a field that takes a number in SI or a string with its unit.

    Parameters
    ----------
    dimension : Dimension
    low : float or None
        The least value, in SI as the others: whichever unit the dimension has, any unit.
    above : float or None
        A bound the value must exceed, any unit.
    high : float or None
        The greatest value, any unit.
    below : float or None
        A bound the value must stay under, any unit.
    """

    dimension: Dimension
    low: float | None = None
    above: float | None = None
    high: float | None = None
    below: float | None = None

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> core_schema.CoreSchema:
        """Validate by `read`."""
        return core_schema.no_info_plain_validator_function(self.read)

    def __get_pydantic_json_schema__(self, _schema: Any, _handler: Any) -> dict[str, Any]:
        """A number, or a text that begins with one: for editors."""
        bounds = {
            "minimum": self.low,
            "exclusiveMinimum": self.above,
            "maximum": self.high,
            "exclusiveMaximum": self.below,
        }
        number = {"type": "number"} | {k: v for k, v in bounds.items() if v is not None}
        text = {"type": "string", "pattern": _NUMBER_FIRST}
        unit, example = self.dimension.unit, self.dimension.example
        words = f'{self.dimension.name} in {unit}, or with its unit as in "{example}"'
        return {"anyOf": [number, text], "description": words if unit else self.dimension.name}

    def read(self, value: object) -> float:
        """Value in SI units.

        Parameters
        ----------
        value : float or str
            A number in SI, or text with its unit.
        """
        try:
            number = units.quantity(value, self.dimension, "")
        except UnitError as error:
            raise PydanticCustomError(
                "unit", "{problem}", {"problem": error.problem, "remedy": error.remedy}
            ) from None
        rule = self._broken(number)
        if rule:
            raise PydanticCustomError(
                "range",
                "{problem}",
                {
                    "problem": f"{units.shown(value)} is out of range.",
                    "remedy": f"Give {self.dimension.name} {rule}.",
                },
            )
        return number

    def _broken(self, number: float) -> str:
        if self.low is not None and number < self.low:
            return f"of at least {self.low:g}"
        if self.above is not None and number <= self.above:
            return f"above {self.above:g}"
        if self.high is not None and number > self.high:
            return f"of at most {self.high:g}"
        if self.below is not None and number >= self.below:
            return f"below {self.below:g}"
        return ""


class Table(BaseModel):
    """A table whose keys are all known."""

    # a file's tables are made ready once, together, when the first file is read
    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)


def _shown(name: str) -> str:
    """A name that shows all of itself, so that two that look alike are alike."""
    if any(is_hidden(c) for c in name):
        raise PydanticCustomError(
            "range",
            "{problem}",
            {
                "problem": f'"{visible(name)}" contains a character that is not shown.',
                "remedy": "Remove control characters, ends of lines and marks of direction.",
            },
        )
    return name


Name = Annotated[str, Field(min_length=1, max_length=100), AfterValidator(_shown)]
Direction = Literal["x", "y", "z", "rx", "ry", "rz"]
Pair = tuple[Name, Name]

Number = Annotated[float, Quantity(units.NUMBER)]
Length = Annotated[float, Quantity(units.LENGTH)]
Size = Annotated[float, Quantity(units.LENGTH, above=0.0)]
Area = Annotated[float, Quantity(units.AREA, above=0.0)]
SecondMoment = Annotated[float, Quantity(units.SECOND_MOMENT, above=0.0)]
Modulus = Annotated[float, Quantity(units.PRESSURE, above=0.0)]
PoissonsRatio = Annotated[float, Quantity(units.NUMBER, above=-1.0, high=0.5)]
Density = Annotated[float, Quantity(units.DENSITY, above=0.0)]
LossFactor = Annotated[float, Quantity(units.NUMBER, low=0.0)]
Mass = Annotated[float, Quantity(units.MASS, low=0.0)]
Inertia = Annotated[float, Quantity(units.INERTIA)]
Acceleration = Annotated[float, Quantity(units.ACCELERATION)]
Force = Annotated[float, Quantity(units.FORCE)]
Moment = Annotated[float, Quantity(units.MOMENT)]
LineForce = Annotated[float, Quantity(units.LINE_LOAD)]
Angle = Annotated[float, Quantity(units.ANGLE)]
Slope = Annotated[float, Quantity(units.ANGLE, above=0.0)]
Speed = Annotated[float, Quantity(units.SPEED, above=0.0)]
TurningSpeed = Annotated[float, Quantity(units.TURNING_SPEED, above=0.0)]
ForceLimit = Annotated[float, Quantity(units.FORCE, above=0.0)]
MomentLimit = Annotated[float, Quantity(units.MOMENT, above=0.0)]
Cost = Annotated[float, Quantity(units.NUMBER, above=0.0)]
Stiff = Annotated[float, Quantity(units.STIFFNESS, above=0.0)]
StiffTurn = Annotated[float, Quantity(units.ROTATIONAL_STIFFNESS, above=0.0)]
Damp = Annotated[float, Quantity(units.DAMPING, low=0.0)]
DampTurn = Annotated[float, Quantity(units.ROTATIONAL_DAMPING, low=0.0)]
Ratio = Annotated[float, Quantity(units.NUMBER, low=0.0, below=1.0)]
Frequency = Annotated[float, Quantity(units.FREQUENCY, above=0.0)]

#: Entries of a bushing's matrix by block.
K_TT = Annotated[float, Quantity(units.STIFFNESS)]
K_TR = Annotated[float, Quantity(units.COUPLING_STIFFNESS)]
K_RR = Annotated[float, Quantity(units.ROTATIONAL_STIFFNESS)]

Point = tuple[Length, Length, Length]
Vector = tuple[Number, Number, Number]
LineForces = tuple[LineForce, LineForce, LineForce]
InertiaRows = tuple[
    tuple[Inertia, Inertia, Inertia],
    tuple[Inertia, Inertia, Inertia],
    tuple[Inertia, Inertia, Inertia],
]
UpperRow = tuple[K_TT, K_TT, K_TT, K_TR, K_TR, K_TR]
LowerRow = tuple[K_TR, K_TR, K_TR, K_RR, K_RR, K_RR]
Matrix = tuple[UpperRow, UpperRow, UpperRow, LowerRow, LowerRow, LowerRow]
