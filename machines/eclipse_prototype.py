"""The Eclipse prototype: three legs on a circular guide, one from below, six to eight drives."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from math import radians
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import Body, Joint, Poses, tangent_rotation
from strutwork.machines.dimensions import check_proportions
from strutwork.machines.legs import Leg, LegPlacement, hinge_on_column
from strutwork.machines.radial import Radial
from strutwork.machines.three_legs import TOOL, ThreeLegs
from strutwork.machines.variant import Variant
from strutwork.msa.beam import Beam
from strutwork.msa.materials import Material
from strutwork.msa.sections import rod
from strutwork.msa.springs import PointMass
from strutwork.msa.structure import Structure

Array = NDArray[Any]

#: Young's modulus and Poisson's number of steel; the paper names neither. The density is ours.
STEEL = Material.isotropic(210e9, 0.3, 7850.0, name="steel")

Drives = Literal["6", "7a", "7b", "8"]

#: Legs whose hinge is driven besides the carriage and the column.
DRIVEN_HINGES: Mapping[str, tuple[int, ...]] = MappingProxyType(
    {"6": (), "7a": (1,), "7b": (2,), "8": (1, 2)}
)


@dataclass(frozen=True, kw_only=True)
class EclipsePrototype(ThreeLegs):
    """Circular P, vertical P, R about the tangent, S in each leg (Kim 2001, section II).

    The carriage of leg 1 stands below its joint centre on the platform, those of legs 2 and 3
    above theirs. The paper prints neither the link's length nor the platform's radius, the place
    of the tool or the columns' section: the set here is calibrated to its singular tilt angles
    and to its Table II, and is not the only one that meets them.

    The column is clamped in the carriage at the plane of the guide; its free length is the
    height of the hinge.

    Parameters
    ----------
    pole_height : float
        Height of the tool above the plane of the guide at home, m; negative here, since the tool
        points down and the platform's centre stands in that plane (our choice).
    base_radius : float
        R_b, m: between the two guides of 500 and 600 mm in diameter (section VI).
    platform_radius, link_length, tool_below : float
        R_p, L and the distance of the tool below the joint centres, m. Calibrated.
    link_radius : float
        Of the solid round links, m (section V: 33 mm).
    column_radius : float
        Of a solid round column as stiff as the prototype's rectangular one, m. Calibrated to
        Table II.
    shortest_column : float
        A column is never modelled shorter than this, m (assumed).
    below : (bool, bool, bool)
        Whether the carriage of a leg stands below its joint centre.
    drives : "6", "7a", "7b" or "8"
        "7a" drives the hinge of leg 1 as well, "7b" that of leg 2, "8" both.
    platform_mass : float
        With its spindle, kg. Assumed: the paper does not give it.
    ball_range : float
        rad. Section II: 55 degrees to each side; from where is not said, and here it is counted
        from the link's direction at home.
    guide_stiffness : float or None
        N/m; None, as the paper prints none: rigid.
    drive_stiffness : float or None
        N/m; None, as the paper prints none: rigid.
    material : Material
        Of links and columns. Assumed.
    """

    pole_height: float = -0.0912
    base_radius: float = 0.275
    platform_radius: float = 0.080
    link_length: float = 0.3121
    tool_below: float = 0.0912
    link_radius: float = 0.033
    column_radius: float = 0.0157
    shortest_column: float = 0.005
    below: tuple[bool, bool, bool] = (True, False, False)
    drives: Drives = "6"
    platform_mass: float = 10.0
    guide_stiffness: float | None = None
    drive_stiffness: float | None = None
    material: Material = STEEL
    ball_range: float = radians(55.0)

    def __post_init__(self) -> None:
        if self.drives not in DRIVEN_HINGES:
            raise ModelError(
                f"{type(self).__name__}.drives",
                f"is {self.drives!r}.",
                "Choose one of " + ", ".join(f'"{d}"' for d in DRIVEN_HINGES) + ".",
            )
        if not (np.isfinite(self.tool_below) and self.tool_below >= 0.0):
            raise ModelError(
                f"{type(self).__name__}.tool_below",
                f"is {self.tool_below!r}.",
                "Give a length that is not negative, m.",
            )
        super().__post_init__()
        # zero is a choice of either: the tool at the platform's centre, that in the guide's plane
        places = {name: abs(getattr(self, name)) for name in ("tool_below", "pole_height")}
        check_proportions(
            type(self).__name__,
            {name: getattr(self, name) for name in self.dimensions}
            | {name: value for name, value in places.items() if value > 0.0},
        )

    @property
    def lengths(self) -> tuple[str, ...]:
        """Fields that must be positive."""
        return (
            *("base_radius", "platform_radius", "link_length"),
            *("link_radius", "column_radius", "shortest_column"),
        )

    @property
    def dimensions(self) -> tuple[str, ...]:
        """Those of `lengths` that are sizes of the machine and in proportion to one another."""
        return tuple(name for name in self.lengths if name != "shortest_column")

    @property
    def leg(self) -> Leg:
        """Template of a leg."""
        drive = {} if self.drive_stiffness is None else {"z": self.drive_stiffness}
        column = Beam(
            "column",
            ("carriage", "overhang"),
            self.material,
            rod(2.0 * self.column_radius, name="column"),
            shear=self.shear,
        )
        link = Beam(
            "link",
            ("root", "end"),
            self.material,
            rod(2.0 * self.link_radius, name="link"),
            shear=self.shear,
        )
        return Leg(
            nodes=("centre", "carriage", "overhang", "slider", "root", "end"),
            bodies=(
                Body("column", ("centre", "carriage", "overhang")),
                Body("link", ("root", "end")),
            ),
            joints=(
                self.guide("centre"),
                Joint("slide", "prismatic", ("overhang", "slider"), drive, driven=("z",)),
                Joint("hinge", "revolute", ("slider", "root")),
                self.ball,
            ),
            beams=(column, link),
            rigid=(Body("carriage", ("centre", "carriage")),),
            lines=(("carriage", "overhang"), ("root", "end")),
        )

    @cached_property
    def legs(self) -> tuple[Leg, ...]:
        """The three legs with their names in the machine; extra drives turn their hinges."""
        made = []
        for number in (1, 2, 3):
            leg = self.leg.numbered(number)
            if number in DRIVEN_HINGES[self.drives]:
                hinge = f"leg{number}/hinge"
                joints = tuple(
                    replace(j, driven=("rz",)) if j.name == hinge else j for j in leg.joints
                )
                leg = replace(leg, joints=joints)
            made.append(leg)
        return tuple(made)

    @cached_property
    def structure(self) -> Structure:
        """The linkage with its flexible links and the platform's mass."""
        across = self.platform_mass * self.platform_radius**2 / 4.0
        disc = ((across, 0.0, 0.0), (0.0, across, 0.0), (0.0, 0.0, 2.0 * across))
        mass = PointMass(TOOL, self.platform_mass, disc, offset=(0.0, 0.0, self.tool_below))
        return replace(super().structure, masses=(mass,))

    @cached_property
    def seats(self) -> Array:
        """Joint centres in the platform's axes from the tool, (3, 3), m."""
        turn = np.arange(3) * (2.0 * np.pi / 3.0)
        flat = np.stack([np.cos(turn), np.sin(turn), np.zeros(3)], axis=-1)
        return np.asarray(self.platform_radius * flat + [0.0, 0.0, self.tool_below])

    @cached_property
    def neutral(self) -> Array:
        """Directions of the links at home, away from the platform, in its axes, (3, 3)."""
        return -self.place_legs(self.radial(self.home().position + self.seats)).link

    @property
    def upward(self) -> Array:
        """One where a link rises to its joint centre, minus one where it descends, (3,)."""
        return np.where(self.below, 1.0, -1.0)

    def tilted(self, tilt: Array | float, roll: Array | float = 0.0) -> Poses:
        """Poses about the tool at home: tilted about y, turned about the spindle's own axis.

        Parameters
        ----------
        tilt, roll : array_like
            β and γ of R = Ry(β) Rz(γ), rad; broadcast together to (...).
        """
        tilt, roll = np.broadcast_arrays(tilt, roll)
        normal = np.stack([np.sin(tilt), np.zeros(tilt.shape), np.cos(tilt)], axis=-1)
        position = np.broadcast_to(self.home().position, normal.shape)
        return Poses.of(position, tangent_rotation(normal, roll))

    def place_legs(self, seats: Radial) -> LegPlacement:
        """Eqs. 1 to 3; the height of a hinge is P_z − L sin φ, whatever the sign of φ.

        Parameters
        ----------
        seats : Radial
            Joint centres on the platform.
        """

        def along(top: Array, hinge: Array) -> dict[str, Array]:
            short = np.abs(top.real) < self.shortest_column
            shortest = np.where(top.real < 0, -1.0, 1.0) * self.shortest_column
            carriage = seats.at(self.base_radius, top - np.where(short, shortest, top))
            return {"carriage": carriage, "overhang": hinge, "slider": hinge}

        return hinge_on_column(seats, self.base_radius, self.link_length, self.upward, along)


def models_by_drives(machine: type[EclipsePrototype]) -> tuple[Variant, ...]:
    """The machine with six, seven or eight drives.

    Parameters
    ----------
    machine : type
        `EclipsePrototype` or a class of its kind.
    """
    words: dict[Drives, str] = {
        "6": "carriages and columns are driven",
        "7a": "the hinge of leg 1 is driven as well",
        "7b": "the hinge of leg 2 is driven as well",
        "8": "the hinges of legs 1 and 2 are driven as well",
    }
    return tuple(Variant(w, text, partial(machine, drives=w)) for w, text in words.items())
