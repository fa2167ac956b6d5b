"""Stiffness and mass on independent coordinates."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.reduction import Reduced, reduce_system
from strutwork.kinematics import mobility
from strutwork.msa import PointMass, Spring, system_of
from tests.structure_cases import LIBRARY
from tests.structures import Model, cantilever
from tests.vibration import BODY, heavy

Array = NDArray[Any]


def reduced(model: Model) -> Reduced:
    return reduce_system(system_of(model.place()))


@pytest.mark.parametrize("name", LIBRARY)
def test_coordinates_meet_every_constraint(name: str) -> None:
    found = reduced(heavy(name))
    system = found.system
    free = found.basis / np.maximum(np.abs(found.basis).max(axis=(1, 2), keepdims=True), 1e-300)
    # rounding of products of lengths near one
    assert np.abs(system.rows @ free).max(initial=0.0) < 1e-10
    # as many coordinates as unknowns less independent rows
    rank = np.linalg.matrix_rank(system.rows, tol=1e-8) if system.rows.shape[1] else 0
    present = np.any(found.basis, axis=1).sum(axis=-1)
    np.testing.assert_array_equal(present, system.topology.size - rank)


@pytest.mark.parametrize("name", LIBRARY)
def test_rigid_motions_cost_no_energy_and_are_as_many_as_the_kinematics_says(name: str) -> None:
    model = heavy(name)
    found = reduced(model)
    energy = np.einsum("pck,pcd,pdk->pk", found.rigid, found.stiffness, found.rigid)
    size = np.einsum("pcc->p", found.stiffness)[:, None] * np.abs(found.rigid).max(initial=0.0) ** 2
    assert np.abs(energy).max(initial=0.0) <= 1e-9 * size.max(initial=1.0)
    placed = model.place()
    first = placed.placement[(0,) * len(placed.batch)]
    count = mobility(placed.structure.linkage, first).mobility_locked
    if not placed.structure.springs:
        assert found.rigid_count[0] == count
    np.testing.assert_array_equal(
        found.rigid_count, np.linalg.matrix_rank(found.rigid, tol=1e-9) if count else 0
    )


def swinging_door() -> Model:
    """A door whose hinges share an axis at the first pose and not at the second.

    Beside it a block slides on a spring, so that neither pose is without a coordinate.
    """
    model = Model("handle")
    second = np.array([[0.0, 0, 1], [0.3, 0, 1]])
    model.ground(low=(0, 0, 0), high=(0, 0, 2), rail=(3, 0, 0))
    model.nodes(handle=(0.9, 0, 1), block=(3, 0, 0))
    model.joint("lower", "revolute", ("low", "d0"))
    model.joint("upper", "revolute", ("high", "d1"))
    axis = second / np.linalg.norm(second, axis=1, keepdims=True)
    side = np.cross([0.0, 1.0, 0.0], axis)
    model.axes["upper"] = np.stack([side, np.cross(axis, side), axis], axis=-1)
    model.rigid("door", "d0", "d1", "handle")
    model.joint("slide", "prismatic", ("rail", "block"), (1, 0, 0), stiffness={"z": 4e4})
    model.masses += [PointMass("handle", 12.0, BODY), PointMass("block", 1.0)]
    return model


def test_poses_may_have_different_numbers_of_coordinates() -> None:
    found = reduced(swinging_door())
    np.testing.assert_array_equal(np.any(found.basis, axis=1).sum(axis=-1), [2, 1])
    np.testing.assert_array_equal(found.rigid_count, [1, 0])
    absent = ~np.any(found.basis, axis=1)
    np.testing.assert_array_equal(absent.sum(axis=-1), [0, 1])
    # it has a stiffness and no mass, so no frequency
    assert np.all(np.einsum("pcc->pc", found.stiffness)[absent] > 0)
    assert np.all(np.einsum("pcc->pc", found.mass)[absent] == 0)


def test_a_node_moves_as_its_cluster_carries_it() -> None:
    model = Model("a")
    model.nodes(a=(0, 0, 0), b=(0.2, 0.1, 0))
    model.rigid("body", "a", "b")
    model.springs.append(Spring("bed", ("a",), {"x": 1.0}))
    found = reduced(model)
    moved = found.at_node("b") - found.at_node("a")
    turn = found.at_node("a")[0, 3:]
    expected = np.cross(turn.T, [0.2, 0.1, 0.0]).T
    np.testing.assert_allclose(moved[0, :3], expected, atol=1e-14)
    np.testing.assert_allclose(moved[0, 3:], 0.0, atol=1e-14)


def test_a_ground_node_does_not_move() -> None:
    found = reduced(heavy("hexapod"))
    assert not np.any(found.at_node("base0"))
    with pytest.raises(ModelError, match="not in the structure"):
        found.at_node("nowhere")


def test_everything_locked_is_an_error() -> None:
    model = cantilever()
    model.support("tip")
    with pytest.raises(ModelError, match="has no degree of freedom: every direction is locked"):
        reduced(model)
    closed = Model("handle")
    closed.ground(low=(0, 0, 0), high=(0, 0, 2))
    closed.nodes(handle=(1, 0, 0))
    closed.joint("lower", "revolute", ("low", "d0"))
    closed.joint("upper", "revolute", ("high", "d1"), (1, 0, 0))
    closed.rigid("door", "d0", "d1", "handle")
    with pytest.raises(ModelError, match="has no degree of freedom"):
        reduced(closed)
