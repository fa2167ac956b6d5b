"""A taut string and a tensioned beam: geometric stiffness.

@book{blevins1979,
  title     = {Formulas for Natural Frequency and Mode Shape},
  author    = {Blevins, Robert D.},
  publisher = {Van Nostrand Reinhold},
  year      = {1979},
  note      = {Table 7-1 (cables), equation 8-20 (beams with axial load)}
}

100 m long, 0.3 m thick, pulled by 54.6 MN: f = n/(2L) √(F/m) = 1.56604, 3.13208,
4.69812 Hz, whence m = 556.58 kg/m. With its bending stiffness the beam vibrates higher by
√(1 + n²π²EI/(F L²)).
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import NumericalError
from strutwork.fea import axial_forces, modes
from strutwork.msa import Material, Section, rod, solve
from tests.structures import Model, wrench

LENGTH, TENSION = 100.0, 54.6e6
STRING = [1.56604, 3.13208, 4.69812]
AREA = rod(0.3).area
PER_LENGTH = TENSION / (2 * LENGTH * STRING[0]) ** 2


def pulled(section: Section, modulus: float, pull: float, elements: int = 40) -> np.ndarray:
    material = Material.isotropic(modulus, 0.3, density=PER_LENGTH / section.area)
    model = Model()
    model.nodes(a=(0, 0, 0), b=(LENGTH, 0, 0))
    model.beam("rope", "a", "b", section, material, elements=elements, shear=False)
    model.support("a", "x", "y", "z", "rx")
    model.support("b", "y", "z")
    placed = model.place()
    tension = axial_forces(solve(placed, [wrench("pull", "b", pull)]), "pull")
    np.testing.assert_allclose(tension, pull, rtol=1e-9)
    return modes(placed, 6, preload=tension).frequencies


def test_string_without_bending_stiffness() -> None:
    slack = Section(AREA, 1e-10, 1e-10, 2e-10, name="string")
    found = pulled(slack, 200e9, TENSION)
    # six digits are published; the mesh of cubic shapes adds (kh)⁴/1440 and less, 2e-6
    np.testing.assert_allclose(found[::2], STRING, rtol=4e-6)
    np.testing.assert_allclose(found[1::2], STRING, rtol=4e-6)


def test_beam_with_its_bending_stiffness() -> None:
    found = pulled(rod(0.3), 200e9, TENSION)
    waves = np.arange(1, 4)
    bending = waves**2 * np.pi**2 * 200e9 * rod(0.3).second_moment_y / (TENSION * LENGTH**2)
    expected = np.array(STRING) * np.sqrt(1 + bending)
    # rotary inertia lowers by (kr)²/2, 2.5e-5 at most
    np.testing.assert_allclose(found[::2], expected, rtol=3e-5)
    # the correction that the string's formula leaves out is itself far larger
    assert np.all(bending > 20 * 3e-5)


def test_pressure_lowers_the_frequency_and_at_eulers_load_it_buckles() -> None:
    stiffness = 200e9 * rod(0.3).second_moment_y
    euler = np.pi**2 * stiffness / LENGTH**2
    still = pulled(rod(0.3), 200e9, 0.0)[0]
    half = pulled(rod(0.3), 200e9, -0.5 * euler)[0]
    # f² falls linearly with the load, since the half sine is both the mode and the buckle
    assert half / still == pytest.approx(np.sqrt(0.5), rel=1e-6)
    with pytest.raises(NumericalError, match="buckles"):
        pulled(rod(0.3), 200e9, -1.001 * euler)
    assert pulled(rod(0.3), 200e9, -0.999 * euler)[0] == pytest.approx(
        still * np.sqrt(1e-3), rel=1e-3
    )
