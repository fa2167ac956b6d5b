"""Every factorisation installed, beside SuperLU, and the memory foreseen."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

import strutwork.fea.factorize
import strutwork.fea.memory
import strutwork.fea.ordering
import strutwork.memory
from strutwork.errors import ModelError, NumericalError
from strutwork.fea import factor_cholmod, factor_mumps, factor_superlu
from strutwork.fea.factorize import SOLVERS, factorize, installed_solvers
from strutwork.fea.memory import foreseen_memory, require_memory
from strutwork.fea.ordering import nested_dissection
from strutwork.memory import available_memory
from tests.solids import frame

INSTALLED = installed_solvers()


def definite(n: int = 300, seed: int = 0) -> sp.csc_array:
    random = np.random.default_rng(seed)
    rows = sp.random_array((n, n), density=0.01, rng=random, format="csc")
    return sp.csc_array(rows @ rows.T + sp.eye_array(n))


@pytest.mark.parametrize("solver", INSTALLED)
def test_every_solver_gives_superlus_answer(solver: str) -> None:
    matrix = definite()
    factor = factorize(matrix, solver)
    right = np.random.default_rng(1).normal(size=(300, 3))
    expected = factorize(matrix, "superlu").solve(right)
    assert factor.name.lower().startswith(solver)
    assert factor.name in repr(factor)
    np.testing.assert_allclose(factor.solve(right), expected, atol=1e-12)
    np.testing.assert_allclose(factor.solve(right[:, 0]), expected[:, 0], atol=1e-12)
    both = factor.solve(right[:, :2] + 1j * right[:, 1:])
    np.testing.assert_allclose(both, expected[:, :2] + 1j * expected[:, 1:], atol=1e-12)
    assert factor.negative_pivots() == 0


@pytest.mark.parametrize("solver", [s for s in INSTALLED if SOLVERS[s].INDEFINITE])
def test_negative_pivots_count_negative_eigenvalues(solver: str) -> None:
    matrix = sp.csc_array(definite() - 1.1 * sp.eye_array(300))
    below = int(np.count_nonzero(np.linalg.eigvalsh(matrix.toarray()) < 0))
    assert below > 0
    assert factorize(matrix, solver, positive=False).negative_pivots() == below


def test_another_solver_takes_over_where_choleskys_method_fails() -> None:
    matrix = sp.csc_array(definite() - 1.1 * sp.eye_array(300))
    for factor in (factorize(matrix), factorize(matrix, positive=False)):
        assert factor.name != factor_cholmod.NAME
        right = np.ones(300)
        np.testing.assert_allclose(matrix @ factor.solve(right), right, atol=1e-9)


@pytest.mark.parametrize("solver", [s for s in SOLVERS if not SOLVERS[s].INDEFINITE])
def test_choleskys_method_refuses_what_is_not_positive(solver: str) -> None:
    words = "accepts only positive definite matrices" if solver in INSTALLED else "not installed"
    with pytest.raises(ModelError, match=words):
        factorize(sp.csc_array(-definite()), solver)


@pytest.mark.parametrize("solver", [s for s in INSTALLED if SOLVERS[s].COMPLEX])
def test_complex_symmetric_matrices(solver: str) -> None:
    matrix = sp.csc_array(definite() + 0.3j * definite(seed=5))
    right = np.random.default_rng(1).normal(size=(300, 2))
    factor = factorize(matrix, solver)
    for given in (right, right[:, 0], right * 1j):
        np.testing.assert_allclose(matrix @ factor.solve(given), given, atol=1e-11)


@pytest.mark.parametrize("solver", [s for s in SOLVERS if not SOLVERS[s].COMPLEX])
def test_a_solver_for_real_matrices_refuses_complex_ones(solver: str) -> None:
    words = "no complex matrices" if solver in INSTALLED else "not installed"
    with pytest.raises(ModelError, match=words):
        factorize(sp.csc_array(definite() * 1j), solver)


@pytest.mark.parametrize("solver", [None, *(s for s in INSTALLED if s != "cholmod")])
def test_singular_matrices_are_errors(solver: str | None) -> None:
    lonely = sp.csc_array(sp.diags_array(np.r_[np.ones(5), 0.0, 1.0]))
    for matrix in (sp.csc_array((5, 5)), lonely):
        with pytest.raises(NumericalError, match="singular"):
            factorize(matrix, solver)


def test_numbers_that_are_not_finite_are_errors() -> None:
    with pytest.raises(NumericalError, match="finite"):
        factorize(sp.csc_array(np.diag([1.0, np.nan])))


def test_unknown_and_missing_solvers(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ModelError, match=r"unknown.*\n.*superlu"):
        factorize(definite(), "umfpack")
    monkeypatch.setattr(factor_mumps, "available", lambda: False)
    with pytest.raises(ModelError, match=r"not installed.*\n.*strutwork\[accel\].*PyMUMPS"):
        factorize(definite(), "mumps")


def test_without_extras_superlu_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    for name, module in SOLVERS.items():
        if name != "superlu":
            monkeypatch.setattr(module, "available", lambda: False)
    assert factorize(definite()).name == "SuperLU ordered by METIS"


@pytest.mark.parametrize("solver", INSTALLED)
def test_without_metis_each_orders_by_itself(solver: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(strutwork.fea.ordering, "pymetis", None)
    matrix, right = definite(), np.ones(300)
    factor = factorize(matrix, solver)
    assert factor.memory is None
    np.testing.assert_allclose(matrix @ factor.solve(right), right, atol=1e-11)


def test_fill_is_that_of_the_factor() -> None:
    stiffness, _, _ = frame(6, 3, 2).held()
    found = nested_dissection(stiffness)
    assert sorted(found.order) == list(range(stiffness.shape[0]))
    ordered = stiffness[found.order][:, found.order].toarray() != 0
    n = len(ordered)
    for k in range(n):  # symbolic elimination on the dense pattern
        below = np.flatnonzero(ordered[k + 1 :, k]) + k + 1
        ordered[np.ix_(below, below)] = True
    lengths = np.array([1 + np.count_nonzero(ordered[k + 1 :, k]) for k in range(n)])
    assert found.fill == pytest.approx(lengths.sum(), rel=0.01)
    assert found.flops == pytest.approx((lengths**2.0).sum(), rel=0.02)
    factor = factorize(stiffness)
    assert factor.fill == found.fill
    assert factor.flops == found.flops
    assert "MB foreseen" in repr(factor)


def test_what_does_not_fit_is_refused_before_it_starts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(strutwork.fea.memory, "available_memory", lambda: 1e5)
    monkeypatch.setattr(factor_mumps, "factorize", lambda *_: pytest.fail("was started"))
    for solver in INSTALLED:
        with pytest.raises(NumericalError, match=r"0\.0001 GB are available.*\n.*coarser"):
            factorize(definite(), solver)


def test_memory_that_runs_out_all_the_same_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise MemoryError

    monkeypatch.setattr(factor_superlu, "factorize", fail)
    with pytest.raises(NumericalError, match="ran out of memory"):
        factorize(definite(), "superlu")


def test_available_memory_is_the_least_of_all_limits(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    info, limit, used = (tmp_path / n for n in ("meminfo", "max", "current"))
    info.write_text("MemTotal: 9 kB\nMemAvailable:    4000 kB\n")
    monkeypatch.setattr(strutwork.memory, "MEMINFO", info)
    monkeypatch.setattr(strutwork.memory, "CONTROL_GROUPS", ((limit, used),))
    assert available_memory() == 4000 * 1024
    limit.write_text("max\n")
    used.write_text("5\n")
    assert available_memory() == 4000 * 1024
    limit.write_text("1005\n")
    assert available_memory() == 1000
    info.unlink()
    limit.unlink()
    assert available_memory() == np.inf
    require_memory(3, 1e18, "SuperLU")


def test_complex_factors_take_twice_the_memory() -> None:
    for name in strutwork.fea.memory.BYTES:
        assert foreseen_memory(10, 10, name, 16) == 2 * foreseen_memory(10, 10, name)


def test_the_count_of_fill_is_the_same_uncompiled(monkeypatch: pytest.MonkeyPatch) -> None:
    compiled = strutwork.fea.ordering._counts
    stiffness, _, _ = frame(4, 2, 2).held()
    expected = nested_dissection(stiffness)
    monkeypatch.setattr(strutwork.fea.ordering, "_counts", getattr(compiled, "py_func", compiled))
    assert nested_dissection(stiffness).fill == expected.fill
