"""Inverse kinematics leg by leg beside the walk over all bodies: places, coordinates, ends."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.kinematics import Poses
from strutwork.kinematics.leg_turns import rotation_log, turn_by_vector
from strutwork.kinematics.motion import Motion
from strutwork.machines.load import load
from tests.legs import (
    arm,
    around,
    platform_with_balls_below,
    three_universal_legs,
    walked,
)
from tests.linkages import gough, open_chain, slider_crank

Array = NDArray[Any]

ROOT = Path(__file__).resolve().parents[2]

#: Two solutions of the same equations by Newton's method, both closed to 1e-11 of the machine's
#: size, whose rates near a singularity grow to some tens.
SAME = 1e-9
#: Ways end where steps of 1e-6 of the way no longer hold: the two may part by a few of these.
PARTED = 1e-5

#: Name, and how far poses lie from home, m and rad: near, far, and out of reach.
MACHINES = {
    "hexel-hexapod": ((0.05, 0.3), (0.5, 0.9)),
    "proposed-3pprs": ((0.01, 0.2), (0.1, 0.6), (0.3, 1.5)),
    "eclipse-3pprs": ((0.01, 0.2), (0.1, 0.6), (0.3, 1.5)),
    "alizade-3prps": ((0.01, 0.2), (0.1, 0.6), (0.3, 1.5)),
    "glozman-3prrs": ((0.01, 0.2), (0.1, 0.6), (0.3, 1.5)),
}

LINKAGES: dict[str, tuple[Callable[[], Motion], float, float]] = {
    "gough": (lambda: of(gough()), 0.1, 0.3),
    "balls below": (platform_with_balls_below, 0.05, 0.15),
    "arm": (arm, 0.04, 0.1),
    "arm, joints named backward": (lambda: arm(backward=True), 0.04, 0.1),
    "two universal joints a leg": (three_universal_legs, 0.04, 0.1),
}

CASES = ROOT / "tests/cases/models"
FILES = [
    *(
        f
        for f in sorted((ROOT / "examples").rglob("*.toml"))
        if f.parent.name not in ("studies", "errors", "calibration", "servos")
    ),
    *(
        CASES / f"{n}.toml"
        for n in ("f1_three_axis_rigid_slides", "f1b_rotary_table", "skew_guide")
    ),
]

#: Those whose legs each have six freedoms.
WITH_LEGS = ("6-ups",)


def of(machine: Any) -> Motion:
    home = machine.home()
    return Motion(machine.linkage, machine.place(home), home.rotation)


def whole_turns(motion: Motion, difference: Array) -> Array:
    """Differences of coordinates; the turns of a ball are a vector that may be counted otherwise.

    Where it grows beyond π its components jump, by how the steps fall.
    """
    held = motion.joints.held[:, 3:]
    names = [j.name for j in motion.linkage.joints]
    ball = np.array(
        [d.startswith("r") and not held[names.index(j)].any() for j, d in motion.joints.names]
    )
    return np.where(ball, np.angle(np.exp(1j * difference)), difference)


def agree(motion: Motion, poses: Poses) -> Array:
    """Hold poses leg by leg beside the walk over all bodies; which were reached."""
    assert motion.legs is not None
    legs, rows = motion.move(tool=poses), walked(motion, poses)
    np.testing.assert_array_equal(legs.reached, rows.reached)
    good = legs.reached
    for one, other in (
        (legs.placement.positions, rows.placement.positions),
        (legs.placement.frames, rows.placement.frames),
        (legs.placement.turns, rows.placement.turns),
    ):
        assert one is not None
        assert other is not None
        assert np.abs(one[good] - other[good]).max(initial=0.0) < SAME
    gap = whole_turns(motion, legs.placement.values[good] - rows.placement.values[good])
    assert np.abs(gap).max(initial=0.0) < SAME
    assert np.abs(legs.share - rows.share).max(initial=0.0) < PARTED
    assert legs.error.max(initial=0.0) < SAME
    for k in np.flatnonzero(~good):
        kind = rows.placement.reason(int(k))[:12]
        assert legs.placement.reason(int(k)).startswith(kind)
    return np.asarray(good)


@pytest.mark.parametrize("name", MACHINES)
def test_machines(name: str) -> None:
    motion = load(name).motion
    ends = []
    for k, (shift, turn) in enumerate(MACHINES[name]):
        ends.append(agree(motion, around(motion, 12, shift, turn, k)))
    assert ends[0].mean() > 0.9
    if name in ("proposed-3pprs", "glozman-3prrs"):
        # poses that are out of reach are among them
        assert not ends[-1].all()


@pytest.mark.parametrize("name", LINKAGES)
def test_linkages(name: str) -> None:
    make, shift, turn = LINKAGES[name]
    motion = make()
    # further off the walk over all bodies of joints with crossed axes takes thousands of steps
    assert agree(motion, around(motion, 12, shift, turn, 1)).mean() > 0.5


@pytest.mark.parametrize("file", FILES, ids=lambda f: f.stem)
@pytest.mark.filterwarnings("ignore::UserWarning")
def test_only_legs_of_six_freedoms_go_by_themselves(file: Path) -> None:
    assert (load(file).motion.legs is not None) == (file.stem in WITH_LEGS)


@pytest.mark.parametrize("name", WITH_LEGS)
def test_model_files(name: str) -> None:
    """Poses that the tool can have, and others."""
    motion = load(ROOT / f"examples/machines/{name}.toml").motion
    assert motion.legs is not None
    random = np.random.default_rng(3)
    size = motion.legs.length
    home = motion.rest()
    task = {
        d: value + random.uniform(-0.05, 0.05, 8) * (1.0 if d.startswith("r") else size)
        for d, value in home.items()
    }
    if task:
        there = motion.move(task=task)
        assert there.reached.any()
        assert there.tool is not None
        good = agree(motion, there.tool[there.reached])
        assert good.all()
    agree(motion, around(motion, 4, 0.05 * size, 0.1, 4))


def test_planar_legs_go_with_all_joints_and_refuse_what_leaves_the_plane() -> None:
    linkage, home = slider_crank(0.7)
    motion = Motion(linkage, home)
    assert motion.legs is None
    start = motion.home_pose
    poses = Poses.of(start.position + np.array([[0.02, 0, 0], [0.02, 0, 1e-4]]), start.rotation)
    found = motion.move(tool=poses)
    assert not found.reached[1]
    assert "contradict one another or the joints" in found.placement.reason(1)


def test_the_leg_that_ends_the_way_is_named_and_the_others_stop_with_it() -> None:
    motion = load("glozman-3prrs").motion
    start = motion.home_pose
    poses = Poses.of(start.position + np.array([[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]]), start.rotation)
    found = motion.move(tool=poses)
    assert found.reached.tolist() == [True, False]
    reason = found.placement.reason(1)
    assert reason.startswith("out of reach: on the path the leg of leg")
    share = float(found.share[1])
    assert 0.0 < share < 1.0
    assert found.tool is not None
    # all bodies stand where the way ended
    np.testing.assert_allclose(
        found.tool.position[1], start.position + share * np.array([0.5, 0.0, 0.0]), atol=1e-12
    )
    assert found.error[1] < SAME
    nodes = motion.joints.nodes
    gaps = found.placement.positions[1, nodes[:, 0]] - found.placement.positions[1, nodes[:, 1]]
    assert np.abs(gaps[~motion.joints.sliding]).max() < SAME


def test_redundant_legs_and_closed_loops_in_legs_are_walked_together() -> None:
    machines = (load("prototype-3ppprs"), load("mit-ss1"))
    for motion in (*(m.motion for m in machines), of(gough("spherical"))):
        assert motion.legs is None
        assert motion.move(tool=motion.home_pose).reached.all()
    # three hinges of which the second stands on the first: no regular leg to start from
    linkage, placement = open_chain([[0, 0, 0], [0, 0, 1], [1, 0, 1]], [[0, 0, 1.0]] * 3)
    assert Motion(linkage, placement).legs is None


def test_a_pose_alone_has_the_digits_that_it_has_among_others() -> None:
    motion = load("hexel-hexapod").motion
    poses = around(motion, 5, 0.1, 0.4, 5)
    together = motion.move(tool=poses).placement
    for k in range(5):
        alone = motion.move(tool=poses[k]).placement
        np.testing.assert_array_equal(alone.positions, together.positions[k])
        np.testing.assert_array_equal(alone.values, together.values[k])


def test_compiled_rotations_beside_scipy() -> None:
    random = np.random.default_rng(6)
    vectors = random.normal(size=(200, 3))
    sizes = np.concatenate([np.logspace(-14, 0, 100), np.pi - np.logspace(-9, 0, 100)])
    vectors *= (sizes / np.linalg.norm(vectors, axis=1))[:, None]
    for vector in vectors:
        wanted = Rotation.from_rotvec(vector).as_matrix()
        matrix = np.eye(3)
        turn_by_vector(matrix, *vector)
        np.testing.assert_allclose(matrix, wanted, atol=4e-16)
        found = np.zeros(3)
        rotation_log(wanted, found, 0)
        # the matrix itself is rounded, and near π its vector turns by the rounding
        np.testing.assert_allclose(found, vector, atol=1e-14)
