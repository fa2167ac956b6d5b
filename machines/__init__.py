"""Machines of the literature: dimensions, kinematics and structures.

Called as a function, `strutwork.machines()` lists them.
"""

import sys
from collections.abc import Mapping
from types import ModuleType

from strutwork.html import table
from strutwork.machines.alizade_3prps import Alizade3PRPS
from strutwork.machines.azulay_dynamic import (
    DYNAMIC_SETS,
    DynamicSet,
    Platform,
    VibratingLegs,
    dynamic_machine,
)
from strutwork.machines.biglide import Biglide
from strutwork.machines.biglide_third_leg import BiglideThirdLeg
from strutwork.machines.catalogue import CATALOGUE, CatalogueEntry, Machine, get
from strutwork.machines.check_points import hemisphere_normals, hemisphere_poses, roll_angles
from strutwork.machines.eclipse_3pprs import Eclipse3PPRS
from strutwork.machines.eclipse_machine import EclipseMachine
from strutwork.machines.eclipse_prototype import EclipsePrototype
from strutwork.machines.glozman_3prrs import Glozman3PRRS
from strutwork.machines.gough_platform import GoughPlatform
from strutwork.machines.hexel_hexapod import HexelHexapod
from strutwork.machines.limits import Limit, check_limits, joint_limits
from strutwork.machines.linear_delta import LinearDelta
from strutwork.machines.literature import Paper
from strutwork.machines.mit_ss1 import MitSS1
from strutwork.machines.moving_bridge import MovingBridge
from strutwork.machines.pose_grid import GridMachine, PoseGrid
from strutwork.machines.proposed_3pprs import Proposed3PPRS
from strutwork.machines.prototype_3ppprs import Prototype3PPPRS
from strutwork.machines.serial_five_axis import SerialFiveAxis
from strutwork.machines.three_legs import ThreeLegs
from strutwork.machines.variant import Variant
from strutwork.machines.variants import (
    NamedMachine,
    is_machine,
    named_machine,
    require_mass,
    variants,
)
from strutwork.machines.work_table import WorkTable

__all__ = [
    "CATALOGUE",
    "DYNAMIC_SETS",
    "Alizade3PRPS",
    "Biglide",
    "BiglideThirdLeg",
    "CatalogueEntry",
    "DynamicSet",
    "Eclipse3PPRS",
    "EclipseMachine",
    "EclipsePrototype",
    "Glozman3PRRS",
    "GoughPlatform",
    "GridMachine",
    "HexelHexapod",
    "Limit",
    "LinearDelta",
    "Machine",
    "MitSS1",
    "MovingBridge",
    "NamedMachine",
    "Paper",
    "Platform",
    "PoseGrid",
    "Proposed3PPRS",
    "Prototype3PPPRS",
    "SerialFiveAxis",
    "ThreeLegs",
    "Variant",
    "VibratingLegs",
    "WorkTable",
    "check_limits",
    "dynamic_machine",
    "get",
    "hemisphere_normals",
    "hemisphere_poses",
    "is_machine",
    "joint_limits",
    "named_machine",
    "require_mass",
    "roll_angles",
    "variants",
]


class Listed(dict[str, CatalogueEntry]):
    """The catalogue, shown as a table."""

    def __repr__(self) -> str:
        width = max(map(len, self), default=0)
        return "\n".join(f"{name:<{width}}  {entry.title}" for name, entry in self.items())

    def _repr_html_(self) -> str:
        rows = [(e.name, e.title, e.topology, e.paper.key) for e in self.values()]
        return table("Machines", rows, ("name", "machine", "topology", "document"))


class _Callable(ModuleType):
    def __call__(self) -> Mapping[str, CatalogueEntry]:
        """Every machine of the catalogue by its name."""
        return Listed(CATALOGUE)


# one name for the room and for the list of what is in it, as a user looks for both
sys.modules[__name__].__class__ = _Callable
