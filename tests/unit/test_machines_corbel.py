"""The linear Delta and the measuring Gough platform against their formulas, written out here."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import Poses, check_coincidence, jacobians, rotation_x
from strutwork.kinematics.mobility import mobility
from strutwork.machines import GoughPlatform, LinearDelta, check_limits

Array = NDArray[np.float64]


def inside(machine: LinearDelta | GoughPlatform, count: int = 40) -> Array:
    """Places in the machine's cube about home."""
    half = machine.workspace_side / 2.0
    shift = np.random.default_rng(8).uniform(-half, half, (count, 3))
    return np.asarray(machine.home().position + shift)


def delta_rods(machine: LinearDelta, place: Array) -> tuple[Array, Array]:
    """a_i (..., 3, 2) and h_i (..., 3): eq. 3 row by row."""
    r, x, y = machine.reach, place[..., 0], place[..., 1]
    a = np.stack(
        [
            np.stack([x + r * np.sqrt(3) / 2, y + r / 2], -1),
            np.stack([x, y - r], -1),
            np.stack([x - r * np.sqrt(3) / 2, y + r / 2], -1),
        ],
        -2,
    )
    return a, np.sqrt(machine.rod_length**2 - (a**2).sum(-1))


def test_the_deltas_carriages_and_rods() -> None:
    """1e-12 m: sums of a few numbers below 1 m."""
    machine = LinearDelta()
    place = inside(machine)
    placement = machine.place(Poses.of(place))
    assert placement.reachable.all()
    check_coincidence(machine.linkage, placement)
    _, h = delta_rods(machine, place)
    column = [placement.names.index((f"leg{i}/slide", "z")) for i in (1, 2, 3)]
    np.testing.assert_allclose(placement.values[:, column], place[:, 2:] - h, atol=1e-12)
    index = machine.linkage.node_index
    for i in (1, 2, 3):
        ends = [[index[f"leg{i}/{part}-{s}"] for s in "ab"] for part in ("root", "end")]
        root, end = (placement.positions[:, e] for e in ends)
        np.testing.assert_allclose(
            np.linalg.norm(end - root, axis=-1), machine.rod_length, atol=1e-12
        )
        apart = np.linalg.norm(root[:, 1] - root[:, 0], axis=-1)
        np.testing.assert_allclose(apart, machine.rod_spacing, atol=1e-12)


def test_the_deltas_jacobian_is_that_of_its_paper() -> None:
    """Rows (a_i/h_i, 1) on translations: 1e-10, of rows eliminated by QR at 1e-15."""
    machine = LinearDelta()
    place = inside(machine)
    found = jacobians(machine.linkage, machine.place(Poses.of(place)))
    a, h = delta_rods(machine, place)
    rows = np.concatenate([a / h[..., None], np.ones((*h.shape, 1))], -1)
    np.testing.assert_allclose(found.inverse[..., :3], rows, atol=1e-10)
    np.testing.assert_allclose(found.inverse[..., 3:], 0.0, atol=1e-10)


def test_the_delta_moves_without_turning_and_nothing_is_held_twice() -> None:
    machine = LinearDelta()
    found = mobility(machine.linkage, machine.place(machine.home()))
    assert (found.mobility, found.redundant) == (3, 0)
    turned = Poses.of(np.zeros((2, 3)), np.stack([np.eye(3), rotation_x(1e-3)]))
    placement = machine.place(turned)
    assert placement.reachable.tolist() == [True, False]
    assert "rotated" in placement.reason(1)


def test_the_stroke_is_what_the_cube_needs() -> None:
    """Largest and least of the carriages over a fine grid: no more than its step away, 1e-4 m."""
    machine = LinearDelta()
    half = machine.workspace_side / 2.0
    line = np.linspace(-half, half, 101)
    grid = np.stack(np.meshgrid(line, line, [-half, half], indexing="ij"), -1).reshape(-1, 3)
    _, h = delta_rods(machine, grid)
    q = grid[:, 2:] - h
    assert (q.min(), q.max()) == pytest.approx(machine.stroke, abs=1e-4)
    assert check_limits(machine.limits, machine.place(Poses.of(grid))).reachable.all()


