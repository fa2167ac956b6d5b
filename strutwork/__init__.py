"""Strutwork: stiffness, vibration and assembly forces of parallel and hybrid machines.

This package is the ground floor: what every other package shares and nothing about machines.
"""

from strutwork.errors import (
    InconsistentConstraintsError,
    MechanismError,
    ModelError,
    NumericalError,
    OutputError,
    PoseWarning,
    ProportionWarning,
    SingularPoseError,
    StrutworkError,
    UnitError,
    UnreachableError,
)
from strutwork.loading import load
from strutwork.outcome import Outcome

__version__ = "0.1.0"

__all__ = [
    "InconsistentConstraintsError",
    "MechanismError",
    "ModelError",
    "NumericalError",
    "Outcome",
    "OutputError",
    "PoseWarning",
    "ProportionWarning",
    "SingularPoseError",
    "StrutworkError",
    "UnitError",
    "UnreachableError",
    "__version__",
    "load",
]
