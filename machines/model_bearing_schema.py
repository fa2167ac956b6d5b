"""The tables of the model file, and of catalogue files, that describe bearings and guides."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field
from pydantic_core import PydanticCustomError

from strutwork import units
from strutwork.machines.model_fields import (
    ForceLimit,
    Length,
    Modulus,
    MomentLimit,
    Name,
    PoissonsRatio,
    Quantity,
    Size,
    Table,
)
from strutwork.machines.model_schema import StiffnessTable

#: Elements of a row, and slices of a roller, at most.
MAX_ELEMENTS, MAX_SLICES = 1000, 200


def _stated(text: str) -> str:
    if not text.strip():
        raise PydanticCustomError(
            "range",
            "{problem}",
            {
                "problem": "is missing: an entry of a catalogue names where its numbers come from.",
                "remedy": 'Add it, as in source = "data sheet of the maker, page 12".',
            },
        )
    return text


Source = Annotated[str, Field(max_length=1000), AfterValidator(_stated)]
Count = Annotated[int, Field(strict=True, ge=2, le=MAX_ELEMENTS)]
Groove = Annotated[float, Quantity(units.NUMBER, above=0.5, high=1.0)]
Preload = Annotated[float, Quantity(units.FORCE, low=0.0)]
RightAngle = Annotated[float, Quantity(units.ANGLE, low=0.0, below=1.5707963)]


class ContactTable(Table):
    """What entries with contacts share."""

    source: Source = Field(default="", validate_default=True)
    youngs_modulus: Modulus = 207e9
    poissons_ratio: PoissonsRatio = 0.3


class AngularContactTable(ContactTable):
    """An angular contact ball bearing, or a pair of two."""

    type: Literal["angular_contact"]
    balls: Count
    ball_diameter: Size
    pitch_diameter: Size
    contact_angle: RightAngle
    inner_groove: Groove
    outer_groove: Groove
    arrangement: Literal["single", "back_to_back", "face_to_face"] = "single"
    spacing: Size | None = None
    preload: Preload = 0.0


class CylindricalRollersTable(Table):
    """A cylindrical roller bearing of steel."""

    type: Literal["cylindrical_rollers"]
    source: Source = Field(default="", validate_default=True)
    rollers: Count
    length: Size
    clearance: Length
    slices: Annotated[int, Field(strict=True, ge=1, le=MAX_SLICES)] = 20


class BallRailTable(ContactTable):
    """A carriage of a profile rail with four rows of balls."""

    type: Literal["ball_rail"]
    balls: Count
    ball_diameter: Size
    rail_groove: Groove
    carriage_groove: Groove
    width: Size
    height: Size
    length: Size
    contact_angle: RightAngle = 0.7853981633974483
    arrangement: Literal["O", "X"] = "O"
    interference: Annotated[float, Quantity(units.LENGTH, low=0.0)] = 0.0
    preload: Preload = 0.0


class OpeningLoads(Table):
    """Forces and moments by direction."""

    x: ForceLimit | None = None
    y: ForceLimit | None = None
    z: ForceLimit | None = None
    rx: MomentLimit | None = None
    ry: MomentLimit | None = None
    rz: MomentLimit | None = None


class GivenStiffnessTable(Table):
    """A bearing or guide whose stiffness is given."""

    type: Literal["stiffness"]
    source: Source = Field(default="", validate_default=True)
    stiffness: StiffnessTable
    opens_at: OpeningLoads = OpeningLoads.model_construct()


BearingTable = Annotated[
    AngularContactTable | CylindricalRollersTable | BallRailTable | GivenStiffnessTable,
    Field(discriminator="type"),
]


class CatalogueTable(Table):
    """A file of bearings and guides."""

    bearings: dict[Name, BearingTable]
