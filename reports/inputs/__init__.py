"""What a model was given, in tables, and what it left out, in sentences."""

from strutwork.reports.inputs.bearings import bearings
from strutwork.reports.inputs.echo import Echo
from strutwork.reports.inputs.flexures import flexures
from strutwork.reports.inputs.joints import drives, joints, springs
from strutwork.reports.inputs.loads import acting
from strutwork.reports.inputs.masses import masses, solids
from strutwork.reports.inputs.parts import beams, materials, sections
from strutwork.reports.inputs.taken import assumed
from strutwork.reports.inputs.tolerances import force_limits, tolerances

__all__ = [
    "Echo",
    "acting",
    "assumed",
    "beams",
    "bearings",
    "drives",
    "flexures",
    "force_limits",
    "joints",
    "masses",
    "materials",
    "sections",
    "solids",
    "springs",
    "tolerances",
]
