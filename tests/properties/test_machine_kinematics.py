"""Kinematics of the machines over their workspace."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from strutwork.kinematics import (
    Poses,
    cross_matrix,
    drive_values,
    forward_kinematics,
    jacobians,
    rotation_z,
    tangent_rotation,
)
from strutwork.machines import Alizade3PRPS, Eclipse3PPRS, Glozman3PRRS, Proposed3PPRS, ThreeLegs

MACHINES = [Proposed3PPRS(), Eclipse3PPRS(), Alizade3PRPS(), Glozman3PRRS(pole_height=0.174)]
NAMES = [type(m).__name__ for m in MACHINES]

every_machine = pytest.mark.parametrize("machine", MACHINES, ids=NAMES)

shifts = st.lists(st.floats(-0.006, 0.006), min_size=3, max_size=3)
turns = st.floats(-np.pi, np.pi)
tilts = st.floats(0.0, np.radians(85.0))


def pose(machine: ThreeLegs, shift: list[float], azimuth: float, tilt: float, roll: float) -> Poses:
    normal = [np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)]
    return Poses.of(machine.home().position + shift, tangent_rotation(normal, roll))


def assume_regular(machine: ThreeLegs, poses: Poses, condition: float) -> Any:
    """The placement of a pose that is reached, away from the guide's axis and singularities."""
    placement = machine.place(poses)
    assume(bool(placement.reachable.all()))
    seats = placement.positions[..., 2:5, :2]
    assume(np.sqrt((seats**2).sum(-1)).min() > 1e-3)
    found = jacobians(machine.linkage, placement).condition(machine.platform_radius)
    assume(float(found.max()) < condition)
    return placement


@every_machine
@settings(max_examples=40)
@given(shift=shifts, azimuth=turns, tilt=tilts, roll=turns)
def test_jacobian_from_the_rows_is_the_derivative_of_the_inverse_kinematics(
    machine: ThreeLegs, shift: list[float], azimuth: float, tilt: float, roll: float
) -> None:
    """Complex steps give derivatives without a difference (Squire and Trapp 1998)."""
    poses = pose(machine, shift, azimuth, tilt, roll)
    placement = assume_regular(machine, poses, 1e6)
    rows = jacobians(machine.linkage, placement).inverse
    step = 1e-30
    stepped = []
    for k in range(6):
        twist = np.zeros(6)
        twist[k] = 1.0
        position = poses.position + 1j * step * twist[:3]
        rotation = (np.eye(3) + 1j * step * cross_matrix(twist[3:])) @ poses.rotation
        moved = drive_values(machine, machine.place(Poses(position, rotation)))
        stepped.append(moved.imag / step)
    derivative = np.stack(stepped, axis=-1)
    # both are exact but for rounding: 1e-10 of each drive's largest rate
    scale = np.abs(derivative).max(axis=-1, keepdims=True)
    np.testing.assert_allclose(rows / scale, derivative / scale, rtol=0.0, atol=1e-10)


@every_machine
@settings(max_examples=40)
@given(shift=shifts, azimuth=turns, tilt=tilts, roll=turns, nudge=shifts)
def test_forward_kinematics_returns_the_pose(
    machine: ThreeLegs,
    shift: list[float],
    azimuth: float,
    tilt: float,
    roll: float,
    nudge: list[float],
) -> None:
    poses = pose(machine, shift, azimuth, tilt, roll)
    placement = assume_regular(machine, poses, 30.0)
    # 0.3 mm and 1 degree off: near enough to stay in the pose's assembly mode
    start = poses.moved([*(0.05 * np.array(nudge)), *(3.0 * np.array(nudge))])
    found = forward_kinematics(machine, drive_values(machine, placement), start)
    # drives met to 1e-12 m, times a condition number of at most 30 at 18 mm: far below 1e-9
    np.testing.assert_allclose(found.position, poses.position, rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(found.rotation, poses.rotation, rtol=0.0, atol=1e-9)


@every_machine
@settings(max_examples=25)
@given(shift=shifts, azimuth=turns, tilt=tilts, roll=turns, turn=turns)
def test_turning_the_whole_pose_turns_the_carriages_only(
    machine: ThreeLegs, shift: list[float], azimuth: float, tilt: float, roll: float, turn: float
) -> None:
    """The guide is round: the machine is the same from every side."""
    poses = pose(machine, shift, azimuth, tilt, roll)
    first = assume_regular(machine, poses, 1e6)
    about = rotation_z(turn)
    second = machine.place(Poses(poses.position @ about.T, about @ poses.rotation))
    guide = np.array([joint.endswith("guide") for joint, _ in first.names])
    # the elbow of a nearly straight leg doubles the digits lost
    np.testing.assert_allclose(first.values[~guide], second.values[~guide], atol=1e-7)
    moved = second.values[guide] - first.values[guide] - turn
    np.testing.assert_allclose(np.exp(1j * moved), 1.0, atol=1e-11)


@every_machine
def test_a_batch_is_the_poses_one_by_one(machine: ThreeLegs) -> None:
    random = np.random.default_rng(7)
    normals = random.normal([0.0, 0.0, 3.0], size=(4, 3))
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    poses = Poses.of(
        machine.home().position + random.uniform(-4e-3, 4e-3, (4, 3)),
        tangent_rotation(normals, random.uniform(0.0, 2.0, 4)),
    )
    together = machine.place(poses)
    for i in range(4):
        alone = machine.place(poses[i])
        np.testing.assert_array_equal(together.positions[i], alone.positions)
        np.testing.assert_array_equal(together.values[i], alone.values)


@pytest.mark.parametrize("roll", np.radians([0.0, 15.0, 30.0, 45.0, 60.0, 90.0]))
def test_the_proposed_machine_has_a_singular_ring_on_the_hemisphere(roll: float) -> None:
    """Azulay 2014, Fig. 4: a ring of type 2 singularities at r of about 2 mm, of 4 mm.

    Read from a figure of which only the text is at hand, so the ring is looked for between 1.9
    and 2.6 mm. The determinant of J⁻¹ goes through zero there, once on every radius.
    """
    machine = Proposed3PPRS()
    radius = np.linspace(0.0, 0.95, 191)[:, None]
    azimuth = np.radians(np.arange(0.0, 360.0, 10.0))[None, :]
    normal = np.stack(
        [
            radius * np.cos(azimuth),
            radius * np.sin(azimuth),
            np.broadcast_to(np.sqrt(1.0 - radius**2), (191, 36)),
        ],
        axis=-1,
    )
    poses = Poses.of(
        [0.0, 0.0, machine.pole_height - 4e-3] + 4e-3 * normal, tangent_rotation(normal, roll)
    )
    sign = np.sign(jacobians(machine.linkage, machine.place(poses)).determinant())
    changes = sign[1:] != sign[:-1]
    assert (changes.sum(axis=0) == 1).all()
    at = 4.0 * radius[:-1, 0][changes.argmax(axis=0)]
    assert at.min() > 1.9
    assert at.max() < 2.6
