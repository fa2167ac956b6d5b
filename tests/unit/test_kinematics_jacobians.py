"""Velocity Jacobians from the constraint rows, against closed forms and differences."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.errors import ModelError
from strutwork.kinematics import (
    Joint,
    Linkage,
    Mechanism,
    Placement,
    Poses,
    drive_values,
    forward_kinematics,
    jacobians,
)
from tests.linkages import Gough, chain, gough

RNG = np.random.default_rng(3)


def tilted_poses(count: int) -> Poses:
    rotation = Rotation.from_rotvec(RNG.uniform(-0.2, 0.2, (count, 3))).as_matrix()
    return Poses.of(np.array([0, 0, 0.5]) + RNG.uniform(-0.05, 0.05, (count, 3)), rotation)


def driven_arm(points: list[list[float]]) -> tuple[Linkage, Placement]:
    linkage, placement = chain(points, [[0, 0, 1]] * 3, closed=False)
    joints = tuple(Joint(j.name, j.type, j.between, driven=("rz",)) for j in linkage.joints)
    return Linkage(linkage.nodes, linkage.bodies, joints, "tool"), placement


def test_serial_arm_with_two_revolutes() -> None:
    points = [[0.0, 0, 0], [0.3, 0.4, 0], [0.9, 0.2, 0]]
    found = jacobians(*driven_arm(points))
    tool = np.array(points[2])
    # each column is the twist of the tool about that joint: (z × arm, z)
    columns = [np.concatenate([np.cross([0, 0, 1], tool - p), [0, 0, 1]]) for p in points[:2]]
    np.testing.assert_allclose(found.forward, np.column_stack(columns), atol=1e-13)
    assert found.driven == (("R1", "rz"), ("R2", "rz"))


@pytest.mark.parametrize("lower", ["universal", "spherical"])
def test_gough_platform_has_the_pluecker_lines_of_its_legs(lower: str) -> None:
    # spherical lower joints leave the legs free to spin: the same rows by another road
    machine = gough(lower)
    poses = tilted_poses(5)
    found = jacobians(machine.linkage, machine.place(poses))
    arms = np.einsum("...ij,lj->...li", poses.rotation, np.asarray(machine.platform))
    legs = poses.position[:, None] + arms - np.asarray(machine.base)
    along = legs / np.linalg.norm(legs, axis=-1, keepdims=True)
    lines = np.concatenate([along, np.cross(arms, along)], axis=-1)
    # entries of order one out of a solve with 72 well-scaled rows
    np.testing.assert_allclose(found.inverse, lines, atol=1e-12)
    np.testing.assert_allclose(
        found.forward @ found.inverse, np.broadcast_to(np.eye(6), (5, 6, 6)), atol=1e-11
    )


def test_inverse_jacobian_is_the_derivative_of_the_inverse_kinematics() -> None:
    machine = gough()
    poses = tilted_poses(3)
    found = jacobians(machine.linkage, machine.place(poses)).inverse
    step = 1e-6
    for direction in range(6):
        twist = np.zeros(6)
        twist[direction] = step
        ahead, behind = (
            drive_values(machine, machine.place(poses.moved(np.tile(s * twist, (3, 1)))))
            for s in (1, -1)
        )
        # central difference: error step², round-off 1e-16/step
        np.testing.assert_allclose(found[..., direction], (ahead - behind) / (2 * step), atol=1e-9)


def test_condition_does_not_depend_on_the_unit_of_length() -> None:
    metres = gough()
    base, platform = (
        tuple((1000 * x, 1000 * y, 1000 * z) for x, y, z in ring)
        for ring in (metres.base, metres.platform)
    )
    millimetres = Gough(base, platform)
    poses = tilted_poses(4)
    larger = Poses(1000 * poses.position, poses.rotation)
    small = jacobians(metres.linkage, metres.place(poses)).condition(0.2)
    large = jacobians(millimetres.linkage, millimetres.place(larger)).condition(200.0)
    np.testing.assert_allclose(small, large, rtol=1e-9)
    assert np.all(small > 1)


def test_determinant_vanishes_where_the_platform_loses_its_stiffness() -> None:
    machine = gough()
    upright = jacobians(machine.linkage, machine.place(machine.home())).determinant()
    # Fichter 1986: turned by 90 degrees about its normal, a Gough platform is singular
    quarter = Rotation.from_rotvec([[0, 0, np.pi / 2]]).as_matrix()
    turned = Poses.of([[0.0, 0, 0.5]], quarter)
    flat = jacobians(machine.linkage, machine.place(turned)).determinant()
    assert abs(flat[0]) < 1e-12
    assert abs(upright) > 1e-3


def test_determinant_needs_six_drives() -> None:
    found = jacobians(*driven_arm([[0.0, 0, 0], [0.3, 0.4, 0], [0.9, 0.2, 0]]))
    with pytest.raises(ModelError, match="2 drives"):
        found.determinant()


def test_a_linkage_without_tool_or_drive_has_no_jacobian() -> None:
    with pytest.raises(ModelError, match="no tool"):
        jacobians(*chain([[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0, 1]] * 3))
    with pytest.raises(ModelError, match="no driven direction"):
        jacobians(*chain([[0, 0, 0], [1, 0, 0]], [[0, 0, 1]] * 2, closed=False))


def test_forward_kinematics_returns_the_pose() -> None:
    machine = gough()
    assert isinstance(machine, Mechanism)
    poses = tilted_poses(8)
    values = drive_values(machine, machine.place(poses))
    found = forward_kinematics(machine, values, machine.home())
    # leg lengths agree to 1e-12 m; the platform is some ten times as sensitive
    np.testing.assert_allclose(found.position, poses.position, atol=1e-10)
    np.testing.assert_allclose(found.rotation, poses.rotation, atol=1e-10)
