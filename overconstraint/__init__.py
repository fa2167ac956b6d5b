"""Forces that manufacturing errors lock into over-constrained mechanisms."""

from __future__ import annotations

from typing import TYPE_CHECKING

from strutwork.later import later

if TYPE_CHECKING:
    from strutwork.overconstraint.allocation import Allocation, allocate
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

#: A model file may state tolerances that its command has no use for.
_LATER = {
    "BINS": "spread",
    "DISTRIBUTIONS": "tolerance",
    "KINDS": "tolerance",
    "TILTS": "tolerance",
    "Allocation": "allocation",
    "AssemblyForces": "influence",
    "Ball": "unit_sets",
    "Disc": "unit_sets",
    "Distribution": "distribution",
    "Influence": "influence",
    "Interval": "unit_sets",
    "Limits": "limits",
    "MisfitSources": "sources",
    "PlaneZone": "unit_sets",
    "Quantity": "responses",
    "Redundancy": "self_stress",
    "Responses": "responses",
    "RigidAssembly": "rigid_assembly",
    "RigidEquilibrium": "rigid_assembly",
    "Sensitivity": "sensitivity",
    "Spread": "spread",
    "Tolerance": "tolerance",
    "ToleranceWarning": "sources",
    "ToolDeviation": "tool_deviation",
    "UndeterminedWarning": "influence",
    "UnitSet": "unit_sets",
    "WorstCase": "worst_case",
    "allocate": "allocation",
    "assembly_forces": "influence",
    "bearing_limit": "limits",
    "distribution": "distribution",
    "draw": "sampling",
    "given_size": "sensitivity",
    "influence": "influence",
    "joint_quantities": "responses",
    "limit_vector": "limits",
    "misfit_sources": "sources",
    "redundancy": "self_stress",
    "responses": "responses",
    "rigid_equilibrium": "rigid_assembly",
    "sensitivity": "sensitivity",
    "tolerance_responses": "responses",
    "tool_deviation": "tool_deviation",
    "tool_quantities": "responses",
    "worst_case": "worst_case",
}

__getattr__, __dir__ = later(__name__, _LATER)
