"""Machines of the literature: dimensions, kinematics and structures.

Called as a function, `strutwork.machines()` lists them.
"""

from __future__ import annotations

import sys
from types import ModuleType
from typing import TYPE_CHECKING

from strutwork.later import later

if TYPE_CHECKING:
    from collections.abc import Mapping

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
    from strutwork.machines.naming import (
        NamedMachine,
        is_machine,
        named_machine,
        require_mass,
        variants,
    )
    from strutwork.machines.pose_grid import GridMachine, PoseGrid
    from strutwork.machines.proposed_3pprs import Proposed3PPRS
    from strutwork.machines.prototype_3ppprs import Prototype3PPPRS
    from strutwork.machines.serial_five_axis import SerialFiveAxis
    from strutwork.machines.three_legs import ThreeLegs
    from strutwork.machines.variant import Variant
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

#: A machine's file is read when somebody asks for it: each builds its structure from closed forms.
_LATER = {
    "Alizade3PRPS": "alizade_3prps",
    "Biglide": "biglide",
    "BiglideThirdLeg": "biglide_third_leg",
    "CATALOGUE": "catalogue",
    "CatalogueEntry": "catalogue",
    "DYNAMIC_SETS": "azulay_dynamic",
    "DynamicSet": "azulay_dynamic",
    "Eclipse3PPRS": "eclipse_3pprs",
    "EclipseMachine": "eclipse_machine",
    "EclipsePrototype": "eclipse_prototype",
    "Glozman3PRRS": "glozman_3prrs",
    "GoughPlatform": "gough_platform",
    "GridMachine": "pose_grid",
    "HexelHexapod": "hexel_hexapod",
    "Limit": "limits",
    "LinearDelta": "linear_delta",
    "Machine": "catalogue",
    "MitSS1": "mit_ss1",
    "MovingBridge": "moving_bridge",
    "NamedMachine": "naming",
    "Paper": "literature",
    "Platform": "azulay_dynamic",
    "PoseGrid": "pose_grid",
    "Proposed3PPRS": "proposed_3pprs",
    "Prototype3PPPRS": "prototype_3ppprs",
    "SerialFiveAxis": "serial_five_axis",
    "ThreeLegs": "three_legs",
    "Variant": "variant",
    "VibratingLegs": "azulay_dynamic",
    "WorkTable": "work_table",
    "check_limits": "limits",
    "dynamic_machine": "azulay_dynamic",
    "get": "catalogue",
    "hemisphere_normals": "check_points",
    "hemisphere_poses": "check_points",
    "is_machine": "naming",
    "joint_limits": "limits",
    "named_machine": "naming",
    "require_mass": "naming",
    "roll_angles": "check_points",
    "variants": "naming",
}

__getattr__, __dir__ = later(__name__, _LATER)


class _Callable(ModuleType):
    def __call__(self) -> Mapping[str, CatalogueEntry]:
        """Every machine of the catalogue by its name."""
        from strutwork.machines.listed import listed

        return listed()


# one name for the room and for the list of what is in it, as a user looks for both
sys.modules[__name__].__class__ = _Callable
