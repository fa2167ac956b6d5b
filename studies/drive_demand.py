"""Largest speeds, forces and powers of drives along a trajectory, beside what they can do."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.kinematics.coordinates import Name
from strutwork.kinematics.following import Followed
from strutwork.machines.limits import SLACK
from strutwork.machines.model import Model

Array = NDArray[Any]


@dataclass(frozen=True)
class DriveLimit:
    """What one drive can do; None where it is not known.

    Parameters
    ----------
    speed : float or None
        m/s or rad/s.
    acceleration : float or None
        m/s² or rad/s².
    force : float or None
        N or N·m.
    power : float or None
        W.
    """

    speed: float | None = None
    acceleration: float | None = None
    force: float | None = None
    power: float | None = None


@dataclass(frozen=True)
class Peak:
    """The largest magnitude of a quantity of a drive, and when.

    Parameters
    ----------
    value : float
        m/s, m/s², N or W, or those of a drive that turns.
    time : float
        s.
    limit : float or None
        In the same unit; None where it is not known.
    """

    value: float
    time: float
    limit: float | None = None

    @property
    def exceeded(self) -> bool:
        """Whether it is beyond its limit."""
        return self.limit is not None and self.value > self.limit


@dataclass(frozen=True)
class DriveDemand:
    """What a trajectory asks of one drive.

    Parameters
    ----------
    joint, direction : str
    low, high : float
        Of its coordinate, m or rad.
    speed, acceleration, force, power : Peak
    rms_force : float
        Root of the mean square over time, N or N·m.
    """

    joint: str
    direction: str
    low: float
    high: float
    speed: Peak
    acceleration: Peak
    force: Peak
    power: Peak
    rms_force: float

    @property
    def label(self) -> str:
        """`joint:direction`."""
        return f"{self.joint}:{self.direction}"


@dataclass(frozen=True)
class OutOfRange:
    """A joint coordinate that leaves its range.

    Parameters
    ----------
    label : str
        `joint:direction`.
    turning : bool
    value, bound : float
        Furthest, and the end of the range, m or rad.
    first, time : float
        When it leaves it, and when it is furthest, s.
    """

    label: str
    turning: bool
    value: float
    bound: float
    first: float
    time: float


def effective_limits(model: Model, given: Mapping[Name, DriveLimit]) -> dict[Name, DriveLimit]:
    """What the drives of a model can do.

    Parameters
    ----------
    model : Model
    given : mapping of (joint, direction) to DriveLimit
        In place of what the model states, each where it is given.
    """
    stated = {(d.joint, d.direction): d for d in model.drives}
    result = {}
    for pair in model.structure.linkage.driven:
        own, other = given.get(pair, DriveLimit()), stated.get(pair)
        speed = other.speed if other is not None else None
        force = other.force if other is not None else None
        result[pair] = DriveLimit(
            own.speed if own.speed is not None else speed,
            own.acceleration,
            own.force if own.force is not None else force,
            own.power,
        )
    return result


def demands_of(followed: Followed, limits: Mapping[Name, DriveLimit]) -> tuple[DriveDemand, ...]:
    """What a trajectory asks of each drive, in the linkage's order.

    Parameters
    ----------
    followed : Followed
    limits : mapping of (joint, direction) to DriveLimit
        Of every drive.
    """

    def peak(values: Array, limit: float | None) -> Peak:
        first = int(np.argmax(np.abs(values)))
        return Peak(float(abs(values[first])), float(followed.times[first]), limit)

    pairs = followed.dynamics.motion.linkage.driven
    rms = followed.rms_forces
    return tuple(
        DriveDemand(
            *pair,
            float(followed.drives[:, k].min()),
            float(followed.drives[:, k].max()),
            peak(followed.speeds[:, k], limits[pair].speed),
            peak(followed.accelerations[:, k], limits[pair].acceleration),
            peak(followed.forces[:, k], limits[pair].force),
            peak(followed.powers[:, k], limits[pair].power),
            float(rms[k]),
        )
        for k, pair in enumerate(pairs)
    )


def ranges_left(model: Model, followed: Followed) -> tuple[OutOfRange, ...]:
    """Joint coordinates that leave their ranges along a trajectory.

    Parameters
    ----------
    model : Model
    followed : Followed
    """
    names = model.motion.joints.names
    found = []
    for limit in model.limits:
        pair = (limit.joint, limit.coordinate)
        if pair not in names:
            # a coordinate of the machine's own formulas
            continue
        values = followed.joint_values[:, names.index(pair)]
        beyond = np.maximum(values - limit.high, limit.low - values)
        worst = int(np.argmax(beyond))
        if beyond[worst] <= SLACK:
            continue
        first = int(np.argmax(beyond > SLACK))
        high = bool(values[worst] > limit.high)
        found.append(
            OutOfRange(
                f"{limit.joint}:{limit.coordinate}",
                limit.coordinate.startswith("r"),
                float(values[worst]),
                limit.high if high else limit.low,
                float(followed.times[first]),
                float(followed.times[worst]),
            )
        )
    return tuple(found)
