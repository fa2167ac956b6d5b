"""Cross-spring pivots: leaves that cross without touching."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from math import cos, pi, sin

import numpy as np
from numpy.typing import ArrayLike

from strutwork.flexures.flexure import Array, Flexure
from strutwork.flexures.leaf import PLATE_WIDTH, leaf_doubts
from strutwork.flexures.profile import leaf_profile
from strutwork.flexures.strip import Strip

#: Angles between the leaves within which the pivot is stiff in both directions, rad.
LEAST_ANGLE, LARGEST_ANGLE = pi / 6, 5 * pi / 6


@dataclass(frozen=True)
class CrossSpring(Flexure):
    """A cross-spring pivot (Haringx 1949; Wittrick 1951); the joint is where its leaves cross.

    Each leaf is clamped in both parts, at ± half the angle from x. The leaves lie side by side
    along z. The rotational stiffness without load is 8 (1 - 3 λ + 3 λ²) E I/L of two leaves,
    2 E I/L where they cross at their middle.

    Parameters
    ----------
    length : float
        Of each leaf between its clamped ends, m.
    angle : float
        Between the leaves, rad.
    crossing : float
        λ: distance of the crossing from the first part along a leaf by its length, no unit.
    leaves : int
        2, or 3: the middle one of the width, the outer ones of half of it.
    spacing : float or None
        Between the middles of neighbouring leaves, along z, m; None: they touch.

    Raises
    ------
    ModelError
        As `Flexure`; leaves that overlap, an angle or crossing out of range.
    """

    length: float
    angle: float = field(default=pi / 2, kw_only=True)
    crossing: float = field(default=0.5, kw_only=True)
    leaves: int = field(default=2, kw_only=True)
    spacing: float | None = field(default=None, kw_only=True)

    shape = "cross_spring"
    sizes = ("length", "spacing")

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.leaves not in {2, 3}:
            raise self.error(f"has {self.leaves!r} leaves.", "Give it 2 or 3.")
        if not 0.0 <= self.crossing <= 1.0:
            raise self.error(
                f"crossing is {self.crossing!r}.",
                "Give a share of the length between 0 and 1: 0.5 crosses at the middle.",
            )
        if not 0.0 < self.angle < pi:
            raise self.error(f"angle is {self.angle:g} rad.", 'Give one as "90 deg".')
        if self.spacing is not None and self.spacing < self.touching * (1 - 1e-9):
            raise self.error(
                f"spacing {self.spacing:g} m is less than {self.touching:g} m, so its leaves "
                "overlap.",
                "Give a larger spacing; leaves that are joined where they cross are no "
                "cross-spring pivot.",
            )

    @property
    def touching(self) -> float:
        """Spacing at which neighbouring leaves touch, m."""
        return self.width * (1.0 if self.leaves == 2 else 0.75)

    @property
    def plate(self) -> bool:
        """Whether its leaves bend as plates: as stated, or from a width of half their length."""
        if self.bending is not None:
            return self.bending == "plate"
        return self.width >= PLATE_WIDTH * self.length

    @cached_property
    def strips(self) -> tuple[tuple[Strip, Array, Array], ...]:
        """Each leaf, its axes as columns, (3, 3), and its middle from the crossing, m, (3,)."""
        factor = self.stress_concentration or 1.0
        profile = leaf_profile(self.length, self.thickness)
        spacing = self.touching if self.spacing is None else self.spacing
        placed = (
            ((1, -0.5, 1.0), (-1, 0.5, 1.0))
            if self.leaves == 2
            else ((1, -1.0, 0.5), (-1, 0.0, 1.0), (1, 1.0, 0.5))
        )
        found = []
        for side, place, share in placed:
            strip = Strip(profile, share * self.width, self.material, self.plate, factor, factor)
            c, s = cos(self.angle / 2.0), side * sin(self.angle / 2.0)
            axes = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
            middle = (0.5 - self.crossing) * self.length * axes[:, 0]
            middle[2] = place * spacing
            found.append((strip, axes, middle))
        return tuple(found)

    @cached_property
    def _maps(self) -> Array:
        """Motion at each leaf's middle, in its axes, per motion of the second part, (k, 6, 6)."""
        found = []
        for _, axes, (x, y, z) in self.strips:
            arm = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
            turn = axes.T
            found.append(np.block([[turn, turn @ arm], [np.zeros((3, 3)), turn]]))
        return np.array(found)

    @cached_property
    def stiffness(self) -> Array:
        """Sum of its leaves', symmetric, N/m, N and N·m/rad, (6, 6)."""
        found = np.zeros((6, 6))
        for (strip, _, _), there in zip(self.strips, self._maps, strict=True):
            found += there.T @ (there / strip.compliance[:, None])
        return (found + found.T) / 2.0

    @cached_property
    def compliance(self) -> Array:
        """Inverse of the stiffness, m/N, 1/N and rad/(N·m), (6, 6)."""
        scale = 1.0 / np.sqrt(np.diag(self.stiffness))
        found = np.linalg.inv(scale[:, None] * self.stiffness * scale)
        found = scale[:, None] * found * scale
        return np.asarray((found + found.T) / 2.0)

    @property
    def doubts(self) -> tuple[str, ...]:
        """Proportions outside the range of its formulas."""
        narrow = self.width if self.leaves == 2 else self.width / 2.0
        found = list(leaf_doubts(self.length, self.thickness, narrow))
        if not LEAST_ANGLE <= self.angle <= LARGEST_ANGLE:
            found.append(
                f"its leaves cross at {np.degrees(self.angle):.3g}°; outside 30° to 150° it is "
                "soft along one axis, where the bending of the leaves decides."
            )
        return tuple(found)

    def stress(self, wrench: ArrayLike) -> Array:
        """Largest equivalent stress of its leaves, Pa, (...).

        Parameters
        ----------
        wrench : (..., 6)
            At the joint, joint axes, N and N·m.
        """
        pairs = zip(self.strips, self._shares(wrench), strict=True)
        return np.asarray(np.max([leaf.stress(six) for (leaf, _, _), six in pairs], axis=0))

    def compression(self, wrench: ArrayLike) -> Array:
        """Largest compression of its leaves by their buckling force, no unit, (...).

        Parameters
        ----------
        wrench : (..., 6)
            At the joint, joint axes, N and N·m.
        """
        pairs = zip(self.strips, self._shares(wrench), strict=True)
        shares = [leaf.compression(six) for (leaf, _, _), six in pairs]
        return np.asarray(np.max(shares, axis=0))

    def _shares(self, wrench: ArrayLike) -> list[Array]:
        """Wrench on each leaf at its middle, in its axes, N and N·m, (..., 6) each."""
        moved = np.asarray(wrench, dtype=float) @ self.compliance.T
        return [
            moved @ there.T / strip.compliance
            for (strip, _, _), there in zip(self.strips, self._maps, strict=True)
        ]
