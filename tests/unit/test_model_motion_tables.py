"""Home, task, workspace, drives and limits of a model file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.machines.drives import Drive
from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model

TEXT = (Path(__file__).parents[2] / "examples/machines/3-rps.toml").read_text()


def parsed(old: str = "", new: str = "") -> Model:
    assert old in TEXT
    return parse_model(TEXT.replace(old, new, 1) if old else TEXT)


def test_they_are_read() -> None:
    model = parsed()
    assert model.task == ("z", "rx", "ry")
    assert model.placement.names == (("drive1", "z"), ("drive2", "z"), ("drive3", "z"))
    np.testing.assert_allclose(model.placement.values, np.hypot(0.6, 0.1), rtol=1e-9)
    assert model.workspace is not None
    assert model.workspace.shape == (3, 7, 7)
    np.testing.assert_allclose(model.workspace.axes["z"], [0.64, 0.68, 0.72])
    assert model.drives[0] == Drive("drive1", "z", 20 / 60, 5000.0, 5e-7)
    assert model.limits[0].low == pytest.approx(0.52)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("[home.drive1]", "[home.drive9]", 'home: names the unknown joint "drive9"'),
        (
            '[home.drive1]\nz = "608',
            '[home.drive1]\nz = "408',
            "joint drive1: has limits that exclude home",
        ),
        ('["520 mm", "720 mm"]', '["720 mm", "520 mm"]', "limits of z are 0.72 and 0.52"),
        (
            'limits = { z = ["520 mm", "720 mm"] }',
            'limits = { x = ["520 mm", "720 mm"] }',
            "joint drive1: has limits in x, in which it does not move",
        ),
        ('directions = ["z", "rx", "ry"]', 'directions = ["z", "z"]', "task: names no direction"),
        (
            'directions = ["z", "rx", "ry"]',
            'directions = ["z", "rx", "ry", "rz"]',
            "task: the tool cannot move in rz from home",
        ),
        ('z = { from = "640 mm"', 'y = { from = "640 mm"', "workspace: goes along y"),
        (
            'from = "640 mm", to = "720 mm"',
            'from = "740 mm", to = "720 mm"',
            "workspace.z: has no extent",
        ),
        ('force = "5 kN"', 'torque = "5 kN*m"', "gives torque to a drive that slides"),
        ('resolution = "0.5 um"', 'angular_resolution = "1 deg"', "resolution of the other kind"),
        ('joints = ["drive1", "drive2", "drive3"]', 'joints = ["ball1"]', "ball1:z, which is not"),
        ('joints = ["drive1", "drive2", "drive3"]', 'joints = ["none"]', 'unknown joint "none"'),
        (
            'joints = ["drive1", "drive2", "drive3"]',
            'joints = ["drive1", "drive1"]',
            "gives drive1:z twice",
        ),
        ('[tool]\ntcp = "TCP"', "", "task: is given without a tool"),
    ],
)
def test_what_is_wrong_is_named(old: str, new: str, words: str) -> None:
    with pytest.raises(ModelError) as caught:
        parsed(old, new)
    assert words in str(caught.value)
