"""Patches tied to nodes: rigid motions, balance of forces, and refusals."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from strutwork.errors import ModelError
from strutwork.fea.interface import Interface, tie
from strutwork.fea.reduce_solid import tied
from strutwork.fea.solid import Solid
from strutwork.meshes import block
from strutwork.msa.materials import Material
from strutwork.msa.structure import rigid_map

STEEL = Material.isotropic(200e9, 0.3, density=7800.0, name="steel")


def square(n: int = 4) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    side = np.linspace(0.0, 0.3, n)
    x, y = np.meshgrid(side, 2 * side)
    points = np.stack([x.ravel(), y.ravel(), np.full(x.size, 0.1)], axis=-1)
    return points, np.arange(len(points)), np.full(len(points), 0.18 / len(points))


@given(st.integers(0, 10_000))
def test_average_reads_rigid_motion_and_spreads_a_balanced_force(seed: int) -> None:
    rng = np.random.default_rng(seed)
    points, nodes, weights = square()
    points = points + 0.02 * rng.standard_normal(points.shape)
    position = tuple(rng.standard_normal(3))
    patch = tie(Interface("n", "p", position), points, nodes, weights)
    motion = rng.standard_normal(6)
    np.testing.assert_allclose(
        patch.average @ (rigid_map(points - position)[:, :3] @ motion).ravel(), motion, atol=1e-10
    )
    # the spread forces have the resultant and the moment of the wrench at the node
    wrench = rng.standard_normal(6)
    forces = (patch.average.T @ wrench).reshape(-1, 3)
    np.testing.assert_allclose(forces.sum(axis=0), wrench[:3], atol=1e-10)
    moment = np.cross(points - position, forces).sum(axis=0)
    np.testing.assert_allclose(moment, wrench[3:], atol=1e-10)


def test_average_weights_by_area() -> None:
    points, nodes, weights = square()
    weights = weights * np.linspace(1.0, 3.0, len(weights))
    patch = tie(Interface("n", "p"), points, nodes, weights)
    np.testing.assert_allclose(patch.position, weights @ points / weights.sum())
    forces = (patch.average.T @ np.array([0.0, 0.0, 1.0, 0, 0, 0])).reshape(-1, 3)
    # a force through the area's middle spreads as the area does
    np.testing.assert_allclose(forces[:, 2], weights / weights.sum(), atol=1e-12)
    np.testing.assert_allclose(forces[:, :2], 0.0, atol=1e-12)


@pytest.mark.parametrize(
    ("nodes", "words"),
    [
        (np.zeros(0, dtype=int), ["interface n", '"p" is empty', "Choose a patch"]),
        (np.arange(4), ["interface n", "on one line", "an area"]),
        (np.array([3]), ["on one line"]),
    ],
)
def test_empty_and_collinear_patches_are_refused(nodes: np.ndarray, words: list[str]) -> None:
    points, _, weights = square()
    with pytest.raises(ModelError) as caught:
        tie(Interface("n", "p"), points, nodes, weights[: len(nodes)])
    for word in words:
        assert word in str(caught.value)


def test_two_interfaces_of_one_name_are_refused() -> None:
    solid = Solid(block((1, 1, 1), (1, 1, 1)), {"solid": STEEL}, order=1)
    with pytest.raises(ModelError, match="interface a: is defined twice"):
        tied(solid, [Interface("a", "-x"), Interface("a", "+x")])


def test_rigid_patches_that_share_a_node_are_refused() -> None:
    solid = Solid(block((1, 1, 1), (1, 1, 1)), {"solid": STEEL}, order=1)
    with pytest.raises(ModelError, match="interface b: shares a mesh node"):
        tied(solid, [Interface("a", "-x", kind="rigid"), Interface("b", "+y", kind="rigid")])


def test_fixed_nodes_on_a_rigid_patch_are_refused() -> None:
    solid = Solid(block((1, 1, 1), (1, 1, 1)), {"solid": STEEL}, order=1)
    with pytest.raises(ModelError, match="has fixed mesh nodes"):
        tied(solid, [Interface("a", "-x", kind="rigid")], fixed=["-y"])


@pytest.mark.parametrize("kind", ["average", "rigid"])
def test_ports_read_rigid_motion(kind: str) -> None:
    solid = Solid(block((0.3, 0.4, 1), (2, 2, 3)), {"solid": STEEL}, order=2)
    whole = tied(solid, [Interface("a", "-z", kind=kind), Interface("b", "+z", kind=kind)])
    assert whole.rigid.shape[1] == 6
    # no energy, and at the ports the rigid motion itself
    energy = np.abs(whole.stiffness @ whole.rigid).max()
    assert energy < 1e-10 * np.abs(whole.stiffness).max()
    moved = (whole.recovery @ whole.rigid).reshape(-1, 3, 6)
    motions = (whole.ports.T @ whole.rigid).reshape(2, 6, 6)
    for patch, motion in zip(whole.patches, motions, strict=True):
        arms = rigid_map(whole.points - patch.position)[:, :3]
        np.testing.assert_allclose(arms @ motion, moved, atol=1e-9)


def test_fixed_dofs_take_rigid_motions_away() -> None:
    mesh = block((0.3, 0.4, 1), (2, 2, 3))
    solid = Solid(mesh, {"solid": STEEL}, order=1)
    assert tied(solid, [Interface("b", "+z")], fixed=["-z"]).rigid.shape[1] == 0
