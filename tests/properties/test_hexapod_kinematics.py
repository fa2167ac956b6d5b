"""Kinematics of the Hexel hexapod over its workspace and beyond."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from strutwork.errors import ModelError
from strutwork.kinematics import (
    Poses,
    check_coincidence,
    cross_matrix,
    drive_values,
    forward_kinematics,
    jacobians,
    mobility,
    velocity_ellipsoid,
)
from strutwork.machines import HexelHexapod
from strutwork.msa import tool_compliance

MACHINE = HexelHexapod()

shifts = st.lists(st.floats(-0.1, 0.1), min_size=3, max_size=3)
turns = st.lists(st.floats(-0.35, 0.35), min_size=3, max_size=3)


def pose(shift: list[float], turn: list[float]) -> Poses:
    return MACHINE.home().moved([*shift, *turn])


@settings(max_examples=30, deadline=None)
@given(shift=shifts, turn=turns)
def test_jacobian_from_the_rows_is_the_derivative_of_the_inverse_kinematics(
    shift: list[float], turn: list[float]
) -> None:
    """By complex steps (Squire and Trapp 1998)."""
    poses = pose(shift, turn)
    rows = jacobians(MACHINE.linkage, MACHINE.place(poses)).inverse
    step = 1e-30
    stepped = []
    for twist in np.eye(6):
        position = poses.position + 1j * step * twist[:3]
        rotation = (np.eye(3) + 1j * step * cross_matrix(twist[3:])) @ poses.rotation
        moved = drive_values(MACHINE, MACHINE.place(Poses(position, rotation)))
        stepped.append(moved.imag / step)
    derivative = np.stack(stepped, axis=-1)
    # both are exact but for rounding: 1e-10 of each leg's largest rate
    scale = np.abs(derivative).max(axis=-1, keepdims=True)
    np.testing.assert_allclose(rows / scale, derivative / scale, rtol=0.0, atol=1e-10)


@settings(max_examples=30, deadline=None)
@given(shift=shifts, turn=turns, nudge=shifts)
def test_forward_kinematics_returns_the_pose(
    shift: list[float], turn: list[float], nudge: list[float]
) -> None:
    poses = pose(shift, turn)
    start = poses.moved([*(0.1 * np.array(nudge)), *(0.3 * np.array(nudge))])
    found = forward_kinematics(MACHINE, drive_values(MACHINE, MACHINE.place(poses)), start)
    # legs met to 1e-12 m; the inverse Jacobian's least singular value is above 0.01
    np.testing.assert_allclose(found.position, poses.position, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(found.rotation, poses.rotation, rtol=0.0, atol=1e-9)


@settings(max_examples=30, deadline=None)
@given(shift=shifts, turn=turns)
def test_inverse_squares_of_the_position_axes_add_to_six(
    shift: list[float], turn: list[float]
) -> None:
    """Σ 1/λ = Σ |u_i|² = 6: the legs' directions are unit vectors."""
    inverse = jacobians(MACHINE.linkage, MACHINE.place(pose(shift, turn))).inverse
    axes = velocity_ellipsoid(inverse[:, :3]).semi_axes
    assert (axes**-2).sum() == pytest.approx(6.0, rel=1e-12)


@settings(max_examples=20, deadline=None)
@given(shift=shifts, turn=turns)
def test_tool_stiffness_is_that_of_six_springs_along_the_legs(
    shift: list[float], turn: list[float]
) -> None:
    """K = k Σ s sᵀ with the legs' lines s, the rows of the inverse Jacobian."""
    placement = MACHINE.place(pose(shift, turn))
    rows = jacobians(MACHINE.linkage, placement).inverse
    expected = MACHINE.leg_stiffness * rows.T @ rows
    found = tool_compliance(MACHINE.structure.at(placement)) @ expected
    # the condition number of K stays below 1e5
    np.testing.assert_allclose(found, np.eye(6), atol=1e-9)


def test_six_freedoms_and_nothing_constrained_twice() -> None:
    found = mobility(MACHINE.linkage, MACHINE.place(MACHINE.home()))
    assert (found.mobility, found.mobility_locked, found.redundant) == (6, 0, 0)


def test_it_stands_as_appendix_a_says() -> None:
    feet, seats = MACHINE.feet, MACHINE.seats
    sides = np.linalg.norm(np.roll(feet, -1, axis=0) - feet, axis=-1)
    np.testing.assert_allclose(sides, [0.25, 0.66] * 3, atol=1e-15)
    assert (feet[:, 2] == 1.2).all()
    edges = np.roll(feet, -1, axis=0) - feet
    turning = np.cross(edges, np.roll(edges, -1, axis=0))[:, 2]
    # equal angles: the sine of 60 degrees at every corner
    np.testing.assert_allclose(turning / (0.25 * 0.66), np.sqrt(0.75), atol=1e-14)
    np.testing.assert_allclose(np.linalg.norm(seats[:, :2], axis=-1), 0.175, atol=1e-15)
    np.testing.assert_array_equal(seats[::2], seats[1::2])
    middles = (feet[::2] + feet[1::2]) / 2
    np.testing.assert_allclose(np.cross(middles, seats[::2])[:, 2], 0.0, atol=1e-15)


def test_nodes_of_every_joint_coincide_and_frames_are_rotations() -> None:
    random = np.random.default_rng(3)
    poses = MACHINE.home().moved(random.uniform(-0.3, 0.3, (20, 6)))
    placement = MACHINE.place(poses)
    check_coincidence(MACHINE.linkage, placement)
    gram = np.swapaxes(placement.frames, -1, -2) @ placement.frames
    np.testing.assert_allclose(gram, np.broadcast_to(np.eye(3), gram.shape), atol=1e-14)
    np.testing.assert_allclose(np.linalg.det(placement.frames), 1.0, atol=1e-13)
    for i in range(4):
        alone = MACHINE.place(poses[i])
        np.testing.assert_array_equal(placement.positions[i], alone.positions)
        np.testing.assert_array_equal(placement.values[i], alone.values)


def test_a_platform_through_the_ceiling_is_refused_with_the_leg() -> None:
    placement = MACHINE.place(MACHINE.poses([0.0, 0.0], 0.0, [0.4, 1.05]))
    assert placement.reachable.tolist() == [True, False]
    assert "leg 1" in (placement.reason((1,)) or "")
    assert np.isfinite(placement.positions).all()


@pytest.mark.parametrize(
    ("fields", "part"),
    [
        ({"long_side": 0.0}, "long_side"),
        ({"joint_radius": np.nan}, "joint_radius"),
        ({"leg_stiffness": -1.0}, "leg_stiffness"),
        ({"base_height": 0.5}, "HexelHexapod"),
    ],
)
def test_wrong_dimensions_are_named(fields: dict[str, float], part: str) -> None:
    with pytest.raises(ModelError, match=part):
        HexelHexapod(**fields)  # type: ignore[arg-type]
