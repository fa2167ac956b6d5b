"""Geometric stiffness of beams."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea import axial_forces, modes
from strutwork.fea.geometric import geometric_stiffness, local_geometric_stiffness, pulled
from strutwork.msa import rigid_map, rod, solve, system_of
from tests.structures import Model, cantilever, wrench

L = 0.7


def test_the_textbook_matrix() -> None:
    """Przemieniecki 1968, eq. 15.22: 1/(30 L) [36, 3L, −36, 3L; …]."""
    found = local_geometric_stiffness(np.array(L), np.zeros(6))
    expected = np.array(
        [
            [36, 3 * L, -36, 3 * L],
            [3 * L, 4 * L**2, -3 * L, -(L**2)],
            [-36, -3 * L, 36, -3 * L],
            [3 * L, -(L**2), -3 * L, 4 * L**2],
        ]
    ) / (30 * L)
    np.testing.assert_allclose(found[np.ix_((1, 5, 7, 11), (1, 5, 7, 11))], expected, atol=1e-14)
    sign = np.outer((1, -1, 1, -1), (1, -1, 1, -1))
    np.testing.assert_allclose(
        found[np.ix_((2, 4, 8, 10), (2, 4, 8, 10))], expected * sign, atol=1e-14
    )
    assert not np.any(found[[0, 3, 6, 9]])


@pytest.mark.parametrize("phi", [0.0, 0.5, 1e8])
def test_a_rigid_turn_lifts_the_load_by_half_the_square(phi: float) -> None:
    """N L θ²/2 of work for any shear flexibility; moving along costs nothing."""
    found = local_geometric_stiffness(np.array(L), np.array([1, 1, 1, 1, phi * L**2, phi * L**2]))
    motion = np.concatenate([rigid_map(np.zeros(3)), rigid_map(np.array([L, 0, 0]))])
    work = motion.T @ found @ motion
    np.testing.assert_allclose(work, np.diag([0, 0, 0, 0, L, L]), atol=1e-12)


def test_axial_forces_of_a_pulled_frame() -> None:
    model = Model("tip")
    model.nodes(a=(0, 0, 0), tip=(0.5, 0, 0), c=(0.5, 0.4, 0))
    model.beam("pulled", "a", "tip", rod(0.02), elements=3)
    model.beam("idle", "tip", "c", rod(0.02), elements=2)
    model.support("a")
    solution = solve(model.place(), [wrench("pull", "tip", 900.0), wrench("push", "c", -1.0)])
    np.testing.assert_allclose(axial_forces(solution, "pull"), [900.0] * 3 + [0.0] * 2, atol=1e-8)
    np.testing.assert_allclose(axial_forces(solution, "push")[:3], -1.0)
    with pytest.raises(ModelError, match='no case "lift"'):
        axial_forces(solution, "lift")


def test_offset_ends_carry_the_force_where_the_beam_is() -> None:
    shift = (0.0, 0.1, 0.0)
    straight = cantilever(rod(0.02), elements=2)
    moved = Model("tip")
    moved.nodes(root=(0, -0.1, 0), tip=(0.6, -0.1, 0))
    moved.beam("beam", "root", "tip", rod(0.02), elements=2, offsets=(shift, shift))
    moved.support("root")
    axial = np.array([500.0, 500.0])
    one = geometric_stiffness(system_of(pulled(straight.place(), axial)))
    other = geometric_stiffness(system_of(pulled(moved.place(), axial)))
    assert np.any(one)
    carry = np.eye(18)
    for i, arm in enumerate((shift, shift, (0.0, 0.0, 0.0))):
        carry[6 * i : 6 * i + 6, 6 * i : 6 * i + 6] = rigid_map(np.array(arm))
    np.testing.assert_allclose(other[0], carry.T @ one[0] @ carry, atol=1e-9)


def test_a_batch_of_preloads() -> None:
    model = cantilever(rod(0.02), elements=3)
    model.positions["tip"] = np.array([[0.5, 0, 0], [0.5, 0, 0]])
    placed = model.place()
    found = modes(placed, 1, preload=np.array([[0.0] * 3, [2000.0] * 3])).frequencies[:, 0]
    assert found[0] == pytest.approx(modes(placed, 1).frequencies[0, 0], rel=1e-12)
    assert found[1] > found[0] * 1.01


def test_bad_preloads() -> None:
    placed = cantilever(elements=3).place()
    with pytest.raises(ModelError, match="2 axial forces for 3 beam elements"):
        modes(placed, 1, preload=np.zeros(2))
    with pytest.raises(ModelError, match="preload: is not finite"):
        modes(placed, 1, preload=np.array([0.0, np.nan, 0.0]))
