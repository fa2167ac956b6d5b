"""The tables of the model file: their fields, dimensions and ranges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, StrictBool
from pydantic_core import PydanticCustomError, core_schema

from kinematics import DIRECTIONS
from strutwork import units
from strutwork.errors import UnitError
from strutwork.units import Dimension

#: A beam may be divided into this many elements at most.
MAX_ELEMENTS = 1000


@dataclass(frozen=True)
class Quantity:
    """Marks a field that takes a number in SI or a string with its unit.

    Parameters
    ----------
    dimension : Dimension
    low : float or None
        The least value.
    above : float or None
        A bound the value must exceed.
    high : float or None
        The greatest value.
    below : float or None
        A bound the value must stay under.
    """

    dimension: Dimension
    low: float | None = None
    above: float | None = None
    high: float | None = None
    below: float | None = None

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> core_schema.CoreSchema:
        """Validate by `read`."""
        return core_schema.no_info_plain_validator_function(self.read)

    def read(self, value: object) -> float:
        """Value in SI units."""
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


def _empty_is_absent(value: object) -> object:
    return None if value == [] else value


def _diagonal_as_rows(value: object) -> object:
    if isinstance(value, list) and len(value) == 3 and not any(isinstance(v, list) for v in value):
        return [[entry if i == j else 0.0 for j in range(3)] for i, entry in enumerate(value)]
    return value


def _all_directions(value: object) -> object:
    return list(DIRECTIONS) if value == "all" else value


Name = Annotated[str, Field(min_length=1, max_length=100)]
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
Stiff = Annotated[float, Quantity(units.STIFFNESS, above=0.0)]
StiffTurn = Annotated[float, Quantity(units.ROTATIONAL_STIFFNESS, above=0.0)]
Damp = Annotated[float, Quantity(units.DAMPING, low=0.0)]
DampTurn = Annotated[float, Quantity(units.ROTATIONAL_DAMPING, low=0.0)]
Ratio = Annotated[float, Quantity(units.NUMBER, low=0.0, below=1.0)]

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


class Table(BaseModel):
    """A table whose keys are all known."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class StiffnessTable(Table):
    """Stiffness by direction."""

    x: Stiff | None = None
    y: Stiff | None = None
    z: Stiff | None = None
    rx: StiffTurn | None = None
    ry: StiffTurn | None = None
    rz: StiffTurn | None = None


class DampingByDirection(Table):
    """Viscous damping by direction."""

    x: Damp | None = None
    y: Damp | None = None
    z: Damp | None = None
    rx: DampTurn | None = None
    ry: DampTurn | None = None
    rz: DampTurn | None = None


class Displacement(Table):
    """A length or an angle by direction."""

    x: Length | None = None
    y: Length | None = None
    z: Length | None = None
    rx: Angle | None = None
    ry: Angle | None = None
    rz: Angle | None = None


class MaterialTable(Table):
    """An isotropic material."""

    youngs_modulus: Modulus
    poissons_ratio: PoissonsRatio | None = None
    shear_modulus: Modulus | None = None
    density: Density | None = None
    loss_factor: LossFactor | None = None


class RodTable(Table):
    """A solid circle."""

    shape: Literal["rod"]
    diameter: Size


class TubeTable(Table):
    """A hollow circle."""

    shape: Literal["tube"]
    outer_diameter: Size
    inner_diameter: Size


class RectangleTable(Table):
    """A solid rectangle."""

    shape: Literal["rectangle"]
    width_y: Size
    height_z: Size


class BoxTable(Table):
    """A hollow rectangle of one wall thickness."""

    shape: Literal["box"]
    width_y: Size
    height_z: Size
    thickness: Size


class PropertiesTable(Table):
    """A section straight from a table."""

    shape: Literal["properties"]
    area: Area
    Iy: SecondMoment
    Iz: SecondMoment
    J: SecondMoment
    shear_area_y: Area | None = None
    shear_area_z: Area | None = None


SectionTable = Annotated[
    RodTable | TubeTable | RectangleTable | BoxTable | PropertiesTable,
    Field(discriminator="shape"),
]


