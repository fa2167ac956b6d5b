"""Ten lowest modes by SLEPc with MUMPS in one process: a program of its own.

Run by `benchmarks.solid_speed` as `python slepc_modes.py FOLDER COUNT ORDER` on any Python that
has petsc4py, slepc4py and NumPy. Reads K.npz and M.npz as SciPy's `save_npz` writes them, and
prints JSON: frequencies, and processor seconds from the loaded arrays on.
"""

from __future__ import annotations

import json
import resource
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

#: Relative tolerance: twice this bounds the relative error of a frequency but for gaps. Ours
#: stops at 1e-7 of a residual in energy, whose square bounds it; 1e-9 is the same accuracy.
TOLERANCE = 1e-9


def matrix(petsc: Any, file: Path) -> Any:
    """A sequential matrix; symmetric, so that columns are rows."""
    with np.load(file) as parts:
        rows = tuple(
            np.asarray(parts[name], dtype=kind)
            for name, kind in (
                ("indptr", petsc.IntType),
                ("indices", petsc.IntType),
                ("data", petsc.ScalarType),
            )
        )
    return rows, len(rows[0]) - 1


def main() -> None:
    """Solve and print."""
    import petsc4py  # noqa: PLC0415 - takes the program's arguments before it starts

    # nothing of this program's own arguments is PETSc's
    petsc4py.init(sys.argv[:1])
    from petsc4py import PETSc as petsc  # noqa: N813, PLC0415
    from slepc4py import SLEPc as slepc  # noqa: N813, PLC0415

    folder, count, order = Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
    loaded = [matrix(petsc, folder / name) for name in ("K.npz", "M.npz")]
    begin = time.process_time()
    stiffness, mass = (
        petsc.Mat().createAIJ((n, n), csr=rows, comm=petsc.COMM_SELF) for rows, n in loaded
    )
    del loaded
    for one in (stiffness, mass):
        one.assemble()
        one.setOption(petsc.Mat.Option.SYMMETRIC, True)
    for prefix in ("", "st_"):
        petsc.Options()[f"{prefix}mat_mumps_icntl_7"] = order
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
    solver.setUp()
    factorised = time.process_time() - begin
    solver.solve()
    values = [solver.getEigenvalue(i).real for i in range(solver.getConverged())]
    seconds = time.process_time() - begin
    if len(values) < count:
        message = f"{len(values)} of {count} modes"
        raise RuntimeError(message)
    frequencies = np.sqrt(np.sort(values)[:count]) / (2.0 * np.pi)
    said = {
        "dofs": stiffness.getSize()[0],
        "modes": seconds,
        "factorisation": factorised,
        "megabytes": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
        "solver": "SLEPc with MUMPS",
        "order": conditioner.getFactorMatrix().getMumpsInfog(7),
        "flops": conditioner.getFactorMatrix().getMumpsRinfog(3),
        "its": solver.getIterationNumber(), "ncv": solver.getDimensions(),
        "frequencies": frequencies.tolist(),
    }
    print(json.dumps(said))


if __name__ == "__main__":
    main()
