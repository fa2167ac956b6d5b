"""Angular contact ball bearings, single or in preloaded pairs."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, isfinite, pi, radians, sin
from typing import Literal

import numpy as np
from scipy.optimize import brentq

from strutwork.contact.bearing import Bearing
from strutwork.contact.contacts import Contacts
from strutwork.contact.hertz import ball_in_groove
from strutwork.contact.law import STEEL, Elastic, in_series
from strutwork.errors import ModelError

Arrangement = Literal["single", "back_to_back", "face_to_face"]

#: Directions of its own axes in which it resists: its axis is z.
HELD = ("x", "y", "z", "rx", "ry")


@dataclass(frozen=True)
class AngularContact:
    """Dimensions of an angular contact ball bearing, of one row or of a pair of equal rows.

    The z axis is that of the bearing. The moving body is the inner ring. A single row bears where
    the inner ring is pushed along +z; a pair bears both ways.

    Parameters
    ----------
    balls : int
        In one row.
    ball_diameter, pitch_diameter : float
        m.
    contact_angle : float
        Where the contacts just touch, rad.
    inner_groove, outer_groove : float
        Radius of the grooves' sections by the ball's diameter, no unit.
    arrangement : "single", "back_to_back" or "face_to_face"
        Back to back the lines of contact meet outside the pair, which resists tilting; face to
        face they meet inside.
    spacing : float
        Between the planes of the balls of a pair, m.
    preload : float
        Axial force on each row, N; of a single row by what stands outside, as a spring, and it
        stays.
    material : Elastic
        Of balls and rings.

    Raises
    ------
    ModelError
        A dimension that cannot be, or that does not go with the others.
    """

    balls: int
    ball_diameter: float
    pitch_diameter: float
    contact_angle: float
    inner_groove: float
    outer_groove: float
    arrangement: Arrangement = "single"
    spacing: float = 0.0
    preload: float = 0.0
    material: Elastic = STEEL

    def __post_init__(self) -> None:
        part = "angular contact bearing"
        if self.balls < 3:
            raise ModelError(part, f"has {self.balls} balls.", "Give at least three.")
        if pi * self.pitch_diameter < self.balls * self.ball_diameter:
            raise ModelError(
                part,
                f"has {self.balls} balls of {1e3 * self.ball_diameter:g} mm, more than its pitch "
                f"diameter of {1e3 * self.pitch_diameter:g} mm holds.",
                "Correct the diameters or the number.",
            )
        if min(self.inner_groove, self.outer_groove) <= 0.5:
            raise ModelError(
                part,
                "has a groove no wider than the ball.",
                "Give the radius of the groove by the diameter of the ball, as 0.52.",
            )
        if not 0.0 <= self.contact_angle < radians(90.0):
            raise ModelError(
                part, "has a contact angle outside 0 to 90 deg.", "Give it, as 25 deg."
            )
        if not (isfinite(self.preload) and self.preload >= 0.0):
            raise ModelError(part, "has a negative preload.", "Give the axial force on a row.")
        if (self.arrangement == "single") != (self.spacing == 0.0):
            raise ModelError(
                part,
                "is single and has a spacing."
                if self.arrangement == "single"
                else "is a pair without a spacing.",
                "Give the distance between the planes of the balls of a pair, and only of a pair.",
            )

    def row(self, facing: int = 1, place: float = 0.0) -> Contacts:
        """One row without preload.

        Parameters
        ----------
        facing : int
            +1 where it bears an inner ring that is pushed along +z, −1 along −z.
        place : float
            Plane of its balls along z, m.
        """
        d, angle = self.ball_diameter, self.contact_angle
        share = d * cos(angle) / self.pitch_diameter
        # the raceway's curvature along its length, by the share of the ball in the pitch diameter
        inner = 2.0 * share / (d * (1.0 - share))
        outer = -2.0 * share / (d * (1.0 + share))
        law = in_series(
            ball_in_groove(d, self.inner_groove, inner, self.material).law,
            ball_in_groove(d, self.outer_groove, outer, self.material).law,
        )
        turn = 2.0 * pi * np.arange(self.balls) / self.balls
        zero, one = np.zeros(self.balls), np.ones(self.balls)
        radial = np.stack([np.cos(turn), np.sin(turn), zero], axis=-1)
        axial = np.array([0.0, 0.0, float(facing)])
        normals = cos(angle) * radial + sin(angle) * axial
        centres = 0.5 * self.pitch_diameter * radial + np.array([0.0, 0.0, place])
        return Contacts(
            points=centres + (self.inner_groove - 0.5) * d * normals,
            normals=normals,
            rolling=np.stack([-np.sin(turn), np.cos(turn), zero], axis=-1),
            distances=(self.inner_groove + self.outer_groove - 1.0) * d * one,
            shifts=np.zeros((self.balls, 3)),
            rows=np.zeros(self.balls, dtype=np.intp),
            law=law,
        )

    def axial_shift(self) -> float:
        """Axial displacement of the inner ring of one row under its preload, m.

        Raises
        ------
        ModelError
            A preload that no row of this contact angle bears.
        """
        if self.preload == 0.0:
            return 0.0
        row = self.row()

        def missing(shift: float) -> float:
            return float(row.loads([0.0, 0.0, shift, 0.0, 0.0, 0.0])[2]) - self.preload

        high = 1e-6 * self.ball_diameter
        while missing(high) < 0.0:
            high *= 2.0
            if high > self.ball_diameter:
                raise ModelError(
                    "angular contact bearing",
                    f"cannot bear an axial preload of {self.preload:g} N.",
                    "Correct the preload, the contact angle or the grooves.",
                )
        return float(brentq(missing, 0.0, high, xtol=1e-18, rtol=1e-14))

    def bearing(self) -> Bearing:
        """The bearing under its preload.

        Raises
        ------
        ModelError
            As `axial_shift`.
        """
        shift = self.axial_shift()
        size = 0.5 * self.pitch_diameter
        if self.arrangement == "single":
            start = np.array([0.0, 0.0, shift, 0.0, 0.0, 0.0])
            return Bearing(self.row(), HELD, ("the row",), start, size)
        out = -1 if self.arrangement == "back_to_back" else 1
        upper = self.row(out, 0.5 * self.spacing).shifted((0.0, 0.0, out * shift))
        lower = self.row(-out, -0.5 * self.spacing).shifted((0.0, 0.0, -out * shift))
        return Bearing(
            upper.joined(lower), HELD, ("the row at +z", "the row at −z"), np.zeros(6), size
        )
