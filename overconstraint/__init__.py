"""Forces that manufacturing errors lock into over-constrained mechanisms."""

from overconstraint.influence import AssemblyForces, Influence, assembly_forces, influence
from overconstraint.responses import (
    Quantity,
    Responses,
    joint_quantities,
    responses,
    tolerance_responses,
    tool_quantities,
)
from overconstraint.rigid_assembly import RigidAssembly, RigidEquilibrium, rigid_equilibrium
from overconstraint.self_stress import Redundancy, redundancy
from overconstraint.sources import MisfitSources, ToleranceWarning, misfit_sources
from overconstraint.tolerance import DISTRIBUTIONS, KINDS, TILTS, Tolerance
from overconstraint.unit_sets import Ball, Disc, Interval, PlaneZone, UnitSet
from overconstraint.worst_case import WorstCase, worst_case

__all__ = [
    "DISTRIBUTIONS",
    "KINDS",
    "TILTS",
    "AssemblyForces",
    "Ball",
    "Disc",
    "Influence",
    "Interval",
    "MisfitSources",
    "PlaneZone",
    "Quantity",
    "Redundancy",
    "Responses",
    "RigidAssembly",
    "RigidEquilibrium",
    "Tolerance",
    "ToleranceWarning",
    "UnitSet",
    "WorstCase",
    "assembly_forces",
    "influence",
    "joint_quantities",
    "misfit_sources",
    "redundancy",
    "responses",
    "rigid_equilibrium",
    "tolerance_responses",
    "tool_quantities",
    "worst_case",
]
