"""Stress concentration at the root of notches."""

from __future__ import annotations

from math import atan, sqrt


def notch_in_bending(ratio: float) -> float:
    """Largest stress over the nominal one, two opposite deep notches in bending (Neuber 1937).

    Parameters
    ----------
    ratio : float
        Half the least thickness by the radius at the root, no unit: β = t/(2 ρ).
    """
    root = sqrt(ratio)
    if ratio < 1e-3:
        # the series of the same, whose leading terms cancel
        return 1.0 + 0.4 * ratio
    return 4.0 * ratio * root / (3.0 * (root + (ratio - 1.0) * atan(root)))


def notch_in_tension(ratio: float) -> float:
    """Largest stress over the nominal one, two opposite deep notches in tension (Neuber 1937).

    Parameters
    ----------
    ratio : float
        β = t/(2 ρ), no unit.
    """
    root = sqrt(ratio)
    return 2.0 * (ratio + 1.0) * root / ((ratio + 1.0) * atan(root) + root)
