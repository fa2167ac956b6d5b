"""Forward kinematics follows one branch, says where it ends, and masks what it cannot find."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.errors import (
    ModelError,
    NumericalError,
    SingularPoseError,
    StrutworkError,
    UnreachableError,
)
from strutwork.kinematics import (
    FoundPoses,
    Mechanism,
    Poses,
    drive_values,
    forward_kinematics,
    jacobians,
)
from strutwork.machines import (
    Alizade3PRPS,
    Eclipse3PPRS,
    HexelHexapod,
    MitSS1,
    Proposed3PPRS,
    Prototype3PPPRS,
)
from tests.linkages import gough

Array = NDArray[Any]

#: Every one has six drives, and home poses away from singularities.
MACHINES: dict[str, Any] = {
    "gough": gough(),
    "hexapod": HexelHexapod(),
    "prototype": Prototype3PPPRS().locked(),
    "proposed": Proposed3PPRS(),
    "eclipse": Eclipse3PPRS(),
    "alizade": Alizade3PRPS(),
}

STARTS = 300


def around(machine: Any, count: int, seed: int) -> tuple[Poses, Array]:
    """Poses within 20 mm and 0.8 rad of home that can be taken, and their drive coordinates."""
    random = np.random.default_rng(seed)
    turn = Rotation.from_rotvec(random.uniform(-0.8, 0.8, (count, 3))).as_matrix()
    poses = Poses.of(machine.home().position + random.uniform(-0.02, 0.02, (count, 3)), turn)
    placement = machine.place(poses)
    good = placement.reachable
    return poses[good], drive_values(machine, placement[good])


def gap(first: Poses, second: Poses) -> Array:
    return np.asarray(
        np.linalg.norm(first.position - second.position, axis=-1)
        + np.linalg.norm(first.rotation - second.rotation, axis=(-2, -1))
    )


def side(machine: Any, poses: Poses) -> Array:
    """Sign of the determinant of the inverse Jacobian: it tells assembly modes apart."""
    return np.sign(jacobians(machine.linkage, machine.place(poses)).determinant())


def walked(machine: Any, values: Array, steps: int) -> tuple[Poses, NDArray[np.bool_]]:
    """The oracle: thousands of equal steps, each put right by Newton, and what kept its side."""
    rotary = np.array([d.startswith("r") for _, d in machine.linkage.driven])

    def round_(x: Array) -> Array:
        return np.where(rotary, np.angle(np.exp(1j * x)), x)

    home = machine.home()
    poses = Poses.of(np.tile(home.position, (len(values), 1)), home.rotation)
    way = round_(values - drive_values(machine, machine.place(poses)))
    begun, kept = side(machine, poses), np.ones(len(values), dtype=bool)
    for k in [*range(1, steps + 1), *[steps] * 12]:
        placement = machine.place(poses)
        rows = jacobians(machine.linkage, placement)
        kept &= placement.reachable & (np.sign(rows.determinant()) == begun)
        rest = round_(values - way * (1 - k / steps) - drive_values(machine, placement))
        twist = np.zeros((len(values), 6))
        twist[kept] = np.linalg.solve(rows.inverse[kept], rest[kept][..., None])[..., 0]
        size = np.linalg.norm(twist, axis=-1, keepdims=True)
        poses = poses.moved(twist / np.maximum(1.0, size / 0.02))
    return poses, kept


@pytest.mark.slow
@pytest.mark.parametrize("name", MACHINES)
def test_no_start_changes_its_assembly_mode(name: str) -> None:
    check_branches(MACHINES[name], STARTS, 4000)


@pytest.mark.parametrize("name", ["hexapod", "prototype", "proposed"])
def test_a_few_starts_keep_their_assembly_mode(name: str) -> None:
    check_branches(MACHINES[name], 40, 800)


def check_branches(machine: Any, count: int, steps: int) -> None:
    poses, values = around(machine, count, 5)
    found = forward_kinematics(machine, values, machine.home())
    good = found.found
    assert good.any()
    # what was found has the drives asked for, and stands on the side of home
    drives = drive_values(machine, machine.place(found[good]))
    rest = np.angle(np.exp(1j * (drives - values[good])))
    assert np.abs(rest).max() < 2e-12
    home = side(machine, machine.home())
    assert (side(machine, found[good]) == home).all()
    # the same pose by a walk of many steps, where that has kept its side
    oracle, kept = walked(machine, values, steps)
    both = good & kept
    assert both.sum() > 0.9 * good.sum()
    # 1e-12 of the drives, near a singularity: a condition of 1e5 at most
    assert gap(found[both], oracle[both]).max() < 1e-6
    # a pose of home's assembly mode is the one found; another mode is never taken for it
    same = side(machine, poses) == home
    assert (gap(found[good & same], poses[good & same]) < 1e-6).all()
    assert (gap(found[good & ~same], poses[good & ~same]) > 1e-6).all()
    # the rest says why
    for i in np.flatnonzero(~good):
        assert found.reason(i)
        assert 0.0 <= found.reached[i] < 1.0
        assert np.isnan(found.position[i]).all()


def test_the_workspace_of_a_regular_machine_is_found_from_home() -> None:
    """A Gough platform in the middle of its workspace: every pose, by legs and batch."""
    machine = gough()
    assert isinstance(machine, Mechanism)
    poses, values = around(machine, 200, 3)
    found = forward_kinematics(machine, values, machine.home())
    assert found.found.all()
    np.testing.assert_allclose(found.position, poses.position, atol=1e-10)
    np.testing.assert_allclose(found.rotation, poses.rotation, atol=1e-10)
    assert found.steps.max() < 200
    assert (found.reached == 1.0).all()
    assert found.reason(0) == ""
    assert found.require_found().batch == (len(values),)


def test_a_batch_is_its_poses_one_by_one() -> None:
    machine = Proposed3PPRS()
    _, values = around(machine, 8, 8)
    together = forward_kinematics(machine, values, machine.home())
    for i in range(len(values)):
        alone = forward_kinematics(machine, values[i : i + 1], machine.home())
        assert alone.status.astype(bool) == together.status[i].astype(bool)
        np.testing.assert_allclose(alone.position[0], together.position[i], atol=1e-12)
    shaped = forward_kinematics(machine, values[:6].reshape(2, 3, 6), machine.home())
    assert shaped.batch == (2, 3)
    np.testing.assert_array_equal(shaped.position.reshape(6, 3), together.position[:6])


def test_one_pose_that_cannot_be_found_is_masked_with_its_reason() -> None:
    machine = gough()
    good = drive_values(machine, machine.place(machine.home()))
    bad = [0.01, 5.0, 0.01, 5.0, 0.01, 5.0]
    found = forward_kinematics(machine, [good, bad, [np.nan, *good[1:]]], machine.home())
    assert isinstance(found, FoundPoses)
    assert found.found.tolist() == [True, False, False]
    np.testing.assert_allclose(found.position[0], [0, 0, 0.5], atol=1e-12)
    assert np.isnan(found.position[1:]).all()
    assert "singularity lies on the path" in found.reason(1)
    assert "not finite" in found.reason(2)
    assert "1 found" in repr(found)
    with pytest.raises(StrutworkError, match=r"forward kinematics, pose 1.*2 of 3 poses"):
        found.require_found()


def test_a_single_pose_that_cannot_be_found_raises() -> None:
    machine = gough()
    with pytest.raises(SingularPoseError, match=r"forward kinematics: a .* singularity"):
        forward_kinematics(machine, [0.01, 5, 0.01, 5, 0.01, 5], machine.home())
    values = drive_values(machine, machine.place(machine.home()))
    with pytest.raises(NumericalError, match="not finite"):
        forward_kinematics(machine, values * np.inf, machine.home())
    with pytest.raises(NumericalError, match="steps allowed"):
        forward_kinematics(machine, values + 0.05, machine.home(), iterations=2)


def test_a_start_that_cannot_be_taken_or_is_singular_is_said() -> None:
    machine = HexelHexapod()
    values = drive_values(machine, machine.place(machine.home()))
    above = machine.poses(0.0, 0.0, 1.5)
    with pytest.raises(UnreachableError, match="the start cannot be reached: leg 1"):
        forward_kinematics(machine, values, above)
    platform = gough()
    quarter = Poses.of([0.0, 0, 0.5], Rotation.from_rotvec([0, 0, np.pi / 2]).as_matrix())
    legs = drive_values(platform, platform.place(platform.home()))
    with pytest.raises(SingularPoseError, match="the start is a singular pose"):
        forward_kinematics(platform, legs, quarter)


def test_a_turn_beyond_the_singularity_does_not_come_back_as_another_pose() -> None:
    """A Gough platform turned past its singular 90 degrees about its normal (Fichter 1986)."""
    machine = gough()
    turns = np.radians([40.0, 85.0, 95.0, 130.0])
    rotation = Rotation.from_rotvec(np.outer(turns, [0, 0, 1])).as_matrix()
    poses = Poses.of([0.01, 0.02, 0.5], rotation)
    values = drive_values(machine, machine.place(poses))
    found = forward_kinematics(machine, values, machine.home())
    home = side(machine, machine.home())
    assert (side(machine, poses) == home).tolist() == [True, True, False, False]
    np.testing.assert_allclose(gap(found[:2], poses[:2]), 0.0, atol=1e-8)
    for i in (2, 3):
        assert not found.found[i] or side(machine, found[i : i + 1]) == home


def test_drives_that_contradict_one_another_are_said() -> None:
    """Nine drives of six freedoms: the curvilinear stages stand elsewhere than wanted."""
    machine = Prototype3PPPRS()
    values = np.array(drive_values(machine, machine.place(machine.home())))
    assert forward_kinematics(machine, values, machine.home()).found
    values[0] += 0.1
    with pytest.raises(NumericalError, match="contradict one another"):
        forward_kinematics(machine, values, machine.home())


def test_a_planar_machine_is_followed_in_its_plane() -> None:
    machine = MitSS1(pins="revolute", struts="rigid")
    random = np.random.default_rng(4)
    poses = machine.poses(*random.uniform([-0.06, -0.1, -0.5], [0.04, 0.1, 0.5], (20, 3)).T)
    found = forward_kinematics(machine, drive_values(machine, machine.place(poses)), machine.home())
    assert found.found.all()
    np.testing.assert_allclose(gap(found, poses), 0.0, atol=1e-9)


def test_each_drive_has_its_coordinate() -> None:
    with pytest.raises(ModelError, match="6 drives"):
        forward_kinematics(gough(), [0.5] * 5, gough().home())


def test_no_pose_no_work() -> None:
    machine = gough()
    found = forward_kinematics(machine, np.zeros((0, 6)), machine.home())
    assert found.batch == (0,)
