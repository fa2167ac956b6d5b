"""Block-Krylov reduction beside direct solutions, and the lowest modes beside dense ones."""

from __future__ import annotations

import functools
from typing import Any

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError
from strutwork.fea.block_krylov import KrylovOptions, krylov_reduction
from strutwork.fea.block_krylov_damping import MatrixDamping
from strutwork.fea.factorize import factorize
from tests.solids import frame

Array = NDArray[Any]

#: Reductions without damping warn; the tests that are about it ask for the warning.
pytestmark = pytest.mark.filterwarnings("ignore:Krylov reduction:strutwork.errors.ValidityWarning")

BAND = (5.0, 1500.0)


@functools.cache
def held_frame() -> tuple[sp.csc_array, sp.csc_array, Array, Array]:
    """Stiffness, mass, loads on a patch in x, y, z, and ports of three dampers."""
    stiffness, mass, _ = frame(10, 4, 3).held()
    n = stiffness.shape[0]
    loads, ports = np.zeros((n, 3)), np.zeros((n, 3))
    for i in range(3):
        loads[n - 30 + i :: 3, i] = 0.1
        start = 3 * (n // 9) * i // 2
        ports[start + i : start + 30 : 3, i] = 0.1
    return stiffness, mass, loads, ports


def direct(damping: MatrixDamping, frequency: float) -> Array:
    stiffness, mass, loads, _ = held_frame()
    w, identity = 2 * np.pi * frequency, np.eye(stiffness.shape[0])
    c, d = damping.apply(stiffness.toarray(), mass.toarray(), identity)
    dynamic = (stiffness - w**2 * mass).toarray() + 1j * (d + w * c)
    return np.asarray(loads.T @ np.linalg.solve(dynamic, loads))


def dashpots(share: float = 0.3) -> MatrixDamping:
    stiffness, _, _, ports = held_frame()
    local = 1.0 / np.einsum("ij,ij->j", ports, factorize(stiffness).solve(ports))
    return MatrixDamping(
        loss_factor=0.005, ports=ports, dashpots=share * local / 1000.0, losses=0.02 * local
    )


def parts() -> MatrixDamping:
    """A loss factor of its own in one half of the dofs."""
    stiffness, _, _, _ = held_frame()
    half = sp.diags_array(np.arange(stiffness.shape[0]) < stiffness.shape[0] // 2, dtype=float)
    return MatrixDamping(
        loss_factor=0.01,
        structural=sp.csc_array(0.01 * half @ stiffness @ half),
        viscous=sp.csc_array(1e-6 * half @ stiffness @ half),
    )


CASES = {
    "loss factor": lambda: MatrixDamping(loss_factor=0.01),
    "Rayleigh": lambda: MatrixDamping(mass_rate=5.0, stiffness_time=1e-6),
    "dashpots": dashpots,
    "parts": parts,
}


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("tolerance", [1e-5, 1e-8])
def test_the_error_of_every_line_is_below_the_tolerance(name: str, tolerance: float) -> None:
    stiffness, mass, loads, _ = held_frame()
    damping = CASES[name]()
    model = krylov_reduction(
        stiffness, mass, loads, BAND, damping, KrylovOptions(tolerance=tolerance)
    )
    assert model.error <= tolerance
    assert model.basis.shape[1] < 120
    assert model.damping == str(damping)
    assert model.residual.proven
    own = model.natural_frequencies
    for frequency in (BAND[0], 311.0, own[own < BAND[1]][-1], model.worst, BAND[1]):
        exact = direct(damping, frequency)
        found = model.receptance([frequency])[0]
        error = np.linalg.norm(found - exact) / np.linalg.norm(exact)
        # at a resonance rounding of K moves the direct solution by its condition, 1e6, times
        # 1e-16, over the loss factor
        assert error <= max(model.errors([frequency])[0], 1e-10)
        assert model.errors([frequency])[0] <= 1.01 * model.error
        np.testing.assert_allclose(found, found.T, atol=1e-9 * np.abs(found).max())


def test_the_bound_is_the_error_over_the_loss_factor() -> None:
    """Only at a resonance that the basis lacks would the error be as large."""
    stiffness, mass, loads, _ = held_frame()
    damping = MatrixDamping(loss_factor=0.01)
    model = krylov_reduction(stiffness, mass, loads, BAND, damping, KrylovOptions(tolerance=1e-3))
    exact = direct(damping, model.worst)
    error = np.linalg.norm(model.receptance([model.worst])[0] - exact) / np.linalg.norm(exact)
    assert 1e-11 < error < 1e-4
    assert 0.01 * model.error <= error * 1.05
    assert error <= model.error
    assert "at most" in repr(model)


@pytest.mark.parametrize("expansion", [0.0, 700.0])
def test_value_and_slopes_match_at_an_expansion(expansion: float) -> None:
    """Moments of the receptance in ω² at the expansions, by central differences of both."""
    stiffness, mass, loads, _ = held_frame()
    model = krylov_reduction(
        stiffness,
        mass,
        loads,
        (0.0, 800.0),
        None,
        KrylovOptions(tolerance=1e-3, expansions=(0.0, 700.0)),
    )
    centre = (2 * np.pi * expansion) ** 2
    dense = (stiffness - centre * mass).toarray()
    answer = loads
    small = model.small.stiffness - centre * model.small.mass
    reduced = model.small.ports
    for power in range(4):
        answer, reduced = np.linalg.solve(dense, answer), np.linalg.solve(small, reduced)
        exact, found = loads.T @ answer, model.small.ports.T @ reduced
        np.testing.assert_allclose(found, exact, rtol=1e-8, atol=1e-8 * np.abs(exact).max())
        answer, reduced = mass @ answer, model.small.mass @ reduced
        assert power < 4


def test_a_full_basis_is_exact() -> None:
    stiffness, mass, _ = frame(2, 1, 1).held()
    n = stiffness.shape[0]
    loads = np.eye(n)[:, :4]
    model = krylov_reduction(stiffness, mass, loads, (1.0, 60000.0), MatrixDamping(loss_factor=0.1))
    w = 2 * np.pi * 47000.0
    dense = (1 + 0.1j) * stiffness.toarray() - w**2 * mass.toarray()
    exact = loads.T @ np.linalg.solve(dense, loads)
    np.testing.assert_allclose(model.receptance([47000.0])[0], exact, rtol=1e-7)
    assert model.basis.shape[1] <= n


def test_a_floating_structure() -> None:
    whole = frame(10, 3, 3)
    stiffness, mass = whole.stiffness, whole.mass
    n = stiffness.shape[0]
    loads = np.zeros((n, 2))
    loads[-30::3, 0] = loads[-28::3, 1] = 0.1
    with pytest.raises(NumericalError, match=r"floats|singular"):
        krylov_reduction(stiffness, mass, loads, (5.0, 900.0), MatrixDamping(loss_factor=0.01))
    model = krylov_reduction(
        stiffness,
        mass,
        loads,
        (5.0, 900.0),
        MatrixDamping(loss_factor=0.01),
        KrylovOptions(floating=True),
    )
    for frequency in (5.0, 450.0, 900.0):
        w = 2 * np.pi * frequency
        dense = (1 + 0.01j) * stiffness.toarray() - w**2 * mass.toarray()
        exact = loads.T @ np.linalg.solve(dense, loads)
        error = np.linalg.norm(model.receptance([frequency])[0] - exact)
        assert error < 1e-8 * np.linalg.norm(exact)


def test_factors_at_hand_are_used_again() -> None:
    stiffness, mass, loads, _ = held_frame()
    factor = factorize(stiffness, "superlu")
    model = krylov_reduction(
        stiffness, mass, loads, BAND, MatrixDamping(loss_factor=0.01), factor=factor
    )
    assert model.solver == "SuperLU ordered by METIS"
    assert "SuperLU" in repr(model)
    lowest = scipy.linalg.eigh(
        stiffness.toarray(), mass.toarray(), eigvals_only=True, subset_by_index=[0, 2]
    )
    np.testing.assert_allclose(
        model.natural_frequencies[:3], np.sqrt(lowest) / (2 * np.pi), rtol=1e-8
    )


def test_what_cannot_be_reached_is_withheld() -> None:
    stiffness, mass, loads, _ = held_frame()
    with pytest.raises(NumericalError, match=r"vectors, for a tolerance.*\n.*expansions"):
        krylov_reduction(
            stiffness, mass, loads, BAND, MatrixDamping(loss_factor=0.01), KrylovOptions(most=9)
        )


def test_an_undamped_resonance_is_an_error() -> None:
    stiffness, mass, loads, _ = held_frame()
    model = krylov_reduction(stiffness, mass, loads, BAND)
    small = model.small
    square = small.undamped[0]
    exactly = [f for f in np.sqrt(square) / (2 * np.pi) if ((2 * np.pi * f) ** 2 == square).any()]
    assert exactly
    with pytest.raises(NumericalError, match="resonance without damping"):
        model.receptance(exactly)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"band": (5.0, 1.0)}, "band"),
        ({"band": (0.0, np.inf)}, "band"),
        ({"band": (0.0, 9.0), "options": KrylovOptions(floating=True)}, "no receptance at zero"),
        ({"ports": np.zeros((3, 1))}, "ports"),
        ({"options": KrylovOptions(floating=True), "factor": "given"}, "factor"),
    ],
)
def test_arguments_that_do_not_fit(arguments: dict[str, Any], message: str) -> None:
    stiffness, mass, loads, _ = held_frame()
    given = {"ports": loads, "band": BAND} | arguments
    with pytest.raises(ModelError, match=message):
        krylov_reduction(stiffness, mass, **given)


