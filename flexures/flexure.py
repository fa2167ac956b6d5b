"""What every flexure has: its size, stiffness, stress, and where its formulas end."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from functools import cached_property
from math import isfinite
from typing import Any, ClassVar, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.msa.materials import Material

Array = NDArray[Any]

#: Rotation beyond which a linear stiffness is not trusted, rad: 6 degrees.
LARGE_ROTATION = 0.1
#: Share of the buckling force beyond which a linear stiffness is not trusted.
LARGE_COMPRESSION = 0.1

#: Largest Poisson's ratio of isotropic materials, with room for rounded moduli.
ISOTROPIC = 0.51

Bending = Literal["beam", "plate"]


@dataclass(frozen=True)
class Flexure(ABC):
    """A flexible joint made of one piece with the parts that it connects.

    Joint axes: z is the axis that it turns about, x runs along it from the first part to the
    second, y across its thickness. Its mass is ignored.

    Parameters
    ----------
    name : str
        For messages.
    material : Material
    thickness : float
        The least, along y, m.
    width : float
        Along z, m.
    bending : "beam", "plate" or None
        Whether it curves across its width as it bends, or the width holds it flat, which is
        1/(1 - ν²) as stiff; None: by its proportions.
    allowable_stress : float or None
        Pa.
    stress_concentration : float or None
        Factor on the stress of bending about z and of axial force, no unit; None: that of the
        shape, which is 1 where the strip meets its part without a known fillet.

    Raises
    ------
    ModelError
        A size that is not positive and finite, or what the shape excludes.
    """

    name: str
    material: Material
    thickness: float
    width: float
    bending: Bending | None = field(default=None, kw_only=True)
    allowable_stress: float | None = field(default=None, kw_only=True)
    stress_concentration: float | None = field(default=None, kw_only=True)

    #: As a model file names it, and the names of its sizes in m.
    shape: ClassVar[str]
    sizes: ClassVar[tuple[str, ...]]

    def __post_init__(self) -> None:
        for size in ("thickness", "width", *self.sizes):
            value = getattr(self, size)
            if value is not None and not (isfinite(value) and value > 0):
                raise self.error(f"{size} is {value!r}.", "Give a positive number.")
        if not self.material.poissons_ratio <= ISOTROPIC:
            raise self.error(
                f"its material {self.material.name} has a Poisson's ratio of "
                f"{self.material.poissons_ratio:.3g} by its moduli, more than 0.5.",
                "Check youngs_modulus and shear_modulus: a flexure is isotropic.",
            )
        if self.allowable_stress is not None and not self.allowable_stress > 0:
            raise self.error(
                f"allowable_stress is {self.allowable_stress!r}.", "Give a positive number."
            )
        if self.stress_concentration is not None and not self.stress_concentration >= 1:
            raise self.error(
                f"stress_concentration is {self.stress_concentration!r}.", "Give 1 or more."
            )

    def error(self, problem: str, remedy: str) -> ModelError:
        """An error that names this flexure.

        Parameters
        ----------
        problem, remedy : str
        """
        return ModelError(f"flexure {self.name}", problem, remedy)

    @property
    @abstractmethod
    def plate(self) -> bool:
        """Whether it bends as a plate, as stated or by its proportions."""

    @property
    @abstractmethod
    def compliance(self) -> Array:
        """Motion of the second part per wrench on it at the joint, joint axes, (6, 6)."""

    @property
    @abstractmethod
    def doubts(self) -> tuple[str, ...]:
        """Where its sizes leave the range of its formulas: sentences; empty within."""

    @abstractmethod
    def stress(self, wrench: ArrayLike) -> Array:
        """Largest equivalent stress under a wrench on the second part, Pa, (...).

        Parameters
        ----------
        wrench : (..., 6)
            At the joint, joint axes, N and N·m.
        """

    @abstractmethod
    def compression(self, wrench: ArrayLike) -> Array:
        """Compression of its strips as a share of their buckling force, no unit, (...).

        Parameters
        ----------
        wrench : (..., 6)
            At the joint, joint axes, N and N·m.
        """

    @cached_property
    def stiffness(self) -> Array:
        """Inverse of the compliance, symmetric, N/m, N and N·m/rad, (6, 6)."""
        # scaled, since compliances of translations and rotations are of other magnitudes
        scale = 1.0 / np.sqrt(np.diag(self.compliance))
        found = np.linalg.inv(scale[:, None] * self.compliance * scale)
        found = scale[:, None] * found * scale
        return np.asarray((found + found.T) / 2.0)

    @cached_property
    def stroke(self) -> Array | None:
        """Motion in each direction at the allowable stress, m and rad, (6,).

        Under a force or moment in that direction alone; None without an allowable stress.
        """
        if self.allowable_stress is None:
            return None
        stress = self.stress(np.eye(6))
        return np.asarray(np.diag(self.compliance) * self.allowable_stress / stress)
