"""Isotropic linear elastic materials."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite

from strutwork.errors import ModelError


@dataclass(frozen=True)
class Material:
    """An isotropic material.

    Parameters
    ----------
    youngs_modulus : float
        Pa.
    shear_modulus : float
        Pa.
    density : float or None
        kg/m³; needed only where mass is needed.
    loss_factor : float or None
        Structural loss factor η, no unit.
    name : str
        For messages.

    Raises
    ------
    ModelError
        A value that is not positive and finite.
    """

    youngs_modulus: float
    shear_modulus: float
    density: float | None = None
    loss_factor: float | None = None
    name: str = "material"

    def __post_init__(self) -> None:
        for field, value in (
            ("youngs_modulus", self.youngs_modulus),
            ("shear_modulus", self.shear_modulus),
            ("density", self.density),
        ):
            if value is not None and not (isfinite(value) and value > 0):
                raise ModelError(
                    f"material {self.name}", f"{field} is {value!r}.", "Give a positive number."
                )
        if self.loss_factor is not None and not (
            isfinite(self.loss_factor) and self.loss_factor >= 0
        ):
            raise ModelError(
                f"material {self.name}",
                f"loss_factor is {self.loss_factor!r}.",
                "Give zero or a positive number.",
            )
        if not -1.0 < self.poissons_ratio < 2.0:
            raise ModelError(
                f"material {self.name}",
                f"E and G give a Poisson's ratio of {self.poissons_ratio:.3g}.",
                "Check youngs_modulus and shear_modulus.",
            )

    @classmethod
    def isotropic(
        cls,
        youngs_modulus: float,
        poissons_ratio: float,
        density: float | None = None,
        loss_factor: float | None = None,
        name: str = "material",
    ) -> Material:
        """Material from Young's modulus and Poisson's ratio, G = E / (2 (1 + ν)).

        Parameters
        ----------
        youngs_modulus : float
            E, Pa.
        poissons_ratio : float
            ν, no unit; above −1 and at most 0.5.
        density : float or None
            kg/m³; needed only where mass is needed.
        loss_factor : float or None
            Structural loss factor η, no unit.
        name : str
            For messages.
        """
        if not (isfinite(poissons_ratio) and -1.0 < poissons_ratio <= 0.5):
            raise ModelError(
                f"material {name}",
                f"poissons_ratio is {poissons_ratio!r}.",
                "Give a number above -1 and at most 0.5.",
            )
        shear = youngs_modulus / (2.0 * (1.0 + poissons_ratio))
        return cls(youngs_modulus, shear, density, loss_factor, name)

    @property
    def poissons_ratio(self) -> float:
        """ν = E / (2 G) − 1."""
        return self.youngs_modulus / (2.0 * self.shear_modulus) - 1.0
