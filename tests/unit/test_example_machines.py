"""Machines that are model files alone: they move, and answer over their workspace.

Closed forms: the linear Delta's by Pythagoras in each leg (Chablat and others), the hexapod's by
the distance between the two ends of each leg.
"""

from __future__ import annotations

import copy
import tomllib
from pathlib import Path

import numpy as np
import pytest

import strutwork
from strutwork.errors import ModelError
from strutwork.kinematics import Poses
from strutwork.kinematics.turns import rotation_matrix
from strutwork.machines.model_builder import build_model
from strutwork.machines.model_file import checked_tables
from strutwork.machines.model_poses import at_pose, moved
from strutwork.machines.model_templates import template, template_names
from strutwork.msa import tool_compliance
from strutwork.reports.model_check import check_model
from strutwork.studies.answers import Stiffness
from strutwork.studies.survey import survey

FOLDER = Path(__file__).parents[2] / "examples" / "machines"
FILES = sorted(FOLDER.glob("*.toml"))

#: Freedoms with the drives free, redundant constraints with them held.
FREEDOMS = {
    "3-rps": (3, 0),
    "6-ups": (6, 0),
    "gantry": (3, 6),
    "linear-delta": (3, 0),
    "planar-3-rrr": (3, 6),
    "tricept": (3, 0),
}

#: Of the linear Delta's file, m.
ROD, REACH, SEATS, HALF = 0.8, 0.48, 0.12, 0.075


def load(name: str):
    return strutwork.load(FOLDER / f"{name}.toml")


def test_every_file_is_known() -> None:
    assert {p.stem for p in FILES} == set(FREEDOMS) == set(template_names())


@pytest.mark.parametrize("name", FREEDOMS)
def test_it_has_the_freedoms_of_its_task(name: str) -> None:
    model = load(name)
    found = check_model(model).mobility
    assert (found.mobility, found.redundant) == FREEDOMS[name]
    assert found.mobility_locked == 0
    assert len(model.task) == found.mobility
    assert {(d.joint, d.direction) for d in model.drives} == set(model.structure.linkage.driven)


@pytest.mark.parametrize("name", FREEDOMS)
def test_nearly_all_of_its_workspace_is_reached_and_stiff(name: str) -> None:
    model = load(name)
    found = survey(model, model.workspace, [Stiffness()], workers=1)
    kept, poses = found.attrs["poses_kept"], found.attrs["poses"]
    assert kept > 0.9 * poses
    good = found["status"].to_numpy() == 0
    values = found["stiffness_free"].to_numpy()[good]
    assert np.all(values > 0)
    assert np.isnan(found["stiffness_free"].to_numpy()[~good]).all()


def delta_task() -> dict[str, np.ndarray]:
    grids = np.meshgrid([-0.12, 0.0, 0.1], [-0.1, 0.05, 0.12], [-0.06, 0.0, 0.07], indexing="ij")
    return dict(zip("xyz", (g.ravel() for g in grids), strict=True))


def test_the_linear_delta_moves_as_its_closed_form_says() -> None:
    """1e-9 m: the issue's demand; the solver closes joints to 1e-11 of the machine's size."""
    model, task = load("linear-delta"), delta_task()
    found, placement = moved(model, task)
    assert placement.reachable.all()
    for i, degrees in enumerate((210, 90, -30), 1):
        out = np.radians(degrees)
        across = np.stack(
            [task["x"] - REACH * np.cos(out), task["y"] - REACH * np.sin(out)], axis=-1
        )
        height = task["z"] + np.sqrt(ROD**2 - (across**2).sum(axis=-1))
        home = np.sqrt(ROD**2 - REACH**2)
        np.testing.assert_allclose(found.coordinate(f"slide{i}", "z"), height - home, atol=1e-9)


def hexapod_ends() -> tuple[np.ndarray, np.ndarray]:
    model = load("6-ups")
    index = model.structure.linkage.node_index
    at = model.placement.positions
    first = np.array([at[index[f"base{i}"]] for i in range(1, 7)])
    return first, np.array([at[index[f"seat{i}"]] for i in range(1, 7)])


