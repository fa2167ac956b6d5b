"""Notch hinges: two circular or elliptic notches opposite each other."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from strutwork.flexures.concentration import notch_in_bending, notch_in_tension
from strutwork.flexures.flexure import Array, Flexure
from strutwork.flexures.profile import notch_profile
from strutwork.flexures.strip import Strip

#: β = t/(2 ρ), ρ the radius at the root, up to which the beam along the notch is as compliant about
#: z as a solid to 12 %; at the second a notch is no hinge.
LARGEST_RATIO, NO_HINGE = 0.2, 1.0
#: Widths, in effective lengths, from which a notch bends as a plate.
PLATE_WIDTH = 3.0


@dataclass(frozen=True)
class Notch(Flexure):
    """What circular and elliptic notches share; the joint is at their middle.

    Parameters
    ----------
    height : float or None
        Of the parts on both sides, along y, m; None: the notches are cut to the middle of the
        circle or ellipse.

    Raises
    ------
    ModelError
        As `Flexure`; a height that cuts no notch or more than half an ellipse; a notch as thick as
        its circle.
    """

    height: float | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        deep = self.thickness + 2.0 * self.half_height
        if self.height is not None and not self.thickness < self.height <= deep * (1 + 1e-9):
            raise self.error(
                f"height {self.height:g} m is not between its thickness and {deep:g} m, where the "
                "notches are cut to the middle.",
                "Leave the height out for notches cut to the middle.",
            )
        if self.ratio >= NO_HINGE:
            raise self.error(
                f"its thickness is {2 * self.ratio:.3g} times the radius at its root, which is no "
                "hinge.",
                "Give a thickness well below the radius; or model it as a beam or a solid.",
            )

    @property
    @abstractmethod
    def half_length(self) -> float:
        """Semi-axis along x, m."""

    @property
    @abstractmethod
    def half_height(self) -> float:
        """Semi-axis along y, m."""

    @property
    def ratio(self) -> float:
        """β: half the thickness by the radius of curvature at the root, no unit."""
        return self.thickness * self.half_height / (2.0 * self.half_length**2)

    @cached_property
    def strip(self) -> Strip:
        """The strip along the notch."""
        cut = 1.0
        if self.height is not None:
            cut = min((self.height - self.thickness) / (2.0 * self.half_height), 1.0)
        profile = notch_profile(self.thickness, self.half_length, self.half_height, cut)
        own = self.stress_concentration
        strip = Strip(
            profile,
            self.width,
            self.material,
            False,
            notch_in_tension(self.ratio) if own is None else own,
            notch_in_bending(self.ratio) if own is None else own,
        )
        plate = self.width >= PLATE_WIDTH * strip.effective_length
        if self.bending is not None:
            plate = self.bending == "plate"
        return Strip(profile, self.width, self.material, plate, strip.tension, strip.bending)

    @property
    def plate(self) -> bool:
        """Whether it bends as a plate: as stated, or from a width of 3 effective lengths."""
        return self.strip.plate

    @property
    def compliance(self) -> Array:
        """Of the strip, diagonal, m/N and rad/(N·m), (6, 6)."""
        return np.diag(self.strip.compliance)

    @property
    def doubts(self) -> tuple[str, ...]:
        """Proportions outside the verified range."""
        found = []
        if self.ratio > LARGEST_RATIO:
            found.append(
                f"its thickness is {2 * self.ratio:.3g} times the radius at its root; the "
                f"formulas hold to {2 * LARGEST_RATIO:g}, where the compliance about z is within "
                "12 % of a solid's."
            )
        if self.width < self.thickness:
            found.append("its width is less than its thickness, so it bends about y too.")
        return tuple(found)

    def stress(self, wrench: ArrayLike) -> Array:
        """Largest equivalent stress, with Neuber's concentration of deep notches, Pa, (...).

        Parameters
        ----------
        wrench : (..., 6)
            At the joint, joint axes, N and N·m.
        """
        return self.strip.stress(wrench)

    def compression(self, wrench: ArrayLike) -> Array:
        """Axial compression by the buckling force of its thin part, no unit, (...).

        Parameters
        ----------
        wrench : (..., 6)
            At the joint, joint axes, N and N·m.
        """
        return self.strip.compression(wrench)


@dataclass(frozen=True)
class CircularNotch(Notch):
    """A notch hinge with circular notches (Paros and Weisbord 1965).

    Parameters
    ----------
    radius : float
        Of both notches, m.
    """

    radius: float

    shape = "circular_notch"
    sizes = ("radius", "height")

    @property
    def half_length(self) -> float:
        """The radius, m."""
        return self.radius

    @property
    def half_height(self) -> float:
        """The radius, m."""
        return self.radius


@dataclass(frozen=True)
class EllipticNotch(Notch):
    """A notch hinge with elliptic notches (Smith, Badami, Dale and Xu 1997).

    Parameters
    ----------
    semi_axis_x, semi_axis_y : float
        Of both ellipses, along the hinge and into it, m.
    """

    semi_axis_x: float
    semi_axis_y: float

    shape = "elliptic_notch"
    sizes = ("semi_axis_x", "semi_axis_y", "height")

    @property
    def half_length(self) -> float:
        """Semi-axis along the hinge, m."""
        return self.semi_axis_x

    @property
    def half_height(self) -> float:
        """Semi-axis into the hinge, m."""
        return self.semi_axis_y
