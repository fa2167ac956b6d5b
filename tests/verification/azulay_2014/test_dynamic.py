"""Dynamic stiffness of four parallel machines, Table 5 of the paper.

@article{azulay2014comparative,
  author  = {Azulay, Hay and Mahmoodi, Masih and Zhao, Ray and Mills, James K.
             and Benhabib, Beno},
  title   = {Comparative analysis of a new {3xPPRS} parallel kinematic mechanism},
  journal = {Robotics and Computer-Integrated Manufacturing},
  volume  = {30},
  year    = {2014}
}

The table cannot be predicted from what is printed: the platform's mass, the height of its centre
above the spherical joints and the home heights are left out, and a few millimetres of that height
change Kxx a hundredfold. The calibrated set fits them to the table; the blind set fits nothing.
Asserted are what symmetry and mechanics force on either, and, of the calibrated set, what it was
fitted to: the rankings, and how far each number is from the print. Joint compliance is left out
and the damping is 1 % viscous in every mode, as the paper says.

Every published number is read from `strutwork.papers.azulay_2014.published`.
"""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import numpy as np
import pytest

from strutwork.fea import ModalRatio, Port, frequency_response
from strutwork.machines import DYNAMIC_SETS, DynamicSet, VibratingLegs, dynamic_machine
from strutwork.papers.azulay_2014.comparison import machines
from strutwork.papers.azulay_2014.dynamic import (
    AzulayDynamics,
    azulay_table_5,
    published_dynamic_ranking,
)
from strutwork.papers.azulay_2014.published import TABLE_5
from strutwork.papers.azulay_2014.sensitivity import closed_form_stiffness
from strutwork.studies import dynamic_stiffness
from strutwork.studies.dynamic import at_home

SETS: tuple[DynamicSet, ...] = tuple(DYNAMIC_SETS)

every_machine = pytest.mark.parametrize("name", machines())
either_set = pytest.mark.parametrize("which", SETS)

#: The paper's equivalent damping ratio (section 3.3.2).
ZETA = 0.01


@pytest.fixture(scope="module")
def found() -> AzulayDynamics:
    return azulay_table_5()


@either_set
@every_machine
def test_three_equal_legs_are_as_stiff_along_x_as_along_y(
    found: AzulayDynamics, name: str, which: DynamicSet
) -> None:
    values = found.studies[which]["minimum_dynamic_stiffness"].sel(machine=name)
    # exact by symmetry: rounding of an eigensolution
    assert float(values.sel(axis="x")) == pytest.approx(float(values.sel(axis="y")), rel=1e-6)
    # and so are the frequencies of the first pair
    first = found.studies[which]["natural_frequency"].sel(machine=name).to_numpy()[:2]
    assert first[0] == pytest.approx(first[1], rel=1e-6)


@either_set
@every_machine
def test_the_minimum_lies_between_its_bounds(
    found: AzulayDynamics, name: str, which: DynamicSet
) -> None:
    study = found.studies[which].sel(machine=name)
    least = study["minimum_dynamic_stiffness"].to_numpy()
    # 2ζ√(1−ζ²) K_static from below and 2ζ min ω²/φ² from above; rounding only
    lower = 2 * ZETA * sqrt(1 - ZETA**2) * study["static_stiffness"].to_numpy()
    np.testing.assert_allclose(study["lower_bound"], lower, rtol=1e-12)
    assert np.all(least >= lower * (1 - 1e-9))
    assert np.all(least <= study["upper_bound"].to_numpy() * (1 + 1e-9))
    assert bool(study["certified"].all())


@either_set
@every_machine
def test_the_direct_solution_agrees_with_the_sum_over_all_modes(
    name: str, which: DynamicSet
) -> None:
    placed = at_home(dynamic_machine(name, which))
    ports = [Port("tool", axis) for axis in "xyz"]
    lines = np.concatenate([np.linspace(0.0, 1000.0, 41), [49.7, 73.4, 114.6, 185.7, 2772.0]])
    both = [
        frequency_response(placed, ports, ports, lines, ModalRatio(ZETA), method).receptance
        for method in ("all_modes", "direct")
    ]
    # two solutions of one linear system
    assert np.abs(both[0] - both[1]).max() <= 1e-8 * np.abs(both[1]).max()
    diagonal = [np.einsum("fii->fi", h) for h in both]
    assert np.all(np.abs(diagonal[0] - diagonal[1]) <= 1e-8 * np.abs(diagonal[1]))


@pytest.mark.parametrize("which", SETS)
@pytest.mark.parametrize("offset", [0.0, 4e-3, 8e-3, 11.5e-3])
def test_the_closed_form_gives_the_static_stiffness_of_links_on_rigid_roots(
    which: DynamicSet, offset: float
) -> None:
    # the Alizade machine has nothing but its struts between platform and clamped roots; beams
    # without shear, as the formula has none
    whole = dynamic_machine("alizade-3prps", which)
    machine = replace(whole, base=replace(whole.base, shear=False), tool_offset=offset)
    exact = dynamic_stiffness({"alizade": machine})["static_stiffness"].to_numpy()[0]
    # 2 %: the formula leaves out that turning the platform also stretches and twists the links
    assert closed_form_stiffness(machine.base, offset) == pytest.approx(exact[0], rel=0.02)


