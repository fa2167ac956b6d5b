"""Eigen and static solutions spread over processes and machines by PETSc and SLEPc."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import ModelError, NumericalError

Array = NDArray[Any]

WORKER = Path(__file__).with_name("petsc_worker.py")

#: Where Debian's packages put the libraries.
SYSTEM_PYTHON = "/usr/bin/python3"

#: Largest relative residual of an answer, in the norm of the forces.
RESIDUAL = 1e-6


@dataclass(frozen=True)
class Ranks:
    """How the work is spread.

    Parameters
    ----------
    count : int
        MPI processes.
    launcher : tuple of str
        Command before the count: `("mpiexec", "-n")`, `("srun", "-n")`; hosts go here too.
    python : str, optional
        A Python with petsc4py and slepc4py; by default this one, else the system's.
    folder : Path, optional
        Where the matrices are written; on several machines one that all of them see.
    """

    count: int = 2
    launcher: tuple[str, ...] = ("mpiexec", "-n")
    python: str | None = None
    folder: Path | None = None

    def __post_init__(self) -> None:
        if self.count < 1:
            raise ModelError("MPI", f"{self.count} processes.", "Give one or more.")


@cache
def petsc_python() -> str | None:
    """A Python here that has both libraries, or None."""
    for python in (sys.executable, SYSTEM_PYTHON):
        if Path(python).exists():
            check = subprocess.run(  # noqa: S603 - this Python or the system's
                [python, "-c", "import petsc4py, slepc4py, numpy"],
                capture_output=True,
                check=False,
                env=petsc_environment(),
            )
            if check.returncode == 0:
                return python
    return None


def slepc_modes(
    stiffness: sp.csc_array, mass: sp.csc_array, count: int, shift: float, ranks: Ranks
) -> tuple[Array, Array, str]:
    """Lowest ω², (m,), rad²/s², mass-normalised vectors, (n, m), and what ran.

    Parameters
    ----------
    stiffness, mass : (n, n) sparse
        N/m and kg, symmetric.
    count : int
        Rigid-body modes included.
    shift : float
        rad²/s²; the modes nearest to ω² = −shift are taken.
    ranks : Ranks

    Raises
    ------
    ModelError
        PETSc, SLEPc or the launcher is missing.
    NumericalError
        The worker failed, too few modes converged, or a residual is not small.
    """
    task = {"kind": "modes", "count": count, "shift": shift}
    answer, name = _run(task, {"stiffness": stiffness, "mass": mass}, None, ranks)
    values, vectors = answer["values"], answer["vectors"].T
    if len(values) < count:
        raise NumericalError(
            "SLEPc", f"found {len(values)} of {count} modes.", "Request fewer, or move the shift."
        )
    order = np.argsort(values)
    values, vectors = values[order], vectors[:, order]
    vectors = vectors / np.sqrt(np.einsum("ij,ij->j", vectors, mass @ vectors))
    push = (values + shift) * (mass @ vectors)
    _require_small(stiffness @ vectors + shift * (mass @ vectors) - push, push, "SLEPc")
    return values, vectors, name


def petsc_solve(stiffness: sp.csc_array, loads: Array, ranks: Ranks) -> tuple[Array, str]:
    """Displacements (n, m), m, and what ran.

    Parameters
    ----------
    stiffness : (n, n) sparse
        N/m, symmetric.
    loads : (n,) or (n, m)
        N.
    ranks : Ranks

    Raises
    ------
    ModelError
        PETSc or the launcher is missing.
    NumericalError
        The worker failed, or a residual is not small.
    """
    columns = np.asarray(loads, dtype=float).reshape(len(loads), -1)
    answer, name = _run({"kind": "static"}, {"stiffness": stiffness}, columns, ranks)
    found = answer["vectors"].T
    _require_small(stiffness @ found - columns, columns, "PETSc")
    return found.reshape(np.shape(loads)), name


def _require_small(miss: Array, beside: Array, part: str) -> None:
    share = np.linalg.norm(miss, axis=0) / np.maximum(np.linalg.norm(beside, axis=0), 1e-300)
    if not np.all(share <= RESIDUAL):
        raise NumericalError(
            part,
            f"left a residual of {share.max():.2g}.",
            "The matrix is singular or badly conditioned.",
        )


def petsc_environment() -> dict[str, str]:
    """Variables under which another Python finds PETSc and works on one thread per rank."""
    # ranks fill the cores; this Python's packages are none of the worker's
    kept = {k: v for k, v in os.environ.items() if not k.startswith("PYTHON")}
    # Debian's modules find themselves through a link that only its development packages make
    for variable, library in (("PETSC_DIR", "petsc"), ("SLEPC_DIR", "slepc")):
        places = sorted(Path("/usr/lib").glob(f"{library}dir/{library}*/*-real"))
        if places and not Path(f"/usr/lib/{library}").exists():
            kept.setdefault(variable, str(places[-1]))
    return kept | {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}


def _run(
    task: dict[str, Any], matrices: dict[str, sp.csc_array], loads: Array | None, ranks: Ranks
) -> tuple[dict[str, Array], str]:
    python = ranks.python or petsc_python()
    launcher = shutil.which(ranks.launcher[0])
    if python is None or launcher is None:
        raise ModelError(
            "solver slepc",
            "needs petsc4py, slepc4py and mpiexec, which are not installed here.",
            "On Debian: apt install python3-petsc4py python3-slepc4py openmpi-bin; elsewhere "
            "petsc4py and slepc4py from conda-forge, or compiled by pip.",
        )
    with tempfile.TemporaryDirectory(dir=ranks.folder, prefix="strutwork-petsc-") as name:
        folder = Path(name)
        for kind, matrix in matrices.items():
            # symmetric: rows are columns
            columns = sp.csc_array(matrix)
            for part in ("indptr", "indices", "data"):
                np.save(folder / f"{kind}.{part}.npy", getattr(columns, part))
        if loads is not None:
            np.save(folder / "loads.npy", loads)
        (folder / "task.json").write_text(json.dumps(task), encoding="utf-8")
        command: Sequence[str] = (
            launcher,
            *ranks.launcher[1:],
            str(ranks.count),
            python,
            str(WORKER),
            name,
        )
        done = subprocess.run(  # noqa: S603 - the caller's own launcher
            command, capture_output=True, text=True, check=False, env=petsc_environment()
        )
        if done.returncode or not (folder / "answer.json").exists():
            raise NumericalError(
                "PETSc",
                f"ended with {done.returncode}: {(done.stderr or done.stdout)[-500:].strip()}",
                "The matrix may be singular; as root or with few cores, MPI needs its own options.",
            )
        said = json.loads((folder / "answer.json").read_text(encoding="utf-8"))
        answer = {p.name.split(".")[1]: np.load(p) for p in sorted(folder.glob("answer.*.npy"))}
    kind = "SLEPc" if task["kind"] == "modes" else "PETSc"
    return answer, f"{kind} {said['petsc']} with MUMPS, {said['ranks']} ranks"
