from __future__ import annotations

import copy
import tomllib
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.flexures.closed_forms import rotational_compliance_thin
from strutwork.machines.model import Model, ModelWarning
from strutwork.machines.model_file import parse_model
from strutwork.reports.model_solution import solve_model
from strutwork.studies.dimension import Dimension
from strutwork.studies.gradient import gradient
from strutwork.studies.parametric import Parametric
from tests.model_files import EXAMPLES, Content, Edit, drop, put, toml

STAGE = next(path for path in EXAMPLES if path.stem == "09_flexure_stage")

SMALL: Content = {
    "materials": {"steel": {"youngs_modulus": "200 GPa", "poissons_ratio": 0.3}},
    "flexures": {
        "hinge": {
            "shape": "circular_notch",
            "material": "steel",
            "thickness": "0.5 mm",
            "radius": "5 mm",
            "width": "10 mm",
            "allowable_stress": "300 MPa",
        }
    },
    "nodes": {"A": [0, 0, 0], "B": [0, 0, 0]},
    "joints": [
        {"name": "joint", "type": "bushing", "between": ["A", "B"], "flexure": "hinge"},
    ],
    "supports": [{"node": "A", "fixed": "all"}],
    "loads": [{"node": "B", "moment": [0, 0, 0.1]}],
}


def content(*edits: Edit) -> str:
    found = copy.deepcopy(SMALL)
    for edit in edits:
        edit(found)
    return toml(found)


def small(*edits: Edit) -> Model:
    return parse_model(content(*edits))


LEAF = {"shape": "leaf", "material": "steel", "thickness": "0.5 mm", "width": "10 mm"}


@pytest.mark.parametrize(
    "table",
    [
        SMALL["flexures"]["hinge"] | {"height": "8 mm"},
        LEAF | {"length": "40 mm", "bending": "beam", "stress_concentration": 1.2},
        LEAF | {"shape": "elliptic_notch", "semi_axis_x": "6 mm", "semi_axis_y": "3 mm"},
        LEAF
        | {"shape": "cross_spring", "length": "40 mm", "angle": "80 deg", "leaves": 3}
        | {"crossing": 0.3, "spacing": "9 mm"},
    ],
    ids=lambda t: t["shape"],
)
def test_a_joint_has_the_stiffness_of_its_flexure(table: dict[str, Any]) -> None:
    model = small(put("flexures.hinge", table))
    flexure = model.flexures["joint"]
    assert flexure.shape == table["shape"]
    joint = model.structure.linkage.joints[0]
    np.testing.assert_array_equal(joint.stiffness_matrix, flexure.stiffness)
    for key, value in table.items():
        if key in {"bending", "stress_concentration", "crossing", "leaves"}:
            assert getattr(flexure, key) == value


def test_the_same_matrix_gives_the_same_answer() -> None:
    model = small()
    rows = model.flexures["joint"].stiffness.tolist()
    other = small(drop("joints.0.flexure"), put("joints.0.matrix", rows))
    found = [solve_model(m).statics.displacements for m in (model, other)]
    np.testing.assert_array_equal(*found)


def test_stress_stroke_and_motion_of_a_case() -> None:
    model = small()
    answer = solve_model(model).to_dict()
    used = answer["cases"]["load"]["flexures"]["joint"]
    flexure = model.flexures["joint"]
    assert used["flexure"] == "hinge"
    assert used["displacement"][5] == pytest.approx(0.1 * flexure.compliance[5, 5])
    assert used["stress"] == pytest.approx(1.0199 * 0.1 * 6 / (10e-3 * 0.5e-3**2), rel=1e-3)
    assert used["share_of_allowable_stress"] == pytest.approx(used["stress"] / 300e6)
    # at the allowable stress the moment is as many times as large
    stroke = answer["flexures"]["joint"]["stroke"]
    assert stroke[5] * used["share_of_allowable_stress"] == pytest.approx(used["displacement"][5])
    assert answer["flexures"]["joint"]["bending"] == "plate"


def test_tension_and_compression_are_told_apart() -> None:
    leaf = LEAF | {"length": "40 mm"}
    pulled = small(put("flexures.hinge", leaf), put("loads.0", {"node": "B", "force": [50, 0, 0]}))
    case = solve_model(pulled).to_dict()["cases"]["load"]["flexures"]["joint"]
    assert case["share_of_buckling_force"] == 0.0
    assert case["share_of_allowable_stress"] is None
    pushed = small(put("flexures.hinge", leaf), put("loads.0", {"node": "B", "force": [-50, 0, 0]}))
    with pytest.warns(ModelWarning, match=r'joint in case "load", 38\.9 %'):
        solve_model(pushed)


def test_stress_beyond_the_allowable_one_is_a_warning() -> None:
    model = small(put("loads.0.moment", [0, 0, 0.2]))
    with pytest.warns(ModelWarning, match=r'joint in case "load", 489 MPa, 1\.63 times'):
        solve_model(model)


