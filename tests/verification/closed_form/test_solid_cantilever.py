"""A slender cantilever as a solid against Timoshenko's beam.

@article{cowper1966,
  title   = {The Shear Coefficient in Timoshenko's Beam Theory},
  author  = {Cowper, G. R.},
  journal = {Journal of Applied Mechanics},
  volume  = {33},
  pages   = {335--340},
  year    = {1966}
}

1 m long, 20 x 30 mm, steel; the shear coefficient of a rectangle is 10 (1 + ν) / (12 + 11 ν),
table 1. A solid clamp also keeps the root from contracting, which stiffens by a share of the
depth over the length.
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.fea import modes
from strutwork.fea.solid_loads import force_load, gravity_load
from strutwork.fea.solid_modes import solid_modes
from strutwork.fea.solid_static import solve_solid
from strutwork.meshes import block
from tests.frame_files import chain, frame_file, read, support
from tests.solid_cases import STEEL, in_tetrahedra, matrices_of

LENGTH, WIDTH, HEIGHT = 1.0, 0.02, 0.03
AREA = WIDTH * HEIGHT
E, G = STEEL.youngs_modulus, STEEL.shear_modulus
KAPPA = 10 * 1.3 / (12 + 11 * 0.3)
#: Second moments for bending along y and along z.
SECOND = {"y": HEIGHT * WIDTH**3 / 12, "z": WIDTH * HEIGHT**3 / 12}


def solid(kind: str = "hexahedron"):  # type: ignore[no-untyped-def]
    mesh = block((LENGTH, WIDTH, HEIGHT), (24, 2, 2), (4.0, 1.0, 1.0))
    return matrices_of(mesh if kind == "hexahedron" else in_tetrahedra(mesh))


@pytest.mark.parametrize("kind", ["hexahedron", "tetra"])
def test_tip_deflection(kind: str) -> None:
    matrices = solid(kind)
    forces = force_load(matrices, "+x", np.eye(3) * 1000.0)
    found = solve_solid(matrices, forces, {"-x": "xyz"}).mean_over("+x")
    bending = {a: 1000 * LENGTH**3 / (3 * E * SECOND[a]) for a in "yz"}
    shear = 1000 * LENGTH / (KAPPA * G * AREA)
    expected = [1000 * LENGTH / (E * AREA), bending["y"] + shear, bending["z"] + shear]
    np.testing.assert_allclose(np.diag(found), expected, rtol=5e-3)


def test_sag_under_its_own_weight() -> None:
    matrices = solid()
    found = solve_solid(matrices, gravity_load(matrices), {"-x": "xyz"}).mean_over("+x")
    q = -8000.0 * 9.80665 * AREA
    expected = q * LENGTH**4 / (8 * E * SECOND["z"]) + q * LENGTH**2 / (2 * KAPPA * G * AREA)
    assert found[2, 0] == pytest.approx(expected, rel=5e-3)


def test_bending_frequencies() -> None:
    content = frame_file(
        {"youngs_modulus": E, "poissons_ratio": 0.3, "density": 8000.0},
        {"shape": "rectangle", "width_y": WIDTH, "height_z": HEIGHT},
    )
    chain(content, "beam", ("A", (0, 0, 0)), ("B", (LENGTH, 0, 0)), 30)
    support(content, "A")
    beam = modes(read(content), 6)
    found = solid_modes(solid(), 6, {"-x": "xyz"})
    # two in each direction are bending; twist, among the six, has Saint-Venant's constant
    np.testing.assert_allclose(found.frequencies[:4], beam.frequencies[:4], rtol=5e-3)
    assert found.effective_mass[0, 1] / found.matrices.total_mass == pytest.approx(0.613, abs=2e-3)
