"""A machine as a function: values, gradients against differences, poses, names, pickles."""

from __future__ import annotations

import pickle
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import strutwork as sw
from strutwork.errors import ModelError, UnitError, UnreachableError
from strutwork.msa.mass import total_mass
from strutwork.studies.function import MachineFunction
from strutwork.studies.gradient import machine_gradient
from strutwork.studies.parameter import Parameter
from tests.gradients import CANTILEVER, CHAIN

HEAD = "examples/machines/3-rps.toml"
RAM, BALLS = "sections.ram.diameter", "joints.ball*.stiffness.*"


def differences(f: MachineFunction, x: NDArray[Any], name: str) -> NDArray[Any]:
    """Central ones of an answer, the parameters last."""
    found = []
    for i, value in enumerate(x):
        step = np.zeros(len(x))
        step[i] = 1e-4 * value
        found.append((f(x + step)[name] - f(x - step)[name]) / (2 * step[i]))
    return np.moveaxis(np.array(found), 0, -1)


@pytest.fixture(scope="module")
def head() -> MachineFunction:
    ranges = {RAM: ("30 mm", "48 mm"), BALLS: (1e8, 1e9), "bodies.platform.mass": (20.0, 30.0)}
    answers = ["stiffness_z", "mass", "frequency_1", "stiffness_x"]
    return sw.load(HEAD).function(ranges, answers, poses={"z": ["670 mm", 0.70], "rx": [0.1]})


def test_the_cantilever_by_hand() -> None:
    """k = 3EI/L³ and the mass ρAL + m, with their gradients."""
    paths = ["sections.bar.diameter", "masses[0].mass", "materials.steel.density"]
    f = MachineFunction.of(CANTILEVER, paths, ["stiffness_z", "mass"])
    at = {"sections.bar.diameter": "32 mm", "materials.steel.density": 7850.0}
    k = 3 * 210e9 * np.pi * 0.032**4 / 64 / 0.6**3
    mass = 7850 * 0.6 * np.pi * 0.032**2 / 4 + 8
    assert f(at) == pytest.approx({"stiffness_z": k, "mass": mass}, rel=1e-9)
    slopes = f.gradient(at)
    assert slopes["stiffness_z"] == pytest.approx(
        {paths[0]: 4 * k / 0.032, paths[1]: 0.0, paths[2]: 0.0}, rel=1e-8, abs=1e-6
    )
    assert slopes["mass"] == pytest.approx(
        {paths[0]: 2 * (mass - 8) / 0.032, paths[1]: 1.0, paths[2]: (mass - 8) / 7850}, rel=1e-8
    )
    assert f.units["stiffness_z"] == "N/m"
    assert f.units["masses[0].mass"] == "kg"


def test_arrays_and_names_are_the_same_point(head: MachineFunction) -> None:
    x = head.start * [1.05, 0.9, 1.0]
    assert head(x) == head(dict(zip(head.parameters, x, strict=True)))
    assert head() == head(head.start) == head({})
    assert head.bounds == [(0.03, 0.048), (1e8, 1e9), (20.0, 30.0)]
    rows = head.jacobian(x)
    for name, row in head.gradient(x).items():
        assert list(row) == list(head.parameters)
        assert list(row.values()) == rows[name].tolist()


@pytest.mark.parametrize("reduction", ["worst", "mean", "poses"])
def test_gradients_are_those_of_differences(reduction: str) -> None:
    paths = [RAM, Parameter(BALLS, relative=True), "nodes.base1.y+nodes.foot1.y"]
    f = MachineFunction.of(
        HEAD,
        paths,
        ["stiffness_x", "mass", "frequency_2"],
        {"z": [0.67, 0.70], "rx": [0.1]},
        reduction=reduction,
    )
    x = f.start * [1.02, 1.1, 1.0]
    for name, rates in f.jacobian(x).items():
        size = np.abs(f(x)[name]).max() / x
        np.testing.assert_allclose(rates / size, differences(f, x, name) / size, atol=1e-6)
        assert rates.shape == ((2, 3) if reduction == "poses" else (3,))


def test_the_worst_is_the_least_of_all_poses(head: MachineFunction) -> None:
    every = MachineFunction.of(
        HEAD, [RAM], head.answers, {"z": [0.67, 0.70], "rx": [0.1]}, reduction="poses"
    )
    values = every()
    assert {name: values[name].min() for name in head.answers} == pytest.approx(head(), rel=1e-12)
    assert values["stiffness_x"][0] != values["stiffness_x"][1]


def test_the_mass_is_that_at_home() -> None:
    """Its first links are as long as the slider is out, which every pose changes."""
    paths = ["link_length", "section.outer_diameter"]
    poses = {"x": [0.003, -0.002], "z": [0.125]}
    machine = sw.load("proposed-3pprs")
    f = machine.function(paths, ["mass"], poses=poses, reduction="poses")
    home = machine.study({"link_length": [0.216]}, "mass", workspace={})["mass"].item()
    there = float(np.ravel(total_mass(machine.at(x=0.003, z=0.125).placed))[0])
    assert abs(there / home - 1.0) > 1e-3
    assert f()["mass"] == pytest.approx([home, home], rel=1e-12)
    slopes = differences(f, f.start, "mass")
    np.testing.assert_allclose(f.jacobian()["mass"], slopes, rtol=1e-6)
    gradient = machine.gradient("mass", by=paths, task={"x": [0.003]})
    np.testing.assert_allclose(gradient["gradient"][0, :, 0], slopes[0], rtol=1e-6)


