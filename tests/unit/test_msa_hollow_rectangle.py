"""Hollow rectangles of any wall against bounds, thin walls and the solid.

Prandtl's stress function gives a torsion constant from below, the warping function one from above
(Timoshenko and Goodier 1970, sections 104 and 108; Washizu 1975): no outside value is needed.
"""

from __future__ import annotations

import numpy as np
import pytest
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from strutwork.msa import box, rectangle
from strutwork.msa.hollow_rectangle import _Grid, hollow_rectangle

SHAPES = [
    (1.0, h, share * min(1.0, h) / 2)
    for h in (1.0, 0.5, 3.0, 0.05)
    for share in (0.01, 0.1, 0.4, 0.8, 0.98)
]


def upper_bound(width: float, height: float, wall: float) -> float:
    """Polar moment less the energy of warping, which is odd about both axes."""
    grid = _Grid.of(width / 2, height / 2, wall)
    x, y = grid.points[..., 0], grid.points[..., 1]
    flux = np.stack([y, -x], axis=-1)
    parts = np.einsum("eg,egd,egkd->ek", grid.weights, flux, grid.slopes)
    right = np.bincount(grid.nodes.ravel(), parts.ravel(), len(grid.places))
    free = np.flatnonzero(np.all(grid.places > 0, axis=1))
    warping = splu(sp.csc_array(grid.stiffness[free][:, free])).solve(right[free])
    return 4 * float((grid.weights * (x**2 + y**2)).sum() - right[free] @ warping)


@pytest.mark.parametrize(("width", "height", "wall"), SHAPES)
def test_torsion_lies_between_two_bounds(width: float, height: float, wall: float) -> None:
    found, upper = hollow_rectangle(width, height, wall), upper_bound(width, height, wall)
    # the upper bound is a difference
    assert found.torsion_constant <= upper * (1 + 1e-6)
    assert found.torsion_constant == pytest.approx(upper, rel=1e-4)


@pytest.mark.parametrize(("width", "height"), [(1.0, 1.0), (1.0, 3.0), (0.2, 1.0)])
def test_thin_walls_are_bredts_and_cowpers(width: float, height: float) -> None:
    """What thin-wall formulas leave out is of the order of the wall over the width."""
    for wall in (1e-2 * min(width, height), 1e-3 * min(width, height)):
        found = box(width, height, wall)
        share = wall / min(width, height)
        y, z = width - wall, height - wall
        bredt = 2 * wall * (y * z) ** 2 / (y + z)
        assert 0 < found.torsion_constant / bredt - 1 < 1.2 * share
        assert found.shear_coefficients is not None
        for kappa, m in zip(found.shear_coefficients(0.3), (z / y, y / z), strict=True):
            # Cowper 1966, rectangular box of one wall thickness, with his m = n
            below = 12 + 72 * m + 150 * m**2 + 90 * m**3
            below += 0.3 * (11 + 66 * m + 135 * m**2 + 90 * m**3) + 10 * m**2 * (3.3 * m + 3 * m**2)
            assert kappa == pytest.approx(13 * (1 + 3 * m) ** 2 / below, rel=0.5 * share)


def test_a_square_whose_hole_vanishes_is_solid() -> None:
    found, solid = box(0.1, 0.1, 0.05 - 1e-6), rectangle(0.1, 0.1)
    assert found.torsion_constant == pytest.approx(solid.torsion_constant, rel=2e-5)
    assert found.shear_coefficients is not None
    assert solid.shear_coefficients is not None
    for nu in (0.0, 0.3, 0.5):
        assert found.shear_coefficients(nu) == pytest.approx(solid.shear_coefficients(nu), rel=1e-5)


def test_torsion_of_a_thick_square_box() -> None:
    """Wall 0.4 of the width: all but the solid, where Bredt's formula loses 38 %."""
    found = box(1.0, 1.0, 0.4).torsion_constant
    assert found == pytest.approx(0.140245, rel=1e-5)
    assert pytest.approx(0.616 * found, rel=1e-3) == 2 * 0.4 * 0.6**4 / 1.2


@pytest.mark.parametrize("order", [2, 6])
def test_another_order_of_elements_agrees(order: int, monkeypatch: pytest.MonkeyPatch) -> None:
    shape, nu = (1.0, 2.0, 0.2), 0.3
    found = hollow_rectangle(*shape)
    monkeypatch.setattr("strutwork.msa.hollow_rectangle.ORDER", order)
    other = hollow_rectangle.__wrapped__(*shape)
    tolerance = 2e-3 if order == 2 else 2e-5
    assert other.torsion_constant == pytest.approx(found.torsion_constant, rel=tolerance)
    assert other.coefficients(nu) == pytest.approx(found.coefficients(nu), rel=tolerance)


def test_sides_and_size_are_only_names() -> None:
    found, turned = box(0.06, 0.1, 0.012), box(0.1, 0.06, 0.012)
    large = box(0.6, 1.0, 0.12)
    assert turned.torsion_constant == pytest.approx(found.torsion_constant, rel=1e-12)
    assert large.torsion_constant == pytest.approx(1e4 * found.torsion_constant, rel=1e-10)
    assert found.shear_coefficients is not None
    assert turned.shear_coefficients is not None
    assert turned.shear_coefficients(0.3) == pytest.approx(
        found.shear_coefficients(0.3)[::-1], rel=1e-10
    )
