"""Hooke's law of isotropic materials in six components."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.msa.materials import Material

Array = NDArray[Any]


def elasticity(material: Material) -> Array:
    """Stresses per engineering strain, Pa, (6, 6), in the order xx, yy, zz, xy, xz, yz.

    Parameters
    ----------
    material : Material
    """
    ratio, shear = material.poissons_ratio, material.shear_modulus
    lame = 2.0 * shear * ratio / (1.0 - 2.0 * ratio)
    law = np.diag([2.0 * shear] * 3 + [shear] * 3)
    law[:3, :3] += lame
    return law


def thermal_stress(material: Material, coefficient: float) -> Array:
    """Stresses per kelvin of a material that cannot expand, D α 1, Pa/K, (6,), order as above.

    Parameters
    ----------
    material : Material
    coefficient : float
        Of expansion, 1/K.
    """
    return np.asarray(elasticity(material)[:, :3].sum(axis=1) * coefficient)
