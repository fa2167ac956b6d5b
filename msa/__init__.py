"""Matrix structural analysis: beams, joints and springs; the saddle-point system; the tool."""

from msa.assembly import System, system_of
from msa.beam import Beam
from msa.budget import ComplianceBudget, compliance_budget
from msa.element import Element
from msa.loads import LineLoad, LoadCase
from msa.materials import Material
from msa.movable import MovableDirections, movable_directions
from msa.sections import Section, box, rectangle, rod, tube
from msa.solve import METHODS, StaticSolution, solve
from msa.springs import PointMass, Spring
from msa.stiffness import (
    StiffnessEllipsoid,
    axis_stiffness_blocked,
    axis_stiffness_free,
    movable_rank,
    stiffness_ellipsoid,
    tool_stiffness,
)
from msa.structure import PlacedStructure, Structure, rigid_map
from msa.tool import compliance_and_outcome, tool_compliance
from msa.topology import Topology

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
