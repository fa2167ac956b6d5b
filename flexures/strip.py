"""A flexible strip between two rigid parts: compliance and stress from its profile."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.flexures.profile import Profile
from strutwork.flexures.torsion import Torsion, torsion
from strutwork.msa.materials import Material

Array = NDArray[Any]


@dataclass(frozen=True)
class Strip:
    """A strip along x, of thickness h(x) along y and width b along z, symmetric in all planes.

    Parameters
    ----------
    profile : Profile
    width : float
        b, m.
    material : Material
    plate : bool
        Whether the width keeps it from curving across, so that it bends with E/(1 - ν²).
    tension, bending : float
        Factors of stress concentration, no unit, on axial force and on bending about z.
    """

    profile: Profile
    width: float
    material: Material
    plate: bool = False
    tension: float = 1.0
    bending: float = 1.0

    @property
    def bending_modulus(self) -> float:
        """Of bending about z: E, or E/(1 - ν²) of a plate, Pa."""
        e, nu = self.material.youngs_modulus, self.material.poissons_ratio
        return e / (1.0 - nu**2) if self.plate else e

    @cached_property
    def torsion(self) -> Torsion:
        """Twist under a torque about x."""
        return torsion(self.profile, self.width, self.bending_modulus, self.material.shear_modulus)

    @cached_property
    def compliance(self) -> Array:
        """Motion of the far side per wrench at the middle, m/N and rad/(N·m), (6,).

        Timoshenko's beam integrated along the profile (Paros and Weisbord 1965; Koseki et al.
        2002), κ = 10 (1 + ν)/(12 + 11 ν); torsion as `strutwork.flexures.torsion`. The middle
        is a plane of symmetry, so the matrix is diagonal.
        """
        p, b = self.profile, self.width
        h, e, nu = p.thickness, self.material.youngs_modulus, self.material.poissons_ratio
        about_z = 12.0 / (self.bending_modulus * b * h**3)
        about_y = 12.0 / (e * h * b**3)
        coefficient = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu)
        sheared = 1.0 / (coefficient * self.material.shear_modulus * b * h)
        return np.array(
            [
                p.integral(1.0 / (e * b * h)),
                p.integral(about_z * p.x**2 + sheared),
                p.integral(about_y * p.x**2 + sheared),
                self.torsion.compliance,
                p.integral(about_y),
                p.integral(about_z),
            ]
        )

    @property
    def effective_length(self) -> float:
        """Of a strip of the least thickness that is as compliant about z, m."""
        least = float(self.profile.station_thickness.min())
        return float(self.compliance[5]) * self.bending_modulus * self.width * least**3 / 12.0

    def stress(self, wrench: ArrayLike) -> Array:
        """Largest equivalent stress (von Mises) under a wrench on the far side, Pa, (...).

        At each section the stresses of axial force, of bending about both axes and of restrained
        warping are added as in a corner, and the largest shear stress is taken to act there too:
        at least the stress that the beam has.

        Parameters
        ----------
        wrench : (..., 6)
            At the middle, N and N·m.
        """
        fx, fy, fz, mx, my, mz = np.moveaxis(np.asarray(wrench, dtype=float)[..., None, :], -1, 0)
        x, h, b = self.profile.stations, self.profile.station_thickness, self.width
        twisted = self.torsion
        area = b * h
        normal = (
            self.tension * np.abs(fx) / area
            + self.bending * 6.0 * np.abs(mz - fy * x) / (area * h)
            + 6.0 * np.abs(my + fz * x) / (area * b)
            + twisted.normal * np.abs(mx)
        )
        shear = 1.5 * np.hypot(fy, fz) / area + twisted.shear * np.abs(mx)
        return np.asarray(np.sqrt(normal**2 + 3.0 * shear**2).max(axis=-1))

    @property
    def buckling_force(self) -> float:
        """Compression under which it buckles, ends that slide and do not turn, N: π² E I/ℓ².

        With the effective length, and exact where the thickness is constant.
        """
        least = float(self.profile.station_thickness.min())
        inertia = self.width * least**3 / 12.0
        return pi**2 * self.bending_modulus * inertia / self.effective_length**2

    def compression(self, wrench: ArrayLike) -> Array:
        """Axial compression by the buckling force, no unit, (...).

        Parameters
        ----------
        wrench : (..., 6)
            On the far side, N and N·m.
        """
        pushed = np.maximum(-np.asarray(wrench, dtype=float)[..., 0], 0.0)
        return np.asarray(pushed / self.buckling_force)
