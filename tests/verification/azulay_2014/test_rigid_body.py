"""Rigid-body dynamics of section 2.2: energy, and what eqs 19, 26 and 29 print wrongly.

@article{azulay2014comparative,
  author  = {Azulay, Hay and Mahmoodi, Masih and Zhao, Ray and Mills, James K.
             and Benhabib, Beno},
  title   = {Comparative analysis of a new {3xPPRS} parallel kinematic mechanism},
  journal = {Robotics and Computer-Integrated Manufacturing},
  volume  = {30},
  year    = {2014}
}

That the chains' own formulas give the same drive forces as the constraint rows is held by
`tests/unit/test_dynamics_legs.py`, whose machine is taken here.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.kinematics.drive_forces import inverse_dynamics
from tests.dynamics import Case
from tests.unit.test_dynamics_legs import MACHINE, chain, dynamics

Array = NDArray[Any]

#: Step of the differences, s, of fourth order: their error is below what is asserted.
STEP = 4e-4
#: Weights of values at −2, −1, 1, 2 steps.
WEIGHTS = np.array([1.0, -8.0, 8.0, -1.0]) / (12.0 * STEP)
TIMES = np.array([-2.0, -1.0, 1.0, 2.0]) * STEP


@pytest.fixture(scope="module", params=range(2))
def case(request: pytest.FixtureRequest) -> Case:
    random = np.random.default_rng(request.param)
    values = np.array([0, 0, MACHINE.pole_height, *random.uniform(-0.15, 0.15, 3)])
    rates = random.uniform(-1, 1, 6) * [0.05, 0.05, 0.05, 0.5, 0.5, 0.5]
    changes = random.uniform(-1, 1, 6) * [0.5, 0.5, 0.5, 2, 2, 2]
    return Case(dynamics(), values, rates, changes)


def path(case: Case) -> tuple[Array, Array]:
    """Values and rates of a motion with constant accelerations at the four times."""
    t = TIMES[:, None]
    return case.values + case.rates * t + case.changes * t**2 / 2, case.rates + case.changes * t


def test_mass_and_coriolis(case: Case) -> None:
    at = case.at(case.values)
    mass = at.mass[0]
    assert np.abs(mass - mass.T).max() <= 1e-14 * np.abs(mass).max()
    assert np.linalg.eigvalsh(mass).min() > 0
    change = np.einsum("t,tij->ij", WEIGHTS, case.at(path(case)[0]).mass)
    skew = change - 2 * at.coriolis(case.rates)[0]
    # poses are closed to 1e-11, over a step
    assert np.abs(skew + skew.T).max() < 1e-7 * np.abs(change).max()


def test_power_of_the_drives_is_the_rate_of_energy(case: Case) -> None:
    forces = inverse_dynamics(case.at(case.values), case.rates, case.changes)
    power = float(forces.drives[0] @ forces.rates_of_drives[0])
    values, rates = path(case)
    along = case.at(values)
    rate = float(WEIGHTS @ (along.kinetic(rates) + along.potential))
    # 1e-9 of the powers that the drives exchange
    size = float(np.abs(forces.drives[0] * forces.rates_of_drives[0]).sum())
    assert rate == pytest.approx(power, abs=1e-9 * size)


def test_bias_in_the_drives_space_takes_their_rates(case: Case) -> None:
    """Eq. 29 prints the platform's twist where the rates of the drives belong."""
    at = case.at(case.values)
    forces = inverse_dynamics(at, case.rates, case.changes)
    jacobian = np.linalg.inv(at.drive_map[0])
    change = np.einsum("t,tij->ij", WEIGHTS, case.at(path(case)[0]).drive_map)
    jacobian_rate = -jacobian @ change @ jacobian

    def drives(multiplied: Array) -> Array:
        own = at.mass[0] @ jacobian @ forces.accelerations_of_drives[0]
        bias = at.mass[0] @ jacobian_rate @ multiplied + at.coriolis(case.rates)[0] @ case.rates
        return np.asarray(jacobian.T @ (own + bias + at.weight[0]))

    size = np.abs(forces.drives[0]).max()
    right = np.abs(drives(forces.rates_of_drives[0]) - forces.drives[0]).max()
    wrong = np.abs(drives(case.rates) - forces.drives[0]).max()
    # poses are closed to 1e-11, over a step
    assert right < 1e-7 * size
    assert wrong > 1e4 * right


def test_rates_of_a_chain_do_not_tell_the_twist() -> None:
    """Eq. 19 inverts a matrix that is 3 x 6."""
    seat = np.array([MACHINE.platform_radius, 0.0, MACHINE.pole_height])
    part, _ = chain(seat, np.zeros(3))
    arm = seat - [0, 0, MACHINE.pole_height]
    cross = np.cross(np.eye(3), arm)
    z = np.linalg.solve(part.w, np.hstack([np.eye(3), cross]))
    assert z.shape == (3, 6)
    assert np.linalg.matrix_rank(z) == 3
    # a turn about the line from the platform's centre to the joint moves the chain not at all
    assert np.abs(z @ [0, 0, 0, *arm]).max() < 1e-15


def test_euler_rates_fail_at_home() -> None:
    """Eq. 26 goes through rates of ZYZ angles: singular at β = 0, where the machine is not."""
    alpha, beta = 0.3, 0.0
    euler = np.array(
        [
            [0, -np.sin(alpha), np.cos(alpha) * np.sin(beta)],
            [0, np.cos(alpha), np.sin(alpha) * np.sin(beta)],
            [1, 0, np.cos(beta)],
        ]
    )
    assert np.linalg.matrix_rank(euler) == 2
    values = np.array([0, 0, MACHINE.pole_height, 0, 0, 0])
    at = Case(dynamics(), values, np.zeros(6), np.zeros(6)).at(values)
    assert np.linalg.matrix_rank(at.drive_map[0]) == 6
