"""Hertz's point contact by complete elliptic integrals."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, pi, sqrt

from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from strutwork.contact.law import STEEL, ContactLaw, Elastic
from strutwork.errors import ModelError

#: Ellipses that are longer are line contacts, logarithm of the ratio of their axes.
LONGEST = 12.0

#: Below this logarithm the ellipse counts as a circle: there the integrals cancel.
ROUND = 1e-6


@dataclass(frozen=True)
class PointContact:
    """Contact of two bodies of the same material at a point.

    Parameters
    ----------
    law : ContactLaw
        Q = C δ^(3/2).
    ratio : float
        Of the long semi-axis of the ellipse to the short one, no unit.
    """

    law: ContactLaw
    ratio: float


def point_contact(first: float, second: float, material: Elastic = STEEL) -> PointContact:
    """Contact by the relative curvatures in its two principal planes.

    With κ the ratio of the semi-axes, m = 1 − 1/κ² and the complete integrals K and E:
    (K − E) / (κ² E − K) is the ratio of the lesser to the greater curvature, and
    C = (π κ E' / 3) √(2 E / (Σρ K³)), E' = E_Young / (1 − ν²) (Johnson, Contact Mechanics, 1985,
    section 4.2; Harris, Rolling Bearing Analysis, chapter on contact stress and deformation).

    Parameters
    ----------
    first, second : float
        Sums of the curvatures of both bodies in the two planes, 1/m; concave is negative.
    material : Elastic
        Of both bodies.

    Returns
    -------
    PointContact

    Raises
    ------
    ModelError
        A sum that is not positive: the bodies conform; or one so small that they touch in a line.
    """
    low, high = sorted((first, second))
    if not low > 0.0:
        raise ModelError(
            "contact",
            f"has the relative curvature {low:.6g} 1/m in one plane: the bodies conform.",
            "Give the groove a radius above half the ball's diameter.",
        )
    ratio = _axis_ratio(low / high)
    m = 1.0 - ratio**-2
    k, e = float(ellipk(m)), float(ellipe(m))
    constant = pi * ratio * material.plane / 3.0 * sqrt(2.0 * e / ((low + high) * k**3))
    return PointContact(ContactLaw(constant, 1.5), ratio)


def _axis_ratio(curvatures: float) -> float:
    """Long by short semi-axis of the ellipse, by the lesser curvature over the greater."""

    def above(log_ratio: float) -> float:
        square = exp(2.0 * log_ratio)
        m = 1.0 - 1.0 / square
        k, e = ellipk(m), ellipe(m)
        return float((k - e) - curvatures * (square * e - k))

    if curvatures >= 1.0 - ROUND:
        # near a circle the ratio of the curvatures is κ^(−3/2)
        return float(curvatures ** (-2.0 / 3.0))
    if above(LONGEST) > 0.0:
        raise ModelError(
            "contact",
            "is so long that the bodies touch in a line.",
            "Use the line contact, or correct the radii.",
        )
    return exp(brentq(above, 0.1 * ROUND, LONGEST, xtol=1e-15, rtol=1e-15))


def ball_in_groove(
    diameter: float, groove: float, along: float = 0.0, material: Elastic = STEEL
) -> PointContact:
    """Contact of a ball with the groove of a raceway.

    Parameters
    ----------
    diameter : float
        Of the ball, m.
    groove : float
        Radius of the groove's section by the ball's diameter, no unit; above one half.
    along : float
        Curvature of the raceway along its length, 1/m: positive of an inner ring, negative of an
        outer ring, zero of a straight rail.
    material : Elastic

    Raises
    ------
    ModelError
        As `point_contact`.
    """
    ball = 2.0 / diameter
    return point_contact(ball - 1.0 / (groove * diameter), ball + along, material)