def test_displacements_are_worst_where_they_are_largest() -> None:
    paths = ["materials.steel.youngs_modulus"]
    f = MachineFunction.of(CHAIN, paths, ["displacement:tip:z@cut", "joint_force:elbow:z@cut"])
    assert f.jacobian()["displacement:tip:z@cut"] == pytest.approx(
        differences(f, f.start, "displacement:tip:z@cut"), rel=1e-6
    )


def test_the_workspace_is_its_poses_that_can_be_taken() -> None:
    f = MachineFunction.of(HEAD, [RAM], ["stiffness_z"], "workspace")
    model = f.machine.model()
    assert model.workspace is not None
    assert 1 < f.poses <= len(model.workspace)
    assert f()["stiffness_z"] < MachineFunction.of(HEAD, [RAM], ["stiffness_z"])()["stiffness_z"]


def test_a_function_pickles_without_its_results(head: MachineFunction) -> None:
    x = head.start * 1.01
    other = pickle.loads(pickle.dumps(head))  # noqa: S301 - what was just written
    assert other(x) == head(x)
    assert other.gradient(x) == head.gradient(x)


def test_results_are_not_those_of_a_caller(head: MachineFunction) -> None:
    head.jacobian()["mass"][:] = 0.0
    assert head.jacobian()["mass"][0] > 0.0


def test_the_front_door_takes_gradients() -> None:
    machine = sw.load(HEAD)
    found = machine.gradient("stiffness_z", "mass", by=[RAM], task={"z": [0.67, 0.7]})
    assert found["gradient"].shape == (2, 1, 2)
    assert str(found["gradient_unit"][1, 0].item()) == "kg per m"
    usual = machine_gradient(HEAD, by=[RAM])
    assert usual["quantity"].to_numpy().tolist() == ["stiffness_x", "stiffness_y", "stiffness_z"]
    with pytest.raises(ModelError, match=r"changed or moved since it was read"):
        machine.at(z="690 mm").function([RAM], ["mass"])


@pytest.mark.parametrize(
    ("parameters", "answers", "options", "said"),
    [
        (["sections.ram.diametre"], ["mass"], {}, 'Did you mean "sections.ram.diameter"'),
        ([], ["mass"], {}, "parameters: are none"),
        (RAM, ["mass"], {}, "Give a list of paths"),
        ([3], ["mass"], {}, "parameters: hold a int"),
        ({RAM: 0.05}, ["mass"], {}, r"Give a pair \(low, high\)"),
        ({RAM: (0.06, 0.05)}, ["mass"], {}, "Give the lower end first"),
        ([RAM, "sections.*.diameter"], ["mass"], {}, "Change each number by one parameter"),
        (["sections.cylinder.*_diameter"], ["mass"], {}, "2 numbers that differ, from 0.052"),
        ([RAM], [], {}, "answers: are no list"),
        ([RAM], "mass", {}, "answers: are no list"),
        ([RAM], ["stiffness"], {}, "has no gradient|no quantity that has a gradient"),
        ([RAM], ["mass", "mass"], {}, "name mass twice"),
        ([RAM], ["displacement:TCP:z@nothing"], {}, "nothing"),
        ([RAM], ["mass"], {"poses": "workspaces"}, "workspace"),
        ([RAM], ["mass"], {"poses": {}}, "poses: are none"),
        ([RAM], ["mass"], {"poses": {"z": []}}, "poses: are none"),
        ([RAM], ["mass"], {"poses": {"up": 0.7}}, "up"),
        ([RAM], ["mass"], {"reduction": "worse"}, 'Did you mean "worst"'),
    ],
)
def test_what_cannot_be_asked(parameters: Any, answers: Any, options: Any, said: str) -> None:
    with pytest.raises(ModelError, match=said):
        MachineFunction.of(HEAD, parameters, answers, **options)


def test_poses_and_points_out_of_range(head: MachineFunction) -> None:
    with pytest.raises(UnreachableError):
        MachineFunction.of(HEAD, [RAM], ["mass"], {"z": "2 m"})
    with pytest.raises(UnitError, match=r"poses\.z"):
        MachineFunction.of(HEAD, [RAM], ["mass"], {"z": "2 N"})
    with pytest.raises(ModelError, match=r"no argument of the function"):
        head({"sections.ram.radius": 0.02})
    with pytest.raises(
        ModelError, match=r"no array of 3 numbers\.\nGive them in the order sections\.ram"
    ):
        head([0.05])
    with pytest.raises(ModelError, match=r"no array of 3 numbers"):
        head(["a", "b", "c"])
    with pytest.raises(ModelError, match=r"sections\.ram\.diameter"):
        head({RAM: -0.01})
    with pytest.raises(ModelError, match=r"sections\.ram\.diameter"):
        head([np.nan, 4e8, 25.0])
    with pytest.raises(UnitError, match=r"sections\.ram\.diameter"):
        head({RAM: "4 kg"})
    factor = MachineFunction.of(HEAD, [Parameter(RAM, relative=True)], ["mass"])
    with pytest.raises(ModelError, match=r"Give a plain number, as 1\.1"):
        factor({RAM: "50 mm"})


def test_a_whole_number_has_no_derivative() -> None:
    f = MachineFunction.of(CANTILEVER, ["beams.arm.elements"], ["stiffness_z"])
    assert f([3])["stiffness_z"] == pytest.approx(f()["stiffness_z"])
    with pytest.raises(ModelError, match=r"beams\.arm\.elements: has no derivative"):
        f.gradient()
