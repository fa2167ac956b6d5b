"""The machines of Azulay et al. 2014 for vibration: heavy links on clamped roots (section 3.3.2).

The paper's Table 5 leaves out what decides it: the platform's mass and inertia, where its centre
stands above the spherical joints, and the home heights. Two sets of these stand side by side.
"calibrated" was fitted to Table 5; "blind" takes what the paper prints and a stated rule for the
rest, with nothing fitted.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from math import cos, hypot, pi, radians, sin, sqrt
from types import MappingProxyType
from typing import Any, Literal

import numpy as np

from strutwork.errors import ModelError
from strutwork.kinematics import Linkage, Placement, Poses
from strutwork.machines.alizade_3prps import Alizade3PRPS
from strutwork.machines.eclipse_3pprs import Eclipse3PPRS
from strutwork.machines.glozman_3prrs import Glozman3PRRS
from strutwork.machines.legs import seat
from strutwork.machines.limits import Limit
from strutwork.machines.proposed_3pprs import Proposed3PPRS
from strutwork.machines.three_legs import AISI_1018, TOOL, ThreeLegs
from strutwork.machines.variant import Variant
from strutwork.msa.springs import PointMass
from strutwork.msa.structure import Structure

DynamicSet = Literal["calibrated", "blind"]

#: The sets of what the paper leaves out, in words.
DYNAMIC_SETS: Mapping[DynamicSet, str] = MappingProxyType(
    {
        "calibrated": "fitted to Table 5: rigid platform of 0.5 kg, its centre 11.5 mm above the "
        "spherical joints, home heights and first links",
        "blind": "nothing fitted: platform a steel disc in the plane of the spherical joints, "
        "every machine at home in the middle of its second joint's range",
    }
)


@dataclass(frozen=True, kw_only=True)
class Platform:
    """A rigid platform: a disc whose axis is the tool's.

    Parameters
    ----------
    mass : float
        kg.
    radius, thickness : float
        m; of the disc that its inertia is taken from.
    centre : float
        Height of its centre of mass above the plane of the spherical joints, m.

    Raises
    ------
    ModelError
        A mass or radius that is not positive, or a negative thickness.
    """

    mass: float
    radius: float
    thickness: float = 0.0
    centre: float = 0.0

    def __post_init__(self) -> None:
        for name, low in (("mass", 0.0), ("radius", 0.0)):
            if not (np.isfinite(getattr(self, name)) and getattr(self, name) > low):
                raise ModelError(
                    f"platform.{name}", f"is {getattr(self, name)!r}.", "Give a positive number."
                )
        if not (np.isfinite(self.thickness) and self.thickness >= 0):
            raise ModelError(
                "platform.thickness", f"is {self.thickness!r}.", "Give zero or more, m."
            )

    @classmethod
    def steel_disc(cls, radius: float, thickness: float, centre: float = 0.0) -> Platform:
        """A solid disc of AISI 1018.

        Parameters
        ----------
        radius, thickness : float
            m.
        centre : float
            Height of its centre of mass above the plane of the spherical joints, m.
        """
        density = AISI_1018.density or 0.0
        mass = density * pi * radius**2 * thickness
        return cls(mass=mass, radius=radius, thickness=thickness, centre=centre)

    def point_mass(self, node: str, height: float, axes: tuple[str, str, str]) -> PointMass:
        """The disc carried by a node.

        Parameters
        ----------
        node : str
        height : float
            Of the node above the plane of the spherical joints, m.
        axes : (str, str, str)
            Nodes that carry the disc's axes, as `PointMass.axes`.
        """
        across = self.mass * (self.radius**2 / 4 + self.thickness**2 / 12)
        about = self.mass * self.radius**2 / 2
        inertia = ((across, 0.0, 0.0), (0.0, across, 0.0), (0.0, 0.0, about))
        return PointMass(node, self.mass, inertia, (0.0, 0.0, self.centre - height), axes)


@dataclass(frozen=True, kw_only=True)
class VibratingLegs:
    """A machine of three legs with the data for vibration.

    Parameters
    ----------
    base : ThreeLegs
        Its pole height is the height of the spherical joints' plane at home.
    platform : Platform
    tool_offset : float
        Height e of the tool, the platform's centre point, above the plane of the spherical
        joints, m.
    elements : int
        Beam elements per link. Eight bring every frequency of the four machines that decides a
        minimum within 0.1 % of its limit; with four the Alizade's along z is 0.11 % high.

    Raises
    ------
    ModelError
        A tool offset that is not finite, or no element.
    """

    base: ThreeLegs
    platform: Platform
    tool_offset: float = 0.0
    elements: int = 8

    def __post_init__(self) -> None:
        if not np.isfinite(self.tool_offset):
            raise ModelError("tool_offset", f"is {self.tool_offset!r}.", "Give a length, m.")
        if self.elements < 1:
            raise ModelError("elements", f"are {self.elements}.", "Give at least one per link.")

    @property
    def linkage(self) -> Linkage:
        """Bodies and joints."""
        return self.base.linkage

    @cached_property
    def structure(self) -> Structure:
        """The base's structure with divided links and the platform's mass."""
        whole = self.base.structure
        axes = (seat(1), seat(2), seat(3))
        return replace(
            whole,
            beams=tuple(replace(beam, elements=self.elements) for beam in whole.beams),
            masses=(*whole.masses, self.platform.point_mass(TOOL, self.tool_offset, axes)),
        )

    @property
    def limits(self) -> tuple[Limit, ...]:
        """Joint ranges."""
        return self.base.limits

    def home(self) -> Poses:
        """The tool above the base's home, level."""
        home = self.base.home()
        return Poses(home.position + self.tool_offset * home.rotation[..., :, 2], home.rotation)

    def skeleton(self) -> Sequence[tuple[str, str]]:
        """Pairs of nodes that a drawing connects by a line."""
        return [*self.base.skeleton(), *((TOOL, seat(i)) for i in (1, 2, 3))]

    def place(self, poses: Poses) -> Placement:
        """The base's inverse kinematics below the tool.

        Parameters
        ----------
        poses : Poses
            Of the tool, (...).
        """
        rise = self.tool_offset * poses.rotation[..., :, 2]
        placed = self.base.place(Poses(poses.position - rise, poses.rotation))
        positions: Any = placed.positions.copy()
        positions[..., self.linkage.node_index[TOOL], :] += rise
        return replace(placed, positions=positions)