class BeamTable(Table):
    """A straight beam."""

    name: Name
    from_: Annotated[Name, Field(alias="from")]
    to: Name
    material: Name
    section: Name
    elements: Annotated[int, Field(strict=True, ge=1, le=MAX_ELEMENTS)] = 1
    shear: StrictBool = True
    orientation: Vector | None = None
    offset_from: Point = (0.0, 0.0, 0.0)
    offset_to: Point = (0.0, 0.0, 0.0)


class BodyTable(Table):
    """A rigid body."""

    name: Name
    nodes: tuple[Name, ...]
    mass: Mass | None = None
    center_of_mass: Point | None = None
    inertia: InertiaRows | None = None


class MassTable(Table):
    """A mass carried by a node."""

    node: Name
    mass: Mass
    inertia: Annotated[InertiaRows | None, BeforeValidator(_diagonal_as_rows)] = None


class JointTable(Table):
    """A joint between two nodes."""

    name: Name
    type: Literal[
        "fixed",
        "revolute",
        "prismatic",
        "cylindrical",
        "universal",
        "spherical",
        "planar",
        "bushing",
    ]
    between: Pair
    axis: Vector = (0.0, 0.0, 1.0)
    second_axis: Vector | None = None
    stiffness: StiffnessTable = StiffnessTable()
    damping: DampingByDirection = DampingByDirection()
    driven: tuple[Direction, ...] = ()
    matrix: Annotated[Matrix | None, BeforeValidator(_empty_is_absent)] = None


class SpringTable(Table):
    """A spring to ground or between two nodes, global axes."""

    name: Name | None = None
    node: Name | None = None
    between: Pair | None = None
    stiffness: StiffnessTable


class SupportTable(Table):
    """Directions of a node held by the ground."""

    node: Name
    fixed: Annotated[tuple[Direction, ...], BeforeValidator(_all_directions)]


class LoadTable(Table):
    """A force and a moment at a node."""

    case: Name = "load"
    node: Name
    force: tuple[Force, Force, Force] | None = None
    moment: tuple[Moment, Moment, Moment] | None = None


class LineLoadTable(Table):
    """A force per length over a whole beam."""

    case: Name = "load"
    beam: Name
    force: LineForces
    force_to: LineForces | None = None


class SettlementTable(Table):
    """A known displacement of a support."""

    case: Name = "load"
    node: Name
    displacement: Displacement


class MisfitTable(Table):
    """A gap between the two sides of a joint."""

    case: Name = "load"
    joint: Name
    gap: Displacement


class ToolTable(Table):
    """The tool centre point."""

    tcp: Name


class RayleighTable(Table):
    """C = alpha M + beta K."""

    alpha: Annotated[float, Quantity(units.RATE, low=0.0)]
    beta: Annotated[float, Quantity(units.TIME, low=0.0)]


class DampingTable(Table):
    """Damping of the whole structure; exactly one kind."""

    modal_ratio: Ratio | None = None
    loss_factor: LossFactor | None = None
    rayleigh: RayleighTable | None = None


class ModelTable(Table):
    """The whole file."""

    title: str = ""
    gravity: tuple[Acceleration, Acceleration, Acceleration] | None = None
    materials: dict[Name, MaterialTable] = {}
    sections: dict[Name, SectionTable] = {}
    nodes: dict[Name, Point]
    beams: tuple[BeamTable, ...] = ()
    bodies: tuple[BodyTable, ...] = ()
    masses: tuple[MassTable, ...] = ()
    joints: tuple[JointTable, ...] = ()
    springs: tuple[SpringTable, ...] = ()
    supports: tuple[SupportTable, ...] = ()
    loads: tuple[LoadTable, ...] = ()
    line_loads: tuple[LineLoadTable, ...] = ()
    settlements: tuple[SettlementTable, ...] = ()
    misfits: tuple[MisfitTable, ...] = ()
    tool: ToolTable | None = None
    damping: DampingTable | None = None
