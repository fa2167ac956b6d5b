"""Travel of joints over poses: by hand, as an answer of studies, as a quantity of designs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from scipy.spatial.transform import Rotation

import strutwork as sw
from strutwork.errors import ModelError
from strutwork.kinematics import Placement
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model_file import read_model
from strutwork.studies.design import Design
from strutwork.studies.design_dataset import Archive
from strutwork.studies.design_judged import FEASIBLE, OUTSIDE
from strutwork.studies.design_quantities import range_reached
from strutwork.studies.design_store import read_design_result, run_design
from strutwork.studies.design_terms import Constraint, Objective
from strutwork.studies.joint_selection import JointCoordinate, coordinates_of
from strutwork.studies.study import Study

HEXAPOD = Path(__file__).parents[2] / "examples/machines/6-ups.toml"
MASS = "bodies.platform.mass"
LINE = {"x": [-0.1, 0.0, 0.1]}

#: A carriage on a rail along x, from home 0.3 m, with a wrist that turns about z.
CARRIAGE = """
[materials.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = "7850 kg/m^3"
[sections.bar]
shape = "rod"
diameter = "30 mm"
[nodes]
floor = [0, 0, 0]
root = [0, 0, 0]
rail = [0, 0, 0]
slide = [0, 0, 0]
wrist = [0, 0, 0]
hand = [0, 0, 0]
tip = [0, 0, "100 mm"]
[[bodies]]
name = "base"
nodes = ["root", "rail"]
[[bodies]]
name = "carriage"
nodes = ["slide", "wrist"]
mass = "5 kg"
[[bodies]]
name = "tool"
nodes = ["hand", "tip"]
[[joints]]
name = "bolted"
type = "fixed"
between = ["floor", "root"]
[[joints]]
name = "guide"
type = "prismatic"
between = ["rail", "slide"]
axis = [1, 0, 0]
driven = ["z"]
[[joints]]
name = "turn"
type = "revolute"
between = ["wrist", "hand"]
axis = [0, 0, 1]
driven = ["rz"]
[[supports]]
node = "floor"
fixed = "all"
[tool]
tcp = "tip"
"""


def biglide(*selected: str, **options: Any) -> xr.Dataset:
    workspace = {"x": [-0.3, 0.1, 0.3], "y": [0.0, 0.4]}
    given = {"workspace": workspace, **options}
    return sw.load("biglide").study({"leg_length": [1.0, 1.2]}, *selected, **given)


def test_strokes_by_hand() -> None:
    """ρ₁ = x − √(L² − y²): ends of the stroke to rounding."""
    found = biglide("travel:carriage1/guide", "mass")
    assert found["joint"].to_numpy().tolist() == ["carriage1/guide:z"]
    length = np.array([1.0, 1.2])
    low, high = -0.3 - length, 0.3 - np.sqrt(length**2 - 0.16)
    for name, wanted in (("least", low), ("greatest", high), ("travel", high - low)):
        values = found[f"joint_coordinate_{name}"]
        np.testing.assert_allclose(values.to_numpy()[:, 0], wanted, rtol=1e-12)
        assert values.attrs["component_units"] == "m or rad"
        assert values[f"joint_coordinate_{name}_unit"].to_numpy().tolist() == ["m"]
    # questions are one where several ask for travel
    both = biglide("travel:carriage*", "travel:rod1a/foot:rz", reductions=["home", "poses"])
    assert both["joint"].to_numpy().tolist() == [
        *("carriage1/guide:z", "rod1a/foot:rz", "carriage2/guide:z")
    ]
    assert both["joint_coordinate"].dims == ("leg_length", "pose", "joint")
    home = both["joint_coordinate_home"].to_numpy()
    np.testing.assert_allclose(home[:, 1], 0.0, atol=1e-15)
    np.testing.assert_allclose(home[:, 0], -length)


def test_bend_of_universal_joints() -> None:
    """Between the normals of the pins: a turn about z, then one about the x that it brought."""
    angles = np.random.default_rng(5).uniform(-1.2, 1.2, (20, 2))
    placement = Placement(
        np.zeros((20, 0, 3)), np.zeros((20, 0, 3, 3)), angles, (("cross", "rz"), ("cross", "rx"))
    )
    turned = Rotation.from_euler("ZX", angles).as_matrix()
    found = JointCoordinate("cross", "bend").values(placement)
    np.testing.assert_allclose(np.cos(found), turned[:, 1, 1], atol=1e-14)


def test_joints_by_their_names() -> None:
    model = read_model(HEXAPOD)
    every = [c.label for c in coordinates_of(model)]
    assert every[:4] == ["cardan1:rx", "cardan1:rz", "cardan1:bend", "drive1:z"]
    some = coordinates_of(model, ["drive*", "ball1:r*"])
    assert [c.label for c in some][:5] == [
        "drive1:z",
        "ball1:rx",
        "ball1:ry",
        "ball1:rz",
        "drive2:z",
    ]
    # what formulas give beside directions
    swing = [c.label for c in coordinates_of(sw.load("proposed-3pprs"), ["*:swing"])]
    assert len(swing) == 3


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("travel:dirve1", 'joint dirve1: does not exist.\nDid you mean "drive1"'),
        ("travel:drive1:x", 'joint drive1: has no coordinate "x".\nDid you mean "drive1:z"'),
        ("travel:ball1:bend", 'joint ball1: has no coordinate "bend"'),
        ("travel:", "Name a joint"),
        ("travle", 'Did you mean "travel"'),
    ],
)
def test_joints_that_do_not_exist(text: str, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        Study.of(HEXAPOD, {MASS: [50.0]}, text, workspace=LINE)


def test_joints_that_do_not_move(tmp_path: Path) -> None:
    file = tmp_path / "carriage.toml"
    file.write_text(CARRIAGE, encoding="utf-8")
    machine = sw.load(file)
    found = machine.study(
        {"bodies.carriage.mass": [5.0]},
        "travel",
        workspace={"x": ["-50 mm", "200 mm"], "rz": ["-90 deg", "30 deg"]},
    )
    assert found["joint"].to_numpy().tolist() == ["guide:z", "turn:rz"]
    travel = found["joint_coordinate_travel"].to_numpy()[0]
    np.testing.assert_allclose(travel, [0.25, np.radians(120.0)], rtol=1e-9)
    with pytest.raises(ModelError, match="joint bolted: is fixed and has no free direction"):
        machine.study({"bodies.carriage.mass": [5.0]}, "travel:bolted", workspace={"x": [0.1]})
    frame = Path(__file__).parents[2] / "examples/01_cantilever.toml"
    with pytest.raises(ModelError, match="joints: have no free direction"):
        Study.of(frame, {"materials.steel.density": [7e3]}, "travel", workspace={})


def strokes(**options: Any) -> Design:
    return Design.of(
        "biglide",
        {"leg_length": ("0.7 m", "1.4 m")},
        Objective.of("travel:carriage*:z"),
        "mass",
        constraints=[Constraint.of("greatest:rod1a/foot:rz", at_most="30 deg")],
        **({"workspace": {"x": [-0.3, 0.3], "y": [-0.3, 0.4]}} | options),
    )


def test_a_design_by_strokes(tmp_path: Path) -> None:
    """The larger stroke counts, and legs whose rods turn too far are not feasible."""
    design = strokes(population=4, generations=2)
    length = np.array([0.78, 0.82, 1.2])
    judged = design.judge(length[:, None], workers=1)
    assert judged.status.tolist() == [OUTSIDE, FEASIBLE, FEASIBLE]
    # ρ₁ sees y of -0.3 and 0.4 m, ρ₂ x of the same size at either end
    first = 0.6 + np.sqrt(length**2 - 0.09) - np.sqrt(length**2 - 0.16)
    wanted = np.maximum(first, 0.7)
    np.testing.assert_allclose(judged.values[:, 0], wanted, rtol=1e-12)
    np.testing.assert_allclose(np.sin(judged.values[:, 2]), 0.4 / length, rtol=1e-12)
    pytest.importorskip("pymoo")
    found = run_design(design, tmp_path / "front.nc", workers=1)
    kept, _ = read_design_result(tmp_path / "front.nc"), Archive(design)
    assert kept["travel:carriage*:z"].attrs["units"] == "m"
    assert kept["greatest:rod1a_foot:rz"].attrs["units"] == "rad"
    assert kept.sizes["machine"] == found.sizes["machine"]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: strokes(workspace={}), "asked for at home alone"),
        (lambda: Objective.of("travel:guide"), "which is no direction of a joint"),
        (lambda: Objective.of("travle:guide:z"), 'Did you mean "travel:guide:z"'),
        (lambda: Constraint.of("least:guide:z", at_least="3 deg"), "not a length"),
        (
            lambda: Design.of("biglide", {"leg_length": (0.9, 1.0)}, "travel:carrige1/guide:z"),
            'Did you mean "carriage1/guide"',
        ),
        (
            lambda: Design.of("biglide", {"leg_length": (0.9, 1.0)}, "reach_z"),
            "needs a grid of poses with several values of z",
        ),
        (
            lambda: strokes(method="both"),
            "what a parameter does to the coordinates of joints is not differentiated",
        ),
        (
            lambda: sw.load("biglide").function(["leg_length"], ["travel:carriage1/guide:z"]),
            "The travel of joints is an answer of `study`",
        ),
    ],
)
def test_wrong_quantities_are_explained(make: Any, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        make()


def test_range_that_is_reached_everywhere() -> None:
    """Neighbouring values about home, with every value of the other direction."""
    grid = TaskGrid({"x": np.array([0.0, 1.0]), "ry": np.array([0.3, -0.2, 0.0, -0.1, 0.1])})
    good = np.ones((4, 2, 5), dtype=bool)
    good[1, 0, 4] = False  # 0.1 misses one place: 0.3 beyond it does not count
    good[2, 1, 2] = False  # home itself
    good[3, :, 1] = False  # the lowest
    found = {"pose_status": np.where(good, 0, 1).reshape(4, 10)}
    np.testing.assert_allclose(range_reached(found, grid, "ry", 0.0), [0.5, 0.2, 0.0, 0.4])
