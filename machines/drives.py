"""What drives can do: speed, force and resolution."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from strutwork.errors import ModelError


@dataclass(frozen=True)
class Drive:
    """What the drive of one joint direction can do.

    Parameters
    ----------
    joint, direction : str
    speed : float or None
        Greatest, m/s or rad/s; None where it is not known, here and below.
    force : float or None
        Greatest, N or N·m.
    resolution : float or None
        Smallest step, m or rad: its coordinate is wrong by half of it at most.

    Raises
    ------
    ModelError
        A value that is not positive.
    """

    joint: str
    direction: str
    speed: float | None = None
    force: float | None = None
    resolution: float | None = None

    def __post_init__(self) -> None:
        for what in ("speed", "force", "resolution"):
            value = getattr(self, what)
            if value is not None and not (isfinite(value) and value > 0):
                raise ModelError(
                    f"drive {self.joint}:{self.direction}",
                    f"{what} is {value!r}.",
                    "Give a positive number, or omit it.",
                )
