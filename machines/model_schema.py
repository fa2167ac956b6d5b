"""The tables of the model file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import BeforeValidator, Field, StrictBool

from strutwork import units
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model_fields import (
    Acceleration,
    Angle,
    Area,
    Cost,
    Damp,
    DampTurn,
    Density,
    Direction,
    Force,
    ForceLimit,
    InertiaRows,
    Length,
    LineForces,
    LossFactor,
    Mass,
    Matrix,
    Modulus,
    Moment,
    MomentLimit,
    Name,
    Pair,
    Point,
    PoissonsRatio,
    Quantity,
    Ratio,
    SecondMoment,
    Size,
    Slope,
    Stiff,
    StiffTurn,
    Table,
    Vector,
)
from strutwork.machines.model_motion_schema import (
    CouplingTable,
    DriveTable,
    LimitsTable,
    TaskTable,
    WorkspaceTable,
)

if TYPE_CHECKING:
    from strutwork.machines.model_bearing_schema import BearingTable
    from strutwork.machines.model_flexure_schema import AnyFlexureTable
    from strutwork.machines.model_process_schema import ProcessTable
    from strutwork.machines.model_servo_schema import ServoTable
    from strutwork.machines.model_solid_schema import ShapeTable, SolidTable
else:
    # read for the files that have them only: machines/model_complete_schema.py
    AnyFlexureTable = BearingTable = ProcessTable = ServoTable = ShapeTable = SolidTable = Any

#: Tables that few files have.
RARE = frozenset({"bearings", "flexures", "process", "servos", "shapes", "solids"})

#: A beam may be divided into this many elements at most.
MAX_ELEMENTS = 1000


def _empty_is_absent(value: object) -> object:
    return None if value == [] else value


def _diagonal_as_rows(value: object) -> object:
    if isinstance(value, list) and len(value) == 3 and not any(isinstance(v, list) for v in value):
        return [[entry if i == j else 0.0 for j in range(3)] for i, entry in enumerate(value)]
    return value


def _all_directions(value: object) -> object:
    return list(DIRECTIONS) if value == "all" else value


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
        "helical",
        "universal",
        "spherical",
        "planar",
        "bushing",
    ]
    between: Pair
    axis: Vector = (0.0, 0.0, 1.0)
    second_axis: Vector | None = None
    stiffness: StiffnessTable = StiffnessTable.model_construct()
    damping: DampingByDirection = DampingByDirection.model_construct()
    driven: tuple[Direction, ...] = ()
    limits: LimitsTable = LimitsTable.model_construct()
    matrix: Annotated[Matrix | None, BeforeValidator(_empty_is_absent)] = None
    pitch: Length | None = None
    flexure: Name | None = None
    bearing: Name | None = None


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


class ToleranceTable(Table):
    """A tolerance of a feature that carries joints."""

    name: Name
    kind: Literal[
        "parallelism",
        "perpendicularity",
        "angularity",
        "position",
        "coaxiality",
        "point_position",
        "location",
        "flatness",
        "length",
    ]
    joint: Name | None = None
    joints: tuple[Name, ...] | None = None
    size: Size | None = None
    slope: Slope | None = None
    datum: Name | None = None
    axis: Vector | None = None
    along: Vector | None = None
    length: Size | None = None
    width: Size | None = None
    limits: tuple[Length, Length] | None = None
    distribution: Literal["surface", "uniform", "normal"] = "uniform"
    cost: Cost = 1.0


class ForceLimitTable(Table):
    """The greatest forces that joints may bear."""

    joint: Name | None = None
    joints: tuple[Name, ...] | None = None
    radial_force: ForceLimit | None = None
    axial_force: ForceLimit | None = None
    bending_moment: MomentLimit | None = None
    torque: MomentLimit | None = None
    static_rating: ForceLimit | None = None
    safety_factor: Cost = 1.0


class ToolTable(Table):
    """The tool centre point, and the node of the workpiece."""

    tcp: Name
    against: Name | None = None


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
    """The whole file; one with a table of `RARE` is read by a class that describes it."""

    title: str = ""
    gravity: tuple[Acceleration, Acceleration, Acceleration] | None = None
    preload: Name | None = None
    materials: dict[Name, MaterialTable] = Field(default_factory=dict)
    sections: dict[Name, SectionTable] = Field(default_factory=dict)
    flexures: dict[Name, AnyFlexureTable] = Field(default_factory=dict)
    nodes: dict[Name, Point]
    beams: tuple[BeamTable, ...] = ()
    solids: tuple[SolidTable, ...] = ()
    shapes: tuple[ShapeTable, ...] = ()
    bodies: tuple[BodyTable, ...] = ()
    masses: tuple[MassTable, ...] = ()
    joints: tuple[JointTable, ...] = ()
    couplings: tuple[CouplingTable, ...] = ()
    springs: tuple[SpringTable, ...] = ()
    supports: tuple[SupportTable, ...] = ()
    loads: tuple[LoadTable, ...] = ()
    line_loads: tuple[LineLoadTable, ...] = ()
    settlements: tuple[SettlementTable, ...] = ()
    misfits: tuple[MisfitTable, ...] = ()
    tolerances: tuple[ToleranceTable, ...] = ()
    force_limits: tuple[ForceLimitTable, ...] = ()
    tool: ToolTable | None = None
    home: dict[Name, Displacement] = Field(default_factory=dict)
    task: TaskTable | None = None
    workspace: WorkspaceTable | None = None
    drives: tuple[DriveTable, ...] = ()
    servos: tuple[ServoTable, ...] = ()
    damping: DampingTable | None = None
    process: ProcessTable | None = None
    bearings: dict[Name, BearingTable] = Field(default_factory=dict)
    catalogue: Name | None = None
