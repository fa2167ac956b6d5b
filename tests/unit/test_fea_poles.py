"""Poles of damped structures: small public cases against other solvers of the same matrices."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import mpmath as mp
import numpy as np
import pytest
import scipy.linalg

from strutwork.errors import NumericalError, UnverifiedWarning
from strutwork.fea import PartDamping, Port, complex_modes, frequency_response, modes
from strutwork.fea.coupled import damped_matrices
from strutwork.fea.eigen import solve_eigen
from strutwork.fea.least_stiffness import least_dynamic_stiffness
from strutwork.fea.mode_damping import damping_ratios
from strutwork.fea.poles import find_poles
from strutwork.fea.reduction import reduce_system
from strutwork.machines.model_file import read_model
from strutwork.msa.assembly import system_of
from strutwork.reports.vibration import Target, vibration_target
from tests.vibration import heavy

CASES = Path(__file__).parents[1] / "cases"
DAMPED = ["models/68.toml", "models/series.toml", "robustness/free_damped.toml"]


def target(name: str) -> Target:
    return vibration_target(str(CASES / name))


def matrices(of: Target) -> tuple[Any, ...]:
    reduced = reduce_system(system_of(of.placed))
    eigen = solve_eigen(reduced)
    assert of.damping is not None
    found = damped_matrices(reduced, eigen, of.damping)
    whole = found.stiffness[0] + 1j * found.structural[0]
    return reduced, eigen, whole, found.viscous[0], found.mass[0]


def precise(k: Any, c: Any, m: Any, pole: complex, shape: Any) -> complex:
    """A pole to 25 digits of the same matrices, by Newton's method from a start.

    Residuals have 40 digits; steps, from one factor of the start in double precision, some.
    """
    n, size = len(shape), 1 / np.sqrt(np.abs(np.diag(k)) + np.diag(m) * abs(pole) ** 2)
    # unknowns and equations scaled; the shape keeps its length along the start
    scaled = shape / size / np.linalg.norm(shape / size)
    bordered = np.zeros((n + 1, n + 1), complex)
    bordered[:n, :n] = (k + pole * c + pole**2 * m) * np.outer(size, size)
    bordered[:n, n] = size * ((c + 2 * pole * m) @ (size * scaled))
    bordered[n, :n] = scaled.conj()
    factor = scipy.linalg.lu_factor(bordered)
    with mp.workdps(40):
        exact = [mp.matrix(x.tolist()) for x in (k, c, m)]
        s, x = mp.mpc(pole), mp.matrix((size * scaled).tolist())
        for _ in range(20):
            left = exact[0] * x + s * (exact[1] * x) + s**2 * (exact[2] * x)
            right = np.append([-complex(v) for v in left] * size, 0.0)
            *step, change = scipy.linalg.lu_solve(factor, right)
            s, x = s + change, x + mp.matrix((size * np.array(step)).tolist())
            if abs(change) <= 1e-25 * abs(s):
                return complex(s)
    raise AssertionError("Newton's method does not converge")


def test_ratios_of_two_coupled_dashpot_modes_are_right() -> None:
    """Motions without mass behind weak dashpots made every ratio of this file random."""
    given = target("models/68.toml")
    assert given.damping is not None
    ratios = damping_ratios(modes(given.placed, 4), given.damping)
    assert 100 * ratios[1] == pytest.approx(2.53, abs=5e-3)
    reduced, eigen, k, c, m = matrices(given)
    found = find_poles(reduced, eigen, given.damping)
    upper = np.flatnonzero(found.values.imag > 0)
    lowest = upper[np.argsort(np.abs(found.values[upper]))]
    for mode, index in enumerate(lowest[:2]):
        pole = precise(k, c, m, found.values[index], found.shapes[:, index])
        assert abs(found.values[index] - pole) <= 1e-9 * abs(pole)
        assert ratios[mode] == pytest.approx(-pole.real / abs(pole), rel=1e-7)


@pytest.mark.parametrize("name", DAMPED)
def test_low_poles_make_the_matrices_singular(name: str) -> None:
    """det(K + iD + sC + s²M) = 0 of the coordinates' own matrices, scaled by K or by mass."""
    given = target(name)
    assert given.damping is not None
    reduced, eigen, k, c, m = matrices(given)
    found = find_poles(reduced, eigen, given.damping)
    size = 1 / np.sqrt(np.abs(np.diag(k)) + np.diag(m) * np.abs(found.values).min() ** 2)
    for s in found.values[np.argsort(np.abs(found.values))][:12]:
        values = np.linalg.svd((k + s * c + s**2 * m) * np.outer(size, size), compute_uv=False)
        # an eigenvalue s with error δ leaves about δ times the first
        assert values[-1] <= 1e-11 * values[0]


