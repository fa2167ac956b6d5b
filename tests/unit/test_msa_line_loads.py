"""Line loads: fixed-end forces and deflections against closed forms and virtual work.

Closed forms of Euler-Bernoulli beams: Young, W. C., Budynas, R. G.: Roark's Formulas for Stress
and Strain, 7th ed., McGraw-Hill 2002, table 8.1, cases 2a, 2d. Shear adds the deflection of the
shear force over G A_s.
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.msa import Beam, LineLoad, LoadCase, StaticSolution, solve
from strutwork.msa.beam import fixed_end_loads
from tests.structures import BAR, STEEL, Model, cantilever, cantilever_compliance

LENGTH = 0.5
SOLVED = 1e-10
shears = pytest.mark.parametrize("shear", [True, False])


def stiffnesses(shear: bool) -> tuple[float, float, float, float, float]:
    """EA, EIy, EIz and 1/G A_s along y and z."""
    e, g = STEEL.youngs_modulus, STEEL.shear_modulus
    areas = BAR.shear_area(STEEL.poissons_ratio)
    assert areas is not None
    slip = tuple(1 / (g * a) if shear else 0.0 for a in areas)
    return e * BAR.area, e * BAR.second_moment_y, e * BAR.second_moment_z, slip[0], slip[1]


def line(first: tuple[float, ...], second: tuple[float, ...]) -> LoadCase:
    return LoadCase("line", line_loads=(LineLoad("beam", first, second),))  # type: ignore[arg-type]


def clamped(case: LoadCase, shear: bool, elements: int) -> StaticSolution:
    model = cantilever(length=LENGTH, shear=shear, elements=elements)
    model.support("tip")
    return solve(model.place(), [case])


@shears
@pytest.mark.parametrize("elements", [1, 2, 7])
def test_uniform_load_on_a_clamped_beam(shear: bool, elements: int) -> None:
    q = (300.0, -700.0, 400.0)
    found = clamped(line(q, q), shear, elements).beam_forces[0, ..., 0]
    half, moment = np.multiply(q, LENGTH / 2), np.multiply(q, LENGTH**2 / 12)
    # by symmetry shear does not change the uniform case: q L/2 and q L²/12
    np.testing.assert_allclose(found[0], [*-half, 0, moment[2], -moment[1]], rtol=SOLVED, atol=1e-8)
    np.testing.assert_allclose(found[1], [*-half, 0, -moment[2], moment[1]], rtol=SOLVED, atol=1e-8)


@pytest.mark.parametrize("elements", [1, 3])
def test_triangular_load_on_a_clamped_euler_bernoulli_beam(elements: int) -> None:
    q = 600.0
    found = clamped(line((0, 0, 0), (0, 0, q)), False, elements).beam_forces[0, ..., 0]
    # Roark 8.1, 2d: 3 q L/20, q L²/30 and 7 q L/20, q L²/20
    expected = (
        [-3 * q * LENGTH / 20, q * LENGTH**2 / 30],
        [-7 * q * LENGTH / 20, -q * LENGTH**2 / 20],
    )
    np.testing.assert_allclose(found[:, [2, 4]], expected, rtol=SOLVED)


@shears
@pytest.mark.parametrize("plane", [1, 2])
def test_linear_load_by_the_force_method(shear: bool, plane: int) -> None:
    """Clamped beam, its second end released: deflections by virtual work, then closed."""
    _, eiy, eiz, slip_y, slip_z = stiffnesses(shear)
    ei, slip = (eiz, slip_y) if plane == 1 else (eiy, slip_z)
    first, second = 250.0, -900.0
    points, weights = np.polynomial.legendre.leggauss(6)
    x, w = LENGTH * (points + 1) / 2, LENGTH * weights / 2
    slope = (second - first) / LENGTH
    # shear force and moment of the load on the part beyond x, cantilever held at x = 0
    rest = LENGTH - x
    q = first + slope * x
    shear_force = q * rest + slope * rest**2 / 2
    moment = q * rest**2 / 2 + slope * rest**3 / 3
    deflection = np.sum(w * (moment * rest / ei + shear_force * slip))
    turn = np.sum(w * moment / ei)
    flexibility = np.array(
        [
            [LENGTH**3 / (3 * ei) + LENGTH * slip, LENGTH**2 / (2 * ei)],
            [LENGTH**2 / (2 * ei), LENGTH / ei],
        ]
    )
    force, couple = -np.linalg.solve(flexibility, [deflection, turn])
    load = [np.zeros(3), np.zeros(3)]
    load[0][plane], load[1][plane] = first, second
    found = clamped(line(tuple(load[0]), tuple(load[1])), shear, 1).beam_forces[0, 1, :, 0]
    sign = 1.0 if plane == 1 else -1.0
    assert found[plane] == pytest.approx(force, rel=SOLVED)
    assert found[5 if plane == 1 else 4] == pytest.approx(sign * couple, rel=SOLVED)


@shears
@pytest.mark.parametrize("elements", [1, 5])
def test_tip_of_a_cantilever(shear: bool, elements: int) -> None:
    ea, eiy, eiz, slip_y, slip_z = stiffnesses(shear)
    q = 800.0
    placed = cantilever(length=LENGTH, shear=shear, elements=elements).place()
    cases = {
        # q L⁴/8EI + q L²/2GA_s
        "uniform": (((0, 0, q), (0, 0, q)), 2, LENGTH**4 / (8 * eiy) + LENGTH**2 / 2 * slip_z),
        # 11 q L⁴/120EI + q L²/3GA_s
        "rising": (
            ((0, 0, 0), (0, q, 0)),
            1,
            11 * LENGTH**4 / (120 * eiz) + LENGTH**2 / 3 * slip_y,
        ),
        # q L⁴/30EI + q L²/6GA_s
        "falling": (((0, 0, q), (0, 0, 0)), 2, LENGTH**4 / (30 * eiy) + LENGTH**2 / 6 * slip_z),
        "axial": (((q, 0, 0), (q, 0, 0)), 0, LENGTH**2 / (2 * ea)),
        "axial, rising": (((0, 0, 0), (q, 0, 0)), 0, LENGTH**2 / (3 * ea)),
    }
    for name, ((first, second), direction, expected) in cases.items():
        tip = solve(placed, [line(first, second)]).displacement("tip", "line")
        assert tip[direction] == pytest.approx(q * expected, rel=SOLVED), name


@shears
def test_any_subdivision_gives_the_same_nodes(shear: bool) -> None:
    """Loads consistent with the exact shape functions make nodes exact at any subdivision."""
    case = line((40.0, 250.0, -700.0), (-10.0, -900.0, 300.0))
    solutions = []
    for elements in (1, 4, 40):
        model = cantilever(length=LENGTH, shear=shear, elements=elements)
        model.support("tip", "y", "z", "rx")
        solutions.append(solve(model.place(), [case]))
    coarse, finer, finest = solutions
    # 40 elements are conditioned 1e4 times worse than one
    for other, tolerance in ((finer, 1e-10), (finest, 1e-7)):
        np.testing.assert_allclose(
            other.displacement("tip", "line"),
            coarse.displacement("tip", "line"),
            rtol=tolerance,
            atol=tolerance * 1e-4,
        )
        largest = np.abs(coarse.beam_forces).max()
        assert np.abs(other.beam_forces - coarse.beam_forces).max() < tolerance * largest
        np.testing.assert_allclose(other.strain_energy, coarse.strain_energy, rtol=tolerance)
    np.testing.assert_allclose(
        finest.displacement("beam/20", "line"),
        finer.displacement("beam/2", "line"),
        rtol=1e-7,
        atol=1e-12,
    )


@shears
@pytest.mark.parametrize("elements", [1, 3])
def test_strain_energy_of_a_line_loaded_cantilever(shear: bool, elements: int) -> None:
    ea, eiy, _, _, slip_z = stiffnesses(shear)
    q = 800.0
    placed = cantilever(length=LENGTH, shear=shear, elements=elements).place()
    # ∫ M²/2EI + V²/2GA_s with M = q x²/2, V = q x
    bending = q**2 * (LENGTH**5 / (40 * eiy) + LENGTH**3 / 6 * slip_z)
    stretching = q**2 * LENGTH**3 / (6 * ea)
    for load, expected in (((0, 0, q), bending), ((q, 0, 0), stretching)):
        found = solve(placed, [line(load, load)])
        assert found.strain_energy[0] == pytest.approx(expected, rel=SOLVED)


def test_line_load_on_a_leaning_beam_is_global() -> None:
    model = Model("tip")
    model.nodes(root=(0, 0, 0), tip=(0.3, 0.0, 0.4))
    model.beam("beam", "root", "tip", BAR)
    model.support("root")
    q = np.array([0.0, 0.0, -100.0])
    found = solve(model.place(), [line(tuple(q), tuple(q))])
    # 100 N/m over 0.5 m, its resultant 0.15 m from the root
    np.testing.assert_allclose(
        found.joint_force("support root", "line"), [0, 0, 50, 0, -7.5, 0], atol=1e-9
    )
    beam, root_half = model.beams[0], LENGTH**2 / 2
    along, across = q @ [0.6, 0, 0.8], q @ [-0.8, 0, 0.6]
    c = cantilever_compliance(beam, LENGTH)
    expected_axial = along * root_half / (STEEL.youngs_modulus * BAR.area)
    _, eiy, _, _, slip_z = stiffnesses(True)
    expected_across = across * (LENGTH**4 / (8 * eiy) + root_half * slip_z)
    tip = found.displacement("tip", "line")
    assert tip[:3] @ [0.6, 0, 0.8] == pytest.approx(expected_axial, rel=SOLVED)
    assert tip[:3] @ [-0.8, 0, 0.6] == pytest.approx(expected_across, rel=SOLVED)
    assert c[0, 0] > 0


def test_loads_on_one_beam_add() -> None:
    placed = cantilever().place()
    one, other = LineLoad("beam", (1, 2, 3), (4, 5, 6)), LineLoad("beam", (7, 0, -3), (0, 1, 2))
    both = solve(placed, [LoadCase("both", line_loads=(one, other))])
    apart = solve(placed, [LoadCase("a", line_loads=(one,)), LoadCase("b", line_loads=(other,))])
    np.testing.assert_allclose(
        both.displacements[..., 0], apart.displacements.sum(axis=-1), rtol=1e-9, atol=1e-18
    )


def test_fixed_end_loads_carry_the_resultant() -> None:
    """Force and moment of the equivalent loads are those of the load, whatever the shear."""
    properties = Beam("b", ("a", "c"), STEEL, BAR).properties
    first, second = np.array([10.0, 20.0, -30.0]), np.array([40.0, -50.0, 60.0])
    loads = fixed_end_loads(np.asarray(LENGTH), properties, first, second)
    total = LENGTH * (first + second) / 2
    np.testing.assert_allclose(loads[:3] + loads[6:9], total, rtol=1e-14)
    arm = np.array([LENGTH, 0, 0])
    moment = loads[3:6] + loads[9:] + np.cross(arm, loads[6:9])
    lever = LENGTH**2 * (first / 6 + second / 3)
    np.testing.assert_allclose(moment, [0.0, -lever[2], lever[1]], rtol=1e-13)
