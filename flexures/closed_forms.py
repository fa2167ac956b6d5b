"""Closed forms of notch hinges, as published: to compare with, not computed with."""

from __future__ import annotations

from math import acos, atan, pi, sqrt, tan


def rotational_compliance(
    youngs_modulus: float,
    width: float,
    thickness: float,
    radius: float,
    height: float | None = None,
) -> float:
    """Rotation about z per moment of a circular notch, rad/(N·m) (Paros and Weisbord 1965, eq. 1).

    Parameters
    ----------
    youngs_modulus : float
        Pa.
    width, thickness, radius : float
        b, t and R, m.
    height : float or None
        Of the parts on both sides, m; None: 2 R + t.
    """
    b = thickness / (2.0 * radius)
    g = 1.0 + b if height is None else height / (2.0 * radius)
    s = 2.0 * b + b**2
    root = sqrt(max(1.0 - (1.0 + b - g) ** 2, 0.0))
    first = ((1.0 + b) / g**2 + (3.0 + 2.0 * b + b**2) / (g * s)) * root
    angle = atan(sqrt((2.0 + b) / b) * (g - b) / root)
    second = 6.0 * (1.0 + b) / s**1.5 * angle
    return float(3.0 / (2.0 * youngs_modulus * width * radius**2) * (first + second) / s)


def rotational_compliance_thin(
    youngs_modulus: float, width: float, thickness: float, radius: float
) -> float:
    """The same where t is much less than R: 9 π R^½/(2 E b t^(5/2)), rad/(N·m) (their eq. 3).

    Parameters
    ----------
    youngs_modulus : float
        Pa.
    width, thickness, radius : float
        b, t and R, m.
    """
    return float(9.0 * pi * sqrt(radius) / (2.0 * youngs_modulus * width * thickness**2.5))


def axial_compliance(
    youngs_modulus: float,
    width: float,
    thickness: float,
    radius: float,
    height: float | None = None,
) -> float:
    """Extension per axial force of a circular notch, m/N (Paros and Weisbord 1965).

    Parameters
    ----------
    youngs_modulus : float
        Pa.
    width, thickness, radius : float
        b, t and R, m.
    height : float or None
        Of the parts on both sides, m; None: 2 R + t.
    """
    b = thickness / (2.0 * radius)
    end = pi / 2 if height is None else acos(1.0 - (height - thickness) / (2.0 * radius))
    turned = atan(sqrt((2.0 + b) / b) * tan(end / 2.0))
    inner = 2.0 * (1.0 + b) / sqrt(2.0 * b + b**2) * turned - end
    return inner / (youngs_modulus * width)


def cross_spring_stiffness(
    youngs_modulus: float, width: float, thickness: float, length: float, crossing: float = 0.5
) -> float:
    """Rotational stiffness of two crossed leaves without load, N·m/rad (Haringx 1949).

    8 (1 - 3 λ + 3 λ²) E I/L, which is 2 E I/L where they cross at their middle.

    Parameters
    ----------
    youngs_modulus : float
        Pa.
    width, thickness, length : float
        Of each leaf, m.
    crossing : float
        λ, no unit.
    """
    inertia = width * thickness**3 / 12.0
    return 8.0 * (1.0 - 3.0 * crossing + 3.0 * crossing**2) * youngs_modulus * inertia / length