def test_places_that_the_rods_do_not_reach_are_named() -> None:
    machine = LinearDelta()
    placement = machine.place(Poses.of([[0.0, 0.0, 0.0], [0.0, -0.4, 0.0]]))
    assert placement.reachable.tolist() == [True, False]
    assert placement.reason(1) == "leg 2: its rods are too short"
    assert np.all(np.isfinite(placement.positions))


def test_the_platforms_legs() -> None:
    machine = GoughPlatform(tool=(0.01, -0.02, 0.1))
    shift = np.random.default_rng(4).uniform(-0.1, 0.1, (20, 6))
    poses = machine.home().moved(shift)
    placement = machine.place(poses)
    check_coincidence(machine.linkage, placement)
    # angles of Table II about lines at 0, 120, 240 deg and 60, 180, 300 deg, written out
    base = np.radians([-3.0, 3.0, 117.0, 123.0, 237.0, 243.0])
    plate = np.radians([320.0, 40.0, 80.0, 160.0, 200.0, 280.0])
    feet = 0.375 * np.stack([np.cos(base), np.sin(base), 0.0 * base], -1)
    seats = 0.075 * np.stack([np.cos(plate), np.sin(plate), 0.0 * plate], -1)
    arms = np.einsum("pij,kj->pki", poses.rotation, seats - np.array(machine.tool))
    span = poses.position[:, None] + arms - feet
    length = np.linalg.norm(span, axis=-1)
    column = [placement.names.index((f"leg{i}/ram", "z")) for i in range(1, 7)]
    np.testing.assert_allclose(placement.values[:, column], length, atol=1e-12)
    u = span / length[..., None]
    rows = np.concatenate([u, np.cross(arms, u)], -1)
    found = jacobians(machine.linkage, placement)
    np.testing.assert_allclose(found.inverse, rows, atol=1e-10)
    assert mobility(machine.linkage, placement[0]).mobility == 6


def test_the_platform_reaches_its_cube_within_its_leg_range() -> None:
    machine = GoughPlatform()
    half = machine.workspace_side / 2.0
    corners = np.stack(np.meshgrid(*[[-half, half]] * 3, indexing="ij"), -1).reshape(-1, 3)
    place = np.concatenate([inside(machine), corners + machine.home().position])
    placement = check_limits(machine.limits, machine.place(machine.at_plate(place)))
    assert placement.reachable.all()
    low = check_limits(machine.limits, machine.place(machine.at_plate(np.array([0.0, 0.0, 0.5]))))
    assert not low.reachable
    behind = machine.place(machine.at_plate(np.array([0.0, 0.0, -0.8])))
    assert "not above" in behind.reason(())


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"base_radius": 0.05}, "not larger than the platform's radius"),
        ({"rod_length": 0.5}, "too short for rails"),
        ({"rod_spacing": -1.0}, "rod_spacing(.|\n)*positive"),
        ({"drive_stiffness": 0.0}, "drive_stiffness(.|\n)*rigid"),
        ({"platform_mass": 0.0}, "platform_mass(.|\n)*positive"),
    ],
)
def test_a_delta_that_cannot_be(change: dict[str, float], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        LinearDelta(**change)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"plate_height": 0.2}, "shorter than its cylinder"),
        ({"plate_pair": 40.0}, "between 0 and 120 degrees"),
        ({"cylinder_length": 0.7}, "do not fit"),
        ({"longest_leg": 0.6}, "do not fit"),
        ({"plate_mass": float("nan")}, "plate_mass(.|\n)*positive"),
    ],
)
def test_a_platform_that_cannot_be(change: dict[str, float], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        replace(GoughPlatform(), **change)
