"""Sixteen ways to put a platform on three circles, and ways from many starts."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import Poses, drive_values, forward_kinematics, jacobians
from strutwork.kinematics.assembly_modes import assembly_modes
from strutwork.kinematics.branches import branches
from strutwork.kinematics.circle_kernel import ROOTS, circle_ways
from strutwork.kinematics.frames import rotation_x
from strutwork.kinematics.platform_circles import platform_circles
from strutwork.machines import Eclipse3PPRS
from strutwork.machines.load import load
from strutwork.machines.model import Model

Array = NDArray[Any]

EXAMPLES = Path(__file__).parents[2] / "examples" / "machines"

ON_CIRCLES = (
    "proposed-3pprs",
    "eclipse-3pprs",
    "alizade-3prps",
    "glozman-3prrs",
    "prototype-3ppprs",
    "hexel-hexapod",
)


def machine(name: str) -> Model:
    file = EXAMPLES / f"{name}.toml"
    return load(file if file.exists() else name)


def ways_of(circles: Array) -> tuple[Array, Array, Array, Array]:
    n = len(circles)
    ways = np.empty((n, ROOTS, 3), dtype=complex)
    real, count, others = np.zeros(n, dtype=np.intp), np.zeros(n, dtype=np.intp), np.zeros(n)
    circle_ways(circles, ways, real, count, others)
    return ways, real, count, others


def eclipse(count: int, rise: float, base: tuple[float, float]) -> Array:
    """Columns on a guide: centres, directions, radii and distances of `circle_ways`."""
    random = np.random.default_rng(5)
    angle = 2 * np.pi * np.arange(3) / 3 + random.uniform(-0.3, 0.3, (count, 3))
    out = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=-1)
    up = np.broadcast_to([0.0, 0.0, 1.0], out.shape)
    centre = random.uniform(*base, (count, 3, 1)) * out
    centre = centre + random.uniform(0, rise, (count, 3, 1)) * up
    length = np.full((count, 1, 3), 0.3121)
    apart = np.full((count, 1, 3), np.sqrt(3) * 0.080)
    return np.concatenate([centre, -out, up, length, apart], axis=1)


def gaps(circles: Array, ways: Array) -> Array:
    """What every distance leaves, of a complex way, over the distance's square."""
    cos, sin = 0.5 * (ways + 1 / ways), -0.5j * (ways - 1 / ways)
    first, second = circles[:, None, 3:6], circles[:, None, 6:9]
    arm = circles[:, None, 9, :, None] * (cos[..., None] * first + sin[..., None] * second)
    points = circles[:, None, :3] + arm
    pairs = ((0, 1), (0, 2), (1, 2))
    left = [((points[:, :, i] - points[:, :, j]) ** 2).sum(-1) for i, j in pairs]
    # complex ways lie far out: their terms, not the distance, set the size of rounding
    size = np.abs(points).max(axis=(-1, -2))[..., None] ** 2
    return np.abs(np.stack(left, -1) - circles[:, None, 10] ** 2) / size


def test_generic_poses_have_sixteen_ways() -> None:
    circles = eclipse(800, 0.1, (0.275, 0.275))
    ways, real, count, others = ways_of(circles)
    assert (count == 16).all()
    # of the Fourier series only degrees −8 to 8 are there
    assert others.max() < 1e-13
    assert gaps(circles, ways).max() < 1e-11
    # complex ones come in pairs
    assert (real % 2 == 0).all()
    conjugate = 1 / np.conj(ways)
    for k in range(50):
        apart = np.abs(ways[k][:, None] / conjugate[k] - 1).max(axis=-1)
        assert apart.min(axis=1).max() < 1e-7


def test_ways_come_in_mirror_pairs_where_all_centres_lie_in_the_plane() -> None:
    circles = eclipse(400, 0.0, (0.2, 0.3))
    ways, _, count, _ = ways_of(circles)
    # some are nearly double: of 400 at least 94 % have all
    assert np.mean(count == 16) >= 0.94
    for k in np.flatnonzero(count == 16)[:50]:
        apart = np.abs(ways[k][:, None] * ways[k] - 1).max(axis=-1)
        assert apart.min(axis=1).max() < 1e-6


@pytest.mark.parametrize("name", ON_CIRCLES)
def test_the_start_is_among_them(name: str) -> None:
    """Of random poses, on circles whose angles do not count from where the machine stands."""
    model = machine(name)
    home = model.motion.home_pose
    random = np.random.default_rng(2)
    count = 40
    place = home.position + 0.01 * random.uniform(-1, 1, (count, 3))
    turn = rotation_x(random.uniform(-0.2, 0.2, count)) @ home.rotation
    assert model.closed_form is not None
    placement = model.closed_form(Poses(place, turn))
    placement = placement[np.flatnonzero(placement.reachable)]
    turn = turn[: len(placement.positions)]
    found = platform_circles(model.structure.linkage, placement)
    assert not isinstance(found, str)
    start = random.uniform(-np.pi, np.pi, found.radius.shape)
    c, s = np.cos(start)[..., None], np.sin(start)[..., None]
    rows = (
        found.centre,
        c * found.first - s * found.second,
        s * found.first + c * found.second,
        found.radius[:, None],
        found.distances[:, None],
    )
    ways, real, _, _ = ways_of(np.ascontiguousarray(np.concatenate(rows, axis=1)))
    apart = np.abs(ways / np.exp(1j * start)[:, None] - 1).max(axis=-1)
    # rounding times the condition of the nearest singular pose; 3e-14 is usual
    assert np.nanmin(apart, axis=1).max() < 1e-12
    assert real.min() >= 2


