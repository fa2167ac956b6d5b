"""Block Lanczos beside dense eigenvalues."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
import scipy.sparse as sp

from strutwork.errors import ModelError, NumericalError
from strutwork.fea import large_modes
from strutwork.fea.factorize import installed_solvers
from strutwork.fea.large_modes import lowest_modes
from tests.solids import bricks, frame


def dense(stiffness: sp.csc_array, mass: sp.csc_array, count: int) -> np.ndarray:
    square = scipy.linalg.eigh(
        stiffness.toarray(), mass.toarray(), eigvals_only=True, subset_by_index=[0, count - 1]
    )
    return np.sqrt(np.maximum(square, 0.0)) / (2 * np.pi)


@pytest.mark.parametrize("solver", installed_solvers())
def test_a_held_frame(solver: str) -> None:
    stiffness, mass, _ = frame(10, 3, 3).held()
    found = lowest_modes(stiffness, mass, 10, solver=solver, counted=solver != "cholmod")
    np.testing.assert_allclose(found.frequencies, dense(stiffness, mass, 10), rtol=1e-9)
    assert found.residuals.max() < 1e-7
    assert found.solver.lower().startswith(f"block lanczos, {solver}")
    assert "block Lanczos" in repr(found)
    v = found.vectors
    np.testing.assert_allclose(v.T @ (mass @ v), np.eye(10), atol=1e-12)
    square = (2 * np.pi * found.frequencies) ** 2
    np.testing.assert_allclose(v.T @ (stiffness @ v), np.diag(square), atol=1e-9 * square.max())


def test_a_free_cube_has_all_copies_and_six_zeros() -> None:
    cube = bricks(np.ones((6, 6, 6), dtype=bool))
    found = lowest_modes(cube.stiffness, cube.mass, 22, floating=True, counted=True)
    assert np.all(found.frequencies[:6] == 0)
    expected = dense(cube.stiffness, cube.mass, 22)
    np.testing.assert_allclose(found.frequencies[6:], expected[6:], rtol=1e-9)


@pytest.mark.parametrize("factor", [1e-9, 1e9])
def test_units_do_not_matter(factor: float) -> None:
    cube = bricks(np.ones((5, 2, 2), dtype=bool))
    found = lowest_modes(cube.stiffness * factor, cube.mass, 10, floating=True)
    expected = dense(cube.stiffness, cube.mass, 10)[6:] * np.sqrt(factor)
    np.testing.assert_allclose(found.frequencies[6:], expected, rtol=1e-8)


def test_a_slender_floating_bar_moves_its_shift() -> None:
    """The first shift, from single dofs, lies far above the bar's first mode."""
    bar = bricks(np.ones((150, 1, 1), dtype=bool))
    found = lowest_modes(bar.stiffness, bar.mass, 9, floating=True)
    # a mode's ω² is known to rounding of the largest stiffness: six digits of 1e-9
    np.testing.assert_allclose(
        found.frequencies[6:], dense(bar.stiffness, bar.mass, 9)[6:], rtol=1e-5
    )


def test_parts_without_mass_are_no_modes() -> None:
    stiffness, mass, free = frame(6, 2, 2).held()
    kept = sp.diags_array((np.arange(len(free)) >= 60).astype(float))
    lighter = sp.csc_array(kept @ mass @ kept)
    found = lowest_modes(stiffness, lighter, 5)
    values = scipy.linalg.eigh(lighter.toarray(), stiffness.toarray(), eigvals_only=True)[::-1]
    np.testing.assert_allclose(found.frequencies, 1 / np.sqrt(values[:5]) / (2 * np.pi), rtol=1e-9)


def test_fewer_modes_than_asked_for() -> None:
    stiffness, _, free = frame(3, 1, 1).held()
    mass = np.zeros(len(free))
    mass[:2] = 1.0
    with pytest.raises(NumericalError, match=r"fewer|converge"):
        lowest_modes(stiffness, sp.csc_array(sp.diags_array(mass)), 5)


def test_too_many_modes() -> None:
    stiffness, mass, free = frame(3, 1, 1).held()
    for count in (0, len(free)):
        with pytest.raises(ModelError, match="lowest modes"):
            lowest_modes(stiffness, mass, count)


def test_a_negative_stiffness_is_refused() -> None:
    stiffness, mass, _ = frame(5, 2, 2).held()
    first = (2 * np.pi * dense(stiffness, mass, 1)[0]) ** 2
    with pytest.raises(NumericalError, match="positive"):
        lowest_modes(sp.csc_array(stiffness - 1.5 * first * mass), mass, 3)


def test_a_missed_mode_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    stiffness, mass, _ = frame(6, 2, 2).held()
    genuine = large_modes._lanczos

    def lose(*arguments: object) -> tuple[np.ndarray, ...]:
        parts = genuine(*arguments)  # type: ignore[arg-type]
        return tuple(np.delete(p, 1, axis=-1) for p in parts)

    monkeypatch.setattr(large_modes, "_lanczos", lose)
    with pytest.raises(NumericalError, match="were found below"):
        lowest_modes(stiffness, mass, 6, counted=True)
