"""Strutwork: stiffness, vibration and assembly forces of parallel and hybrid machines.

This package is the ground floor: what every other package shares and nothing about machines.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

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

if TYPE_CHECKING:
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

#: Rooms, entered when somebody asks for one: importing strutwork stays quick.
_ROOMS = (
    "cutting",
    "fea",
    "flexures",
    "kinematics",
    "machines",
    "meshes",
    "msa",
    "overconstraint",
    "papers",
    "reports",
    "servo",
    "studies",
)

#: What completion shows; errors and the ground floor's files are there as well.
_SHOWN = ("StrutworkError", "load", *_ROOMS)


def __getattr__(name: str) -> object:
    if name == "Outcome":
        # the one name here that needs NumPy
        return import_module(f"{__name__}.outcome").Outcome
    if name not in _ROOMS:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return import_module(f"{__name__}.{name}")


def __dir__() -> list[str]:
    return [*_SHOWN, "__version__", "__all__", "__doc__", "__file__", "__path__", "__name__"]
