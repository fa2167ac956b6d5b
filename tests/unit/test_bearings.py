from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import root

from strutwork.errors import ContactError
from strutwork.fea import modes
from strutwork.kinematics.joint import State
from strutwork.machines.bearing_equilibrium import equilibrium
from strutwork.machines.model_file import parse_model
from strutwork.msa import tool_compliance
from strutwork.msa.assembly import system_of
from strutwork.msa.program_builder import compile_program
from strutwork.reports.model_solution import solve_model
from strutwork.studies.error_inputs import DriveError
from strutwork.studies.error_servos import with_servos
from tests.bearings import ROLLERS, SHAFT, shaft

Array = NDArray[Any]


def test_a_joint_has_the_stiffness_of_its_bearing_at_preload() -> None:
    model = shaft()
    joints = {j.name: j for j in model.structure.linkage.joints}
    free = {State.FREE, State.LOCKED}
    assert [s not in free for s in joints["balls"].states] == [True] * 5 + [False]
    held = [True, True, False, True, True, False]
    assert [s not in free for s in joints["rollers"].states] == held
    for name, joint in joints.items():
        if name in model.bearings:
            np.testing.assert_array_equal(joint.stiffness_matrix, model.bearings[name].stiffness)
    # the rest of the program takes it as any elastic joint
    by_way = [tool_compliance(model.placed, m) for m in ("saddle_point", "null_space")]
    np.testing.assert_allclose(by_way[0], by_way[1], rtol=1e-9, atol=1e-18)


def test_equilibrium_of_two_bearings_against_a_direct_solution() -> None:
    """The five equations of a rigid shaft, solved by MINPACK on the contacts alone."""
    model = shaft()
    found = equilibrium(model, model.case("cut"))
    front, rear = (model.bearings[j].bearing for j in ("balls", "rollers"))
    assert front is not None
    assert rear is not None
    force = np.array([90.0, 20.0, -100.0])
    load = np.concatenate([force, np.cross([0.0, 0.0, 0.06], force)])
    arm = np.array([0.0, 0.0, -0.12])

    def left(u: Array) -> Array:
        q = np.array([*u, 0.0]) * 1e-6 * np.array([1, 1, 1, 10, 10, 10])
        behind = np.concatenate([q[:3] + np.cross(q[3:], arm), q[3:]])
        there = rear.loads(behind)
        there[3:] += np.cross(arm, there[:3])
        return np.asarray(front.loads(q) + there - load)[:5]

    direct = root(left, np.zeros(5), tol=1e-13, method="hybr").x * 1e-6
    expected = np.array([*direct[:3], *(10 * direct[3:]), 0.0])
    state = found.states[0]
    np.testing.assert_allclose(state.displacement, expected, rtol=1e-6, atol=1e-13)
    for one in found.states:
        np.testing.assert_allclose(one.secant @ one.displacement, one.load, rtol=1e-7, atol=1e-7)
    # the joint's force in the solution is the bearing's
    index = model.structure.linkage.joint_index["balls"]
    np.testing.assert_allclose(
        found.solution.joint_forces[index, :5, 0], -state.load[:5], rtol=1e-6, atol=1e-6
    )


def test_the_tangent_at_the_load_is_the_slope_of_the_displacement() -> None:
    model = shaft()
    case = model.case("cut")
    slope = tool_compliance(equilibrium(model, case).tangent)[0, 0]
    step = 1e-3

    def moved(more: float) -> float:
        node, wrench = case.wrenches[0]
        loads = ((node, (wrench[0] + more, *wrench[1:])),)
        solved = equilibrium(model, type(case)(case.name, loads)).solution
        return float(solved.displacement("nose", case.name)[0])

    assert (moved(step) - moved(-step)) / (2 * step) == pytest.approx(slope, rel=1e-4)
    at_preload = tool_compliance(model.placed)[0, 0]
    assert abs(slope / at_preload - 1.0) > 1e-3


def test_the_compiled_kernel_leaves_coupled_stiffnesses_to_the_other_solvers() -> None:
    """It has one stiffness for each coordinate; a bearing that is tilted couples two."""
    model = parse_model(
        """
[nodes]
seat = [0, 0, 0]
shaft = [0, 0, 0]
nose = [0, 0, 0.1]
[[supports]]
node = "seat"
fixed = "all"
[[bodies]]
name = "shaft"
nodes = ["shaft", "nose"]
[[joints]]
name = "rollers"
type = "revolute"
between = ["seat", "shaft"]
bearing = "roller-row-6"
driven = ["rz"]
[[loads]]
node = "nose"
force = ["200 N", "30 N", 0]
[tool]
tcp = "nose"
"""
    )
    loaded = equilibrium(model, model.cases[0]).tangent
    assert compile_program(system_of(model.placed)) is not None
    assert compile_program(system_of(loaded)) is None


