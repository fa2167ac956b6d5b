"""Forces that manufacturing errors lock into over-constrained mechanisms."""

from overconstraint.allocation import Allocation, allocate
from overconstraint.distribution import Distribution, distribution
from overconstraint.influence import (
    AssemblyForces,
    Influence,
    UndeterminedWarning,
    assembly_forces,
    influence,
)
from overconstraint.limits import Limits, bearing_limit, limit_vector
from overconstraint.responses import (
    Quantity,
    Responses,
    joint_quantities,
    responses,
    tolerance_responses,
    tool_quantities,
)
from overconstraint.rigid_assembly import RigidAssembly, RigidEquilibrium, rigid_equilibrium
from overconstraint.sampling import draw
from overconstraint.self_stress import Redundancy, redundancy
from overconstraint.sensitivity import Sensitivity, given_size, sensitivity
from overconstraint.sources import MisfitSources, ToleranceWarning, misfit_sources
from overconstraint.spread import BINS, Spread
from overconstraint.tolerance import DISTRIBUTIONS, KINDS, TILTS, Tolerance
from overconstraint.tool_deviation import ToolDeviation, tool_deviation
from overconstraint.unit_sets import Ball, Disc, Interval, PlaneZone, UnitSet
from overconstraint.worst_case import WorstCase, worst_case

__all__ = [
    "BINS",
    "DISTRIBUTIONS",
    "KINDS",
    "TILTS",
    "Allocation",
    "AssemblyForces",
    "Ball",
    "Disc",
    "Distribution",
    "Influence",
    "Interval",
    "Limits",
    "MisfitSources",
    "PlaneZone",
    "Quantity",
    "Redundancy",
    "Responses",
    "RigidAssembly",
    "RigidEquilibrium",
    "Sensitivity",
    "Spread",
    "Tolerance",
    "ToleranceWarning",
    "ToolDeviation",
    "UndeterminedWarning",
    "UnitSet",
    "WorstCase",
    "allocate",
    "assembly_forces",
    "bearing_limit",
    "distribution",
    "draw",
    "given_size",
    "influence",
    "joint_quantities",
    "limit_vector",
    "misfit_sources",
    "redundancy",
    "responses",
    "rigid_equilibrium",
    "sensitivity",
    "tolerance_responses",
    "tool_deviation",
    "tool_quantities",
    "worst_case",
]
