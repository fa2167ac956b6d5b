"""Kinematics of the MIT-SS-1 and of its work table over the workspace."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from strutwork.kinematics import (
    Poses,
    cross_matrix,
    drive_values,
    forward_kinematics,
    jacobians,
    rotation_y,
    velocity_ellipsoid,
)
from strutwork.machines import MitSS1, WorkTable
from strutwork.machines.mit_ss1 import NOMINAL_TILT, NOMINAL_X

MACHINES = [MitSS1(), MitSS1(pins="revolute", struts="rigid")]

every_machine = pytest.mark.parametrize("machine", MACHINES, ids=["bearings", "ideal pins"])

across = st.floats(*NOMINAL_X)
heights = st.floats(-0.5, 0.5)
tilts = st.floats(-NOMINAL_TILT, NOMINAL_TILT)
points = st.lists(st.floats(-0.1, 0.1), min_size=3, max_size=3)
table_tilts = st.floats(-1.5, 1.5)


@every_machine
@settings(max_examples=30, deadline=None)
@given(x=across, z=heights, b=tilts)
def test_jacobian_from_the_rows_is_the_derivative_of_the_inverse_kinematics(
    machine: MitSS1, x: float, z: float, b: float
) -> None:
    """By complex steps (Squire and Trapp 1998), motions out of the plane included."""
    poses = machine.poses(x, z, b)
    rows = jacobians(machine.linkage, machine.place(poses)).inverse
    step = 1e-30
    stepped = []
    for twist in np.eye(6):
        position = poses.position + 1j * step * twist[:3]
        rotation = (np.eye(3) + 1j * step * cross_matrix(twist[3:])) @ poses.rotation
        moved = drive_values(machine, machine.place(Poses(position, rotation)))
        stepped.append(moved.imag / step)
    derivative = np.stack(stepped, axis=-1)
    # both are exact but for rounding: 1e-10 of each drive's largest rate
    scale = np.abs(derivative).max(axis=-1, keepdims=True)
    np.testing.assert_allclose(rows / scale, derivative / scale, rtol=0.0, atol=1e-10)


@every_machine
@settings(max_examples=30, deadline=None)
@given(x=across, z=heights, b=tilts, nudge=points)
def test_forward_kinematics_returns_the_pose(
    machine: MitSS1, x: float, z: float, b: float, nudge: list[float]
) -> None:
    poses = machine.poses(x, z, b)
    start = machine.poses(x + 0.1 * nudge[0], z + 0.1 * nudge[1], b + 0.5 * nudge[2])
    found = forward_kinematics(machine, drive_values(machine, machine.place(poses)), start)
    # drives met to 1e-12 m; the inverse Jacobian's least singular value is above 0.01
    np.testing.assert_allclose(found.position, poses.position, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(found.rotation, poses.rotation, rtol=0.0, atol=1e-9)


@every_machine
@settings(max_examples=30, deadline=None)
@given(x=across, z=heights, b=tilts)
def test_height_is_a_pure_translation(machine: MitSS1, x: float, z: float, b: float) -> None:
    level, raised = (machine.place(machine.poses(x, height, b)) for height in (0.0, z))
    guides = np.array([d == "z" for _, d in level.names])
    np.testing.assert_allclose(raised.values[guides], level.values[guides] + z, atol=1e-15)
    np.testing.assert_array_equal(raised.values[~guides], level.values[~guides])


@every_machine
def test_a_batch_is_the_poses_one_by_one(machine: MitSS1) -> None:
    random = np.random.default_rng(7)
    poses = machine.poses(*random.uniform([-0.06, -0.1, -0.5], [0.04, 0.1, 0.5], (4, 3)).T)
    together = machine.place(poses)
    for i in range(4):
        alone = machine.place(poses[i])
        np.testing.assert_array_equal(together.positions[i], alone.positions)
        np.testing.assert_array_equal(together.values[i], alone.values)
        np.testing.assert_array_equal(together.frames[i], alone.frames)


@settings(max_examples=60)
@given(work=points, a=table_tilts)
def test_the_table_brings_the_point_back(work: list[float], a: float) -> None:
    table = WorkTable()
    tool, drives = table.tool_position(work, a), table.drive_values(work, a)
    assert tool[1] == 0.0
    # rounding of lengths below a metre
    np.testing.assert_allclose(table.work_position(tool, drives), work, atol=1e-15)


@settings(max_examples=30, deadline=None)
@given(work=points, a=table_tilts, x=across, b=tilts)
def test_tilting_the_table_turns_the_velocity_ellipsoid_and_leaves_its_shape(
    work: list[float], a: float, x: float, b: float
) -> None:
    """The five drives' rates at all positions of the table, by complex steps."""
    machine, table = MACHINES[0], WorkTable()

    def semi_axes(point: list[float], tilt: float) -> np.ndarray:
        step = 1e-30
        at = np.array([x, *point[1:]]) + 1j * step * np.eye(3)
        poses = Poses(table.tool_position(at, tilt), np.tile(rotation_y(b), (3, 1, 1)))
        blocks = drive_values(machine, machine.place(poses))
        rates = np.concatenate([blocks, table.drive_values(at, tilt)], axis=-1).imag / step
        return np.asarray(velocity_ellipsoid(rates.T).semi_axes)

    np.testing.assert_allclose(semi_axes(work, a), semi_axes([0.0] * 3, 0.0), rtol=1e-12)