def test_energy_is_the_work_of_the_load() -> None:
    model = shaft()
    case = model.case("push")
    nodes, weights = np.polynomial.legendre.leggauss(3)
    work = 0.0
    for x, w in zip(0.5 * (1 + nodes), 0.5 * weights, strict=True):
        # ∫ u dF along a growing load is the complementary energy: F u − E
        part = type(case)(case.name, (("nose", (0.0, 0.0, -300.0 * x, 0.0, 0.0, 0.0)),))
        u = equilibrium(model, part).solution.displacement("nose", case.name)[2]
        work += w * -300.0 * float(u)
    solution = equilibrium(model, case).solution
    u = float(solution.displacement("nose", case.name)[2])
    assert solution.strain_energy[0] == pytest.approx(-300.0 * u - work, rel=1e-4)


@pytest.mark.filterwarnings("ignore:tool. does not move:strutwork.errors.ModelWarning")
def test_solve_states_secant_tangent_and_the_tool_under_load() -> None:
    model = shaft(
        ('node = "nose"\nforce = [0, 0, "-600 N"]', 'node = "nose"\nforce = [0, 0, "9 N"]')
    )
    answer = solve_model(model).to_dict()
    cut = answer["cases"]["cut"]
    assert set(cut["bearings"]) == {"balls", "rollers"}
    assert 3 <= cut["bearing_steps"] <= 60
    assert cut["bearings"]["balls"]["entry"] == "front"
    exact = tool_compliance(equilibrium(model, model.case("cut")).tangent)
    np.testing.assert_allclose(cut["tcp"]["compliance"], exact, rtol=1e-12)
    np.testing.assert_allclose(
        answer["tcp"]["compliance"], tool_compliance(model.placed), rtol=1e-9
    )


def test_vibration_takes_the_tangent_at_the_load_of_the_preload() -> None:
    model = shaft()
    tangent = equilibrium(model, model.case("cut")).tangent
    bare = modes(tangent, 5).frequencies
    # the geometric stiffness of 100 N is small beside the bearings'
    np.testing.assert_allclose(modes(model.vibrating, 5).frequencies, bare, rtol=1e-4)
    assert np.abs(modes(model.placed, 5).frequencies / bare - 1.0).max() > 2e-3


def test_lost_preload_names_bearing_load_and_remedy() -> None:
    model = shaft()
    with pytest.raises(ContactError) as caught:
        equilibrium(model, model.case("too much"))
    words = str(caught.value)
    for part in (
        "bearing front of the joint balls",
        "too much",
        "600 N along it",
        "opens at 4",
        "150 N",
    ):
        assert part in words
    assert "give the entry more" in words
    big = shaft(
        ('node = "nose"\nforce = [0, 0, "-600 N"]', 'node = "rear"\nforce = ["9 kN", 0, 0]'),
        ('"150 N"', '"30 kN"'),
    )
    with pytest.raises(ContactError, match="one side"):
        equilibrium(big, big.case("too much"))


def test_a_given_stiffness_and_its_opening() -> None:
    guide = """
[bearings.front]
type = "stiffness"
source = "made up"
stiffness = { x = "100 N/um", y = "100 N/um", z = "200 N/um", rx = 1e5, ry = 1e5 }
opens_at = { z = "500 N" }
"""
    model = parse_model(SHAFT + guide + ROLLERS)
    z = equilibrium(model, model.case("push")).solution.displacement("nose", "push")[2]
    assert z == pytest.approx(-300.0 / 200e6, rel=1e-9)
    with pytest.raises(ContactError, match=r"bears 600 N in z, and its contact opens at 500 N"):
        equilibrium(model, model.case("too much"))


def test_a_drive_beside_a_guide_keeps_its_stiffness() -> None:
    text = """
[nodes]
rail = [0, 0, 0]
table = [0, 0, 0]
[[supports]]
node = "rail"
fixed = "all"
[[joints]]
name = "guide"
type = "prismatic"
between = ["rail", "table"]
bearing = "rail-contacts"
driven = ["z"]
stiffness = { z = "50 N/um" }
[[loads]]
node = "table"
force = [0, "-300 N", "100 N"]
[tool]
tcp = "table"
"""
    model = parse_model(text)
    found = equilibrium(model, model.cases[0])
    moved = found.solution.displacement("table", "load")
    assert moved[2] == pytest.approx(100.0 / 50e6, rel=1e-9)
    contacts = model.bearings["guide"].bearing
    assert contacts is not None
    servo = with_servos(model.structure, [DriveError("guide", "z", servo_stiffness=150e6)])
    soft = servo.linkage.joints[0].stiffness_matrix
    assert soft[2, 2] == pytest.approx(37.5e6)
    assert soft[1, 1] == contacts.tangent()[1, 1]
    assert contacts.loads(found.states[0].displacement)[1] == pytest.approx(-300.0, rel=1e-8)
