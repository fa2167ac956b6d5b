"""A calibration of the geometry: it takes away what it can see, and names what it cannot."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model
from strutwork.machines.model_poses import moved, walked
from strutwork.overconstraint.accuracy import accuracy
from strutwork.overconstraint.sampling import draw
from strutwork.studies.error_answer import ErrorSheets
from strutwork.studies.error_causes import error_sheet
from strutwork.studies.error_file import parse_errors
from strutwork.studies.error_inputs import ErrorInputs
from strutwork.studies.error_sheet import ErrorSheet

AFTER = "geometry after calibration"

CROSS_SLIDE = """
title = "Cross slide"

[nodes]
foot = [0, 0, 0]
carriage = [0, 0, 0]
guide = ["0 mm", "0 mm", "100 mm"]
saddle = ["0 mm", "0 mm", "100 mm"]
tip = ["50 mm", "0 mm", "300 mm"]

[[supports]]
node = "foot"
fixed = "all"

[[bodies]]
name = "cross"
nodes = ["carriage", "guide"]

[[bodies]]
name = "ram"
nodes = ["saddle", "tip"]

[[joints]]
name = "x"
type = "prismatic"
between = ["foot", "carriage"]
axis = [1, 0, 0]
second_axis = [0, 0, 1]
driven = ["z"]
limits = { z = ["-200 mm", "200 mm"] }

[[joints]]
name = "y"
type = "prismatic"
between = ["guide", "saddle"]
axis = [0, 1, 0]
second_axis = [0, 0, 1]
driven = ["z"]
limits = { z = ["-200 mm", "200 mm"] }

[tool]
tcp = "tip"

[task]
directions = ["x", "y"]

[workspace]
x = { from = "-100 mm", to = "100 mm", points = 3 }
y = { from = "-100 mm", to = "100 mm", points = 5 }

[[tolerances]]
name = "zero of x"
kind = "length"
joint = "x"
axis = [1, 0, 0]
size = "20 um"

[[tolerances]]
name = "place of y"
kind = "length"
joint = "y"
axis = [1, 0, 0]
size = "10 um"

