"""Leaf springs."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from strutwork.flexures.flexure import Array, Flexure
from strutwork.flexures.profile import leaf_profile
from strutwork.flexures.strip import Strip

#: Lengths by thickness below which the clamped ends give way noticeably.
SHORT = 10.0
#: Widths, in lengths, from which a leaf bends as a plate.
PLATE_WIDTH = 0.5


@dataclass(frozen=True)
class Leaf(Flexure):
    """A leaf spring, clamped at both ends; the joint is at its middle.

    Parameters
    ----------
    length : float
        Along x between the clamped ends, m.
    """

    length: float

    shape = "leaf"
    sizes = ("length",)

    @property
    def plate(self) -> bool:
        """Whether it bends as a plate: as stated, or from a width of half its length."""
        if self.bending is not None:
            return self.bending == "plate"
        return self.width >= PLATE_WIDTH * self.length

    @cached_property
    def strip(self) -> Strip:
        """The leaf itself."""
        factor = self.stress_concentration or 1.0
        profile = leaf_profile(self.length, self.thickness)
        return Strip(profile, self.width, self.material, self.plate, factor, factor)

    @property
    def compliance(self) -> Array:
        """Of the strip, diagonal, m/N and rad/(N·m), (6, 6)."""
        return np.diag(self.strip.compliance)

    @property
    def doubts(self) -> tuple[str, ...]:
        """Proportions at which it is no leaf."""
        return leaf_doubts(self.length, self.thickness, self.width)

    def stress(self, wrench: ArrayLike) -> Array:
        """Largest equivalent stress, Pa, (...).

        Parameters
        ----------
        wrench : (..., 6)
            At the joint, joint axes, N and N·m.
        """
        return self.strip.stress(wrench)

    def compression(self, wrench: ArrayLike) -> Array:
        """Axial compression by the buckling force, no unit, (...).

        Parameters
        ----------
        wrench : (..., 6)
            At the joint, joint axes, N and N·m.
        """
        return self.strip.compression(wrench)


def leaf_doubts(length: float, thickness: float, width: float) -> tuple[str, ...]:
    """Proportions at which a strip is no leaf, in sentences.

    Parameters
    ----------
    length, thickness, width : float
        m.
    """
    found = []
    if length < SHORT * thickness:
        found.append(
            f"its length is {length / thickness:.3g} times its thickness; below {SHORT:g} the "
            "parts at its ends deform as much as 10 % of the leaf."
        )
    if width < thickness:
        found.append("its width is less than its thickness, so it bends about y too.")
    return tuple(found)
