"""Vibration: modes, frequency response and dynamic stiffness."""

from fea.complex_modes import ComplexModes, complex_modes
from fea.coupled import PartDamping
from fea.damping import Damping, LossFactor, ModalRatio, Rayleigh
from fea.dynamic_stiffness import (
    MinimumDynamicStiffness,
    blocked_dynamic_stiffness,
    minimum_dynamic_stiffness,
    worst_direction,
)
from fea.frf import FrequencyResponse, frequency_response
from fea.geometric import axial_forces
from fea.level_set import exceeds, level_crossings
from fea.modal import ModalModel, modal_model
from fea.modes import Modes, modes
from fea.ports import Port
from fea.preload import preloaded

__all__ = [
    "ComplexModes",
    "Damping",
    "FrequencyResponse",
    "LossFactor",
    "MinimumDynamicStiffness",
    "ModalModel",
    "ModalRatio",
    "Modes",
    "PartDamping",
    "Port",
    "Rayleigh",
    "axial_forces",
    "blocked_dynamic_stiffness",
    "complex_modes",
    "exceeds",
    "frequency_response",
    "level_crossings",
    "minimum_dynamic_stiffness",
    "modal_model",
    "modes",
    "preloaded",
    "worst_direction",
]
