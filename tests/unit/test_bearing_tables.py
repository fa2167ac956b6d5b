"""Tables of bearings in model files and catalogues: what is read, and what is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from strutwork.errors import ModelError, UnitError
from strutwork.machines.bearing_catalogue import borne_stiffness, package_catalogue, read_catalogue
from strutwork.machines.model_file import parse_model
from strutwork.machines.model_schema import JointTable
from tests.bearings import BALLS, ROLLERS, SHAFT, shaft


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            'source = "made up"\nballs',
            'source = " "\nballs',
            r"bearings\.front\.source: is missing",
        ),
        ('source = "made up"\nballs', "balls", r"source = \"data sheet"),
        (
            'type = "angular_contact"',
            'type = "angular"',
            r"bearings\.front\.type: .angular. is not known",
        ),
        ('type = "angular_contact"\n', "", r"bearings\.front\.type: is missing"),
        (
            'ball_diameter = "6.35 mm"',
            'ball_diameter = "6.35 N"',
            r"bearings\.front\.ball_diameter",
        ),
        ("inner_groove = 0.52", "inner_groove = 0.4", r"inner_groove: 0\.4 is out of range"),
        ('bearing = "rear"', 'bearing = "reer"', r"names the unknown bearing .reer"),
        ('type = "cylindrical"', 'type = "planar"', "fits joints of the type fixed or revolute"),
        ('type = "revolute"', 'type = "spherical"', "free in rx, ry"),
        ('driven = ["rz"]', 'driven = ["z"]', "drives z, where its bearing front resists"),
        ('driven = ["rz"]', "stiffness = { x = 1e8 }", "has a stiffness in x beside"),
        (
            'clearance = "-6 um"',
            'clearance = "6 um"',
            "no contact without load.*\n.*negative clearance",
        ),
        ('arrangement = "back_to_back"', 'arrangement = "single"', "bearing front: is single"),
        ('preload = "150 N"', "", "bearing front: has no contact without load"),
        ('spacing = "12 mm"', "space = 1", r"bearings\.front\.space: is not a known key"),
    ],
)
def test_wrong_entries(old: str, new: str, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        shaft((old, new))


def test_a_joint_has_a_bearing_or_a_flexure() -> None:
    keys = {"name": "hinge", "type": "bushing", "between": ("a", "b"), "flexure": "leaf"}
    with pytest.raises(ModelError, match="joint hinge: has a bearing and a flexure"):
        borne_stiffness(JointTable.model_validate(keys), package_catalogue()["rail-25"])


def test_a_unit_of_another_dimension_is_a_unit_error() -> None:
    with pytest.raises(UnitError, match=r"bearings\.front\.preload"):
        shaft(('preload = "150 N"', 'preload = "150 mm"'))


def test_a_catalogue_beside_the_model(tmp_path: Path) -> None:
    (tmp_path / "own.toml").write_text(BALLS + ROLLERS)
    model = parse_model('catalogue = "own.toml"\n' + SHAFT, folder=tmp_path)
    assert model.bearings["balls"].origin == "own.toml"
    # the model's own entry goes first
    other = BALLS.replace('"150 N"', '"300 N"')
    model = parse_model('catalogue = "own.toml"\n' + SHAFT + other, folder=tmp_path)
    assert model.bearings["balls"].origin == "the model file"
    assert model.bearings["balls"].preload == "300 N"
    with pytest.raises(ModelError, match="leads out of the folder"):
        parse_model('catalogue = "../own.toml"\n' + SHAFT, folder=tmp_path)
    (tmp_path / "own.toml").write_text(BALLS.replace('source = "made up"\n', ""))
    with pytest.raises(ModelError, match=r"bearings\.front\.source: is missing"):
        read_catalogue(tmp_path / "own.toml")


def test_every_entry_of_the_package_has_a_source_and_a_stiffness() -> None:
    for name, entry in package_catalogue().items():
        assert len(entry.source) > 20, name
        assert all(entry.stiffness[i, i] > 0 for i, d in enumerate("xyz") if d in entry.held)
