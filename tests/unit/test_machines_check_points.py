"""Check points on the hemisphere."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.machines import hemisphere_normals, hemisphere_poses, roll_angles


def test_the_lattice_has_the_number_of_points_of_the_paper() -> None:
    """317 check points (Azulay 2014, section 3.3.1): the lattice points of a disc of radius 10."""
    normals = hemisphere_normals()
    assert normals.shape == (317, 3)
    np.testing.assert_allclose((normals**2).sum(-1), 1.0, atol=1e-15)
    assert normals[:, 2].min() >= 0.0
    assert len(np.unique(normals, axis=0)) == 317


def test_rolls_fill_a_third_of_a_turn_without_repeating_it() -> None:
    np.testing.assert_allclose(np.degrees(roll_angles()), np.arange(0.0, 120.0, 5.0))


def test_the_platform_is_tangent_to_the_hemisphere() -> None:
    poses = hemisphere_poses(0.126, radius=4e-3)
    assert poses.batch == (317, 24)
    from_centre = (poses.position - [0.0, 0.0, 0.122]) / 4e-3
    np.testing.assert_allclose(poses.rotation[..., 2], from_centre, atol=1e-12)
    assert poses.position[..., 2].max() == pytest.approx(0.126)


def test_the_roll_turns_about_the_normal() -> None:
    poses = hemisphere_poses(0.126, lattice=2, rolls=4)
    x = poses.rotation[..., 0]
    turned = np.einsum("pri,pri->pr", x[:, :1], x)
    expected = np.broadcast_to(np.cos(roll_angles(4)), turned.shape)
    np.testing.assert_allclose(turned, expected, atol=1e-15)


@pytest.mark.parametrize("wrong", [{"lattice": 0}, {"rolls": 0}])
def test_an_empty_hemisphere_is_an_error(wrong: dict[str, int]) -> None:
    with pytest.raises(ModelError, match="hemisphere"):
        hemisphere_poses(0.126, **wrong)
