"""A bearing or guide of a catalogue, as a joint uses it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.contact import (
    AngularContact,
    BallRail,
    Bearing,
    CylindricalRollers,
    Elastic,
    Geometry,
)
from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model_bearing_schema import (
    AngularContactTable,
    BallRailTable,
    BearingTable,
    CylindricalRollersTable,
    GivenStiffnessTable,
)

Array = NDArray[Any]

#: Entries of a stiffness below this share of its diagonal are zero.
ROUNDING = 1e-12


@dataclass(frozen=True)
class BearingEntry:
    """An entry of a catalogue.

    Parameters
    ----------
    name : str
    type : str
        As the catalogue calls it.
    source : str
        Where its numbers come from.
    origin : str
        In which file it stands; "the package" for the package's own catalogue.
    preload : str
        In words.
    geometry : Geometry or None
        What its contacts follow from; None where its stiffness is given.
    given : mapping of direction to float
        Given stiffness, N/m and N·m/rad.
    opens_at : mapping of direction to float
        Of a given stiffness: the load at which a contact opens, N and N·m.

    Raises
    ------
    ModelError
        Without preload it has no stiffness.
    """

    name: str
    type: str
    source: str
    origin: str
    preload: str = ""
    geometry: Geometry | None = None
    given: Mapping[str, float] = field(default_factory=dict)
    opens_at: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def bearing(self) -> Bearing | None:
        """Its contacts under preload; None where its stiffness is given."""
        if self.geometry is None:
            return None
        made = self.geometry.bearing()
        stiffness = np.diag(made.tangent())
        slack = [d for d in made.held if not stiffness[DIRECTIONS.index(d)] > 0.0]
        if slack:
            raise ModelError(
                f"bearing {self.name}",
                f"has no contact without load: it has no stiffness in {', '.join(slack)}.",
                "Give it a preload"
                + (
                    ", as a negative clearance."
                    if self.type == "cylindrical_rollers"
                    else ", as the entry's data sheet states."
                ),
            )
        return made

    @property
    def held(self) -> tuple[str, ...]:
        """Directions in which it resists."""
        return tuple(self.given) if self.bearing is None else self.bearing.held

    @cached_property
    def stiffness(self) -> Array:
        """Tangent at its preload, or the given stiffness, (6, 6), N/m, N and N·m."""
        if self.bearing is not None:
            found = self.bearing.tangent()
            # what symmetry makes zero is left as rounding by the sum over the elements
            scale = np.sqrt(np.abs(np.diag(found)))
            return np.where(np.abs(found) < ROUNDING * np.outer(scale, scale), 0.0, found)
        return np.diag([self.given.get(d, 0.0) for d in DIRECTIONS])


def entry_of(name: str, table: BearingTable, origin: str) -> BearingEntry:
    """The entry that a table describes.

    Parameters
    ----------
    name : str
    table : AngularContactTable, CylindricalRollersTable, BallRailTable or GivenStiffnessTable
    origin : str
        In which file it stands.

    Raises
    ------
    ModelError
        A dimension that cannot be; names the entry.
    """
    if isinstance(table, GivenStiffnessTable):
        given = _named(table.stiffness)
        opens = _named(table.opens_at)
        if not given:
            raise ModelError(f"bearing {name}", "names no stiffness.", "Give it by direction.")
        odd = [d for d in opens if d not in given]
        if odd:
            raise ModelError(
                f"bearing {name}",
                f"opens at a load in {', '.join(odd)}, in which it has no stiffness.",
                "Name directions of its stiffness.",
            )
        return BearingEntry(name, table.type, table.source, origin, "", None, given, opens)
    try:
        geometry, preload = _geometry(table)
    except ModelError as error:
        raise ModelError(f"bearing {name}", error.problem, error.remedy) from None
    return BearingEntry(name, table.type, table.source, origin, preload, geometry)


def _geometry(
    table: AngularContactTable | CylindricalRollersTable | BallRailTable,
) -> tuple[Geometry, str]:
    if isinstance(table, CylindricalRollersTable):
        words = f"clearance {1e6 * table.clearance:g} µm".replace("-", "−")
        return (
            CylindricalRollers(table.rollers, table.length, table.clearance, table.slices),
            words,
        )
    steel = Elastic(table.youngs_modulus, table.poissons_ratio)
    force = f"{table.preload:g} N"
    if isinstance(table, AngularContactTable):
        return (
            AngularContact(
                table.balls,
                table.ball_diameter,
                table.pitch_diameter,
                table.contact_angle,
                table.inner_groove,
                table.outer_groove,
                table.arrangement,
                table.spacing or 0.0,
                table.preload,
                steel,
            ),
            force,
        )
    return (
        BallRail(
            table.balls,
            table.ball_diameter,
            table.rail_groove,
            table.carriage_groove,
            table.width,
            table.height,
            table.length,
            table.contact_angle,
            table.arrangement,
            table.interference,
            table.preload,
            steel,
        ),
        f"interference {1e6 * table.interference:g} µm" if table.interference else force,
    )


def _named(table: Any) -> dict[str, float]:
    named = {d: getattr(table, d) for d in DIRECTIONS}
    return {d: v for d, v in named.items() if v is not None}