@pytest.mark.parametrize("name", [*ON_CIRCLES, "3-rps"])
def test_modes_at_home(name: str) -> None:
    """Equal legs at home share angles, and all sixteen are found; home is where it stands."""
    model = machine(name)
    modes = assembly_modes(model.structure.linkage, model.placement, model.rotation)
    assert int(modes.count) == 16
    pose = modes.poses()
    home = model.motion.home_pose
    np.testing.assert_allclose(pose.position[modes.home], home.position, atol=1e-12)
    np.testing.assert_allclose(pose.rotation[modes.home], home.rotation, atol=1e-12)
    distances = modes.circles.distances
    points = modes.points[: int(modes.real)]
    for row, (i, j) in enumerate(((0, 1), (0, 2), (1, 2))):
        apart = np.linalg.norm(points[:, i] - points[:, j], axis=-1)
        np.testing.assert_allclose(apart, distances[row], rtol=1e-11)


def test_every_mode_has_the_drives_of_the_machine() -> None:
    """By the machine's own inverse kinematics, where that reaches: links above the guide."""
    model = machine("proposed-3pprs")
    modes = assembly_modes(model.structure.linkage, model.placement, model.rotation)
    above = (modes.points[: int(modes.real), :, 2] > 0).all(axis=1)
    # kinematics of these machines: all joints above the guide at L = 216, pole 126 mm
    assert above.sum() == 8
    assert model.closed_form is not None
    placed = model.closed_form(modes.poses())
    driven = [placed.names.index(pair) for pair in model.structure.linkage.driven]
    home = model.placement.values[driven]
    good = above & placed.reachable
    assert good.sum() >= 2
    values = placed.values[good][:, driven]
    apart = np.where(
        [d.startswith("r") for _, d in model.structure.linkage.driven],
        np.angle(np.exp(1j * (values - home))),
        values - home,
    )
    # in the others a carriage's own formulas put it on the opposite side of the guide
    same = np.abs(apart).max(axis=1) < 1e-11
    assert same.sum() >= 4
    turns = np.abs(apart[~same]).max(axis=1)
    np.testing.assert_allclose(turns, np.pi, rtol=1e-9)


def test_between_modes_the_sense_of_the_jacobian_changes() -> None:
    """Half of the modes above the guide lie on the other side of a type 2 singularity."""
    model = machine("proposed-3pprs")
    modes = assembly_modes(model.structure.linkage, model.placement, model.rotation)
    assert model.closed_form is not None
    placed = model.closed_form(modes.poses())
    good = np.flatnonzero(placed.reachable)
    sign = np.linalg.slogdet(jacobians(model.structure.linkage, placed[good]).inverse)[0]
    assert {-1.0, 1.0} == set(np.sign(sign))


def test_which_mode_forward_kinematics_returned() -> None:
    """Followed from home to other drives, and back among all modes there."""
    eclipse3 = Eclipse3PPRS()
    home = eclipse3.home()
    goal = home.moved(np.array([[0.004, -0.003, 0.005, 0.1, 0.05, -0.05], [0.0] * 6]))
    placement = eclipse3.place(goal)
    drives = drive_values(eclipse3, placement)
    found = forward_kinematics(eclipse3, drives, home)
    modes = assembly_modes(eclipse3.linkage, placement, goal.rotation)
    np.testing.assert_array_equal(modes.which(found), modes.home)
    # every mode is itself, and a pose of other drives is none
    for k in range(int(modes.real.min())):
        itself = Poses(modes.position[:, k], modes.rotation[:, k])
        np.testing.assert_array_equal(modes.which(itself), [k, k])
    aside = found.moved(np.array([1e-4, 0.0, 0.0, 0.0, 0.0, 0.0]))
    np.testing.assert_array_equal(modes.which(aside), [-1, -1])


def test_many_starts_find_what_the_elimination_finds() -> None:
    model = machine("3-rps")
    every = assembly_modes(model.structure.linkage, model.placement, model.rotation)
    motion = model.motion
    drives = {
        pair: float(motion.home_values[motion.joints.names.index(pair)])
        for pair in motion.linkage.driven
    }
    found = branches(motion, joints=drives, starts=100)
    assert found.tool is not None
    assert len(found) == int(every.real) == 16
    apart = np.linalg.norm(found.tool.position[:, None] - every.poses().position, axis=-1)
    # each is one of them, and no two are the same
    assert apart.min(axis=1).max() < 1e-8
    assert len(set(apart.argmin(axis=1).tolist())) == 16
    assert not found.moves
    assert found.error.max() < 1e-11


@pytest.mark.parametrize(("name", "ways"), [("planar-3-rrr", 8), ("mit-ss1", 8), ("3-rps", 8)])
def test_working_modes(name: str, ways: int) -> None:
    """Two a leg of a planar machine with three (Son 2002, eq. 45: the sign of each root)."""
    motion = machine(name).motion
    found = branches(motion, tool=motion.home_pose, starts=100)
    assert len(found) == ways
    assert found.tool is not None
    np.testing.assert_allclose(
        found.tool.position, np.broadcast_to(motion.home_pose.position, (ways, 3)), atol=1e-9
    )


def test_a_serial_machine_has_one_working_mode() -> None:
    motion = machine("gantry").motion
    assert len(branches(motion, tool=motion.home_pose, starts=40)) == 1


def test_why_there_are_no_circles() -> None:
    for name, words in (
        ("6-ups", "hangs on 6 balls"),
        ("linear-delta", "does not split into legs"),
        ("planar-3-rrr", "does not end in a ball"),
    ):
        model = machine(name)
        with pytest.raises(ModelError, match=words):
            assembly_modes(model.structure.linkage, model.placement)


def test_several_targets_are_refused() -> None:
    motion = machine("3-rps").motion
    with pytest.raises(ModelError, match="2 targets"):
        branches(motion, task={"z": np.array([0.6, 0.7])})
