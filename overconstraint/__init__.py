"""Forces that manufacturing errors lock into over-constrained mechanisms."""

from typing import TYPE_CHECKING

from strutwork.later import later
from strutwork.overconstraint.distribution import Distribution, distribution
from strutwork.overconstraint.influence import (
    AssemblyForces,
    Influence,
    UndeterminedWarning,
    assembly_forces,
    influence,
)
from strutwork.overconstraint.limits import Limits, bearing_limit, limit_vector
from strutwork.overconstraint.responses import (
    Quantity,
    Responses,
    joint_quantities,
    responses,
    tolerance_responses,
    tool_quantities,
)
from strutwork.overconstraint.rigid_assembly import (
    RigidAssembly,
    RigidEquilibrium,
    rigid_equilibrium,
)
from strutwork.overconstraint.sampling import draw
from strutwork.overconstraint.self_stress import Redundancy, redundancy
from strutwork.overconstraint.sensitivity import Sensitivity, given_size, sensitivity
from strutwork.overconstraint.sources import MisfitSources, ToleranceWarning, misfit_sources
from strutwork.overconstraint.spread import BINS, Spread
from strutwork.overconstraint.tolerance import DISTRIBUTIONS, KINDS, TILTS, Tolerance
from strutwork.overconstraint.tool_deviation import ToolDeviation, tool_deviation
from strutwork.overconstraint.unit_sets import Ball, Disc, Interval, PlaneZone, UnitSet
from strutwork.overconstraint.worst_case import WorstCase, worst_case

if TYPE_CHECKING:
    from strutwork.overconstraint.allocation import Allocation, allocate

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

#: The optimisers that these need are slow to read.
__getattr__, __dir__ = later(__name__, {"Allocation": "allocation", "allocate": "allocation"})
