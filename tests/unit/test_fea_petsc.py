"""Two ranks of PETSc and SLEPc beside this process.

Needs Debian's python3-petsc4py, python3-slepc4py and openmpi-bin.
"""

from __future__ import annotations

import shutil
import subprocess
from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp

import strutwork.fea.petsc
from strutwork.errors import ModelError, NumericalError
from strutwork.fea.factorize import factorize
from strutwork.fea.large_modes import lowest_modes
from strutwork.fea.petsc import Ranks, petsc_python, petsc_solve
from tests.solids import bricks, frame

#: Root may start MPI in a container, and two ranks may share one core.
RANKS = Ranks(2, ("mpiexec", "--allow-run-as-root", "--oversubscribe", "-n"))


def installed() -> None:
    if petsc_python() is None or shutil.which("mpiexec") is None:
        pytest.fail("install python3-petsc4py, python3-slepc4py and openmpi-bin")


@pytest.mark.slow
def test_modes_on_two_ranks_are_those_of_one_process() -> None:
    installed()
    stiffness, mass, _ = frame(10, 3, 3).held()
    found = lowest_modes(stiffness, mass, 6, solver="slepc", ranks=RANKS)
    assert "2 ranks" in found.solver
    own = lowest_modes(stiffness, mass, 6)
    np.testing.assert_allclose(found.frequencies, own.frequencies, rtol=1e-8)
    overlap = np.abs(found.vectors.T @ mass @ own.vectors)
    np.testing.assert_allclose(overlap, np.eye(6), atol=1e-5)


@pytest.mark.slow
def test_a_free_cube_on_two_ranks() -> None:
    installed()
    cube = bricks(np.ones((4, 4, 4), dtype=bool))
    found = lowest_modes(cube.stiffness, cube.mass, 12, floating=True, solver="slepc", ranks=RANKS)
    own = lowest_modes(cube.stiffness, cube.mass, 12, floating=True)
    assert np.all(found.frequencies[:6] == 0)
    np.testing.assert_allclose(found.frequencies[6:], own.frequencies[6:], rtol=1e-7)


@pytest.mark.slow
def test_displacements_on_two_ranks() -> None:
    installed()
    stiffness, _, _ = frame(8, 3, 3).held()
    loads = np.random.default_rng(0).normal(size=(stiffness.shape[0], 2))
    found, name = petsc_solve(stiffness, loads, RANKS)
    assert name.startswith("PETSc")
    expected = factorize(stiffness).solve(loads)
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())
    single, _ = petsc_solve(stiffness, loads[:, 0], RANKS)
    np.testing.assert_allclose(single, found[:, 0], atol=1e-9 * np.abs(expected).max())


def test_what_is_missing_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(strutwork.fea.petsc, "petsc_python", lambda: None)
    with pytest.raises(ModelError, match=r"petsc4py.*\n.*python3-slepc4py"):
        petsc_solve(sp.csc_array(sp.eye_array(3)), np.ones(3), Ranks())
    with pytest.raises(ModelError, match="processes"):
        Ranks(0)


def test_a_worker_that_fails_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: Any, **__: Any) -> subprocess.CompletedProcess[str]:
        return subprocess.CompletedProcess([], 3, "", "no slots")

    monkeypatch.setattr(strutwork.fea.petsc, "petsc_python", lambda: "python3")
    monkeypatch.setattr(strutwork.fea.petsc.shutil, "which", lambda _: "mpiexec")
    monkeypatch.setattr(strutwork.fea.petsc.subprocess, "run", fail)
    with pytest.raises(NumericalError, match="ended with 3: no slots"):
        petsc_solve(sp.csc_array(sp.eye_array(3)), np.ones(3), Ranks())
