"""Cases of cutting that several tests and benchmarks share."""

from __future__ import annotations

import numpy as np

from strutwork.cutting import Cutter, ForceCoefficients, Milling, TipModes
from tests.semi_discretization import Cut

#: Turning with one degree of freedom: stiffness, N/m, damping ratio, frequency, Hz.
STIFFNESS, RATIO, FREQUENCY = 2.26e8, 0.012, 250.0
#: Its limit in closed form at a cutting stiffness of 1e9 Pa: m, Hz, and rpm of five lobes.
CLOSED_DEPTH = 2.0 * STIFFNESS * RATIO * (1.0 + RATIO) / 1e9
CLOSED_FREQUENCY = FREQUENCY * np.sqrt(1.0 + 2.0 * RATIO)
#: Phase between the waves of two turns by 2π: where the real part of the receptance is least.
_SHARE = 1.0 - np.arctan(1.0 / np.sqrt(1.0 + 2.0 * RATIO)) / np.pi
CLOSED_SPEEDS = 60.0 * CLOSED_FREQUENCY / (np.arange(1, 6) + _SHARE)

#: Milling of Insperger and Stépán: frequency, Hz, damping ratio, mass, kg, K_t and K_n, Pa.
MILL = (922.0, 0.011, 0.03993)
CHIP = ForceCoefficients(6e8, 2e8)


def one_mode() -> TipModes:
    """The tip of the turning case."""
    omega = 2.0 * np.pi * FREQUENCY
    return TipModes.from_modes([FREQUENCY], [RATIO], [[omega / np.sqrt(STIFFNESS), 0.0, 0.0]])


def shaping() -> TipModes:
    """Two modes at +30 and −45 degrees to the direction of the chip."""
    omega = 2.0 * np.pi * np.array([250.0, 150.0])
    angles = np.deg2rad([30.0, -45.0])
    ways = np.stack([np.cos(angles), np.sin(angles), np.zeros(2)], axis=1)
    shapes = ways * (omega / np.sqrt([2.26e8, 2.13e8]))[:, None]
    return TipModes.from_modes([250.0, 150.0], [0.012, 0.010], shapes)


def mill_tip(directions: int) -> TipModes:
    """The tip of the milling case, with a mode along the feed, and one across it for 2."""
    frequency, ratio, mass = MILL
    shapes = np.eye(3)[:directions] / np.sqrt(mass)
    return TipModes.from_modes([frequency] * directions, [ratio] * directions, shapes)


def mill(immersion: float, helix: float = 0.0, teeth: int = 2) -> Milling:
    """Down-milling of the milling case."""
    return Milling(Cutter(0.02, teeth, helix=helix), CHIP, immersion, "down")


def mill_cut(process: Milling, directions: int) -> Cut:
    """The same for the semi-discretisation."""
    frequency, ratio, mass = MILL
    return Cut(
        np.full(directions, frequency),
        np.full(directions, ratio),
        np.eye(2)[:directions] / np.sqrt(mass),
        process.coefficients.tangential,
        process.coefficients.radial,
        float(np.arccos(2.0 * process.immersion - 1.0)),
        np.pi,
        process.teeth,
        2.0 * float(np.tan(process.cutter.helix)) / process.cutter.diameter,
    )


def bull_nose(real: bool) -> TipModes:
    """The measured tip of the bull-nose cutter, with its residues or their imaginary parts."""
    omega = 2.0 * np.pi * np.array([452.77, 1448.53, 516.17, 1407.64])
    zeta = np.array([0.123718, 0.01651, 0.0243, 0.0324])
    residues = np.array(
        [
            9.202966e-5 - 1.862195e-4j,
            -4.181562e-5 - 3.043618e-4j,
            -2.3929e-6 - 1.721539e-4j,
            4.055052e-5 - 3.618808e-4j,
        ]
    )
    if real:
        residues = 1j * residues.imag
    ways = np.eye(3)[[0, 0, 1, 1]]
    poles = -zeta * omega + 1j * omega * np.sqrt(1.0 - zeta**2)
    return TipModes(poles, ways, ways * residues[:, None])


def bull_nose_cut() -> Milling:
    """Half-immersion down-milling with it."""
    return Milling(Cutter(0.03175, 2), ForceCoefficients(1319.4e6, 788.8e6), 0.5, "down")
