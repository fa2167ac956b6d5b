"""Vibration: modes, frequency response and dynamic stiffness."""

from strutwork.fea.complex_modes import ComplexModes, complex_modes
from strutwork.fea.coupled import PartDamping
from strutwork.fea.damping import Damping, LossFactor, ModalRatio, Rayleigh
from strutwork.fea.dynamic_stiffness import (
    MinimumDynamicStiffness,
    blocked_dynamic_stiffness,
    minimum_dynamic_stiffness,
    worst_direction,
)
from strutwork.fea.frf import FrequencyResponse, frequency_response
from strutwork.fea.geometric import axial_forces
from strutwork.fea.level_set import exceeds, level_crossings
from strutwork.fea.modal import ModalModel, modal_model
from strutwork.fea.modes import Modes, modes
from strutwork.fea.ports import Port
from strutwork.fea.preload import preloaded

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
