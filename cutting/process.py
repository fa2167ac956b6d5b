"""Processes: which force a tool takes for a motion of its tip, and when a tooth returns.

Both kinds answer the same questions: how often a tooth passes, the directional matrix over the
angle of rotation, and where it is not smooth. Forces act on the tool. The axes are x along the
feed, z along the axis of the tool from its tip to its holder, and y completes them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from strutwork.cutting.coefficients import ForceCoefficients, ProcessDamping
from strutwork.cutting.cutter import Cutter
from strutwork.cutting.directional import Directional, edge_terms, flank_terms
from strutwork.cutting.numbers import positive
from strutwork.errors import ModelError

Array = NDArray[Any]


@dataclass(frozen=True)
class Milling:
    """A milling cut with constant radial immersion.

    Angles of rotation are counted clockwise from +y (Altintas 2012, figure 2.10): a tooth at
    φ takes a chip of thickness c sin φ at the feed c per tooth.

    Parameters
    ----------
    cutter : Cutter
    coefficients : ForceCoefficients
    immersion : float
        Radial depth of cut by the diameter, no unit, above 0 to 1 (a slot).
    way : "up" or "down"
        Down: the tooth leaves where the chip is thinnest (climb milling).
    damping : ProcessDamping or None

    Raises
    ------
    ModelError
        An immersion out of range, another way.
    """

    cutter: Cutter
    coefficients: ForceCoefficients
    immersion: float
    way: Literal["up", "down"] = "down"
    damping: ProcessDamping | None = None

    def __post_init__(self) -> None:
        if not 0.0 < self.immersion <= 1.0:
            raise ModelError(
                "milling",
                f"has the radial immersion {self.immersion:g}.",
                "Give the radial depth of cut by the diameter, above 0 to 1.",
            )
        if self.way not in ("up", "down"):
            raise ModelError("milling", f'goes "{self.way}".', "up or down.")

    @property
    def teeth(self) -> int:
        """Passes per turn."""
        return self.cutter.teeth

    @property
    def angles(self) -> tuple[float, float]:
        """Entry and exit of a tooth, rad."""
        swept = float(np.arccos(1.0 - 2.0 * self.immersion))
        return (0.0, swept) if self.way == "up" else (np.pi - swept, np.pi)

    @property
    def directional(self) -> Directional:
        """Force on the tool per chip and depth over the angle."""
        c = self.coefficients
        terms = edge_terms((c.tangential, c.radial, c.axial), self.cutter.lead)
        return Directional(terms, *self.angles, self.cutter.pitch, self.cutter.lag)

    def flank(self, speed: float) -> Directional | None:
        """Force on the tool per velocity and depth, or None without process damping.

        Parameters
        ----------
        speed : float
            Of the spindle, turns per second, Hz.
        """
        if self.damping is None:
            return None
        surface = np.pi * self.cutter.diameter * speed
        terms = flank_terms(self.damping.friction, self.cutter.lead)
        terms = terms * (self.damping.indentation / surface)
        return Directional(terms, *self.angles, self.cutter.pitch, self.cutter.lag)


@dataclass(frozen=True)
class Turning:
    """Turning, boring or shaping: an edge that never leaves the cut, with a steady direction.

    The chip thickness is the motion of the tip along `normal`; the force on the tool per chip
    thickness and width of cut is −`force` times `cutting_stiffness`. Boring is the same with the
    directions of a boring bar's insert; a head with several inserts has `teeth`.

    Parameters
    ----------
    cutting_stiffness : float
        K_f, Pa: the resultant force by chip thickness and width of cut.
    normal : (3,) tuple
        Direction in which the chip grows thicker, any unit; normalised here.
    force : (3,) tuple or None
        Direction of the force of the tool on the workpiece, any unit; None for along `normal`.
    teeth : int
        Inserts per turn.
    diameter : float or None
        Of the surface that is cut, m; process damping takes it for the cutting speed.
    damping : ProcessDamping or None

    Raises
    ------
    ModelError
        A direction of length zero, a number out of range, damping without a diameter.
    """

    cutting_stiffness: float
    normal: tuple[float, float, float] = (1.0, 0.0, 0.0)
    force: tuple[float, float, float] | None = None
    teeth: int = 1
    diameter: float | None = None
    damping: ProcessDamping | None = None

    def __post_init__(self) -> None:
        positive("turning", "cutting stiffness", self.cutting_stiffness)
        for name in ("normal", "force"):
            given = getattr(self, name)
            if given is not None and not (np.shape(given) == (3,) and np.linalg.norm(given) > 0):
                raise ModelError("turning", f"has no direction {name}.", "Give three numbers.")
        if isinstance(self.teeth, bool) or int(self.teeth) != self.teeth or self.teeth < 1:
            raise ModelError("turning", f"has {self.teeth} inserts.", "Give a whole number from 1.")
        if self.diameter is not None:
            positive("turning", "diameter", self.diameter)
        elif self.damping is not None:
            raise ModelError(
                "turning",
                "has process damping and no diameter.",
                "Give the diameter of the surface that is cut: the damping falls with its speed.",
            )

    @property
    def _normal(self) -> Array:
        return np.asarray(np.asarray(self.normal) / np.linalg.norm(self.normal))

    @property
    def _force(self) -> Array:
        given = np.asarray(self.normal if self.force is None else self.force, dtype=float)
        return np.asarray(given / np.linalg.norm(given))

    @property
    def directional(self) -> Directional:
        """Force on the tool per chip and width, the same at every angle."""
        return self._steady(-self.cutting_stiffness * np.outer(self._force, self._normal))

    def flank(self, speed: float) -> Directional | None:
        """Force on the tool per velocity and width, or None without process damping.

        Parameters
        ----------
        speed : float
            Of the spindle, turns per second, Hz.
        """
        if self.damping is None or self.diameter is None:
            return None
        n = self._normal
        # friction acts along the cut: the part of the force across the normal gives its direction
        along = self._force - n * (n @ self._force)
        length = float(np.linalg.norm(along))
        way = n + (self.damping.friction * along / length if length > 1e-12 else 0.0)
        surface = np.pi * self.diameter * speed
        return self._steady(-(self.damping.indentation / surface) * np.outer(way, n))

    def _steady(self, matrix: Array) -> Directional:
        terms = np.zeros((6, 3, 3))
        terms[5] = matrix
        pitch = 2.0 * np.pi / self.teeth
        return Directional(terms, 0.0, pitch, pitch, 0.0)


#: What stability is asked of.
Process = Milling | Turning