def test_a_large_rotation_is_a_warning() -> None:
    thin = LEAF | {"length": "40 mm", "thickness": "0.2 mm"}
    model = small(put("flexures.hinge", thin), put("loads.0.moment", [0, 0, 0.01]))
    # L M/(E I) = 0.3 rad
    with pytest.warns(ModelWarning, match=r"rotate farther .* 17\.2°"):
        solve_model(model)


@pytest.mark.filterwarnings("ignore::strutwork.machines.model.ModelWarning")
def test_sizes_outside_the_range_of_the_formulas_are_a_warning() -> None:
    with pytest.warns(ModelWarning, match=r"flexure hinge: its thickness is 0\.6 times the radius"):
        small(put("flexures.hinge.thickness", "3 mm"))


@pytest.mark.parametrize(
    ("edit", "part", "words"),
    [
        (put("joints.0.flexure", "hinj"), "joint joint", 'unknown flexure "hinj"'),
        (put("joints.0.type", "revolute"), "joint joint", "elastic in all directions"),
        (put("joints.0.stiffness", {"x": 1e6}), "joint joint", "stiffness of its own"),
        (put("joints.0.bearing", "any"), "joint joint", "and a bearing"),
        (put("joints.0.limits", {"x": [-1e-3, 1e-3]}), "joint joint", "does not move"),
        (put("flexures.hinge.material", "stel"), "flexure hinge", 'unknown material "stel"'),
        (put("flexures.hinge.thickness", "12 mm"), "flexure hinge", "no hinge"),
        (put("flexures.hinge.bending", "shell"), "flexures.hinge.bending", "not known"),
        (put("flexures.hinge.length", "1 mm"), "flexures.hinge.length", "not a known key"),
        (drop("flexures.hinge.shape"), "flexures.hinge.shape", "shape of the flexure"),
        (drop("flexures.hinge.radius"), "flexures.hinge.radius", "is missing"),
    ],
)
def test_errors_name_the_part(edit: Edit, part: str, words: str) -> None:
    with pytest.raises(ModelError, match=words) as caught:
        small(edit)
    assert caught.value.part == part


def test_stage_has_the_stiffness_of_its_four_hinges() -> None:
    model = parse_model(STAGE.read_text("utf-8"))
    found = solve_model(model)
    assert found.compliance is not None
    flexure = next(iter(model.flexures.values()))
    turning, axial, sheared = (flexure.compliance[i, i] for i in (5, 0, 1))
    length, apart = 60e-3, 80e-3
    # 9 π √R/(2 E b t^2.5) with E/(1 - ν²), 2.5 % too compliant at t/R = 0.16
    thin = rotational_compliance_thin(71e9 / (1 - 0.33**2), 15e-3, 0.8e-3, 5e-3)
    assert 1 / found.compliance[0, 0] == pytest.approx(4 / thin / length**2, rel=0.03)
    # every hinge bears F L/4, F/2 across and F L/(2 d) along
    expected = length**2 * turning / 4 + sheared + (length / apart) ** 2 * axial
    assert found.compliance[0, 0] == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("flexures.hinge.thickness", 1e-3),
        ("materials.aluminium.youngs_modulus", 60e9),
        ("flexures.hinge.allowable_stress", 1e8),
    ],
)
def test_a_changed_number_gives_the_model_of_a_changed_file(path: str, value: float) -> None:
    machine = Parametric.of(STAGE)
    found = machine.model({path: value})
    data = tomllib.loads(STAGE.read_text("utf-8"))
    table: Any = data
    *steps, last = path.split(".")
    for step in steps:
        table = table[step]
    table[last] = value
    expected = parse_model(toml(data))
    for name, flexure in expected.flexures.items():
        np.testing.assert_array_equal(found.flexures[name].stiffness, flexure.stiffness)
        assert found.flexures[name].allowable_stress == flexure.allowable_stress
    one, other = (solve_model(m).compliance for m in (found, expected))
    np.testing.assert_allclose(one, other, rtol=1e-12, atol=1e-20)


def test_gradients_know_the_sizes_of_flexures() -> None:
    machine = Parametric.of(STAGE)
    names = [
        "flexures.hinge.thickness",
        "flexures.hinge.radius",
        "materials.aluminium.youngs_modulus",
    ]
    parameters = [Dimension.of(machine, name) for name in names]
    found = gradient(machine.model, parameters, ["stiffness_x"])
    # k = 2 E b t^2.5/(9 π √R) where t is much less than R
    np.testing.assert_allclose(found["elasticity"].values[0, :, 0], [2.5, -0.5, 1.0], atol=0.03)


def test_models_without_flexures_say_nothing_of_them() -> None:
    path: Path = next(p for p in EXAMPLES if p.stem == "03_tripod")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        answer = solve_model(parse_model(path.read_text("utf-8"))).to_dict()
    assert "flexures" not in answer
    assert all("flexures" not in case for case in answer["cases"].values())
