"""Controllers of drives: cascades of a position and a velocity loop."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import Literal

from strutwork.errors import ModelError

#: Highest order of the Padé approximation of a delay.
MOST_ORDER = 8


@dataclass(frozen=True)
class Servo:
    """The controller of one drive, its quantities brought to the joint.

    The velocity that is demanded is K_v (r − p) + f ṙ for the position r that is demanded and
    the measured one p; the force is K_p (e + ∫ e dt / T_n) for the error e of the velocity.

    Parameters
    ----------
    joint, direction : str
    position_gain : float
        K_v, 1/s.
    velocity_gain : float
        K_p, N·s/m, or N·m·s/rad of a rotation.
    inertia : float
        Of the motor and what turns with it, kg or kg·m².
    integral_time : float or None
        T_n, s; None for a velocity loop without integral action.
    feed_forward : float
        f, of the velocity; no unit.
    delay : float
        From the measurement to the force, s.
    order : int
        Of the Padé approximation of the delay.
    encoder : "motor" or "load"
        Where the position is measured; the velocity is the motor's.

    Raises
    ------
    ModelError
        A gain or time that is not positive, a negative inertia or delay, an unknown encoder.
    """

    joint: str
    direction: str
    position_gain: float
    velocity_gain: float
    inertia: float = 0.0
    integral_time: float | None = None
    feed_forward: float = 0.0
    delay: float = 0.0
    order: int = 2
    encoder: Literal["motor", "load"] = "motor"

    def __post_init__(self) -> None:
        for what in ("position_gain", "velocity_gain", "integral_time"):
            value = getattr(self, what)
            if value is not None and not (isfinite(value) and value > 0):
                raise ModelError(
                    f"servo {self}",
                    f"{what} is {value!r}.",
                    "Give a positive number: a drive with a negative or no gain holds nothing."
                    if what != "integral_time"
                    else "Give a positive time, or omit it for no integral action.",
                )
        for what in ("inertia", "feed_forward", "delay"):
            value = getattr(self, what)
            if not (isfinite(value) and value >= 0):
                raise ModelError(f"servo {self}", f"{what} is {value!r}.", "Give zero or more.")
        if not 1 <= self.order <= MOST_ORDER:
            raise ModelError(
                f"servo {self}", f"pade_order is {self.order}.", f"Give 1 to {MOST_ORDER}."
            )
        if self.encoder not in ("motor", "load"):
            raise ModelError(
                f"servo {self}", f'encoder is "{self.encoder}".', 'Write "motor" or "load".'
            )

    def __str__(self) -> str:
        return f"{self.joint}:{self.direction}"

    @property
    def static_stiffness(self) -> float:
        """Force per lasting error of position, N/m or N·m/rad; infinite with integral action."""
        if self.integral_time is not None:
            return float("inf")
        return self.position_gain * self.velocity_gain

    @property
    def lag(self) -> float:
        """Error of position per speed in steady motion, (1 − f) / K_v, s."""
        return (1.0 - self.feed_forward) / self.position_gain
