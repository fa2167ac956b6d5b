"""Ten lowest modes by SLEPc with MUMPS in one process: a program of its own.

Run by `benchmarks.solid_speed` as `python slepc_modes.py FOLDER COUNT` on any Python that has
petsc4py, slepc4py and NumPy. Reads K.npz and M.npz as SciPy's `save_npz` writes them, and prints
JSON: frequencies, and processor seconds from the loaded arrays on.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

#: Residual of the inverted operator's eigenpair beside its eigenvalue: that of
#: `strutwork.fea.large_modes.RESIDUAL`, which this Python may not be able to import.
TOLERANCE = 1e-7


def arrays(petsc: Any, file: Path) -> tuple[Any, ...]:
    """Starts, columns and values of the rows, which are the columns of a symmetric matrix."""
    with np.load(file) as parts:
        return (
            np.asarray(parts["indptr"], dtype=petsc.IntType),
            np.asarray(parts["indices"], dtype=petsc.IntType),
            np.asarray(parts["data"], dtype=petsc.ScalarType),
        )


def solver_of(petsc: Any, slepc: Any, stiffness: Any, mass: Any, count: int) -> Any:
    """Krylov-Schur about zero, inverted by MUMPS's symmetric factors."""
    solver = slepc.EPS().create(petsc.COMM_SELF)
    solver.setOperators(stiffness, mass)
    solver.setProblemType(slepc.EPS.ProblemType.GHEP)
    solver.setType(slepc.EPS.Type.KRYLOVSCHUR)
    solver.setDimensions(count)
    solver.setTarget(0.0)
    solver.setWhichEigenpairs(slepc.EPS.Which.TARGET_MAGNITUDE)
    solver.setTolerances(TOLERANCE, 500)
    transform = solver.getST()
    transform.setType(slepc.ST.Type.SINVERT)
    linear = transform.getKSP()
    linear.setType(petsc.KSP.Type.PREONLY)
    conditioner = linear.getPC()
    conditioner.setType(petsc.PC.Type.CHOLESKY)
    conditioner.setFactorSolverType("mumps")
    return solver


def main() -> None:
    """Solve and print."""
    import petsc4py  # noqa: PLC0415 - takes the program's arguments before it starts

    # nothing of this program's own arguments is PETSc's
    petsc4py.init(sys.argv[:1])
    from petsc4py import PETSc as petsc  # noqa: N813, PLC0415
    from slepc4py import SLEPc as slepc  # noqa: N813, PLC0415

    folder, count = Path(sys.argv[1]), int(sys.argv[2])
    loaded = [arrays(petsc, folder / name) for name in ("K.npz", "M.npz")]
    begin = time.process_time()
    stiffness, mass = (
        petsc.Mat().createAIJ((len(rows[0]) - 1,) * 2, csr=rows, comm=petsc.COMM_SELF)
        for rows in loaded
    )
    # PETSc has its copies now
    del loaded
    for one in (stiffness, mass):
        one.assemble()
        one.setOption(petsc.Mat.Option.SYMMETRIC, True)
    solver = solver_of(petsc, slepc, stiffness, mass, count)
    solver.solve()
    found = solver.getConverged()
    if found < count:
        message = f"{found} of {count} modes converged"
        raise RuntimeError(message)
    squares = np.sort([solver.getEigenvalue(i).real for i in range(found)])[:count]
    vector = stiffness.createVecRight()
    # our result holds the vectors too
    vectors = []
    for i in range(count):
        solver.getEigenvector(i, vector)
        vectors.append(vector.getArray().copy())
    said = {
        "dofs": len(vectors[0]),
        "modes": time.process_time() - begin,
        "frequencies": (np.sqrt(squares) / (2.0 * np.pi)).tolist(),
        "solver": "SLEPc with MUMPS",
    }
    print(json.dumps(said))


if __name__ == "__main__":
    main()
