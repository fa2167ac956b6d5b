"""Materials: moduli, Poisson's ratio, and what is refused."""

from __future__ import annotations

import re
from typing import Any

import pytest

from strutwork.errors import ModelError
from strutwork.msa import Material


def test_isotropic_material_has_the_shear_modulus_of_its_poissons_ratio() -> None:
    steel = Material.isotropic(205e9, 0.29, density=7870.0, loss_factor=0.002, name="steel")
    # G = E / (2 (1 + ν)); exact but for rounding
    assert steel.shear_modulus == pytest.approx(205e9 / 2.58, rel=1e-15)
    assert steel.poissons_ratio == pytest.approx(0.29, rel=1e-14)
    assert (steel.density, steel.loss_factor) == (7870.0, 0.002)


def test_shear_modulus_may_be_given_apart_from_poissons_ratio() -> None:
    # wood and composites: E / G far from an isotropic body's
    assert Material(12e9, 2.2e9).poissons_ratio == pytest.approx(12 / 4.4 - 1, rel=1e-15)


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        ({"youngs_modulus": 0.0}, "youngs_modulus is 0.0"),
        ({"youngs_modulus": -1.0}, "youngs_modulus is -1.0"),
        ({"youngs_modulus": float("nan")}, "youngs_modulus is nan"),
        ({"shear_modulus": float("inf")}, "shear_modulus is inf"),
        ({"density": 0.0}, "density is 0.0"),
        ({"loss_factor": -0.1}, "loss_factor is -0.1"),
        ({"loss_factor": float("nan")}, "loss_factor is nan"),
        ({"shear_modulus": 1e9}, "Poisson's ratio of 99"),
    ],
)
def test_a_wrong_property_is_refused_by_name(arguments: dict[str, Any], problem: str) -> None:
    given = {"youngs_modulus": 200e9, "shear_modulus": 80e9, "name": "alloy", **arguments}
    with pytest.raises(ModelError, match=re.escape(problem)) as caught:
        Material(**given)
    assert caught.value.part == "material alloy"
    assert caught.value.remedy


@pytest.mark.parametrize("nu", [-1.0, 0.51, float("nan")])
def test_a_poissons_ratio_that_no_body_has_is_refused(nu: float) -> None:
    with pytest.raises(ModelError, match="poissons_ratio"):
        Material.isotropic(200e9, nu)