def test_the_hexapod_moves_as_its_closed_form_says() -> None:
    model = load("6-ups")
    rng = np.random.default_rng(3)
    place = np.array([0.0, 0.0, 0.9]) + rng.uniform(-0.06, 0.06, (40, 3))
    turn = rng.uniform(-0.15, 0.15, (40, 3))
    rotation = rotation_matrix(turn)
    found = model.motion.move(tool=Poses(place, rotation))
    assert found.reached.all()
    base, seat = hexapod_ends()
    arms = seat - np.array([0.0, 0.0, 0.9])
    ends = place[:, None] + np.einsum("pij,kj->pki", rotation, arms)
    lengths = np.linalg.norm(ends - base, axis=-1)
    for i in range(6):
        np.testing.assert_allclose(found.coordinate(f"drive{i + 1}", "z"), lengths[:, i], atol=1e-9)


def delta_at(place: np.ndarray) -> dict:
    """The Delta's file written anew at a place, by hand."""
    data = copy.deepcopy(tomllib.loads((FOLDER / "linear-delta.toml").read_text()))
    data["nodes"]["TCP"] = place.tolist()
    axes = {}
    for i, degrees in enumerate((210, 90, -30), 1):
        out = np.radians(degrees)
        u, t = np.array([np.cos(out), np.sin(out), 0]), np.array([-np.sin(out), np.cos(out), 0])
        seat = place + SEATS * u
        across = seat - (SEATS + REACH) * u
        height = place[2] + np.sqrt(ROD**2 - across[0] ** 2 - across[1] ** 2)
        top = (SEATS + REACH) * u + [0, 0, height]
        data["nodes"][f"rail{i}"] = data["nodes"][f"carriage{i}"] = top.tolist()
        for s, w in (("a", HALF), ("b", -HALF)):
            for n in ("top", "upper"):
                data["nodes"][f"{n}{i}{s}"] = (top + w * t).tolist()
            for n in ("seat", "lower"):
                data["nodes"][f"{n}{i}{s}"] = (seat + w * t).tolist()
            normal = np.cross(t, seat - top)
            axes[f"upper{i}{s}"] = (normal / np.linalg.norm(normal)).tolist()
    for joint in data["joints"]:
        if joint["name"] in axes:
            joint["second_axis"] = axes[joint["name"]]
        joint.pop("limits", None)
    return data


def test_its_stiffness_is_that_of_files_written_at_every_pose() -> None:
    """1e-8: the rounding of coordinates closed to 1e-11 m, in a structure of condition 1e3."""
    model, task = load("linear-delta"), delta_task()
    _, placement = moved(model, task)
    every = tool_compliance(model.structure.at(placement))
    for k, place in enumerate(np.stack([task[d] for d in "xyz"], axis=-1)):
        anew = build_model(checked_tables(delta_at(place)), FOLDER)
        one = tool_compliance(anew.placed)
        np.testing.assert_allclose(every[k], one, rtol=0, atol=1e-8 * np.abs(one).max())


def test_the_hexapods_stiffness_is_that_of_poses_taken_one_by_one() -> None:
    """The batch through the compiled kernel; each pose through the saddle-point system."""
    model = load("6-ups")
    task = {"x": np.linspace(-0.1, 0.1, 6), "rz": np.linspace(-0.2, 0.2, 6)}
    _, placement = moved(model, task)
    every = tool_compliance(model.structure.at(placement), method="compiled")
    for k in range(6):
        there = at_pose(model, {d: float(v[k]) for d, v in task.items()})
        one = tool_compliance(there.placed, method="saddle_point")
        np.testing.assert_allclose(every[k], one, rtol=0, atol=1e-8 * np.abs(one).max())


def test_a_pose_out_of_a_limit_offers_the_nearest_on_the_way() -> None:
    with pytest.raises(strutwork.UnreachableError, match=r"slide1.*exceeded") as caught:
        at_pose(load("linear-delta"), {"z": 0.4})
    assert "reaches z = 250 mm" in str(caught.value)


def test_a_template_takes_any_title() -> None:
    text = template("6-UPS", 'a "b" \\ c')
    assert tomllib.loads(text)["title"] == 'a "b" \\ c'
    with pytest.raises(ModelError, match="Choose one of: 3-rps"):
        template("7-UPS")