@pytest.mark.parametrize(
    "options", [{"tolerance": 0.0}, {"expansions": ()}, {"expansions": (3.0,)}]
)
def test_options_out_of_range(options: dict[str, Any]) -> None:
    with pytest.raises(ModelError, match="Krylov reduction"):
        KrylovOptions(**options)


@pytest.mark.parametrize(
    "values",
    [
        {"loss_factor": -0.1},
        {"mass_rate": np.nan},
        {"dashpots": np.ones(2)},
        {"ports": np.ones((5, 2)), "losses": np.ones(3)},
    ],
)
def test_damping_that_does_not_fit(values: dict[str, Any]) -> None:
    with pytest.raises(ModelError, match="damping"):
        MatrixDamping(**values)


def test_damping_says_what_damps() -> None:
    assert str(MatrixDamping()) == "none"
    assert str(dashpots()) == "loss factor 0.005, 3 single dampers"
    assert str(parts()) == "loss factor 0.01, damping matrices"


def test_lines_out_of_range() -> None:
    stiffness, mass, loads, _ = held_frame()
    model = krylov_reduction(stiffness, mass, loads, BAND, MatrixDamping(loss_factor=0.01))
    for lines in ([-1.0], [np.nan]):
        with pytest.raises(ModelError, match="frequency lines"):
            model.receptance(lines)
