"""Residuals of reduced models beside those of the full system, and what they must not miss."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import NumericalError, ValidityWarning
from strutwork.fea.block_krylov import KrylovOptions, krylov_reduction
from strutwork.fea.block_krylov_damping import MatrixDamping
from strutwork.fea.block_krylov_residual import Residual
from strutwork.fea.factorize import factorize
from tests.solids import frame, resonator, tip_loads

Array = NDArray[Any]

#: Reductions without damping warn; the tests that are about it ask for the warning.
pytestmark = pytest.mark.filterwarnings("ignore:Krylov reduction:strutwork.errors.ValidityWarning")

BAND = (5.0, 1500.0)


def full(stiffness: Any, mass: Any, damping: MatrixDamping, frequency: float) -> sp.csc_array:
    """Dynamic stiffness."""
    w = 2.0 * np.pi * frequency
    dynamic = (1.0 + 1j * (damping.loss_factor + w * damping.stiffness_time)) * stiffness
    dynamic = dynamic + (1j * w * damping.mass_rate - w**2) * mass
    for matrix, factor in ((damping.viscous, 1j * w), (damping.structural, 1j)):
        if matrix is not None:
            dynamic = dynamic + factor * matrix
    if damping.ports is not None:
        at = sp.csc_array(damping.ports)
        dynamic = dynamic + 1j * w * (at @ sp.diags_array(damping.dashpots) @ at.T)
    return sp.csc_array(dynamic)


def answer(stiffness: Any, mass: Any, damping: MatrixDamping, loads: Array, at: float) -> Array:
    dynamic = full(stiffness, mass, damping, at)
    return np.asarray(loads.T @ factorize(dynamic, "superlu").solve(loads.astype(complex)))


def half(stiffness: Any) -> sp.csc_array:
    n = stiffness.shape[0]
    chosen = sp.diags_array(np.arange(n) < n // 2, dtype=float)
    return sp.csc_array(chosen @ stiffness @ chosen)


def dampings(stiffness: Any, loads: Array) -> dict[str, MatrixDamping]:
    part = half(stiffness)
    ports = np.roll(loads, 60, axis=0)
    return {
        "none": MatrixDamping(),
        "loss factor": MatrixDamping(loss_factor=0.01),
        "Rayleigh": MatrixDamping(mass_rate=5.0, stiffness_time=1e-6),
        "dashpots": MatrixDamping(loss_factor=0.01, ports=ports, dashpots=np.full(3, 200.0)),
        "parts": MatrixDamping(
            loss_factor=0.01,
            structural=sp.csc_array(0.01 * part),
            viscous=sp.csc_array(1e-6 * part),
        ),
    }


@pytest.mark.parametrize("damped", ["none", "loss factor", "Rayleigh", "dashpots", "parts"])
@pytest.mark.parametrize(
    "options",
    [
        {"expansions": (0.0,)},
        {"expansions": (0.0, 600.0, 1400.0)},
        {"floating": True, "expansions": (0.0, 600.0)},
    ],
)
def test_the_norm_is_that_of_the_full_residual(damped: str, options: dict[str, Any]) -> None:
    whole = frame(7, 2, 2)
    stiffness, mass = whole.stiffness, whole.mass
    if not options.get("floating"):
        stiffness, mass, _ = whole.held()
    loads = tip_loads(stiffness.shape[0])
    damping = dampings(stiffness, loads)[damped]
    model = krylov_reduction(
        stiffness, mass, loads, BAND, damping, KrylovOptions(tolerance=1e-2, **options)
    )
    lines = np.array([BAND[0], 333.0, 1111.0, BAND[1], 2500.0])
    states = model.small.coordinates(lines)
    found = np.linalg.norm(model.residual.coordinates(model.small, lines, states), axis=(1, 2))
    factor = factorize(sp.csc_array(stiffness + model.shift * mass), "superlu")
    for line, state, norm in zip(lines, states, found, strict=True):
        rest = loads - full(stiffness, mass, damping, line) @ (model.basis @ state)
        energy = np.vdot(rest.real, factor.solve(np.ascontiguousarray(rest.real)))
        energy += np.vdot(rest.imag, factor.solve(np.ascontiguousarray(rest.imag)))
        size = np.linalg.norm(state)
        assert norm == pytest.approx(np.sqrt(energy), rel=1e-3, abs=1e-7 * size)


@pytest.mark.parametrize("shift", [0.0, 0.3])
def test_the_gain_bounds_the_inverse_of_every_passive_damping(shift: float) -> None:
    random = np.random.default_rng(4)
    tightest = np.inf
    for _ in range(40):
        n = 8
        square = np.sort(10.0 ** random.uniform(-2, 2, n))
        spare = random.normal(size=(n, 2))
        extra = [random.uniform(0, 0.1) * np.outer(x, x) for x in spare.T]
        eta, rate, time = random.uniform(0, 0.1, 3) * random.integers(0, 2, 3)
        lines = 10.0 ** random.uniform(-2, 1, 5)
        small: Any = type("Factors", (), {"factors": (eta, rate, time)})
        gains = Residual(shift, spare, spare, spare, proven=True).gain(small, lines)
        for line, gain in zip(lines, gains, strict=True):
            w = 2.0 * np.pi * line
            dynamic = np.diag(square * (1 + 1j * (eta + w * time)) + 1j * w * rate - w**2)
            dynamic = dynamic + 1j * (extra[0] + w * extra[1])
            root = np.sqrt(square + shift)
            exact = np.linalg.norm(root[:, None] * np.linalg.inv(dynamic) * root, 2)
            assert exact <= gain * (1 + 1e-9)
            tightest = min(tightest, gain / exact)
    assert tightest < 1.5


@pytest.mark.parametrize("share", [1e-7, 1e-8])
def test_a_resonance_that_the_ports_hardly_excite_is_not_missed(share: float) -> None:
    """Residuals at other lines were 200 times smaller, and the tolerance was exceeded ten times."""
    damping = MatrixDamping(loss_factor=1e-3)
    stiffness, mass, loads = resonator(frame(8, 3, 3), share, 1333.0)
    model = krylov_reduction(stiffness, mass, loads, BAND, damping, KrylovOptions(tolerance=1e-5))
    for frequency in (1333.0, 1335.3, 1500.0):
        exact = answer(stiffness, mass, damping, loads, frequency)
        found = model.receptance([frequency])[0]
        assert np.linalg.norm(found - exact) <= model.error * np.linalg.norm(exact)


def test_the_lower_end_of_the_band_is_not_missed() -> None:
    """With damping matrices the error is largest there, 12 times what the upper end has."""
    stiffness, mass, _ = frame(10, 3, 3).held()
    loads = tip_loads(stiffness.shape[0])
    damping = dampings(stiffness, loads)["parts"]
    model = krylov_reduction(stiffness, mass, loads, BAND, damping, KrylovOptions(tolerance=1e-3))
    for frequency in (5.0, 311.0, 1500.0):
        exact = answer(stiffness, mass, damping, loads, frequency)
        error = np.linalg.norm(model.receptance([frequency])[0] - exact) / np.linalg.norm(exact)
        assert error <= model.errors([frequency])[0] <= 1.01 * model.error


def test_lines_whose_error_may_exceed_the_tolerance_are_withheld() -> None:
    stiffness, mass, _ = frame(8, 3, 3).held()
    loads = tip_loads(stiffness.shape[0])
    damping = MatrixDamping(loss_factor=0.01)
    model = krylov_reduction(stiffness, mass, loads, BAND, damping, KrylovOptions(tolerance=1e-8))
    assert model.receptance([0.0, BAND[1]]).shape == (2, 3, 3)
    with pytest.raises(NumericalError, match=r"wrong by .* at 4000 Hz(.|\n)*band that includes"):
        model.receptance([20.0, 4000.0])
    assert model.proven
    assert model.errors([20.0])[0] < 1e-8 < model.errors([4000.0])[0]


def test_without_damping_lines_next_to_a_resonance_are_withheld() -> None:
    stiffness, mass, _ = frame(8, 3, 3).held()
    loads = tip_loads(stiffness.shape[0])
    with pytest.warns(ValidityWarning, match="is an estimate and no bound"):
        model = krylov_reduction(stiffness, mass, loads, BAND, None, KrylovOptions(tolerance=1e-5))
    assert not model.proven
    assert "estimated" in repr(model)
    first = model.natural_frequencies[0]
    for frequency in (0.99 * first, 1.01 * first, 1500.0):
        exact = answer(stiffness, mass, MatrixDamping(), loads, frequency)
        error = np.linalg.norm(model.receptance([frequency])[0] - exact) / np.linalg.norm(exact)
        assert error <= max(model.errors([frequency])[0], 1e-9)
    with pytest.raises(NumericalError, match=r"keep lines away from resonances"):
        model.receptance([first * (1.0 + 1e-9)])


def test_damping_that_feeds_power_in_proves_nothing() -> None:
    stiffness, mass, _ = frame(6, 2, 2).held()
    loads = tip_loads(stiffness.shape[0])
    ports = np.roll(loads, 60, axis=0)
    for damping in (
        MatrixDamping(loss_factor=0.01, ports=ports, dashpots=np.array([1.0, -1.0, 1.0])),
        MatrixDamping(loss_factor=0.01, structural=sp.csc_array(-0.005 * half(stiffness))),
        MatrixDamping(ports=ports, dashpots=np.full(3, 200.0)),
    ):
        with pytest.warns(ValidityWarning, match="or feeds power in"):
            model = krylov_reduction(
                stiffness, mass, loads, (5.0, 500.0), damping, KrylovOptions(tolerance=1e-4)
            )
        assert not model.residual.proven


def test_a_residual_of_the_full_system_that_disagrees_is_an_error(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stiffness, mass, _ = frame(6, 2, 2).held()
    loads = tip_loads(stiffness.shape[0])
    monkeypatch.setattr(Residual, "errors", lambda *given: np.zeros(len(given[2])))
    with pytest.raises(NumericalError, match=r"leaves an error of .* for a tolerance"):
        krylov_reduction(stiffness, mass, loads, BAND, MatrixDamping(loss_factor=0.01))