def test_a_few_millimetres_change_the_stiffness_a_hundredfold() -> None:
    def along_x(offset: float) -> float:
        machine = replace(dynamic_machine("alizade-3prps"), tool_offset=offset)
        return float(dynamic_stiffness({"a": machine})["static_stiffness"].sel(axis="x")[0])

    # ρ = R_p tan φ = 18 mm · 152.2/144 = 19.0 mm is where the links' directions meet the axis
    assert along_x(19.0e-3) > 100.0 * along_x(0.0)
    assert along_x(19.0e-3) > 10.0 * along_x(14.0e-3)


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_the_calibrated_set_ranks_the_machines_as_the_table_does(
    found: AzulayDynamics, axis: str
) -> None:
    if axis == "x":
        # the print splits what symmetry makes equal, and ranks Eclipse and Alizade (.044, .047)
        # by 7 % along x where it splits them by up to 23 %; ours is the ranking of both axes
        assert published_dynamic_ranking("x") == published_dynamic_ranking("y")
    # calibrated: the set was fitted to this table
    assert found.ranking(axis, "calibrated") == published_dynamic_ranking(axis)


def test_the_calibrated_set_is_near_the_table(found: AzulayDynamics) -> None:
    factors = found.factors("calibrated")
    assert len(factors) == len(TABLE_5.values) == 12
    # calibrated, and what it leaves: each within a factor of 4, the geometric mean within 1.6
    assert max(factors.values()) <= 4.0
    assert found.mean_factor("calibrated") <= 1.6


#: N/µm along x and z, and the first three frequencies, Hz, of the documented calibrated set.
DOCUMENTED = {
    "proposed-3pprs": ((0.115, 0.0716), (49.7, 49.7, 104.4)),
    "eclipse-3pprs": ((0.0202, 0.582), (73.4, 73.4, 101.6)),
    "alizade-3prps": ((0.0577, 4.28), (114.6, 114.6, 163.5)),
    "glozman-3prrs": ((0.0177, 0.0185), (50.0, 50.0, 122.3)),
}


@every_machine
def test_the_calibrated_set_is_the_documented_one(found: AzulayDynamics, name: str) -> None:
    study = found.studies["calibrated"].sel(machine=name)
    stiffness, frequencies = DOCUMENTED[name]
    least = study["minimum_dynamic_stiffness"].sel(axis=["x", "z"]).to_numpy() / 1e6
    # three digits are given: half of the last one
    np.testing.assert_allclose(least, stiffness, rtol=5e-3)
    np.testing.assert_allclose(study["natural_frequency"].to_numpy()[:3], frequencies, atol=0.051)


def test_rows_say_what_they_are_worth(found: AzulayDynamics) -> None:
    assert {row.status for row in found.rows["blind"]} == {"not reproducible"}
    # fitted to the table, so calibrated, also where the fit misses it; the note says so then
    assert {row.status for row in found.rows["calibrated"]} == {"calibrated"}
    missed = {
        (row.row, row.quantity)
        for row in found.rows["calibrated"]
        if "the fit misses it" in row.note
    }
    factors = found.factors("calibrated")
    assert missed == {key for key, factor in factors.items() if factor > 2.0}
    assert ("alizade-3prps", "Kzz minimum") in missed
    assert [row.published for row in found.rows["blind"]] == [v.value for v in TABLE_5]


def test_one_percent_read_as_a_loss_factor_halves_the_damping(found: AzulayDynamics) -> None:
    """Alizade's Kzz = 2.08 contradicts a damping ratio of 1 % and agrees with a loss factor."""
    at = {"machine": "alizade-3prps", "axis": "z"}
    viscous = float(found.studies["calibrated"]["minimum_dynamic_stiffness"].sel(at))
    structural = float(found.loss_factor["calibrated"]["minimum_dynamic_stiffness"].sel(at))
    # at a single resonance η = 2ζ: 1 % of loss factor is half a percent of ratio; neighbours 1 %
    assert structural == pytest.approx(viscous / 2.0, rel=0.01)
    published = TABLE_5.value("alizade-3prps", "Kzz minimum") * 1e6
    bound = float(found.studies["calibrated"]["lower_bound"].sel(at))
    assert published < 0.6 * bound
    assert structural == pytest.approx(published, rel=0.05)


def test_the_machines_are_heavy_where_they_should_be() -> None:
    machine = dynamic_machine("proposed-3pprs", "calibrated")
    (platform,) = machine.structure.masses
    assert (platform.mass, machine.tool_offset) == (0.5, 11.5e-3)
    assert isinstance(machine, VibratingLegs)
    # 1/2 m R²
    assert platform.inertia[2][2] == pytest.approx(0.5 * 0.5 * 0.030**2, rel=1e-12)
