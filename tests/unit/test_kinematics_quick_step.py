"""Compiled steps of a walk beside the stacked ones: the same poses, coordinates and reasons."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from strutwork.kinematics import DIRECTIONS, Placement, Poses
from strutwork.kinematics.follow import Follower
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.quick_step import QuickStep
from strutwork.kinematics.turns import rotation_matrix
from strutwork.machines.load import load

Array = NDArray[Any]

# directions, and how far poses lie: some of them out of reach
CASES = [
    ("examples/machines/linear-delta.toml", ("x", "y", "z"), 0.45),
    ("examples/machines/6-ups.toml", ("x", "rx", "rz"), 0.9),
    ("examples/machines/3-rps.toml", ("z", "rx", "ry"), 0.6),
    ("examples/machines/planar-3-rrr.toml", ("x", "y"), 0.2),
    ("examples/machines/gantry.toml", ("x", "y", "z"), 0.3),
    ("biglide:third-leg", ("x", "y", "ry"), 0.5),
]


@cache
def motion_of(name: str) -> Motion:
    return load(name).motion


def agree(found: Placement, expected: Placement) -> None:
    assert found.reasons == expected.reasons
    np.testing.assert_array_equal(found.status, expected.status)
    good = np.asarray(found.status) == 0
    # Newton's method squares: where it has closed, rounding is left
    np.testing.assert_allclose(found.values[good], expected.values[good], atol=1e-11)
    np.testing.assert_allclose(found.positions[good], expected.positions[good], atol=1e-11)
    np.testing.assert_allclose(found.frames[good], expected.frames[good], atol=1e-11)


@pytest.mark.parametrize(("name", "directions", "far"), CASES)
def test_followed_poses(
    name: str, directions: tuple[str, ...], far: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    motion = motion_of(name)
    home = motion.task_of(motion.home_pose)[[DIRECTIONS.index(d) for d in directions]]
    points = home + far * np.random.default_rng(2).uniform(-1, 1, (40, len(directions)))
    fixed = motion.rest(directions)

    def placed() -> Placement:
        return Follower(motion, directions, fixed, np.full(len(directions), 3 * far)).place(points)

    found = placed()
    monkeypatch.setattr(QuickStep, "of", lambda *_: None)
    agree(found, placed())
    # rods of one length and bars have an end: both are looked at
    if "delta" in name or "planar" in name:
        assert 0 < np.count_nonzero(found.status) < len(points)


@pytest.mark.parametrize("name", ["examples/machines/tricept.toml", "prototype-3ppprs"])
def test_many_poses_and_few_are_alike(name: str) -> None:
    """From 64 on a walk from home takes compiled steps."""
    motion = motion_of(name)
    directions = ("x", "y", "z")
    home = motion.task_of(motion.home_pose)[:3]
    points = home + 0.05 * np.random.default_rng(4).uniform(-1, 1, (70, 3))
    rest = motion.rest(directions)

    def placed(some: Array) -> Placement:
        task = {d: some[:, k] for k, d in enumerate(directions)} | rest
        return motion.move(task=task).placement

    agree(placed(points)[:30], placed(points[:30]))


@settings(max_examples=10, deadline=None)
@given(
    st.lists(st.floats(-0.15, 0.15), min_size=3, max_size=3),
    st.lists(st.floats(-0.8, 0.8), min_size=3, max_size=3),
)
def test_poses_walked_by_bodies_and_by_legs(shift: list[float], turn: list[float]) -> None:
    """All six directions of a hexapod's tool: its legs give the same."""
    motion = motion_of("examples/machines/6-ups.toml")
    home = motion.home_pose
    place = home.position + np.array(shift)
    rotation = rotation_matrix(np.array(turn)) @ home.rotation
    legs = motion.place(Poses(place[None], rotation[None]))
    task = motion.task_of(Poses(place, rotation))
    follower = Follower(motion, DIRECTIONS, {}, np.full(6, 2.0))
    bodies = follower.place(task[None])
    np.testing.assert_array_equal(legs.reachable, bodies.reachable)
    if legs.reachable[0]:
        np.testing.assert_allclose(bodies.positions, legs.positions, atol=1e-10)
        np.testing.assert_allclose(bodies.values, legs.values, atol=1e-9)
