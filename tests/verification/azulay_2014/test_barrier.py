"""The ring of type 2 singularities on the hemisphere of 4 mm, section 3.2 and Fig. 4.

@article{azulay2014comparative,
  author  = {Azulay, Hay and Mahmoodi, Masih and Zhao, Ray and Mills, James K.
             and Benhabib, Beno},
  title   = {Comparative analysis of a new {3xPPRS} parallel kinematic mechanism},
  journal = {Robotics and Computer-Integrated Manufacturing},
  volume  = {30},
  year    = {2014}
}

The signed function s is derived from the circles on which the platform's joints run once the
drives stand; the determinant of the general Jacobian is what it is compared with. Fig. 4 shows
the ring of the proposed machine "at about r = 2 mm"; the others are not printed, and their
values here are regressions of ours to the last digit given.
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.kinematics import Poses, jacobians
from strutwork.machines import hemisphere_poses
from strutwork.papers.azulay_2014.barrier import legs_at, ring, signed, tilted
from strutwork.papers.azulay_2014.comparison import machines, variant

RINGS = {
    "proposed-3pprs": (2.14, 2.42),
    "eclipse-3pprs": (2.93, 3.38),
    "alizade-3prps": (2.37, 2.70),
    "glozman-3prrs": (2.01, 2.33),
}


@pytest.mark.parametrize("name", machines())
def test_sign_at_the_pole_and_at_90_degrees(name: str) -> None:
    machine = variant(name, "spherical")
    roll = np.linspace(0.0, 2.0 * np.pi, 721)
    pole = signed(machine, tilted(machine, np.zeros(721), roll))
    edge = signed(machine, tilted(machine, np.full(721, np.pi / 2), roll))
    # at three rolls of five one leg of this machine is too short for 90°: no way leads there
    reached = np.isfinite(edge)
    assert reached.mean() == pytest.approx(0.413 if name == "glozman-3prrs" else 1.0, abs=0.001)
    edge = edge[reached]
    # all rolls, at once: one sign each, and not a value near zero
    assert np.ptp(np.sign(pole)) == np.ptp(np.sign(edge)) == 0
    assert np.sign(pole[0]) == -np.sign(edge[0]) != 0
    assert np.abs(pole).min() > 1e-3
    assert np.abs(edge).min() > 1e-3


@pytest.mark.parametrize("name", machines())
def test_ring(name: str) -> None:
    # two decimals of a millimetre, as stated: half of the last digit
    assert 1e3 * np.array(ring(variant(name, "spherical")).extent) == pytest.approx(
        RINGS[name], abs=0.0051
    )


def test_ring_of_the_proposed_machine_in_figure_4() -> None:
    # "a circular area at about r = 2 mm": read to half a millimetre
    low, high = ring(variant("proposed-3pprs", "spherical")).extent
    assert 1.5e-3 < low < high < 2.5e-3


@pytest.mark.parametrize("name", machines())
def test_every_direction_of_tilt_is_a_roll(name: str) -> None:
    # the guide is a whole circle: s on the whole hemisphere is s of tilts towards x
    machine = variant(name, "spherical")
    poses = hemisphere_poses(machine.pole_height, lattice=6, rolls=5)
    tilt = np.arccos(np.clip(poses.rotation[..., 2, 2], -1.0, 1.0))
    roll = np.broadcast_to(np.arange(5) * (2 * np.pi / 15), tilt.shape)
    # at the pole the direction of tilt has no meaning
    away = tilt > 1e-3
    found, expected = signed(machine, poses), signed(machine, tilted(machine, tilt, roll))
    assert found[away] == pytest.approx(expected[away], abs=1e-12, nan_ok=True)


@pytest.mark.parametrize("name", machines())
def test_determinant_of_the_inverse_jacobian(name: str) -> None:
    # det J⁻¹ = ±(√3 R_p)³ s / ∏ ρ w; 1e-12 relative, times how near to singular the pose is
    machine = variant(name, "spherical")
    rng = np.random.default_rng(7)
    tilt, roll = rng.uniform(0.0, 1.4, 300), rng.uniform(0.0, 2.0, 300)
    poses = tilted(machine, tilt, roll)
    poses = Poses.of(poses.position + rng.uniform(-4e-3, 4e-3, (300, 3)), poses.rotation)
    placement = machine.place(poses)
    good = placement.reachable
    poses, placement = Poses.of(poses.position[good], poses.rotation[good]), placement[good]
    assert good.sum() > 200
    determinant = jacobians(machine.linkage, placement).determinant()
    radial, legs = legs_at(machine, poses)
    along = -np.einsum("...i,...i->...", legs.link, radial.outward)
    up = legs.link[..., 2]
    if name == "glozman-3prrs":
        shoulder = legs.values["shoulder", "rz"]
        length = machine.link_length  # type: ignore[attr-defined]
        w = length * (np.sin(shoulder) * along - np.cos(shoulder) * up)
    else:
        w = {"proposed-3pprs": along, "eclipse-3pprs": up}.get(name, np.ones_like(up))
    side = np.sqrt(3.0) * machine.platform_radius
    expected = side**3 * signed(machine, poses) / (radial.radius * w).prod(axis=-1)
    ratio = determinant / expected
    assert np.ptp(np.sign(ratio)) == 0
    near = np.maximum(1.0, np.abs(expected).max() / np.abs(expected))
    assert np.all(np.abs(np.abs(ratio) - 1.0) < 1e-12 * near)
