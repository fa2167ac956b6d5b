"""Load cases: settlements, gravity, misfits, reactions, energy; what the solution answers."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from strutwork.errors import InconsistentConstraintsError, ModelError
from strutwork.kinematics import DIRECTIONS
from strutwork.msa import LineLoad, LoadCase, PointMass, solve
from tests.structure_cases import LIBRARY, door_on_two_hinges, rigid_table, stewart
from tests.structures import BAR, STEEL, Model, cantilever, wrench

SOLVED = 1e-9


def clamped(length: float = 0.6, **options: Any) -> Model:
    model = cantilever(length=length, **options)
    model.support("tip")
    return model


def test_a_settlement_of_a_clamped_end() -> None:
    model = clamped(shear=False, elements=2)
    drop = 2e-3
    found = solve(model.place(), [LoadCase("sink", gaps={("support tip", "z"): -drop})])
    ei = STEEL.youngs_modulus * BAR.second_moment_y
    # 12 EI d/L³ and 6 EI d/L²
    force, moment = 12 * ei * drop / 0.6**3, 6 * ei * drop / 0.6**2
    np.testing.assert_allclose(
        found.displacement("tip", "sink"), [0, 0, -drop, 0, 0, 0], atol=1e-15
    )
    np.testing.assert_allclose(
        found.joint_force("support tip", "sink"), [0, 0, -force, 0, -moment, 0],
        rtol=SOLVED, atol=1e-7,
    )  # fmt: skip
    assert found.displacement("beam/1", "sink")[2] == pytest.approx(-drop / 2, rel=SOLVED)
    # work of the settlement: half of force times drop
    assert found.strain_energy[0] == pytest.approx(force * drop / 2, rel=SOLVED)


def test_a_settlement_of_a_statically_determinate_frame_costs_no_force() -> None:
    model = cantilever()
    gaps = {("support root", "z"): 1e-3, ("support root", "ry"): -2e-3}
    found = solve(model.place(), [LoadCase("sink", gaps=gaps)])
    np.testing.assert_allclose(
        found.displacement("tip", "sink"), [0, 0, 1e-3 + 0.6 * 2e-3, 0, -2e-3, 0], atol=1e-14
    )
    # EA d/L would be 2e5 N: what is left is round-off of that
    assert np.abs(found.beam_forces).max() < 1e-6
    assert found.strain_energy[0] == pytest.approx(0.0, abs=1e-9)


def test_gravity_on_beams_and_masses_ends_in_the_support() -> None:
    model = cantilever(elements=2)
    model.masses.append(PointMass("tip", 4.0, offset=(0.1, 0.2, 0.0)))
    found = solve(model.place(), [LoadCase("g", gravity=(0.0, 0.0, -10.0))])
    beam = STEEL.density or 0.0
    beam *= BAR.area * 0.6
    weight = 10 * (beam + 4.0)
    moment = [10 * 4.0 * 0.2, -10 * (beam * 0.3 + 4.0 * 0.7), 0.0]
    np.testing.assert_allclose(
        found.joint_force("support root", "g"), [0, 0, weight, *moment], rtol=SOLVED, atol=1e-8
    )


def test_gravity_needs_densities() -> None:
    model = cantilever()
    model.beams[0] = replace(model.beams[0], material=replace(STEEL, density=None))
    with pytest.raises(ModelError, match='material steel: has no density, and beam "beam"'):
        solve(model.place(), [LoadCase("g", gravity=(0.0, 0.0, -9.81))])
    # without gravity none is needed
    solve(model.place(), [wrench("push", "tip", 1.0)])


def test_a_misfit_moves_the_second_side_along_the_joint_axis() -> None:
    """(u₂ − u₁)·e = gap, whichever side is held."""
    for between, sign in ((("base", "tool"), 1.0), (("tool", "base"), -1.0)):
        model = Model("tool")
        model.ground(base=(0, 0, 0))
        model.joint("weld", "fixed", between, (0, 1, 0), (0, 0, 1))
        found = solve(model.place(), [LoadCase("gap", gaps={("weld", "z"): 1e-3})])
        assert found.displacement("tool", "gap")[1] == pytest.approx(sign * 1e-3, rel=1e-15)


def test_an_elastic_gap_is_shared_as_springs_in_series_share_it() -> None:
    model = Model("b")
    model.ground(base=(0, 0, 0))
    model.joint("one", "fixed", ("base", "a"), stiffness={"z": 3e6})
    model.nodes(b=(0, 0, 1))
    model.rigid("bar", "a", "b")
    model.support("b", stiffness={"z": 6e6})
    found = solve(model.place(), [LoadCase("gap", gaps={("one", "z"): 3e-4})])
    # k = 2e6 in series: 600 N, split 1/3 and 2/3 of the gap
    assert found.joint_force("one", "gap")[2] == pytest.approx(600.0, rel=1e-12)
    assert found.joint_force("support b", "gap")[2] == pytest.approx(-600.0, rel=1e-12)
    assert found.displacement("b", "gap")[2] == pytest.approx(1e-4, rel=1e-12)
    assert found.strain_energy[0] == pytest.approx(0.5 * 600 * 3e-4, rel=1e-12)


@pytest.mark.parametrize("name", LIBRARY)
def test_half_the_work_of_the_nodal_loads_is_stored(name: str) -> None:
    """Clapeyron's theorem, on every structure of the library."""
    example = LIBRARY[name]()
    placed = example.model.place()
    case = example.cases[0]
    assert not case.gaps
    assert not case.line_loads
    found = solve(placed, [case])
    work = sum(
        0.5 * np.asarray(found.displacement(node, case.name)) @ np.asarray(six)
        for node, six in case.wrenches
    )
    assert np.all(np.asarray(work) > 0)
    np.testing.assert_allclose(found.strain_energy[..., 0], work, rtol=1e-8)