[[tolerances]]
name = "squareness"
kind = "perpendicularity"
joint = "y"
slope = 1e-4
datum = "carriage"
"""


@cache
def cross_slide() -> Model:
    return parse_model(CROSS_SLIDE, "cross.toml")


def plan(text: str, model: Model | None = None) -> ErrorInputs:
    return parse_errors(f"[calibration]\n{text}", "errors.toml", model or cross_slide())


def after(sheet: ErrorSheet) -> ErrorSheet:
    return sheet.of(AFTER)


def test_what_is_seen_vanishes_and_what_is_not_is_named() -> None:
    sheet = error_sheet(cross_slide(), plan('poses = 4\nuncertainty = "1e-6 um"'))
    found = sheet.calibrated
    assert found is not None
    assert (found.found.rank, found.poses) == (3, 4)
    # only the sum of the two offsets along x shows: their difference stays, and does no harm
    (left,) = found.undetermined
    assert set(left) == {"zero of x", "place of y"}
    zero, place = left["zero of x"] * 20e-6, left["place of y"] * 10e-6
    assert zero == pytest.approx(-place, rel=1e-6)
    assert set(found.found.determined) == {"squareness 1", "squareness 2"}
    assert after(sheet).worst.max() < 1e-10
    before = ErrorSheet(sheet.uncalibrated).worst
    np.testing.assert_allclose(before[0], 30e-6, rtol=1e-9)
    assert set(sheet.causes) == {AFTER}
    told = sheet.to_dict()["calibration"]
    assert told["determined_combinations"] == 3
    assert told["geometry_before"]["worst_case"][0] == pytest.approx(30e-6)


def test_the_best_poses_are_at_the_ends_of_the_lever() -> None:
    sheet = error_sheet(cross_slide(), plan('poses = 4\nuncertainty = "1 um"'))
    assert sheet.calibrated is not None
    np.testing.assert_allclose(np.abs(sheet.calibrated.task["y"]), 0.1)


def test_a_synthetic_measurement_recovers_what_the_rows_promise() -> None:
    """Draw misfits and noise, estimate by ordinary least squares, compensate, compare spreads."""
    model = cross_slide()
    inputs = plan(
        'at = [{ y = "-100 mm" }, { x = "50 mm" }, { y = "100 mm" }]\nuncertainty = "4 um"'
    )
    tolerances = inputs.all_tolerances(model)
    sheet = error_sheet(model, inputs)
    placement = walked(
        model, {"x": np.array([0.05, 0.1, 0.05]), "y": np.array([-0.1, 0.0, 0.1])}
    ).placement
    assert sheet.calibrated is not None
    np.testing.assert_allclose(sheet.calibrated.task["y"], [-0.1, 0.0, 0.1])
    poses = accuracy(model.structure.at(placement), tolerances)
    jacobian = poses.gain[:, :3].reshape(-1, 4)
    home = accuracy(model.placed, tolerances).gain
    rng = np.random.default_rng(1)
    z = draw(poses.sources, rng.random((4000, 4)))
    y = z @ jacobian.T + 4e-6 * rng.standard_normal((4000, 9))
    # three numbers that the tool shows: the offset along x and two tilts
    offset = jacobian[:, 0] / np.linalg.norm(jacobian[:, 0])
    basis = np.column_stack([offset, jacobian[:, 2:]])
    fitted = np.linalg.lstsq(basis, y.T, rcond=None)[0]
    shown = np.linalg.lstsq(basis, jacobian, rcond=None)[0]
    left = home @ (z.T - np.linalg.pinv(shown) @ fitted)
    np.testing.assert_allclose(left[:3].std(axis=1), after(sheet).deviation[:3], rtol=0.05)


def test_what_is_not_calibrated_stays_and_spoils_the_estimate() -> None:
    inputs = plan('parameters = ["squareness"]\nat = [{ y = "-100 mm" }]\nuncertainty = "1e-3 um"')
    sheet = error_sheet(cross_slide(), inputs)
    found = sheet.calibrated
    assert found is not None
    assert found.found.names == ("squareness 1", "squareness 2")
    rows = {row.part: row for row in after(sheet).rows}
    # a tilt that is seen through an offset of 30 µm at one pose is wrong by all of it
    before = ErrorSheet(sheet.uncalibrated)
    assert rows["zero of x"].worst[0] == pytest.approx(20e-6, rel=1e-3)
    assert after(sheet).worst[5] > 2 * before.worst[5]


def test_by_kinds_and_over_poses() -> None:
    model = cross_slide()
    inputs = plan('parameters = ["length"]\nposes = 2\nuncertainty = "1 um"')
    sheets = ErrorSheets(model, inputs)
    placed = model.structure.at(walked(model, {"x": np.array([0.05, -0.03])}).placement)
    values, outcome = sheets(placed)
    assert outcome.solved.all()
    one = error_sheet(model, inputs, placed[1])
    np.testing.assert_allclose(values["worst_case"][1], one.worst, rtol=1e-12)
    # squareness is left, and the measuring uncertainty of two poses
    assert {row.part for row in one.rows} >= {"squareness", "uncertainty of the measurement"}
    noise = next(row for row in one.rows if row.part == "uncertainty of the measurement")
    assert noise.deviation[0] == pytest.approx(1e-6 / np.sqrt(2), rel=0.05)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('uncertainty = "1 um"', "calibration.*no pose"),
        ("poses = 3", "does not state uncertainty"),
        ('poses = 3\ndirections = ["x", "rz"]\nuncertainty = "1 um"', "angular_uncertainty"),
        ('poses = 3\nuncertainty = "1 um"\nparameters = ["squarenes"]', "unknown tolerance"),
        ('poses = 99\nuncertainty = "1 um"', "too few to choose 99"),
        ('at = [{ x = "900 mm" }]\nuncertainty = "1 um"', "measures at x = 0.9"),
    ],
)
def test_wrong_plans_are_refused_by_name(text: str, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        plan(text).computed(cross_slide())


@pytest.mark.slow
def test_a_machine_with_formulas_turns_its_misfits_with_its_bodies() -> None:
    model = load("eclipse-3pprs")
    text = '[[tolerances]]\nname = "ball"\nkind = "point_position"\njoint = "leg1/ball"\n'
    text += 'size = "20 um"\n[calibration]\nuncertainty = "5 um"\nposes = 2\n'
    inputs = parse_errors(text, "errors.toml", model).computed(model)
    task = {"x": np.array([0.02]), "y": np.array([-0.01])}
    by_formula = model.structure.at(moved(model, task)[1])[0]
    by_joints = model.structure.at(walked(model, task).placement)[0]
    assert by_formula.placement.turns is None
    assert by_joints.placement.turns is not None
    found = [error_sheet(model, inputs, placed) for placed in (by_formula, by_joints)]
    np.testing.assert_allclose(after(found[0]).worst, after(found[1]).worst, rtol=1e-6)
