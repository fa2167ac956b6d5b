"""Eigen and static solutions by PETSc and SLEPc under MPI: a program of its own.

Run by `strutwork.fea.petsc` as `mpiexec -n RANKS python petsc_worker.py FOLDER`, on any Python that
has petsc4py, slepc4py and NumPy, which need not be the one that asks. Every rank reads its rows of
the matrices; the first writes the answer.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np


def matrix(petsc: Any, folder: Path, name: str) -> Any:
    """A distributed matrix from arrays mapped from files, each rank its own rows.

    Parameters
    ----------
    petsc : module
        `petsc4py.PETSc`.
    folder : Path
        Where the arrays `NAME.indptr.npy` and so on are.
    name : str
        Of the matrix.
    """
    indptr, indices, data = (
        np.load(folder / f"{name}.{part}.npy", mmap_mode="r")
        for part in ("indptr", "indices", "data")
    )
    n = len(indptr) - 1
    size, rank = petsc.COMM_WORLD.getSize(), petsc.COMM_WORLD.getRank()
    low, high = rank * n // size, (rank + 1) * n // size
    first, last = int(indptr[low]), int(indptr[high])
    rows = (
        (indptr[low : high + 1] - first).astype(petsc.IntType),
        np.asarray(indices[first:last]).astype(petsc.IntType),
        np.asarray(data[first:last], dtype=float).astype(petsc.ScalarType),
    )
    made = petsc.Mat().createAIJ(((high - low, n), (high - low, n)), csr=rows)
    made.assemble()
    made.setOption(petsc.Mat.Option.SYMMETRIC, True)
    return made


def direct(solver: Any, petsc: Any) -> None:
    """Let a linear solver factorise with MUMPS.

    Parameters
    ----------
    solver : KSP
        Set up in place.
    petsc : module
        `petsc4py.PETSc`.
    """
    solver.setType(petsc.KSP.Type.PREONLY)
    preconditioner = solver.getPC()
    preconditioner.setType(petsc.PC.Type.CHOLESKY)
    preconditioner.setFactorSolverType("mumps")


def whole(petsc: Any, vector: Any) -> Any:
    """A distributed vector on the first rank, (n,); empty on the others.

    Parameters
    ----------
    petsc : module
        `petsc4py.PETSc`.
    vector : Vec
    """
    scatter, target = petsc.Scatter.toZero(vector)
    scatter.scatter(vector, target)
    return np.real(target.getArray()).copy()


def modes(petsc: Any, folder: Path, task: dict[str, Any]) -> dict[str, Any]:
    """Lowest ω², (m,), rad²/s², and vectors, (m, n), by SLEPc's Krylov-Schur, shifted and inverted.

    Parameters
    ----------
    petsc : module
        `petsc4py.PETSc`.
    folder : Path
        Holds the stiffness and the mass.
    task : dict
        `count`, and `shift`, rad²/s².
    """
    from slepc4py import SLEPc as slepc  # noqa: N813, PLC0415 - as the library writes it

    stiffness, mass = matrix(petsc, folder, "stiffness"), matrix(petsc, folder, "mass")
    solver = slepc.EPS().create()
    solver.setOperators(stiffness, mass)
    solver.setProblemType(slepc.EPS.ProblemType.GHEP)
    solver.setDimensions(task["count"])
    solver.setTarget(-task["shift"])
    solver.setWhichEigenpairs(slepc.EPS.Which.TARGET_MAGNITUDE)
    solver.setTolerances(1e-10, 500)
    transform = solver.getST()
    transform.setType(slepc.ST.Type.SINVERT)
    direct(transform.getKSP(), petsc)
    # Lanczos' method may miss copies of a frequency: again without what it found
    kept: list[tuple[float, Any]] = []
    wanted = task["count"]
    while True:
        solver.solve()
        new = []
        for i in range(min(solver.getConverged(), wanted)):
            vector = stiffness.createVecRight()
            new.append((float(np.real(solver.getEigenpair(i, vector))), vector))
        full = len(kept) >= task["count"]
        if full:
            worst = kept[task["count"] - 1][0]
            new = [pair for pair in new if pair[0] < worst - 1e-6 * (worst + task["shift"])]
        if not new or (kept and not full):
            break
        kept = sorted([*kept, *new], key=lambda pair: pair[0])
        solver.setDeflationSpace([vector for _, vector in kept])
        wanted = min(4, task["count"])
        solver.setDimensions(wanted)
    kept = kept[: task["count"]]
    return {
        "values": np.array([value for value, _ in kept]),
        "vectors": np.array([whole(petsc, vector) for _, vector in kept]),
    }


def static(petsc: Any, folder: Path, _: dict[str, Any]) -> dict[str, Any]:
    """Displacements under some loads, (m, n), m.

    Parameters
    ----------
    petsc : module
        `petsc4py.PETSc`.
    folder : Path
        Holds the stiffness, and the loads (n, m) in `loads.npy`, N.
    _ : dict
        Not used.
    """
    stiffness = matrix(petsc, folder, "stiffness")
    loads = np.load(folder / "loads.npy", mmap_mode="r")
    solver = petsc.KSP().create()
    solver.setOperators(stiffness)
    direct(solver, petsc)
    right, answer = stiffness.createVecLeft(), stiffness.createVecRight()
    low, high = right.getOwnershipRange()
    columns = []
    for i in range(loads.shape[1]):
        right.setArray(np.asarray(loads[low:high, i]).astype(petsc.ScalarType))
        solver.solve(right, answer)
        columns.append(whole(petsc, answer))
    return {"vectors": np.array(columns)}


def main() -> None:
    """Carry out the task described in the folder."""
    import petsc4py  # noqa: PLC0415 - takes the program's arguments before it starts

    petsc4py.init(sys.argv[:1])
    from petsc4py import PETSc as petsc  # noqa: N813, PLC0415

    folder = Path(sys.argv[1])
    task = json.loads((folder / "task.json").read_text(encoding="utf-8"))
    answer = (modes if task["kind"] == "modes" else static)(petsc, folder, task)
    if petsc.COMM_WORLD.getRank() == 0:
        for name, values in answer.items():
            np.save(folder / f"answer.{name}.npy", values)
        ranks = petsc.COMM_WORLD.getSize()
        version = ".".join(map(str, petsc.Sys.getVersion()))
        text = json.dumps({"ranks": ranks, "petsc": version})
        (folder / "answer.json").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