def test_misfit_energy_is_half_of_force_times_gap() -> None:
    for name in ("portal frame", "four-bar, flexible", "block on bushings"):
        example = LIBRARY[name]()
        case = next(c for c in example.cases if c.gaps)
        found = solve(example.model.place(), [case])
        work = sum(
            0.5 * gap * found.joint_force(joint, case.name)[..., DIRECTIONS.index(d)]
            for (joint, d), gap in case.gaps.items()
        )
        assert found.strain_energy[0] == pytest.approx(work, rel=1e-8)


def test_line_load_energy_adds_work_of_the_deflected_line() -> None:
    """Strain energy of line and nodal loads together: ½ (F·u + ∫ q w dx), w by fine division."""
    q = -500.0
    line = LineLoad("beam", (0, 0, q), (0, 0, q))
    case = LoadCase("all", (("tip", (0, 0, 90.0, 0, 0, 0)),), (line,))
    coarse = solve(cantilever(elements=1).place(), [case])
    fine = solve(cantilever(elements=64).place(), [case])
    nodes = ["root", *(f"beam/{i}" for i in range(1, 64)), "tip"]
    w = np.array([fine.displacement(n, "all")[2] for n in nodes])
    # composite Simpson on 64 intervals of a quartic: error (1/64)⁴
    weights = np.array([1.0, *([4.0, 2.0] * 32)[:-1], 1.0]) * (0.6 / 64) / 3
    work = 0.5 * (90.0 * w[-1] + q * weights @ w)
    assert coarse.strain_energy[0] == pytest.approx(work, rel=1e-6)
    assert coarse.strain_energy[0] == pytest.approx(fine.strain_energy[0], rel=1e-7)


def test_redundant_rows_share_the_least_force_in_balance() -> None:
    """Four legs locked under a rigid plate: a central load is shared equally, statics alone
    leaves one force open, and the least is the one without self-stress."""
    found = solve(rigid_table().model.place(), [wrench("push", "tool", 0, 0, -400.0)])
    index = found.placed.structure.linkage.joint_index
    for i in range(4):
        force = found.joint_forces[index[f"support c{i}"], 2, 0]
        assert force == pytest.approx(100.0, rel=1e-12)
        # one of many in balance, so by name it is withheld
        assert found.joint_force(f"support c{i}", "push")[2] is np.ma.masked


def test_misfits_that_redundant_rows_cannot_meet_are_refused_with_their_joints() -> None:
    case = LoadCase("warp", gaps={("support c0", "z"): 1e-3})
    placed = rigid_table().model.place()
    for method in ("saddle_point", "null_space", "condensed", "sparse"):
        with pytest.raises(InconsistentConstraintsError, match="rigid loop") as caught:
            solve(placed, [case], method)
        for i in range(4):
            assert f"support c{i}" in caught.value.part
        assert "support tool" not in caught.value.part
        assert "real stiffness" in caught.value.remedy


