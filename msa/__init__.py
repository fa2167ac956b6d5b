"""Matrix structural analysis: beams, joints and springs; the saddle-point system; the tool."""

from __future__ import annotations

from typing import TYPE_CHECKING

from strutwork.later import later

if TYPE_CHECKING:
    from strutwork.msa.assembly import System, system_of
    from strutwork.msa.beam import Beam
    from strutwork.msa.budget import ComplianceBudget, compliance_budget
    from strutwork.msa.element import Element
    from strutwork.msa.loads import LineLoad, LoadCase
    from strutwork.msa.materials import Material
    from strutwork.msa.movable import MovableDirections, movable_directions
    from strutwork.msa.rigid_map import rigid_map
    from strutwork.msa.sections import Section, box, rectangle, rod, tube
    from strutwork.msa.solve import METHODS, StaticSolution, solve
    from strutwork.msa.springs import PointMass, Spring
    from strutwork.msa.stiffness import (
        StiffnessEllipsoid,
        axis_stiffness_blocked,
        axis_stiffness_free,
        movable_rank,
        stiffness_ellipsoid,
        tool_stiffness,
    )
    from strutwork.msa.structure import PlacedStructure, Structure
    from strutwork.msa.tool import compliance_and_outcome, prepare_compliance, tool_compliance
    from strutwork.msa.topology import Topology

__all__ = [
    "METHODS",
    "Beam",
    "ComplianceBudget",
    "Element",
    "LineLoad",
    "LoadCase",
    "Material",
    "MovableDirections",
    "PlacedStructure",
    "PointMass",
    "Section",
    "Spring",
    "StaticSolution",
    "StiffnessEllipsoid",
    "Structure",
    "System",
    "Topology",
    "axis_stiffness_blocked",
    "axis_stiffness_free",
    "box",
    "compliance_and_outcome",
    "compliance_budget",
    "movable_directions",
    "movable_rank",
    "prepare_compliance",
    "rectangle",
    "rigid_map",
    "rod",
    "solve",
    "stiffness_ellipsoid",
    "system_of",
    "tool_compliance",
    "tool_stiffness",
    "tube",
]

#: A check of a model file reads no solver, and a structure no section that it has not.
_LATER = {
    "METHODS": "solve",
    "Beam": "beam",
    "ComplianceBudget": "budget",
    "Element": "element",
    "LineLoad": "loads",
    "LoadCase": "loads",
    "Material": "materials",
    "MovableDirections": "movable",
    "PlacedStructure": "structure",
    "PointMass": "springs",
    "Section": "sections",
    "Spring": "springs",
    "StaticSolution": "solve",
    "StiffnessEllipsoid": "stiffness",
    "Structure": "structure",
    "System": "assembly",
    "Topology": "topology",
    "axis_stiffness_blocked": "stiffness",
    "axis_stiffness_free": "stiffness",
    "box": "sections",
    "compliance_and_outcome": "tool",
    "compliance_budget": "budget",
    "movable_directions": "movable",
    "movable_rank": "stiffness",
    "prepare_compliance": "tool",
    "rectangle": "sections",
    "rigid_map": "rigid_map",
    "rod": "sections",
    "solve": "solve",
    "stiffness_ellipsoid": "stiffness",
    "system_of": "assembly",
    "tool_compliance": "tool",
    "tool_stiffness": "stiffness",
    "tube": "sections",
}

__getattr__, __dir__ = later(__name__, _LATER)
