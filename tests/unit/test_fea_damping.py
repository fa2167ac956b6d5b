"""Damping of each kind, and of parts."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea import LossFactor, ModalRatio, PartDamping, Rayleigh
from strutwork.fea.coupled import damped_matrices, is_coupled, part_matrices
from strutwork.fea.damping import modal_ratios
from strutwork.fea.eigen import solve_eigen
from strutwork.fea.reduction import reduce_system
from strutwork.msa import Material, system_of
from tests.structures import BAR, Model, cantilever
from tests.vibration import heavy, oscillators

OMEGA = np.array([[10.0, 200.0, 3000.0]])
SQUARE = 1.0 / OMEGA**2


def test_ratios_of_the_modes() -> None:
    np.testing.assert_allclose(modal_ratios(ModalRatio(0.02), SQUARE), 0.02)
    # η = 2 ζ at resonance
    np.testing.assert_allclose(modal_ratios(LossFactor(0.03), SQUARE), 0.015)
    rayleigh = Rayleigh(3.0, 1e-4)
    np.testing.assert_allclose(
        modal_ratios(rayleigh, SQUARE), 3.0 / (2 * OMEGA) + 1e-4 * OMEGA / 2, rtol=1e-14
    )


def test_motions_without_mass_have_no_ratio() -> None:
    square = np.array([[1e-4, 0.0]])
    for damping in (ModalRatio(0.1), LossFactor(0.1), Rayleigh(0.0, 1e-3)):
        assert modal_ratios(damping, square)[0, 1] == 0.0


def test_ratio_beyond_critical() -> None:
    # βω/2
    np.testing.assert_allclose(modal_ratios(Rayleigh(0.0, 1e-3), SQUARE), OMEGA * 1e-3 / 2)


@pytest.mark.parametrize("value", [-0.01, 1.0, 2.0, np.nan, np.inf])
def test_a_modal_ratio_is_from_zero_to_below_one(value: float) -> None:
    with pytest.raises(ModelError, match=r"damping\.modal_ratio"):
        ModalRatio(value)


@pytest.mark.parametrize("value", [-0.01, 2.0, np.nan])
def test_a_loss_factor_is_from_zero_to_below_two(value: float) -> None:
    with pytest.raises(ModelError, match=r"damping\.loss_factor"):
        LossFactor(value)
    with pytest.raises(ModelError, match="joint J1: loss factor"):
        PartDamping(joints={"J1": value})


@pytest.mark.parametrize("pair", [(-1.0, 0.0), (0.0, -1e-6), (np.inf, 0.0)])
def test_rayleigh_coefficients_are_not_negative(pair: tuple[float, float]) -> None:
    with pytest.raises(ModelError, match=r"damping\.rayleigh"):
        Rayleigh(*pair)


def test_damping_says_what_it_is() -> None:
    assert str(ModalRatio(0.02)) == "viscous, ratio ζ = 0.02 in every mode"
    assert str(LossFactor(0.03)) == "structural, loss factor η = 0.03"
    assert str(Rayleigh(1.0, 2e-5)) == "Rayleigh, C = 1 M + 2e-05 K"
    everything = PartDamping(ModalRatio(0.01), joints={"J1": 0.1})
    assert str(everything) == (
        "viscous, ratio ζ = 0.01 in every mode, materials' loss factors, joints' loss factors, "
        "joints' dashpots"
    )
    assert str(PartDamping(materials=False, dashpots=False)) == ""


def lossy_arm() -> Model:
    model = cantilever(BAR, material=Material.isotropic(200e9, 0.3, 7800.0, 0.02, name="lossy"))
    model.joint("grip", "fixed", ("tip", "hand"), stiffness={"x": 1e7, "rz": 2e3})
    model.joints[-1] = replace(model.joints[-1], damping={"x": 50.0, "ry": 7.0})
    model.nodes(load=(0.7, 0, 0))
    model.beam("tool", "hand", "load", BAR)
    return model


def test_matrices_of_parts() -> None:
    system = system_of(lossy_arm().place())
    viscous, structural = part_matrices(system, PartDamping(joints={"grip": 0.3}))
    parts = {name: (nodes, k) for name, nodes, k in system.contributions()}
    expected = np.zeros_like(structural)
    for name, factor in (("beam beam", 0.02), ("joint grip", 0.3)):
        system.add_part(expected, parts[name][0], factor * parts[name][1])
    np.testing.assert_allclose(structural, expected)
    # the dashpot pulls its two sides together: x along (1, 0, 0) turned into the joint's axes
    nodes = parts["joint grip"][0]
    turn = system.joint_frames[:, 1]
    c = turn @ np.diag([50.0, 0, 0, 0, 7.0, 0]) @ np.swapaxes(turn, -1, -2)
    whole = np.zeros_like(viscous)
    system.add_part(whole, nodes, np.block([[[c[0], -c[0]], [-c[0], c[0]]]]).reshape(1, 12, 12))
    np.testing.assert_allclose(viscous, whole)
    for pair in (viscous, structural):
        assert np.linalg.eigvalsh(pair[0]).min() > -1e-6 * np.abs(pair).max()


def test_parts_may_be_left_out() -> None:
    system = system_of(lossy_arm().place())
    none = part_matrices(system, PartDamping(materials=False, dashpots=False))
    assert not np.any(none[0])
    assert not np.any(none[1])
    reduced = reduce_system(system)
    assert not is_coupled(reduced, PartDamping(materials=False, dashpots=False))
    assert is_coupled(reduced, PartDamping(materials=False))
    assert is_coupled(reduced, PartDamping(dashpots=False))
    assert not is_coupled(reduced, ModalRatio(0.1))


def test_a_loss_factor_needs_an_elastic_joint() -> None:
    system = system_of(lossy_arm().place())
    for name in ("support root", "nowhere"):
        with pytest.raises(ModelError, match=f"joint {name}: has a loss factor but no elastic"):
            part_matrices(system, PartDamping(joints={name: 0.1}))


def test_a_modal_ratio_as_a_matrix_gives_every_mode_its_ratio() -> None:
    reduced = reduce_system(system_of(heavy("hexapod").place()))
    eigen = solve_eigen(reduced)
    matrices = damped_matrices(reduced, eigen, ModalRatio(0.03))
    phi = eigen.flexibility * np.where(eigen.finite, eigen.circular, 0.0)[:, None, :]
    found = np.swapaxes(phi, -1, -2) @ matrices.viscous @ phi
    expected = 0.06 * eigen.circular[:, None, :] * np.eye(phi.shape[-1])
    size = 0.06 * eigen.circular.max()
    assert np.abs(found - expected).max() < 1e-9 * size


def test_matrices_of_the_other_kinds() -> None:
    reduced = reduce_system(system_of(oscillators((1e4, 1.0), (3e4, 2.0)).place()))
    eigen = solve_eigen(reduced)
    rayleigh = damped_matrices(reduced, eigen, Rayleigh(2.0, 1e-3))
    np.testing.assert_allclose(rayleigh.viscous, 2.0 * reduced.mass + 1e-3 * reduced.stiffness)
    assert not np.any(rayleigh.structural)
    loss = damped_matrices(reduced, eigen, LossFactor(0.1))
    np.testing.assert_allclose(loss.structural, 0.1 * reduced.stiffness)
    assert not np.any(loss.viscous)
    both = damped_matrices(
        reduced, eigen, PartDamping(Rayleigh(2.0, 0.0), joints={"J1": 0.5, "J2": 0.5})
    )
    np.testing.assert_allclose(both.viscous, 2.0 * reduced.mass)
    np.testing.assert_allclose(both.structural, 0.5 * reduced.stiffness)