#: What all machines have in Table 5: drives locked, and beams with shear as finite-element
#: programs have them.
_HELD: Mapping[str, Any] = MappingProxyType(
    {"guide_stiffness": None, "drive_stiffness": None, "shear": True}
)

#: Fitted. The thickness says where the inertia of 0.5 kg lies; with none the first frequencies
#: are 1.5 to 3.5 % higher and the minima change by less than 1 %.
_CALIBRATED_OFFSET = 11.5e-3
_CALIBRATED_PLATFORM = Platform(
    mass=0.5, radius=0.030, thickness=15.5e-3, centre=_CALIBRATED_OFFSET / 2
)

#: The printed joint circle as a disc; 10 mm is what carries a spherical joint of this size.
_BLIND_PLATFORM = Platform.steel_disc(radius=0.018, thickness=0.010)


def _calibrated() -> Mapping[str, Callable[[], ThreeLegs]]:
    height = 0.1522
    return {
        "proposed-3pprs": lambda: Proposed3PPRS(
            pole_height=0.1051, first_link_length=0.130, **_HELD
        ),
        "eclipse-3pprs": lambda: Eclipse3PPRS(column_length=0.065, **_HELD),
        "alizade-3prps": lambda: Alizade3PRPS(
            pole_height=height, strut_length=hypot(0.162 - 0.018, height), **_HELD
        ),
        "glozman-3prrs": lambda: Glozman3PRRS(pole_height=0.1808, **_HELD),
    }


def _blind() -> Mapping[str, Callable[[], ThreeLegs]]:
    base, platform, link, stroke = 0.162, 0.018, 0.216, 0.065
    reach = base + stroke / 2 - platform
    strut_height = sqrt(link**2 - (base - platform) ** 2)
    bar, elevation = 0.130, radians((5.0 + 70.0) / 2)
    inward = base - platform - bar * cos(elevation)
    elbow_height = sqrt(bar**2 - inward**2) + bar * sin(elevation)
    return {
        "proposed-3pprs": lambda: Proposed3PPRS(pole_height=sqrt(link**2 - reach**2), **_HELD),
        "eclipse-3pprs": lambda: Eclipse3PPRS(column_length=stroke / 2, **_HELD),
        "alizade-3prps": lambda: Alizade3PRPS(pole_height=strut_height, strut_length=link, **_HELD),
        "glozman-3prrs": lambda: Glozman3PRRS(pole_height=elbow_height, **_HELD),
    }


def dynamic_machine(name: str, which: DynamicSet = "calibrated") -> VibratingLegs:
    """A machine of Table 5: roots clamped, drives locked, a rigid heavy platform.

    Parameters
    ----------
    name : str
        In the catalogue.
    which : "calibrated" or "blind"
        Of `DYNAMIC_SETS`. Blind: the radial slide (proposed), the column (Eclipse) and the strut
        (Alizade, as the paper says) in the middle of their strokes, the last link of the Glozman
        machine in the middle of its range of 5° to 70°, elbow up; the tool in the plane of the
        joints; the platform a steel disc of the joint circle's radius and 10 mm, 80 g.

    Returns
    -------
    VibratingLegs

    Raises
    ------
    ModelError
        An unknown machine or set.
    """
    known = {"calibrated": _calibrated, "blind": _blind}
    if which not in known or name not in known[which]():
        raise ModelError(
            f"dynamic model {name}, {which}",
            "is not one of Table 5's.",
            "Machines: " + ", ".join(_calibrated()) + "; sets: " + ", ".join(known) + ".",
        )
    base = known[which]()[name]()
    if which == "blind":
        return VibratingLegs(base=base, platform=_BLIND_PLATFORM)
    return VibratingLegs(base=base, platform=_CALIBRATED_PLATFORM, tool_offset=_CALIBRATED_OFFSET)


def _apparent(machine: Callable[[], ThreeLegs]) -> ThreeLegs:
    return machine().apparent()


def models_for_statics_and_vibration(
    name: str, machine: Callable[[], ThreeLegs]
) -> tuple[Variant, ...]:
    """A machine of the comparison as its static tables have it, and as it vibrates.

    Parameters
    ----------
    name : str
        In the catalogue.
    machine : callable
        Makes the machine of the static tables.
    """
    return (
        Variant("static", "true spherical joints, drives with their stiffness", machine),
        Variant(
            "apparent",
            "links clamped in the platform, carriages that do not rotate: as the paper's static "
            "tables suggest",
            partial(_apparent, machine),
        ),
        *(
            Variant(which, words, partial(dynamic_machine, name, which))
            for which, words in DYNAMIC_SETS.items()
        ),
    )
