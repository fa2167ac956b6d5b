"""Tolerances in the words of ISO 1101, and the small displacements that their zones allow.

A toleranced feature moves as a rigid thing: a translation d of its datum point and a rotation θ
about it, a small-displacement torsor (Bourdet and Clément 1988). The zone says which torsors are
allowed; whatever joints the feature carries see the same torsor, so that one tilted axis causes
radial and axial errors of several bearings with one azimuth.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite
from types import MappingProxyType

from strutwork.errors import ModelError

Vector = tuple[float, float, float]

#: What each kind of tolerance limits.
KINDS: Mapping[str, str] = MappingProxyType(
    {
        "parallelism": "tilt of an axis against its datum, any azimuth",
        "perpendicularity": "tilt of an axis against its datum, any azimuth",
        "angularity": "tilt of an axis against its datum, any azimuth",
        "position": "place of an axis in a cylinder about its true place",
        "coaxiality": "place of an axis in a cylinder about its datum axis",
        "point_position": "place of a point in a sphere about its true place",
        "location": "place and tilt of a surface between two planes about its true place",
        "flatness": "height of each seat on a surface, each for itself",
        "length": "a distance along the axis, between two limits",
    }
)

#: Kinds whose zone is a cone of tilts.
TILTS = ("parallelism", "perpendicularity", "angularity")

#: How a value falls within its zone when it is sampled.
DISTRIBUTIONS: Mapping[str, str] = MappingProxyType(
    {
        "surface": "anywhere on the zone's surface",
        "uniform": "anywhere in the zone",
        "normal": "normal, the zone's limit at three standard deviations, cut there",
    }
)


@dataclass(frozen=True)
class Tolerance:
    """A tolerance of a feature that carries joints.

    Parameters
    ----------
    name : str
    kind : str
        A key of `KINDS`.
    joints : tuple of str
        The joints that the feature carries.
    size : float or None
        Width or diameter t of the zone, m: deviations reach t/2 on either side. For a length
        half of its range, ±size.
    slope : float or None
        For tilts, instead of `size` and `length`: the half-angle of the cone, rad or m/m.
    datum : str or None
        The node on the feature about which it turns, on one of the joints' sides. Default: the
        first node of the first joint.
    axis : (3,) or None
        Global direction of the axis, of a surface's normal, or of a length. Default: the z axis
        of the first joint.
    length : float or None
        Of the toleranced axis, or of the surface along `along`, m. A tilt of t over this length
        fills the zone. Without it a position or location cannot tilt.
    width : float or None
        Of the surface across `along`, m.
    along : (3,) or None
        Direction of a surface's length, global. Default: x of `strutwork.kinematics.axes_frame`.
    limits : (float, float) or None
        Of a length, instead of ±`size`, m.
    distribution : str
        A key of `DISTRIBUTIONS`; matters for sampling alone.

    Raises
    ------
    ModelError
        An unknown kind, a size that is not positive, or one given twice or not at all.
    """

    name: str
    kind: str
    joints: tuple[str, ...]
    size: float | None = None
    slope: float | None = None
    datum: str | None = None
    axis: Vector | None = None
    length: float | None = None
    width: float | None = None
    along: Vector | None = None
    limits: tuple[float, float] | None = None
    distribution: str = "uniform"

    def __post_init__(self) -> None:
        part = f"tolerance {self.name}"
        if self.kind not in KINDS:
            raise ModelError(
                part, f'unknown kind "{self.kind}".', "Choose one of: " + ", ".join(KINDS) + "."
            )
        if self.distribution not in DISTRIBUTIONS:
            raise ModelError(
                part,
                f'unknown distribution "{self.distribution}".',
                "Choose one of: " + ", ".join(DISTRIBUTIONS) + ".",
            )
        if not self.joints:
            raise ModelError(part, "names no joint.", "Name the joints that the feature carries.")
        for joint in self.joints:
            if self.joints.count(joint) > 1:
                raise ModelError(part, f'names the joint "{joint}" twice.', "Name it once.")
        for what in ("size", "slope", "length", "width"):
            value = getattr(self, what)
            if value is not None and not (isfinite(value) and value > 0):
                raise ModelError(
                    part,
                    f"{what} is {value:g}.",
                    "Give a positive number; leave the tolerance out where nothing deviates.",
                )
        self._check_size(part)
        for what in ("axis", "along"):
            vector = getattr(self, what)
            if vector is not None and not (
                all(isfinite(v) for v in vector) and any(v != 0 for v in vector)
            ):
                raise ModelError(part, f"{what} is {vector}.", "Give it a direction.")

    def _check_size(self, part: str) -> None:
        tilts = self.kind in TILTS
        given = [n for n in ("size", "slope", "limits") if getattr(self, n) is not None]
        allowed = ("size", "slope") if tilts else ("size",)
        if self.kind == "length":
            allowed = ("size", "limits")
        if len(given) != 1 or given[0] not in allowed:
            raise ModelError(
                part,
                f"a {self.kind} needs {' or '.join(allowed)}, one of them; it has "
                f"{' and '.join(given) or 'none'}.",
                "Give exactly one.",
            )
        if tilts and self.size is not None and self.length is None:
            raise ModelError(
                part,
                f"a {self.kind} of a size needs the length over which it holds.",
                "Give length, or slope instead of size.",
            )
        if self.kind == "location" and (self.length is None) != (self.width is None):
            raise ModelError(
                part, "has one of length and width.", "Give the surface both, or none."
            )
        if self.limits is not None:
            low, high = self.limits
            if not (isfinite(low) and isfinite(high) and low < high):
                raise ModelError(
                    part, f"limits are {low:g} and {high:g}.", "Give the lower one first."
                )

    @property
    def extent(self) -> float:
        """What scales the zone: the half-angle of a cone, else half of its width, rad or m."""
        if self.kind in TILTS:
            return self.slope if self.slope is not None else (self.size or 0) / (self.length or 1)
        if self.limits is not None:
            return (self.limits[1] - self.limits[0]) / 2
        return (self.size or 0.0) * (1.0 if self.kind == "length" else 0.5)

    @property
    def middle(self) -> float:
        """Middle of a length's limits, m; zero else."""
        return sum(self.limits) / 2 if self.limits is not None else 0.0
