"""Flexures: formulas of beams against solids between rigid ends.

@article{yong2008,
  title   = {Review of Circular Flexure Hinge Design Equations and Derivation of Empirical
             Formulations},
  author  = {Yong, Y. K. and Lu, T.-F. and Handley, D. C.},
  journal = {Precision Engineering},
  volume  = {32},
  pages   = {63--70},
  year    = {2008}
}

@book{neuber1937,
  title     = {Kerbspannungslehre},
  author    = {Neuber, Heinz},
  publisher = {Springer},
  year      = {1937}
}

The solids are our own, of quadratic bricks; their ends are rigid, as the formulas assume. A beam
along a notch neglects how stress spreads from its thin part, and across its width it is either free
to curve or held flat, so the tolerances are those of the formulas, several percent, not of the
meshes, which are converged to 1 %.
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.flexures import CircularNotch, CrossSpring, EllipticNotch, Leaf
from strutwork.flexures.notch import Notch
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.transform import mapped
from strutwork.msa.materials import Material
from tests.flexure_solids import between_rigid_ends, largest_stress, leaf_mesh, notch_mesh

STEEL = Material.isotropic(200e9, 0.3, 7800.0, name="steel")
R = 5e-3

slow = pytest.mark.slow


def notch(ratio: float, width: float, stretch: float = 1.0) -> Notch:
    """Of t/(2 a_y), b/t and a_x/a_y."""
    t = 2 * R * ratio
    if stretch == 1:
        return CircularNotch("hinge", STEEL, t, width * t, R)
    return EllipticNotch("hinge", STEEL, t, width * t, stretch * R, R)


CASES = [
    (0.05, 10.0, 1.0),
    pytest.param(0.01, 20.0, 1.0, marks=slow),
    pytest.param(0.02, 20.0, 1.0, marks=slow),
    pytest.param(0.05, 40.0, 1.0, marks=slow),
    pytest.param(0.1, 10.0, 1.0, marks=slow),
    pytest.param(0.2, 4.0, 1.0, marks=slow),
    pytest.param(0.2, 15.0, 1.0, marks=slow),
    pytest.param(0.1, 10.0, 3.0, marks=slow),
    pytest.param(0.1, 40.0, 3.0, marks=slow),
]


@pytest.mark.parametrize(("ratio", "width", "stretch"), CASES)
def test_compliance_and_stress_of_notches(ratio: float, width: float, stretch: float) -> None:
    hinge = notch(ratio, width, stretch)
    matrices, stiffness, motions = between_rigid_ends(notch_mesh(hinge), STEEL)
    solid = np.diag(np.linalg.inv(stiffness))
    beam = np.diag(hinge.compliance)
    # what the hinge is made for: the rotation about z, up to t/(2 R) = 0.2
    assert beam[5] == pytest.approx(solid[5], rel=0.12)
    # the other directions: stress spreads slowly into the thick ends
    np.testing.assert_allclose(beam, solid, rtol=0.15)
    for direction, tolerance in ((5, 0.05), (0, 0.07)):
        wrench = np.eye(6)[direction]
        along, _ = largest_stress(matrices, stiffness, motions, wrench)
        # Neuber's factor of deep notches, for the stress along x, which the equivalent one
        # exceeds where the width is free to curve
        assert float(hinge.stress(wrench)) == pytest.approx(along, rel=tolerance)
    for wrench in np.eye(6):
        # added as if they acted at one place, so not much below the solid's
        _, equivalent = largest_stress(matrices, stiffness, motions, wrench)
        assert 0.95 * equivalent < float(hinge.stress(wrench)) < 1.4 * equivalent


@pytest.mark.parametrize(
    ("thickness", "width", "length"),
    [
        (0.5, 5.0, 20.0),
        pytest.param(0.5, 2.0, 20.0, marks=slow),
        pytest.param(0.5, 10.0, 20.0, marks=slow),
        pytest.param(0.5, 20.0, 20.0, marks=slow),
        pytest.param(0.5, 40.0, 20.0, marks=slow),
        pytest.param(0.5, 5.0, 5.0, marks=slow),
    ],
)
def test_compliance_of_leaves(thickness: float, width: float, length: float) -> None:
    t, b, long = (1e-3 * v for v in (thickness, width, length))
    leaf = Leaf("leaf", STEEL, t, b, long)
    _, stiffness, _ = between_rigid_ends(leaf_mesh(long, t, b), STEEL)
    solid = np.diag(np.linalg.inv(stiffness))
    # between free and prevented curvature across the width lie 9 %
    np.testing.assert_allclose(np.diag(leaf.compliance), solid, rtol=0.09)
    coupling = stiffness - np.diag(np.diag(stiffness))
    # both ends are alike, so the middle decouples all directions
    scale = np.sqrt(np.outer(np.diag(stiffness), np.diag(stiffness)))
    assert np.abs(coupling / scale).max() < 1e-6


@slow
@pytest.mark.parametrize("crossing", [0.5, 0.2])
def test_stiffness_of_a_cross_spring_pivot(crossing: float) -> None:
    """Two crossed leaves as solids between the same rigid parts, with all couplings."""
    t, b, length, spacing = 0.3e-3, 8e-3, 30e-3, 10e-3
    pivot = CrossSpring("pivot", STEEL, t, b, length, crossing=crossing, spacing=spacing)
    solid = np.zeros((6, 6))
    for side in (1, -1):
        solid += between_rigid_ends(_placed(side, t, b, length, crossing, spacing), STEEL)[1]
    scale = np.sqrt(np.diag(solid))
    found, expected = (k / np.outer(scale, scale) for k in (pivot.stiffness, solid))
    # relative to the stiffness of the two directions that an entry couples
    np.testing.assert_allclose(found, expected, rtol=0, atol=0.06)
    assert np.count_nonzero(np.abs(expected - np.diag(np.diag(expected))) > 0.1) >= 4


def _placed(side: int, t: float, b: float, length: float, crossing: float, spacing: float) -> Mesh:
    c, s = np.sqrt(0.5), side * np.sqrt(0.5)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    shift = np.array([(0.5 - crossing) * length, 0.0, 0.0])

    def place(points: np.ndarray) -> np.ndarray:
        return (points + shift) @ turn.T + [0.0, 0.0, -0.5 * side * spacing]

    return mapped(leaf_mesh(length, t, b), place)
