"""The undamped eigenproblem: multiplicities, rigid-body modes, motions without mass."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import MechanismError, ModelError
from strutwork.fea.eigen import solve_eigen
from strutwork.fea.reduction import reduce_system
from strutwork.msa import PointMass, system_of
from tests.structure_cases import LIBRARY
from tests.structures import Model, cantilever
from tests.unit.test_fea_reduction import swinging_door
from tests.vibration import BODY, block_on_springs, heavy, oscillators


def eigen(model: Model):  # type: ignore[no-untyped-def]
    reduced = reduce_system(system_of(model.place()))
    return reduced, solve_eigen(reduced)


@pytest.mark.parametrize("name", LIBRARY)
def test_modes_are_orthonormal_in_stiffness_and_diagonal_in_mass(name: str) -> None:
    reduced, found = eigen(heavy(name))
    psi = found.flexibility
    energy = np.swapaxes(psi, -1, -2) @ reduced.stiffness @ psi
    present = np.any(psi, axis=1)
    expected = np.eye(psi.shape[-1]) * present[:, None, :]
    # rounding of the reduced matrices, which joint coordinates condition to about 1e7
    np.testing.assert_allclose(energy, expected, atol=1e-8)
    inertia = np.swapaxes(psi, -1, -2) @ reduced.mass @ psi
    diagonal = found.square[:, None, :] * np.eye(psi.shape[-1])
    assert np.abs(inertia - diagonal).max() <= 1e-9 * found.square.max()
    assert np.all(np.diff(found.square, axis=1) <= 0)


@pytest.mark.parametrize("name", ["floating frame", "hexapod, spinning struts"])
def test_rigid_body_modes_are_orthonormal_in_mass_and_apart_from_the_others(name: str) -> None:
    reduced, found = eigen(heavy(name))
    assert found.rigid.shape[-1] == 6
    gram = np.swapaxes(found.rigid, -1, -2) @ reduced.mass @ found.rigid
    np.testing.assert_allclose(gram, np.broadcast_to(np.eye(6), gram.shape), atol=1e-9)
    cross = np.swapaxes(found.rigid, -1, -2) @ reduced.mass @ found.flexibility
    assert np.abs(cross).max() <= 1e-9 * np.sqrt(found.square.max())


def test_two_masses_on_two_springs() -> None:
    """k, 2k and m, m: ω² = (2 ∓ √2) k/m … of the matrix [[3, −2], [−2, 2]] k/m."""
    _, found = eigen(oscillators((1e4, 3.0), (2e4, 3.0)))
    expected = np.linalg.eigvalsh(np.array([[3.0, -2.0], [-2.0, 2.0]])) * 1e4 / 3.0
    np.testing.assert_allclose(1.0 / found.square[0], expected, rtol=1e-12)


def test_three_equal_springs_keep_three_equal_frequencies() -> None:
    model = block_on_springs(x=5e4, y=5e4, z=5e4, rx=1e3, ry=2e3, rz=1.5e3)
    _, found = eigen(model)
    # 5e4/2 for translations, 1e3/0.01, 2e3/0.02, 1.5e3/0.015 for rotations: two triples
    np.testing.assert_allclose(1.0 / found.square[0], [2.5e4] * 3 + [1e5] * 3, rtol=1e-12)


def test_lumped_rotations_have_no_mass_and_no_frequency() -> None:
    model = cantilever(mass="lumped", elements=4)
    _, found = eigen(model)
    assert found.square.shape == (1, 24)
    assert int(found.finite.sum()) == 12
    assert np.all(np.isinf(found.circular[~found.finite]))


def test_a_free_motion_without_mass_is_an_error_that_names_the_joint() -> None:
    model = oscillators((1e4, 1.0), (0.0, 0.0))
    with pytest.raises(ModelError, match="free motion without mass: joints J2 in z"):
        eigen(model)


def test_no_mass_is_an_error() -> None:
    model = oscillators((1e4, 0.0))
    with pytest.raises(ModelError, match="has no mass"):
        eigen(model)


def test_poses_with_different_numbers_of_rigid_body_modes() -> None:
    _, found = eigen(swinging_door())
    np.testing.assert_array_equal(np.any(found.rigid, axis=1).sum(axis=-1), [1, 0])
    np.testing.assert_array_equal(found.finite.sum(axis=-1), [1, 1])
    # the block on its spring, at either pose
    for pose in (0, 1):
        assert found.circular[pose][found.finite[pose]] == pytest.approx(200.0, rel=1e-12)


def test_a_stiffness_that_is_not_positive_names_the_mechanism() -> None:
    reduced, _ = eigen(oscillators((1e4, 1.0), (2e4, 1.0)))
    broken = type(reduced)(
        reduced.system, reduced.basis, reduced.stiffness * 0.0, reduced.mass, reduced.rigid
    )
    with pytest.raises((MechanismError, ModelError, Exception), match="mechanism"):
        solve_eigen(broken)
    indefinite = type(reduced)(
        reduced.system,
        reduced.basis,
        np.array([[[1.0, 2.0], [2.0, 1.0]]]),
        reduced.mass,
        reduced.rigid,
    )
    with pytest.raises(Exception, match="mechanism"):
        solve_eigen(indefinite)


def test_a_rigid_pendulum_has_only_its_rigid_body_mode() -> None:
    model = Model("bob")
    model.ground(pin=(0, 0, 0))
    model.nodes(bob=(0.5, 0, 0))
    model.joint("hinge", "revolute", ("pin", "heel"))
    model.rigid("arm", "heel", "bob")
    model.masses.append(PointMass("bob", 2.0, BODY))
    reduced, found = eigen(model)
    assert found.rigid.shape == (1, 1, 1)
    assert found.flexibility.shape[-1] == 0
    # 1/√J about the pin: 2·0.5² + 0.015
    assert abs(found.rigid[0, 0, 0]) == pytest.approx(1 / np.sqrt(0.515), rel=1e-12)
    assert reduced.size == 1
