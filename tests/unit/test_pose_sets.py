"""Poses of designs that form no grid, and quantities over them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines import Proposed3PPRS
from strutwork.studies import stiffness_map, summary
from strutwork.studies.check_points import hemisphere
from strutwork.studies.design import Design
from strutwork.studies.design_file import read_design
from strutwork.studies.filters import Filters
from strutwork.studies.parametric import Parametric
from strutwork.studies.pose_sets import PoseList, TaskList, hemisphere_poses, settings_of

STUDIES = Path(__file__).parents[2] / "examples/studies"
RPS = Path(__file__).parents[2] / "examples/machines/3-rps.toml"
OUTER = "sections.cylinder.outer_diameter"
LEGS = {"leg_length": ("0.9 m", "1.6 m")}


def test_a_list_of_poses_is_a_grid_of_the_same_poses() -> None:
    asked = ("least_amplification", "largest_amplification", "condition", "mean_stiffness_x")
    axes = {"x": np.array([-0.2, 0.3]), "y": np.array([0.1, 0.25])}
    grid = TaskGrid(axes)
    listed = TaskList(grid.task())
    assert len(listed) == 4
    found = [Design.of("biglide", LEGS, *asked, workspace=w).stated.values for w in (grid, listed)]
    np.testing.assert_allclose(*found, rtol=1e-12)
    assert np.isfinite(found[0]).all()
    assert settings_of(grid) != settings_of(listed)
    assert settings_of(None) == {}


def test_amplifications_of_the_biglide_are_those_of_its_jacobian() -> None:
    place = (0.31, -0.22)
    design = Design.of(
        "biglide",
        LEGS,
        "least_amplification",
        "largest_amplification",
        workspace=TaskList({d: np.array([v]) for d, v in zip("xy", place, strict=True)}),
    )
    x, y = place
    rows = np.array([[1.0, y / np.sqrt(1.0 - y * y)], [x / np.sqrt(1.0 - x * x), 1.0]])
    values = np.linalg.svd(np.linalg.inv(rows), compute_uv=False)
    assert design.stated.values[0] == pytest.approx(values[::-1], rel=1e-10)


def test_the_mean_over_a_hemisphere_is_that_of_its_stiffness_map() -> None:
    machine, ranges = Proposed3PPRS(), ("revolute",)
    poses = hemisphere_poses(Parametric.of(machine), 4e-3, 3, 4, ranges)
    turns = np.arange(4) * np.pi / 6.0
    mapped = stiffness_map(
        machine, hemisphere(machine, 4e-3, 3), turns, Filters(joint_kinds=ranges)
    )
    found = summary(mapped)
    assert len(poses) == found.points_kept
    names = [f"mean_blocked_stiffness_{a}" for a in "xyz"]
    design = Design.of(
        machine, {"section.outer_diameter": ("18 mm", "22 mm")}, *names, workspace=poses
    )
    expected = [found.axis(a).statistics.mean for a in "xyz"]
    assert design.stated.values[0] == pytest.approx(expected, rel=1e-9)
    assert "hemisphere of 4 mm" in repr(poses)
    assert set(settings_of(poses)) == {"poses", "count", "sha256", "joint_ranges"}
    # a range that few poses keep takes poses away: machines are held to all of them
    every = PoseList(poses.name, poses.poses)
    strict = Design.of(
        machine, {"section.outer_diameter": ("18 mm", "22 mm")}, *names, workspace=every
    )
    assert strict.stated.reached[0] < 1.0


def test_the_mass_is_that_at_home() -> None:
    """The first links are as long as their sliders are out, which the pose decides."""
    paths = {"section.outer_diameter": ("18 mm", "22 mm")}
    here = Design.of(Proposed3PPRS(), paths, "mass", workspace={})
    there = Design.of(Proposed3PPRS(), paths, "mass", workspace={"x": [0.01, 0.02]})
    assert here.stated.values == pytest.approx(there.stated.values, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("poses = [{x = 0.1}, {y = 0.1}]", "do not all name the same directions"),
        ("poses = []", "poses: are none"),
        ("poses = [{x = 0.1}]\nworkspace = {}", "named by workspace and by poses"),
        ("poses = [{q = 0.1}]", "q"),
        ("hemisphere = {radius = 0}", "radius"),
        ("hemisphere = {}", "needs a machine with formulas of its own"),
    ],
)
def test_wrong_poses_are_explained(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "design.toml"
    path.write_text(
        f'machine = "{RPS}"\n{text}\n[[parameters]]\npath = "{OUTER}"\n'
        'range = ["55 mm", "90 mm"]\n[[objectives]]\nquantity = "mass"\n',
        encoding="utf-8",
    )
    with pytest.raises(ModelError) as caught:
        read_design(path)
    assert message in str(caught.value)


def test_lists_of_poses_are_checked() -> None:
    with pytest.raises(ModelError, match="unknown direction"):
        TaskList({"q": np.zeros(1)})
    with pytest.raises(ModelError, match="no finite value of y"):
        TaskList({"x": np.zeros(2), "y": np.zeros(1)})
    file = Parametric.of(RPS)
    poses = hemisphere_poses(Parametric.of(Proposed3PPRS()), 4e-3, 1, 1, ("revolute",))
    with pytest.raises(ModelError, match="a model file does not have"):
        Design.of(file, {OUTER: ("55 mm", "90 mm")}, "stiffness_z", workspace=poses)


@pytest.mark.parametrize("name", ["biglide-design", "delta-design"])
def test_design_files_of_published_machines_are_read(name: str) -> None:
    design = read_design(STUDIES / f"{name}.toml")
    assert design.workspace is not None
    assert len(design.workspace) == 9
    assert [c.quantity.name for c in design.constraints] == [
        "least_amplification",
        "largest_amplification",
    ]
