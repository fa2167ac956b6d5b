"""Motion from the joints alone: beside closed forms, along whole turns, and where it must end."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.errors import ModelError
from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, Poses, drive_values
from strutwork.kinematics.motion import Motion
from strutwork.machines import (
    Alizade3PRPS,
    Eclipse3PPRS,
    Glozman3PRRS,
    HexelHexapod,
    Proposed3PPRS,
    Prototype3PPPRS,
)
from tests.linkages import chain, gough, open_chain, slider_crank

Array = NDArray[Any]

MACHINES: dict[str, Any] = {
    "gough": gough(),
    "hexapod": HexelHexapod(),
    "proposed": Proposed3PPRS(),
    "eclipse": Eclipse3PPRS(),
    "alizade": Alizade3PRPS(),
    "glozman": Glozman3PRRS(),
}


def motion_of(machine: Any) -> Motion:
    home = machine.home()
    return Motion(machine.linkage, machine.place(home), home.rotation)


def around(machine: Any, count: int, seed: int, turn: float = 0.4) -> Poses:
    """Poses within 15 mm and `turn` of home that can be taken."""
    random = np.random.default_rng(seed)
    rotation = Rotation.from_rotvec(random.uniform(-turn, turn, (count, 3))).as_matrix()
    home = machine.home()
    poses = Poses.of(
        home.position + random.uniform(-0.015, 0.015, (count, 3)), rotation @ home.rotation
    )
    return poses[machine.place(poses).reachable]


def on_circle(machine: Any, difference: Array) -> Array:
    """Differences of drive coordinates; turns that differ by whole ones are the same."""
    turning = [d.startswith("r") for _, d in machine.linkage.driven]
    return np.where(turning, np.angle(np.exp(1j * difference)), difference)


@pytest.mark.parametrize("name", MACHINES)
def test_poses_as_the_closed_form_takes_them(name: str) -> None:
    machine = MACHINES[name]
    poses = around(machine, 40, 1)
    found, wanted = motion_of(machine).move(tool=poses), machine.place(poses)
    assert found.reached.all()
    drives = np.stack([found.coordinate(*pair) for pair in machine.linkage.driven], axis=-1)
    # two solutions of one equation in double precision, whose derivative is some hundreds
    gap = on_circle(machine, drives - drive_values(machine, wanted))
    assert np.abs(gap).max() < 1e-9
    platform = machine.linkage.body_of_node == machine.linkage.tool_body
    apart = found.placement.positions[:, platform] - wanted.positions[:, platform]
    assert np.abs(apart).max() < 1e-9
    assert found.tool is not None
    assert np.abs(found.tool.rotation - poses.rotation).max() < 1e-9


@pytest.mark.parametrize("name", MACHINES)
def test_drives_lead_back(name: str) -> None:
    machine = MACHINES[name]
    motion = motion_of(machine)
    there = motion.move(tool=around(machine, 20, 2, 0.2))
    drives = {pair: there.coordinate(*pair) for pair in machine.linkage.driven}
    back = motion.move(joints=drives)
    assert back.reached.any()
    assert back.tool is not None
    assert there.tool is not None
    same = back.reached
    assert np.abs(back.tool.position - there.tool.position)[same].max() < 1e-9
    assert np.abs(back.tool.rotation - there.tool.rotation)[same].max() < 1e-9


def four_bar() -> tuple[Any, Placement]:
    """Crank 1, coupler 3, rocker 2.5, ground 3: a crank-rocker in the plane of x and y."""
    crank, coupler, rocker, ground = 1.0, 3.0, 2.5, 3.0
    tip = np.array([0.0, crank, 0.0])
    far = np.array([ground, 0.0, 0.0])
    d = np.linalg.norm(far - tip)
    along = (coupler**2 - rocker**2 + d**2) / (2 * d)
    e = (far - tip) / d
    joint = tip + along * e + np.sqrt(coupler**2 - along**2) * np.array([-e[1], e[0], 0.0])
    return chain([[0, 0, 0], tip, joint, far], [[0, 0, 1.0]] * 4, driven=0)


def test_a_whole_turn_of_a_crank_with_redundant_constraints() -> None:
    linkage, home = four_bar()
    motion = Motion(linkage, home)
    found = motion.move(joints={("R1", "rz"): [0.0, np.pi, 2 * np.pi, -4 * np.pi]})
    assert found.reached.all()
    assert found.tool is None
    # turns are counted on; the rocker comes back
    np.testing.assert_allclose(
        found.coordinate("R1", "rz"), [0.0, np.pi, 2 * np.pi, -4 * np.pi], atol=1e-9
    )
    np.testing.assert_allclose(found.coordinate("R4", "rz")[[0, 2, 3]], 0.0, atol=1e-9)
    back = found.placement.positions[[2, 3]] - home.positions
    assert np.abs(back).max() < 1e-9
    # half a turn on, by the law of cosines
    tip = np.array([0.0, -1.0])
    rocker = found.placement.positions[1, linkage.node_index["a2"]][:2]
    assert np.linalg.norm(rocker - tip) == pytest.approx(3.0, abs=1e-9)
    assert np.linalg.norm(rocker - [3.0, 0.0]) == pytest.approx(2.5, abs=1e-9)


def test_one_coordinate_of_the_tool() -> None:
    machine = slider_crank(0.7)
    linkage, home = machine
    motion = Motion(linkage, home)
    start = motion.home_pose.position
    found = motion.move(task={"x": start[0] + np.array([-0.02, 0.0, 0.02])})
    assert found.reached.all()
    assert found.tool is not None
    np.testing.assert_allclose(found.tool.position[:, 0] - start[0], [-0.02, 0, 0.02], atol=1e-9)
    with pytest.raises(ModelError, match="cannot move in z from home"):
        motion.move(task={"z": 0.1})


def test_the_end_of_reach_is_named_and_the_way_to_it_kept() -> None:
    motion = motion_of(gough())
    start = motion.home_pose
    # straight along x two legs would come to lie along the first axes of their universal joints,
    # where they can no longer move sideways
    far = Poses.of(start.position + np.array([[0.0, 0.0, 0.01], [5.0, 0.5, 0.0]]), start.rotation)
    linkage, home = slider_crank(0.7)
    crank = Motion(linkage, home)
    found = crank.move(task={"x": [0.39, 0.41]})
    # crank and rod in one line: 0.1 + 0.3 m
    assert found.reached.tolist() == [True, False]
    assert found.placement.reason(1).startswith("out of reach")
    assert found.tool is not None
    assert found.tool.position[1, 0] == pytest.approx(0.4, abs=1e-4)
    assert 0.0 < found.share[1] < 1.0
    # a telescope has no end
    assert motion.move(tool=far).reached.all()


def test_drives_that_cross_a_singularity() -> None:
    # the slider as the drive: at dead centre the crank may go on either way
    linkage, home = slider_crank(0.7)
    found = Motion(linkage, home).move(joints={("guide", "z"): 0.2})
    assert not found.reached
    assert "a parallel singularity (type 2) lies on the path" in found.placement.reason(())


def test_what_is_given_twice_must_agree() -> None:
    linkage, home = four_bar()
    motion = Motion(linkage, home)
    alone = motion.move(joints={("R1", "rz"): 0.5})
    rocker = float(alone.coordinate("R4", "rz"))
    both = motion.move(joints={("R1", "rz"): 0.5, ("R4", "rz"): [rocker, rocker + 0.1]})
    assert not both.reached[1]
    assert both.placement.reason(1).startswith("the given coordinates contradict one another")


def test_a_redundant_coordinate_is_fixed_or_moves_least() -> None:
    machine = Prototype3PPPRS()
    motion = motion_of(machine.locked())
    home = motion.home_pose
    poses = Poses.of(
        home.position + np.array([[0.0, 0.0, 0.005], [0.004, 0.0, 0.0]]), home.rotation
    )
    assert motion.move(tool=poses).reached.all()
    linkage, placement = open_chain([[0, 0, 0], [1, 0, 0], [1, 1, 0], [2, 1, 0]], [[0, 0, 1.0]] * 4)
    arm = Motion(linkage, placement)
    target = {"x": 2.1, "y": 0.9}
    free = arm.move(task=target)
    fixed = arm.move(task=target, joints={("R1", "rz"): 0.1})
    assert free.reached
    assert fixed.reached
    assert fixed.coordinate("R1", "rz") == pytest.approx(0.1, abs=1e-12)

    def turned(moved: Any) -> float:
        bodies = moved.placement.frames[:, 0, :] - placement.frames[:, 0, :]
        return float(np.linalg.norm(bodies))

    assert turned(free) < turned(fixed)


def test_a_screw_joint_is_measured_along_its_axis() -> None:
    # a cylindrical joint that turns and slides; both are coordinates
    linkage, placement = chain([[0, 0, 0], [1, 0, 0]], [[0, 0, 1.0]], closed=False)
    joint = linkage.joints[0]
    linkage = type(linkage)(
        linkage.nodes,
        linkage.bodies,
        (type(joint)(joint.name, "cylindrical", joint.between, driven=("z", "rz")),),
        "tool",
    )
    found = Motion(linkage, placement).move(joints={("R1", "z"): 0.3, ("R1", "rz"): 3.0})
    assert found.reached
    assert found.tool is not None
    np.testing.assert_allclose(found.tool.position, [np.cos(3.0), np.sin(3.0), 0.3], atol=1e-12)
    np.testing.assert_allclose(
        found.tool.rotation, Rotation.from_rotvec([0, 0, 3.0]).as_matrix(), atol=1e-12
    )


@pytest.mark.parametrize(
    ("wanted", "message"),
    [
        ({}, "is given no target"),
        ({"task": {"u": 1.0}}, 'unknown direction "u"'),
        ({"task": {"x": np.nan}}, "x of target 0 is not finite"),
        ({"joints": {("crnak", "rz"): 0.1}}, 'unknown joint "crnak".\nDid you mean "crank"'),
        ({"joints": {("crank", "z"): 0.1}}, '"z" does not move in it.\nIts coordinates are rz'),
        ({"task": {"x": [0.1, 0.2]}, "joints": {("pin", "rz"): [1, 2, 3]}}, "do not match"),
        ({"tool": Poses.of([0, 0, 0.0]), "task": {"x": 0.0}}, "both a pose and a task"),
    ],
)
def test_targets_that_make_no_sense(wanted: Any, message: str) -> None:
    linkage, home = slider_crank(0.7)
    with pytest.raises(ModelError, match=message):
        Motion(linkage, home).move(**wanted)


def test_a_joint_that_does_not_close_at_home() -> None:
    linkage, home = slider_crank(0.7)
    positions = home.positions.copy()
    positions[linkage.node_index["s"], 0] += 1e-3
    with pytest.raises(ModelError, match=r"joint wrist: .* 0\.001 m apart"):
        Motion(linkage, Placement(positions, home.frames, np.zeros(0)))


def parallelogram(angle: float) -> Motion:
    """Cranks of 1 m on bases 2 m apart, turned from the line of the bases."""
    end = np.array([np.cos(angle), np.sin(angle), 0.0])
    base = np.array([2.0, 0.0, 0.0])
    places = {"o1": 0 * end, "a1": 0 * end, "b1": end, "c1": end}
    places |= {"c2": base + end, "b2": base + end, "a2": base, "o2": base}
    bars = (("crank", "a1", "b1"), ("coupler", "c1", "c2"), ("rocker", "a2", "b2"))
    hinges = (("j1", "o1", "a1"), ("j2", "b1", "c1"), ("j3", "c2", "b2"), ("j4", "o2", "a2"))
    linkage = Linkage(
        tuple(places),
        (Body(GROUND, ("o1", "o2")), *(Body(n, (a, b)) for n, a, b in bars)),
        tuple(Joint(n, "revolute", (a, b)) for n, a, b in hinges),
    )
    frames = np.tile(np.eye(3), (4, 1, 1))
    return Motion(linkage, Placement(np.array(list(places.values())), frames, np.zeros(0)))


def test_a_flat_parallelogram_says_that_home_is_special() -> None:
    """Flat, it has two freedoms to first order, and two branches leave: parallel and crossed."""
    flat, beside = parallelogram(0.0), parallelogram(0.1)
    ended = flat.move(joints={("j1", "rz"): 0.2})
    assert not ended.reached
    assert "home is a special position" in ended.placement.reason(())
    assert "give a home beside it" in ended.placement.reason(())
    # the parallel branch, named by its other crank
    named = flat.move(joints={("j1", "rz"): 0.2, ("j4", "rz"): 0.2})
    assert named.reached
    np.testing.assert_allclose(named.coordinate("j2", "rz"), -0.2, atol=1e-9)
    # beside it nothing is special, and two that disagree contradict each other
    np.testing.assert_allclose(
        beside.move(joints={("j1", "rz"): 0.2}).coordinate("j4", "rz"), 0.2, atol=1e-9
    )
    wrong = beside.move(joints={("j1", "rz"): 0.2, ("j4", "rz"): 0.1})
    assert "contradict one another" in wrong.placement.reason(())