@pytest.mark.parametrize("name", DAMPED)
def test_sum_over_poles_is_the_direct_solution(name: str) -> None:
    given = target(name)
    assert given.damping is not None
    node = given.nodes[-1]
    port = Port(node, "x")
    least = least_dynamic_stiffness(given.placed, port, port, given.damping, (5.0, 500.0))
    assert least.certified
    lines = np.append(np.linspace(5.0, 500.0, 700), least.frequency)
    direct = frequency_response(given.placed, [port], [port], lines, given.damping, "direct")
    size = np.abs(direct.receptance[:, 0, 0])
    assert size[-1] * least.value == pytest.approx(1.0, rel=1e-6)
    assert size.max() * least.value <= 1 + 1e-6


def test_series_of_bushings_has_the_ratio_of_its_energies() -> None:
    """Light damping: ζ is to first order the work of the dashpots at the undamped shape."""
    given = target("models/series.toml")
    assert given.damping is not None
    found = modes(given.placed, 2)
    index = given.placed.structure.mesh_index
    shape = found.shapes[:, index["A"]]
    work = (shape**2 * np.array([100.0] * 3 + [1e-3] * 3)).sum(axis=1)
    wanted = work / (2 * 2 * np.pi * found.frequencies)
    assert damping_ratios(found, given.damping) == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize("name", ["models/f5_modes_n3_traceback.toml", *DAMPED])
def test_any_number_of_modes(name: str) -> None:
    """From one to beyond all there are: the ratios of the first never depend on how many."""
    given = target(name)
    assert given.damping is not None
    whole = damping_ratios(modes(given.placed, 200), given.damping)
    for count in (1, 2, 3, 5, 6, 7, 8, len(whole), len(whole) + 1):
        some = damping_ratios(modes(given.placed, count), given.damping)
        assert some == pytest.approx(whole[:count], rel=1e-12, abs=1e-15)


def test_what_residuals_do_not_verify_is_withheld(monkeypatch: pytest.MonkeyPatch) -> None:
    given = target("models/68.toml")
    assert given.damping is not None
    found = modes(given.placed, 3)
    monkeypatch.setattr("strutwork.fea.poles._errors", lambda values, *_: np.full(len(values), 0.1))
    with pytest.warns(UnverifiedWarning, match=r"modes 1 \(15\.48 Hz\), 2 .* are withheld"):
        ratios = damping_ratios(found, given.damping)
    assert np.isnan(ratios).all()
    with pytest.raises(NumericalError, match=r"relative error up to 0\.1"):
        complex_modes(given.placed, given.damping)


def test_a_wrong_pole_has_a_large_error(monkeypatch: pytest.MonkeyPatch) -> None:
    """The check sees eigenvalues that are off, whatever made them so."""
    reduced, eigen, *_ = matrices(target("models/68.toml"))
    eig = np.linalg.eig

    def spoiled(matrix: Any) -> Any:
        values, vectors = eig(matrix)
        return values * (1 + 1e-3), vectors

    monkeypatch.setattr(np.linalg, "eig", spoiled)
    damping = target("models/68.toml").damping
    assert damping is not None
    errors = find_poles(reduced, eigen, damping).errors
    assert errors.min() >= 0.5e-3


def test_direct_solutions_stand_in_for_poles_that_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    given = target("models/series.toml")
    assert given.damping is not None
    port = Port("T", "z")
    sure = least_dynamic_stiffness(given.placed, port, port, given.damping, (1.0, 500.0))

    def fail(*_: Any) -> Any:
        raise NumericalError("poles", "cannot be distinguished.", "")

    monkeypatch.setattr("strutwork.fea.least_stiffness.pole_model", fail)
    found = least_dynamic_stiffness(given.placed, port, port, given.damping, (1.0, 500.0))
    assert not found.certified
    # the best of a search may miss, and never lies below the minimum
    assert sure.value * (1 - 1e-6) <= found.value <= sure.value * (1 + 1e-3)


def test_a_machine_whose_struts_spin_with_dashpots() -> None:
    placed = heavy("hexapod, spinning struts").place()[0]
    assert np.all(damping_ratios(modes(placed, 10), PartDamping(materials=True)) >= 0)


def test_rayleigh_damping_beyond_critical_is_sound() -> None:
    model = read_model(CASES / "models/rayleigh.toml")
    given = target("models/rayleigh.toml")
    assert given.damping is not None
    found = modes(model.placed, 24)
    ratios = damping_ratios(found, given.damping)
    w = 2 * np.pi * found.frequencies
    np.testing.assert_allclose(ratios, np.minimum(5.36 / (2 * w) + 7.46e-5 * w / 2, 1.0))
    assert ratios[-1] == 1.0
    port = Port("B", "y")
    least = least_dynamic_stiffness(model.placed, port, port, given.damping, (1.0, 500.0))
    assert least.certified
    lines = np.append(np.linspace(1.0, 500.0, 2000), least.frequency)
    direct = frequency_response(model.placed, [port], [port], lines, given.damping, "direct")
    size = np.abs(direct.receptance[:, 0, 0])
    assert size.argmax() == len(lines) - 1
    assert size[-1] * least.value == pytest.approx(1.0, rel=1e-8)
