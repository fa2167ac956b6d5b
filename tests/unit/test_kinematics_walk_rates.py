"""Rates of a walk are those of what is open, so that its corrections square."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.given import given
from strutwork.kinematics.joint_motion import BodyPoses
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.quick_step import QuickStep
from strutwork.kinematics.turns import rotation_matrix
from strutwork.kinematics.walk import Walk
from strutwork.machines.load import load
from strutwork.machines.model import Model

Array = NDArray[Any]

THIRD_LEG = "biglide:third-leg"

# machines with universal joints, with spheres and with pins, and where their tool goes
CASES = [
    (THIRD_LEG, {"x": 0.1, "y": 0.3, "ry": 0.2}),
    ("examples/machines/linear-delta.toml", {"x": 0.05, "y": -0.1, "z": 0.04}),
    ("examples/machines/tricept.toml", {"x": 0.08, "y": -0.06, "z": 0.05}),
    ("examples/machines/6-ups.toml", {"x": 0.1, "rx": 0.2, "rz": -0.3}),
    ("examples/machines/planar-3-rrr.toml", {"x": 0.05, "y": 0.02}),
    ("examples/machines/gantry.toml", {"x": 0.1, "y": 0.1, "z": 0.05}),
]


@cache
def model_of(name: str) -> Model:
    return load(name)


def task_of(motion: Motion, shift: dict[str, float]) -> dict[str, Array]:
    home = dict(zip(DIRECTIONS, motion.task_of(motion.home_pose), strict=True))
    named = {d: home[d] + by for d, by in shift.items()} | motion.rest(tuple(shift))
    return {d: np.array([float(v)]) for d, v in named.items()}


@pytest.mark.parametrize(("name", "shift"), CASES)
def test_rates_are_those_of_what_is_open(name: str, shift: dict[str, float]) -> None:
    motion = model_of(name).motion
    task = task_of(motion, shift)
    moved = motion.move(task=task)
    assert moved.reached.all()
    wanted = given(motion.joints, motion.home_pose, motion.home_values, None, dict(task), None)
    walk = Walk(motion.joints, motion.rotation, wanted)
    bodies, near = moved.bodies, moved.placement.values - motion.home_values
    at, share = np.array([0]), np.ones(1)
    _, matrix = walk.system(at, bodies, share, near)
    columns = matrix.shape[-1]

    def opened(column: int, by: float) -> Array:
        change = np.zeros((1, columns // 6, 6))
        change.reshape(-1)[column] = by
        place = bodies.position + walk.length * change[..., :3]
        turned = rotation_matrix(change[..., 3:]) @ bodies.rotation
        return np.asarray(walk.system(at, BodyPoses(place, turned), share, near)[0][0])

    step = 1e-5
    slopes = [(opened(c, step) - opened(c, -step)) / (2.0 * step) for c in range(columns)]
    # a clamp goes with the node that slides through it, and never turns
    clamps = np.asarray(motion.joints.still.all(axis=1))[walk.joint]
    chosen = np.setdiff1d(np.arange(matrix.shape[1]), np.flatnonzero(clamps))
    # differences of the second order: the step's square, and rounding over the step
    np.testing.assert_allclose(np.stack(slopes, axis=-1)[chosen], matrix[0][chosen], atol=1e-9)


@pytest.mark.parametrize("count", [1, 80], ids=["stacked", "compiled"])
def test_a_leg_of_universal_joints_goes_in_one_step(count: int) -> None:
    """With rates along other axes corrections shrank by a share only: 79 steps, 1.6e-11 m open."""
    model = model_of(THIRD_LEG)
    assert model.closed_form is not None
    random = np.random.default_rng(3)
    x, y = random.uniform(-0.4, 0.4, (2, count))
    moved = model.motion.move(task={"x": x, "y": y, "ry": random.uniform(-0.5, 0.5, count)})
    assert moved.reached.all()
    assert moved.steps.max() == 1
    assert moved.tool is not None
    expected = model.closed_form(moved.tool)
    np.testing.assert_allclose(moved.placement.positions, expected.positions, atol=1e-12)
    np.testing.assert_allclose(moved.placement.frames, expected.frames, atol=1e-12)


def test_a_long_way_of_one_pose_takes_compiled_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """A pose that ends at a singularity takes many steps: after some they are compiled ones."""
    motion = model_of("examples/machines/planar-3-rrr.toml").motion
    task = task_of(motion, {"x": 0.6, "y": 0.4})
    taken: list[int] = []
    newton = QuickStep.newton

    def counted(self: QuickStep, *given: Any) -> Any:
        taken.append(1)
        return newton(self, *given)

    monkeypatch.setattr(QuickStep, "newton", counted)
    monkeypatch.setattr(Walk, "few", 8)
    found = motion.move(task=task)
    assert not found.reached.any()
    assert 0 < len(taken) == found.steps[0] - 7
    monkeypatch.setattr(QuickStep, "of", lambda *_: None)
    stacked = motion.move(task=task)
    assert stacked.placement.reasons == found.placement.reasons
    np.testing.assert_allclose(stacked.share, found.share, atol=1e-6)
    np.testing.assert_allclose(stacked.placement.values, found.placement.values, atol=1e-4)
