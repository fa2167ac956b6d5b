"""Carriages of profile rails with four rows of balls."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, isfinite, radians, sin
from typing import Literal

import numpy as np

from strutwork.contact.bearing import Bearing
from strutwork.contact.contacts import Contacts
from strutwork.contact.hertz import ball_in_groove
from strutwork.contact.law import STEEL, Elastic, in_series
from strutwork.errors import ModelError

#: Directions of its own axes in which it resists: it slides along z.
HELD = ("x", "y", "rx", "ry", "rz")

#: Rows by the signs of their places along x and y.
ROWS = (
    ((1, 1), "the row at +x +y"),
    ((-1, 1), "the row at −x +y"),
    ((-1, -1), "the row at −x −y"),
    ((1, -1), "the row at +x −y"),
)


@dataclass(frozen=True)
class BallRail:
    """Dimensions of a carriage on a profile rail with four rows of balls.

    The z axis is that of the rail, y is normal to its mounting face, x lies across it. The moving
    body is the carriage. Carriage and rail are rigid but for their contacts.

    Parameters
    ----------
    balls : int
        That bear, in one row.
    ball_diameter : float
        m.
    rail_groove, carriage_groove : float
        Radius of the grooves' sections by the ball's diameter, no unit.
    width, height, length : float
        Between the rows across the rail and above one another, and between the first and the last
        ball that bears, m.
    contact_angle : float
        Between the lines of contact and the x axis, rad.
    arrangement : "O" or "X"
        In an O the lines of contact of one side meet outside the rail, which resists rolling about
        z; in an X they meet inside.
    interference : float
        By how much the balls are larger than their space, m.
    preload : float
        In place of `interference`: vertical force of the two rows that bear upward, and of the two
        that bear downward, N.
    material : Elastic
        Of balls, rail and carriage.

    Raises
    ------
    ModelError
        A dimension that cannot be; a preload and an interference.
    """

    balls: int
    ball_diameter: float
    rail_groove: float
    carriage_groove: float
    width: float
    height: float
    length: float
    contact_angle: float = radians(45.0)
    arrangement: Literal["O", "X"] = "O"
    interference: float = 0.0
    preload: float = 0.0
    material: Elastic = STEEL

    def __post_init__(self) -> None:
        part = "rail carriage"
        if self.balls < 2:
            raise ModelError(part, f"has {self.balls} balls a row.", "Give at least two.")
        if min(self.rail_groove, self.carriage_groove) <= 0.5:
            raise ModelError(
                part,
                "has a groove no wider than the ball.",
                "Give the radius of the groove by the diameter of the ball, as 0.52.",
            )
        if not 0.0 < self.contact_angle < radians(90.0):
            raise ModelError(
                part, "has a contact angle outside 0 to 90 deg.", "Give it, as 45 deg."
            )
        values = (self.width, self.height, self.length, self.interference, self.preload)
        if not all(isfinite(v) and v >= 0.0 for v in values):
            raise ModelError(part, "has a negative dimension or preload.", "Correct it.")
        if self.interference and self.preload:
            raise ModelError(
                part, "has a preload and an interference.", "One follows from the other: give one."
            )

    def bearing(self) -> Bearing:
        """The carriage under its preload."""
        law = in_series(
            ball_in_groove(self.ball_diameter, self.rail_groove, 0.0, self.material).law,
            ball_in_groove(self.ball_diameter, self.carriage_groove, 0.0, self.material).law,
        )
        lean = sin(self.contact_angle)
        squeeze = self.interference
        if self.preload:
            squeeze = float(law.approach(self.preload / (2.0 * self.balls * lean)))
        along = np.linspace(-0.5, 0.5, self.balls) * self.length
        out = 1.0 if self.arrangement == "O" else -1.0
        points, normals = [], []
        for (x, y), _ in ROWS:
            normal = np.array([-x * cos(self.contact_angle), out * y * lean, 0.0])
            centre = np.array([0.5 * x * self.width, 0.5 * y * self.height, 0.0])
            centre = centre + (self.carriage_groove - 0.5) * self.ball_diameter * normal
            points.append(centre + along[:, None] * np.array([0.0, 0.0, 1.0]))
            normals.append(np.tile(normal, (self.balls, 1)))
        count = 4 * self.balls
        every = np.concatenate(normals)
        span = (self.rail_groove + self.carriage_groove - 1.0) * self.ball_diameter
        contacts = Contacts(
            points=np.concatenate(points),
            normals=every,
            rolling=np.tile([0.0, 0.0, 1.0], (count, 1)),
            distances=np.full(count, span),
            shifts=squeeze * every,
            rows=np.repeat(np.arange(4), self.balls),
            law=law,
        )
        size = 0.5 * max(self.width, self.height, self.length)
        return Bearing(contacts, HELD, tuple(name for _, name in ROWS), size=size)
