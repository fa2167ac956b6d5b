"""Stiffness where a direction is locked: finite or infinite, never negative, in any frame."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.errors import SingularPoseError
from strutwork.machines.model_file import read_model
from strutwork.msa import (
    axis_stiffness_blocked,
    axis_stiffness_free,
    compliance_budget,
    movable_directions,
    movable_rank,
    stiffness_ellipsoid,
    system_of,
    tool_compliance,
    tool_stiffness,
)
from strutwork.msa.movable import always_movable
from tests.structure_cases import LIBRARY
from tests.structures import Model, cantilever

CASES = Path(__file__).parents[1] / "cases"
INF = float("inf")
METHODS = ("saddle_point", "null_space", "condensed", "sparse")

#: Free and blocked stiffness along x y z rx ry rz, N/m and N·m/rad, by hand.
RIGHT = {
    "models/skew_guide": ([1e8 / 0.75, 1e8 / 0.25, *[INF] * 4], [INF] * 6),
    "models/skew_guide2": ([14e8 / 9, 14e8 / 4, 14e8, *[INF] * 3], [INF] * 6),
    "models/f1_three_axis_rigid_slides": ([1e8, 5e7, 2e8, *[INF] * 3],) * 2,
    # K = 1e5/r² along x and y, with arms 0.1 m and 0.3 m
    "models/f1b_rotary_table": ([1e7, 1e5 / 0.09, INF, INF, INF, 1e5], [INF] * 6),
    "models/locked_tool": (
        [14e7, 14e7 / 4, 14e7 / 9, 14e4, 14e4 / 4, 14e4 / 9],
        [INF] * 6,
    ),
    "robustness/straight_guide": ([1e8, *[INF] * 5],) * 2,
}


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("name", RIGHT)
def test_a_locked_direction_is_infinitely_stiff(name: str, method: str) -> None:
    compliance = tool_compliance(read_model(CASES / f"{name}.toml").placed, method)  # type: ignore[arg-type]
    free, blocked = RIGHT[name]
    with np.errstate(all="raise"):
        np.testing.assert_allclose(axis_stiffness_free(compliance), free, rtol=1e-9)
        np.testing.assert_allclose(axis_stiffness_blocked(compliance), blocked, rtol=1e-9)
    with pytest.raises(SingularPoseError, match="does not move at all"):
        tool_stiffness(compliance)


def test_an_arm_whose_end_cannot_turn_is_that_of_a_beam_clamped_at_both_ends() -> None:
    compliance = tool_compliance(read_model(CASES / "models/skew_hexa.toml").placed)
    assert movable_rank(compliance) == 3
    block = compliance[:3, :3]
    assert not np.any(compliance[3:])
    stiffness = np.linalg.inv(block)
    blocked, free = axis_stiffness_blocked(compliance), axis_stiffness_free(compliance)
    np.testing.assert_allclose(blocked[:3], np.diag(stiffness), rtol=1e-9)
    np.testing.assert_allclose(free[:3], 1 / np.diag(block), rtol=1e-12)
    assert np.all(np.isposinf([blocked[3:], free[3:]]))
    # with no rotation left both ellipsoids are one
    for rotation in ("free", "blocked"):
        found = stiffness_ellipsoid(compliance, rotation)
        np.testing.assert_allclose(found.values, np.linalg.eigvalsh(stiffness), rtol=1e-9)


def slides(size: float = 1.0) -> Model:
    """Two crossed slides at 90 degrees on elastic drives, the tool off their plane."""
    model = Model("tool")
    model.ground(base=(0, 0, 0))
    model.nodes(tool=np.array([0.3, -0.2, 0.4]) * size, top=np.array([0.1, 0.1, 0.1]) * size)
    model.joint("x", "prismatic", ("base", "foot"), (1, 0, 0), driven=("z",), stiffness={"z": 1e8})
    model.rigid("saddle", "foot", "top")
    model.joint("y", "prismatic", ("top", "table"), (0, 1, 0), driven=("z",), stiffness={"z": 3e6})
    model.rigid("table", "table", "tool")
    return model


def tables(size: float = 1.0) -> Model:
    """A slide, and on it a rotary table with the tool off its axis: translation and rotation."""
    model = Model("tool")
    model.ground(base=(0, 0, 0))
    model.nodes(tool=np.array([0.3, -0.2, 0.4]) * size, top=np.array([0.1, 0.1, 0.1]) * size)
    model.joint("x", "prismatic", ("base", "foot"), (1, 0, 0), driven=("z",), stiffness={"z": 1e8})
    model.rigid("saddle", "foot", "top")
    model.joint("c", "revolute", ("top", "table"), (0, 0, 1), driven=("rz",), stiffness={"rz": 4e5})
    model.rigid("table", "table", "tool")
    return model


@pytest.mark.parametrize("make", [slides, tables])
@pytest.mark.parametrize("size", [1e-3, 1.0, 1e2])
@pytest.mark.parametrize("method", METHODS)
def test_stiffness_does_not_see_the_frame(make, size: float, method: str) -> None:  # type: ignore[no-untyped-def]
    model = make(size)
    here = tool_compliance(model.place(), method)
    rng = np.random.default_rng(7)
    for turn in Rotation.random(8, rng=rng).as_matrix():
        there = tool_compliance(model.turned(turn, size * rng.normal(size=3)).place(), method)
        six = np.kron(np.eye(2), turn)
        scale = np.sqrt(np.diag(here).reshape(2, 3).sum(axis=1)).repeat(3)
        outer = np.where(np.outer(scale, scale) == 0, 1.0, np.outer(scale, scale))
        np.testing.assert_allclose((six.T @ there @ six) / outer, here / outer, atol=1e-9)
        assert movable_rank(there) == movable_rank(here) == 2
        # turned back, so is the answer, infinite where it was
        back = six.T @ there @ six
        for stiffness in (axis_stiffness_free, axis_stiffness_blocked):
            assert np.all(stiffness(there) > 0)
            np.testing.assert_allclose(stiffness(back), stiffness(here), rtol=1e-8)
        for rotation in ("free", "blocked"):
            found, expected = (stiffness_ellipsoid(c, rotation) for c in (there, here))
            np.testing.assert_allclose(found.values, expected.values, rtol=1e-8)
            finite = np.isfinite(found.values)
            turned = turn @ expected.directions
            overlap = np.abs((turned * found.directions).sum(axis=0))[finite]
            np.testing.assert_allclose(overlap, 1.0, rtol=1e-8)


def test_the_values_of_the_frame_cases() -> None:
    blocked = axis_stiffness_blocked(tool_compliance(slides().place()))
    np.testing.assert_allclose(blocked, [1e8, 3e6, INF, INF, INF, INF], rtol=1e-12)
    compliance = tool_compliance(tables().place())
    # the table moves the tool along both axes and turns it: only the slide moves it purely
    np.testing.assert_allclose(
        axis_stiffness_blocked(compliance), [1e8, INF, INF, INF, INF, INF], rtol=1e-9
    )
    arm = np.array([0.2, -0.3])
    np.testing.assert_allclose(
        axis_stiffness_free(compliance)[:2],
        [1 / (1e-8 + arm[1] ** 2 / 4e5), 4e5 / arm[0] ** 2],
        rtol=1e-9,
    )
    np.testing.assert_allclose(
        stiffness_ellipsoid(compliance, "blocked").values, [1e8, INF, INF], rtol=1e-9
    )


def test_a_direction_that_can_move_is_not_locked_by_its_stiffness() -> None:
    """Stiffnesses eight orders apart in a frame of their own: soft, stiff and nothing else."""
    model = slides()
    model.joints[1] = type(model.joints[1])(
        "y", "prismatic", ("top", "table"), driven=("z",), stiffness={"z": 1.0}
    )
    turn = Rotation.from_rotvec([0.3, -1.1, 0.7]).as_matrix()
    compliance = tool_compliance(model.turned(turn).place())
    assert movable_rank(compliance) == 2
    found = stiffness_ellipsoid(compliance, "blocked").values
    np.testing.assert_allclose(found, [1.0, 1e8, INF], rtol=1e-5)


def test_a_cantilever_can_move_everywhere_and_needs_no_rank() -> None:
    system = system_of(cantilever().place())
    assert always_movable(system)
    assert movable_directions(system).rank.tolist() == [6]
    # the arm of a machine whose platform stands on balls too; on slides of its own not
    assert always_movable(system_of(LIBRARY["three-legged frame"]().model.place()))
    assert not always_movable(system_of(slides().place()))


def test_ranks_of_a_batch_are_those_of_its_poses() -> None:
    """Of two crossed slides the second turns until both are one."""
    model = slides()
    turn = np.array([0.0, 0.4, 1.2])
    frames = Rotation.from_rotvec(np.outer(np.pi / 2 - turn, [0, 0, 1])).as_matrix()
    model.axes["y"] = frames @ np.stack([[0, 1, 0], [0, 0, 1], [1, 0, 0]], axis=1)
    model.axes["y"] = np.concatenate([model.axes["y"], model.axes["x"][None]])
    placed = model.place()
    assert movable_directions(system_of(placed)).rank.tolist() == [2, 2, 2, 1]
    compliance = tool_compliance(placed)
    assert movable_rank(compliance).tolist() == [2, 2, 2, 1]
    for pose in range(4):
        np.testing.assert_allclose(compliance[pose], tool_compliance(placed[pose]), atol=1e-20)
    # both drives in a row
    np.testing.assert_allclose(
        axis_stiffness_blocked(compliance)[3, 0], 1 / (1e-8 + 1 / 3e6), rtol=1e-9
    )


def test_missing_poses_stay_missing() -> None:
    compliance = np.stack([np.eye(6), np.full((6, 6), np.nan), np.diag([1.0, 0, 0, 0, 0, 0])])
    for stiffness in (axis_stiffness_free, axis_stiffness_blocked):
        found = stiffness(compliance)
        assert np.isnan(found[1]).all()
        np.testing.assert_array_equal(found[2], [1.0, INF, INF, INF, INF, INF])
        np.testing.assert_array_equal(found[0], 1.0)
    assert np.isnan(stiffness_ellipsoid(compliance, "blocked").values[1]).all()
    assert np.isnan(tool_stiffness(compliance[:2])[1]).all()
    with pytest.raises(SingularPoseError, match="at pose 2"):
        tool_stiffness(compliance)


@pytest.mark.parametrize("name", ["skew_guide", "skew_guide2", "locked_tool", "skew_hexa"])
def test_a_budget_of_any_force_adds_up(name: str) -> None:
    placed = read_model(CASES / "models" / f"{name}.toml").placed
    compliance = tool_compliance(placed)
    across = np.linalg.svd(compliance[:3, :3])[2][-1]
    for wrench in (*np.eye(6)[:3], np.array([*across, 0, 0, 0])):
        budget = compliance_budget(placed, wrench)
        np.testing.assert_allclose(budget.deflection, wrench @ compliance @ wrench, atol=1e-20)
        total = budget.shares.sum()
        assert total == pytest.approx(1.0 if budget.deflection > 1e-20 else 0.0)
    if name != "skew_hexa":
        # a force that the guide takes alone stores nothing at all
        assert not compliance_budget(placed, [*across, 0, 0, 0]).shares.any()