def test_a_misfit_of_one_door_hinge_along_its_axis_is_refused() -> None:
    placed = door_on_two_hinges().model.place()
    with pytest.raises(InconsistentConstraintsError, match="lower, upper"):
        solve(placed, [LoadCase("long", gaps={("upper", "z"): 1e-3})])
    both = {("upper", "z"): 1e-3, ("lower", "z"): 1e-3}
    found = solve(placed, [LoadCase("lifted", gaps=both)])
    assert found.displacement("handle", "lifted")[2] == pytest.approx(1e-3, rel=1e-12)
    assert np.abs(found.joint_forces).max() < 1e-9


def test_self_balanced_loads_leave_a_floating_frame_where_it_is() -> None:
    example = LIBRARY["floating frame"]()
    found = solve(example.model.place(), example.cases)
    positions = found.placed.placement.positions
    u = found.displacements[:3, :, 0]
    # the cluster displacements have no share in a rigid motion; with one cluster a node, and a
    # fourth inside "rp", translation of all four sums to nothing
    every = found.displacements[..., 0]
    assert np.abs(every[:, :3].sum(axis=0)).max() < 1e-9 * np.abs(u).max()
    assert positions.shape == (3, 3)
    assert found.strain_energy[0] > 0


def test_the_solution_answers_by_name_and_as_a_dictionary() -> None:
    example = LIBRARY["portal frame"]()
    found = solve(example.model.place(), example.cases)
    assert repr(found).startswith("<StaticSolution: 4 cases, batch (), method saddle_point")
    data = json.loads(json.dumps(found.to_dict()))
    assert set(data) == {"crown", "snow", "settle", "gravity"}
    one = data["snow"]
    assert set(one) == {"displacements", "joint_forces", "beam_forces", "strain_energy"}
    assert set(one["beam_forces"]) == {"left", "rafter1", "rafter2", "right"}
    np.testing.assert_array_equal(one["displacements"]["c"], found.displacement("c", "snow"))
    np.testing.assert_array_equal(
        one["joint_forces"]["support a"], found.joint_force("support a", "snow")
    )
    for call, problem in (
        (lambda: found.displacement("zz", "snow"), 'no node "zz"'),
        (lambda: found.joint_force("zz", "snow"), 'no joint "zz"'),
        (lambda: found.displacement("a", "zz"), 'no case "zz"'),
    ):
        with pytest.raises(ModelError, match=problem):
            call()
    batch = stewart()
    with pytest.raises(ModelError, match="has several poses"):
        solve(batch.model.place(), batch.cases).to_dict()


def test_a_solution_of_no_case_is_empty() -> None:
    found = solve(cantilever().place(), [])
    assert found.displacements.shape == (3, 6, 0)
    assert found.strain_energy.shape == (0,)


def test_a_structure_that_stands_on_the_ground_alone_does_not_move() -> None:
    model = Model("b")
    model.ground(a=(0, 0, 0), b=(1, 0, 0))
    model.beam("rail", "a", "b", BAR)
    found = solve(model.place(), [wrench("push", "b", 1.0, 2.0, 3.0)])
    assert not np.any(found.displacements)
    assert not np.any(found.beam_forces)


@pytest.mark.parametrize(
    ("case", "problem"),
    [
        (wrench("c", "zz", 1.0), 'load case c: names the unknown node "zz"'),
        (LoadCase("c", line_loads=(LineLoad("zz", (0, 0, 1), (0, 0, 1)),)), 'unknown beam "zz"'),
    ],
)
def test_a_load_must_name_a_part(case: LoadCase, problem: str) -> None:
    with pytest.raises(ModelError, match=problem):
        solve(cantilever().place(), [case])


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        ({"wrenches": (("tip", (float("nan"),) * 6),)}, "load at node tip is nan"),
        ({"line_loads": (LineLoad("b", (0, 0, 1), (0, float("inf"), 1)),)}, "line load on beam b"),
        ({"gaps": {("J", "z"): float("nan")}}, "misfit of joint J in z is nan"),
        ({"gravity": (0.0, 0.0, float("-inf"))}, "gravity is 0, 0, -inf"),
    ],
)
def test_a_load_that_is_not_finite_is_refused(arguments: dict[str, Any], problem: str) -> None:
    with pytest.raises(ModelError, match=problem) as caught:
        LoadCase("bad", **arguments)
    assert caught.value.part == "load case bad"
