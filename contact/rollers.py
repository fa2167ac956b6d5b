"""Cylindrical roller bearings."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite, pi

import numpy as np

from strutwork.contact.bearing import Bearing
from strutwork.contact.contacts import Contacts
from strutwork.contact.law import ContactLaw, in_series
from strutwork.contact.line import line_contact
from strutwork.errors import ModelError

#: Directions of its own axes in which it resists: its axis is z.
HELD = ("x", "y", "rx", "ry")


@dataclass(frozen=True)
class CylindricalRollers:
    """Dimensions of a cylindrical roller bearing of one row, of steel.

    The z axis is that of the bearing; along it the bearing is free. Each roller is cut into slices
    that are pressed by themselves, so that it resists tilting; its ends are not relieved.

    Parameters
    ----------
    rollers : int
    length : float
        Effective length of a roller, m.
    clearance : float
        Of the bearing in diameter, m; negative of a bearing that is preloaded.
    slices : int
        Of a roller.

    Raises
    ------
    ModelError
        Too few rollers or slices, or a length that is not positive.
    """

    rollers: int
    length: float
    clearance: float = 0.0
    slices: int = 20

    def __post_init__(self) -> None:
        part = "cylindrical roller bearing"
        if self.rollers < 3:
            raise ModelError(part, f"has {self.rollers} rollers.", "Give at least three.")
        if self.slices < 1:
            raise ModelError(part, "has no slices.", "Give at least one.")
        if not (self.length > 0.0 and isfinite(self.length) and isfinite(self.clearance)):
            raise ModelError(part, "has a length that is not positive.", "Give it, as 10 mm.")

    def law(self) -> ContactLaw:
        """Of one roller in both of its contacts."""
        one = line_contact(self.length)
        return in_series(one, one)

    def bearing(self) -> Bearing:
        """The bearing with its clearance."""
        turn = np.repeat(2.0 * pi * np.arange(self.rollers) / self.rollers, self.slices)
        middle = (np.arange(self.slices) + 0.5) / self.slices - 0.5
        place = np.tile(self.length * middle, self.rollers)
        zero, one = np.zeros_like(turn), np.ones_like(turn)
        radial = np.stack([np.cos(turn), np.sin(turn), zero], axis=-1)
        roller = self.law()
        contacts = Contacts(
            points=np.stack([zero, zero, place], axis=-1),
            normals=radial,
            rolling=np.stack([-np.sin(turn), np.cos(turn), zero], axis=-1),
            distances=np.inf * one,
            shifts=-0.5 * self.clearance * radial,
            rows=np.zeros(len(turn), dtype=np.intp),
            law=ContactLaw(roller.constant / self.slices, roller.exponent),
        )
        return Bearing(
            contacts, HELD, ("the row",), size=0.5 * self.length, around=self.clearance < 0.0
        )
