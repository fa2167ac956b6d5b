"""Cutting: stability of milling, turning and boring, removal rates and cutting forces."""

from strutwork.cutting.absolute import AbsoluteLimits, absolute_limits, turned_matrices
from strutwork.cutting.assembly import period_map
from strutwork.cutting.coefficients import ForceCoefficients, ProcessDamping
from strutwork.cutting.cutter import Cutter
from strutwork.cutting.depth_effects import DepthEffects, depth_effects
from strutwork.cutting.described import described_frame, described_milling, described_speeds
from strutwork.cutting.forces import cutting_force
from strutwork.cutting.limits import (
    DepthLimits,
    StabilityChart,
    depth_limits,
    kind_of,
    stability_chart,
)
from strutwork.cutting.materials import material, material_library
from strutwork.cutting.period_map import PeriodMap
from strutwork.cutting.pockets import Pocket, best_pockets, removal_rates
from strutwork.cutting.process import Milling, Turning
from strutwork.cutting.tip_dynamics import TipDynamics, tip_dynamics
from strutwork.cutting.tip_modes import TipModes
from strutwork.cutting.tip_response import (
    Frame,
    TipResponse,
    computed_response,
    measured_response,
    oriented,
)
from strutwork.cutting.zero_order import LobeLimits, Lobes, zero_order_lobes

__all__ = [
    "AbsoluteLimits",
    "Cutter",
    "DepthEffects",
    "DepthLimits",
    "ForceCoefficients",
    "Frame",
    "LobeLimits",
    "Lobes",
    "Milling",
    "PeriodMap",
    "Pocket",
    "ProcessDamping",
    "StabilityChart",
    "TipDynamics",
    "TipModes",
    "TipResponse",
    "Turning",
    "absolute_limits",
    "best_pockets",
    "computed_response",
    "cutting_force",
    "depth_effects",
    "depth_limits",
    "described_frame",
    "described_milling",
    "described_speeds",
    "kind_of",
    "material",
    "material_library",
    "measured_response",
    "oriented",
    "period_map",
    "removal_rates",
    "stability_chart",
    "tip_dynamics",
    "turned_matrices",
    "zero_order_lobes",
]
