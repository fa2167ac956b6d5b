"""What an error sheet is computed from, beside the machine."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import exp, isfinite
from typing import Any

from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.ground_vibration import GroundSpectrum
from strutwork.kinematics import DIRECTIONS
from strutwork.machines.model import Model
from strutwork.msa.thermal_loads import Expansion
from strutwork.overconstraint.tolerance import Tolerance
from strutwork.studies.error_calibration import (
    CalibrationPlan,
    GeometryCalibration,
    calibrated_geometry,
)
from strutwork.studies.error_milling import MillingCut
from strutwork.studies.error_solid_heat import SolidHeat

Array = NDArray[Any]


@dataclass(frozen=True)
class Temperature:
    """Change of temperature of parts.

    Parameters
    ----------
    name : str
        Of the entry: a material, or the parts.
    parts : tuple of (part, expansion)
        Coefficient of expansion of every part, 1/K; of a solid of several materials the first.
    change : float
        Uniform, after a long time, K.
    spread : float
        ± beside the change, of all parts together, K.
    gradient : (float, float)
        Along local y and z of beams, K/m.
    time_constant : float or None
        s; None where the change is there at once.
    solids : tuple of SolidHeat
        Loads of those of the parts that are solids.

    Raises
    ------
    ModelError
        A number out of its range.
    """

    name: str
    parts: tuple[tuple[str, float], ...]
    change: float = 0.0
    spread: float = 0.0
    gradient: tuple[float, float] = (0.0, 0.0)
    time_constant: float | None = None
    solids: tuple[SolidHeat, ...] = ()

    def __post_init__(self) -> None:
        part = f"temperature of {self.name}"
        if not (isfinite(self.spread) and self.spread >= 0):
            raise ModelError(part, f"has the spread {self.spread:g} K.", "Give zero or more.")
        if self.time_constant is not None and not self.time_constant > 0:
            raise ModelError(
                part, f"has the time constant {self.time_constant:g} s.", "Give a positive time."
            )

    def share(self, time: float | None) -> float:
        """Share of the change that is there, 1 − exp(−t/τ), no unit.

        Parameters
        ----------
        time : float or None
            s from the start; None for a long time.
        """
        if time is None or self.time_constant is None:
            return 1.0
        return 1.0 - exp(-time / self.time_constant)

    def expansions(self) -> list[Expansion]:
        """Of every part, after a long time."""
        heated = {s.part: s.load for s in self.solids}
        return [
            Expansion(part, load=heated[part])
            if part in heated
            else Expansion(part, a * self.change, (a * self.gradient[0], a * self.gradient[1]))
            for part, a in self.parts
        ]

    def spreads(self) -> list[Expansion]:
        """Of every part by the spread alone."""
        heated = {s.part: s.per_kelvin for s in self.solids}
        return [
            Expansion(part, load=self.spread * heated[part])
            if part in heated
            else Expansion(part, a * self.spread)
            for part, a in self.parts
        ]


@dataclass(frozen=True)
class CuttingForce:
    """Force of the cut on the tool, and the opposite one on the workpiece.

    Parameters
    ----------
    name : str
    wrench : (6,) tuple
        N and N·m, global axes; the amplitude where there is a frequency.
    frequency : float or None
        Of the teeth, Hz; None for a static force.
    """

    name: str
    wrench: tuple[float, ...]
    frequency: float | None = None

    def __post_init__(self) -> None:
        if self.frequency is not None and not (isfinite(self.frequency) and self.frequency > 0):
            raise ModelError(
                f"cutting {self.name}",
                f"has the frequency {self.frequency:g} Hz.",
                "Give a positive frequency, or none for a static force.",
            )


@dataclass(frozen=True)
class DriveError:
    """What is not perfect in one drive.

    Parameters
    ----------
    joint, direction : str
    resolution : float or None
        Smallest step, m or rad: ± half of it.
    backlash : float or None
        From stop to stop, m or rad: ± half of it.
    servo_stiffness : float or None
        Static stiffness of the closed loop, N/m or N·m/rad; infinite with integral action.
    at_load : bool
        Whether the servo measures the joint: its stiffness is then that of the entire drive, and
        in series with the drive otherwise.
    servo : bool
        Whether the servo of the model counts, where no stiffness is given.

    Raises
    ------
    ModelError
        A value that is not positive; a backlash or resolution of zero is none.
    """

    joint: str
    direction: str
    resolution: float | None = None
    backlash: float | None = None
    servo_stiffness: float | None = None
    at_load: bool = False
    servo: bool = True

    def __post_init__(self) -> None:
        part = f"drive {self.joint}:{self.direction}"
        for what in ("resolution", "backlash"):
            value = getattr(self, what)
            if value is not None and not (isfinite(value) and value >= 0):
                raise ModelError(
                    part, f"has the {what} {value:g}.", "Give the size of its range, zero or more."
                )
        k = self.servo_stiffness
        if k is not None and not k > 0:
            raise ModelError(
                part, f"has the servo stiffness {k:g}.", "Give a positive one, or omit it."
            )


@dataclass(frozen=True)
class ErrorInputs:
    """Causes of errors beside those that the machine states.

    Parameters
    ----------
    temperatures : tuple of Temperature
    cutting : tuple of CuttingForce
    drives : tuple of DriveError
    ground : tuple of GroundSpectrum
    against : str or None
        Node of the workpiece; by default that of the model, or the ground where it has none.
    geometry, gravity : bool
        Whether the machine's tolerances and its gravity count.
    time : float or None
        Moment of the sheet after the temperatures began to change, s; None for a long time.
    moments : tuple of float
        Of the drift, s.
    tolerances : tuple of Tolerance
        Beside those of the machine.
    acceleration : (3,) or None
        Of gravity, m/s², for a machine that states none.
    milling : MillingCut or None
        In the machine's process.
    plan : CalibrationPlan or None
        Of the geometry.
    calibrated : GeometryCalibration or None
        What the plan came to; computed where it is not given.
    source : str
        Where the numbers come from.
    servos : bool
        Whether the servos of the model count, where a drive gives no stiffness of its own.
    """

    temperatures: tuple[Temperature, ...] = ()
    cutting: tuple[CuttingForce, ...] = ()
    drives: tuple[DriveError, ...] = ()
    ground: tuple[GroundSpectrum, ...] = ()
    against: str | None = None
    geometry: bool = True
    gravity: bool = True
    time: float | None = None
    moments: tuple[float, ...] = ()
    tolerances: tuple[Tolerance, ...] = ()
    acceleration: tuple[float, float, float] | None = None
    milling: MillingCut | None = None
    plan: CalibrationPlan | None = None
    calibrated: GeometryCalibration | None = None
    source: str = ""
    servos: bool = True

    def all_tolerances(self, model: Model) -> tuple[Tolerance, ...]:
        """Those of the machine, where they count, and its own.

        Parameters
        ----------
        model : Model
        """
        return (*(model.tolerances if self.geometry else ()), *self.tolerances)

    def computed(self, model: Model) -> ErrorInputs:
        """With what the plan of the calibration comes to, once for all poses.

        Parameters
        ----------
        model : Model

        Raises
        ------
        StrutworkError
            As `strutwork.studies.error_calibration.calibrated_geometry`.
        """
        if self.plan is None or self.calibrated is not None:
            return self
        found = calibrated_geometry(model, self.all_tolerances(model), self.plan)
        return replace(self, calibrated=found)


def unit_of(direction: str) -> str:
    """Unit of a displacement in a direction.

    Parameters
    ----------
    direction : str
    """
    return "rad" if DIRECTIONS.index(direction) > 2 else "m"
