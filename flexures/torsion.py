"""Torsion of a short flexure, whose ends do not warp."""

from __future__ import annotations

from dataclasses import dataclass
from math import tanh
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.flexures.profile import Profile
from strutwork.msa.sections import rectangle_torsion_constant

Array = NDArray[Any]


@dataclass(frozen=True)
class Torsion:
    """Twist and stress of a flexure under a unit torque about its length.

    Parameters
    ----------
    compliance : float
        rad/(N·m).
    normal : (m,)
        Largest normal stress at the profile's stations per torque, from bending across the
        width that the ends restrain, Pa/(N·m).
    shear : (m,)
        Largest shear stress at the stations per torque, Pa/(N·m).
    """

    compliance: float
    normal: Array
    shear: Array


def torsion(profile: Profile, width: float, bending: float, shear: float) -> Torsion:
    """Torsion between ends that stay plane.

    A strip along x at the distance z from the axis is a Timoshenko beam: it deflects by θ(x) z and
    its sections turn by φ(x) z. With B = E h³ b³/144, S = κ G h b³/12 and 1/T = 4/(G J) - 1/S the
    energy is ½ ∫ B φ'² + S (θ' - φ)² + T (θ' + φ)² dx, φ = 0 at both ends: the plate of Mindlin
    with a deflection linear in z, and with J of the rectangle. Without shear it is Vlasov's
    torsion with the secondary warping constant b³ h³/144, by which constrained leaf springs are
    computed (Brouwer, Meijaard and Jonker 2013); long flexures have Saint-Venant's ∫ dx/(G J).

    Parameters
    ----------
    profile : Profile
    width : float
        b, m.
    bending : float
        E, or E/(1 - ν²) of a plate, Pa.
    shear : float
        G, Pa.
    """
    x = profile.stations
    step = np.diff(x)
    h = 0.5 * (profile.station_thickness[1:] + profile.station_thickness[:-1])
    constant = _torsion_constants(h, width)
    b = bending * (h * width) ** 3 / 144.0
    # κ = 5/6, as Reissner's for plates
    s = shear * h * width**3 / 14.4
    # sections much thicker than wide, at the thick end of a notch, hardly twist: no negative T
    t = 1.0 / np.maximum(4.0 / (shear * constant) - 1.0 / s, 0.2 / (shear * constant))
    held = 4.0 * s * t / (s + t)
    given = (s - t) / (s + t)
    # linear elements; the ends are held
    inner = len(x) - 2
    matrix = np.zeros((inner, inner))
    across, own = b / step, held * step / 6.0
    place = np.arange(inner)
    matrix[place, place] = across[:-1] + across[1:] + 2.0 * (own[:-1] + own[1:])
    matrix[place[1:], place[:-1]] = matrix[place[:-1], place[1:]] = own[1:-1] - across[1:-1]
    right = 0.5 * (given[:-1] * step[:-1] + given[1:] * step[1:])
    turn = np.zeros(len(x))
    turn[1:-1] = np.linalg.solve(matrix, right)
    mean = 0.5 * (turn[1:] + turn[:-1])
    twist = (1.0 + (s - t) * mean) / (s + t)
    curved = bending * np.abs(np.diff(turn)) / step * (h * width) / 4.0
    # Saint-Venant's share of the torque, and 3/2 of the mean of what shears the edges beside it
    sheared = 2.0 * t * np.abs(mean + twist) / _torsion_moduli(h, width)
    sheared += 0.625 * shear * width * np.abs(twist - mean - t / s * (twist + mean))
    return Torsion(float(twist @ step), _at_stations(curved), _at_stations(sheared))


def _at_stations(values: Array) -> Array:
    """The larger of the two intervals that meet at a station, (m,)."""
    return np.asarray(np.maximum(np.append(values, values[-1]), np.insert(values, 0, values[0])))


def _torsion_constants(thickness: Array, width: float) -> Array:
    """Of rectangles; equal ones once."""
    found = {h: rectangle_torsion_constant(h, width) for h in set(thickness.tolist())}
    return np.array([found[h] for h in thickness.tolist()])


def _torsion_moduli(thickness: Array, width: float) -> Array:
    """Torque per largest shear stress of rectangles, m³ (Timoshenko and Goodier, §109)."""

    def modulus(h: float) -> float:
        a, b = max(h, width), min(h, width)
        # 1 - (8/π²) Σ 1/(n² cosh(nπa/2b)) over odd n, and 1/cosh = sqrt(1 - tanh²)
        terms = (
            (1.0 - tanh(n * np.pi * a / (2.0 * b)) ** 2) ** 0.5 / n**2 for n in range(1, 12, 2)
        )
        largest = 1.0 - 8.0 / np.pi**2 * sum(terms)
        return float(rectangle_torsion_constant(a, b) / (b * largest))

    found = {h: modulus(h) for h in set(thickness.tolist())}
    return np.array([found[h] for h in thickness.tolist()])
