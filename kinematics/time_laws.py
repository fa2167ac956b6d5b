"""Time laws and paths: point to point under speed limits of drives, and circles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.coordinates import Coordinates
from strutwork.kinematics.trajectory import Trajectory

Array = NDArray[Any]

#: Samples of a trajectory that is made.
SAMPLES = 101


@dataclass(frozen=True)
class TimeLaw:
    """From rest to rest: the share of a way over the share of its time.

    Parameters
    ----------
    share : callable
        From u, 0 to 1, (p,), to s, s′ and s″, (3, p).
    breaks : tuple of float
        Shares of the time where a higher derivative jumps, 0 and 1 among them.
    """

    share: Callable[[Array], Array]
    breaks: tuple[float, ...] = (0.0, 1.0)


def quintic() -> TimeLaw:
    """10 u³ − 15 u⁴ + 6 u⁵: no speed and no acceleration at the ends; s′ ≤ 15/8."""

    def share(u: Array) -> Array:
        return np.stack(
            [
                u**3 * (10 - 15 * u + 6 * u**2),
                30 * u**2 * (1 - u) ** 2,
                60 * u * (1 - u) * (1 - 2 * u),
            ]
        )

    return TimeLaw(share)


def trapezoid(ramp: float = 0.25) -> TimeLaw:
    """Constant speed between two ramps, whose acceleration is half a sine squared.

    Parameters
    ----------
    ramp : float
        Share of the time that each ramp takes, up to 1/2. s′ ≤ 1/(1 − ramp).

    Raises
    ------
    ModelError
        A share that is not above 0 and up to 1/2.
    """
    if not 0.0 < ramp <= 0.5:
        raise ModelError("time law", f"has ramps of {ramp!r}.", "Give a share above 0, up to 0.5.")
    top = 1.0 / (1.0 - ramp)

    def share(u: Array) -> Array:
        mirrored = np.minimum(u, 1.0 - u)
        v = np.minimum(mirrored / ramp, 1.0)
        # s′ = top (v − sin 2πv / 2π), whose slope is top (1 − cos 2πv)
        way = top * ramp * (v**2 / 2 + (np.cos(2 * pi * v) - 1) / (4 * pi**2))
        way += top * np.maximum(mirrored - ramp, 0.0)
        speed = top * (v - np.sin(2 * pi * v) / (2 * pi))
        slope = top / ramp * (1 - np.cos(2 * pi * v))
        ahead = u <= 0.5
        return np.stack([np.where(ahead, way, 1.0 - way), speed, np.where(ahead, slope, -slope)])

    breaks = (0.0, ramp, 1.0 - ramp, 1.0) if ramp < 0.5 else (0.0, 0.5, 1.0)
    return TimeLaw(share, breaks)


def _samples(law: TimeLaw, duration: float, start: float) -> Array:
    """Times of samples, those where a derivative jumps among them."""
    even = np.linspace(0.0, 1.0, SAMPLES)
    inner = np.array(law.breaks)
    even = even[np.abs(even[:, None] - inner).min(axis=1) > 1e-9]
    return start + duration * np.sort(np.concatenate([even, inner]))


def _require_duration(duration: float) -> None:
    if not (np.isfinite(duration) and duration > 0):
        raise ModelError("trajectory", f"lasts {duration!r} s.", "Give a time above zero.")


def point_to_point(
    coordinates: Coordinates,
    start: ArrayLike,
    end: ArrayLike,
    duration: float,
    law: TimeLaw | None = None,
) -> Trajectory:
    """Straight in the coordinates, from rest to rest.

    Parameters
    ----------
    coordinates : Coordinates
    start, end : (t,)
        m and rad.
    duration : float
        s.
    law : TimeLaw, optional
        Default `quintic()`.

    Raises
    ------
    ModelError
        Values of another number or not finite, or a duration that is not positive.
    """
    first, last = np.asarray(start, dtype=float), np.asarray(end, dtype=float)
    if first.shape != (len(coordinates),) or last.shape != first.shape:
        raise ModelError(
            "trajectory",
            f"goes from {first.shape} to {last.shape} values.",
            f"Give one each for {', '.join(coordinates.labels)}.",
        )
    if not np.all(np.isfinite([first, last])):
        raise ModelError("trajectory", "has an end that is not finite.", "Give finite numbers.")
    _require_duration(duration)
    used = law or quintic()

    def curve(at: Array) -> Array:
        s = used.share(np.clip(at / duration, 0.0, 1.0))
        way = last - first
        return np.stack(
            [
                first + s[0][:, None] * way,
                s[1][:, None] * way / duration,
                s[2][:, None] * way / duration**2,
            ]
        )

    return Trajectory(coordinates, _samples(used, duration, 0.0), curve)


def circle(
    coordinates: Coordinates,
    centre: ArrayLike,
    radius: float,
    duration: float,
    plane: tuple[str, str] = ("x", "y"),
    law: TimeLaw | None = None,
) -> Trajectory:
    """Once round a circle of two coordinates, from rest to rest; the others stay.

    Parameters
    ----------
    coordinates : Coordinates
    centre : (t,)
        m and rad.
    radius : float
        m, or rad for turns.
    duration : float
        s.
    plane : (str, str)
        Labels of the two coordinates; it begins on the first's positive side, towards the second.
    law : TimeLaw, optional
        Default `quintic()`.

    Raises
    ------
    ModelError
        Labels that are not two of the coordinates', a centre of another number of values, or a
        radius or duration that is not positive.
    """
    middle = np.asarray(centre, dtype=float)
    labels = coordinates.labels
    if len(set(plane)) != 2 or any(name not in labels for name in plane):
        raise ModelError(
            "circle",
            f"lies in {plane[0]} and {plane[1]}.",
            f"Name two of {', '.join(labels)}.",
        )
    if middle.shape != (len(labels),) or not np.all(np.isfinite(middle)):
        raise ModelError(
            "circle", f"has a centre of {middle.shape} values.", f"Give {', '.join(labels)}."
        )
    if not (np.isfinite(radius) and radius > 0):
        raise ModelError("circle", f"has a radius of {radius!r}.", "Give one above zero.")
    _require_duration(duration)
    used = law or quintic()
    ways = np.zeros((2, len(labels)))
    ways[[0, 1], [labels.index(name) for name in plane]] = radius

    def curve(at: Array) -> Array:
        s = used.share(np.clip(at / duration, 0.0, 1.0))
        angle, rate, change = (2 * pi * s / np.array([[1.0], [duration], [duration**2]]))[
            :, :, None
        ]
        c, d = np.cos(angle), np.sin(angle)
        return np.stack(
            [
                middle + c * ways[0] + d * ways[1],
                rate * (-d * ways[0] + c * ways[1]),
                (-change * d - rate**2 * c) * ways[0] + (change * c - rate**2 * d) * ways[1],
            ]
        )

    return Trajectory(coordinates, _samples(used, duration, 0.0), curve)
