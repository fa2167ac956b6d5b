"""Factorisation of large sparse symmetric matrices by what is installed."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType

import numpy as np
import scipy.sparse as sp

from strutwork.errors import ModelError, NumericalError
from strutwork.fea import factor_cholmod, factor_mumps, factor_pardiso, factor_superlu, ordering
from strutwork.fea.factor import Factor, NotPositiveError, singular
from strutwork.fea.memory import foreseen_memory, require_memory
from strutwork.stages import stage

__all__ = ["SOLVERS", "Factor", "factorize", "installed_solvers"]

#: Fastest first, as measured in docs/performance-solids.md.
SOLVERS: dict[str, ModuleType] = {
    "cholmod": factor_cholmod,
    "mumps": factor_mumps,
    "pardiso": factor_pardiso,
    "superlu": factor_superlu,
}

#: What to install for each.
INSTALL = {
    "cholmod": 'pip install "scikit-sparse<0.5" (after apt install libsuitesparse-dev)',
    "mumps": "pip install PyMUMPS (after apt install libmumps-seq-dev)",
    "pardiso": "pip install pypardiso",
}


#: Operations a second by which the time of a factorisation is foreseen, on one thread: SuperLU's,
#: measured on cubes of 36 000 to 108 000 degrees of freedom, which have larger fronts than slender
#: solids; the others take a third to a quarter of its time.
FLOPS, OTHERS = {"SuperLU": 3.3e9}, 1.2e10


def installed_solvers() -> tuple[str, ...]:
    """Names of the solvers that can run here, fastest first."""
    return tuple(name for name, module in SOLVERS.items() if module.available())


def factorize(matrix: sp.csc_array, solver: str | None = None, *, positive: bool = True) -> Factor:
    """Factorise a symmetric matrix.

    The order of elimination is found first, by METIS's nested dissection, and with it what
    the factorisation will take; where that is more memory than there is, nothing is started.

    Parameters
    ----------
    matrix : (n, n) sparse
        Real, or complex and symmetric, not Hermitian; any unit.
    solver : "cholmod", "mumps", "pardiso" or "superlu", optional
        By default the fastest of those installed that takes the matrix.
    positive : bool
        Whether a positive definite matrix is expected: Cholesky's method is tried first and
        another takes over where it fails.

    Returns
    -------
    Factor
        Its name says which ran.

    Raises
    ------
    ModelError
        A solver that is unknown, not installed, or does not take such a matrix.
    NumericalError
        A singular matrix, or one whose factors will not fit into memory.
    """
    whole = sp.csc_array(matrix)
    # NumPy integers and single precision would come back as such
    whole = whole.astype(complex if whole.dtype.kind == "c" else float, copy=False)
    if not np.all(np.isfinite(whole.data)):
        raise NumericalError(
            "factorisation", "of numbers that are not finite.", "Check materials and coordinates."
        )
    if whole.nnz == 0:
        raise singular()
    found = None if ordering.pymetis is None else ordering.nested_dissection(whole)
    for name in _candidates(whole, solver, positive):
        module = SOLVERS[name]
        memory = None
        if found is not None:
            memory = foreseen_memory(found.fill, whole.nnz, module.NAME, whole.dtype.itemsize)
            require_memory(whole.shape[0], memory, module.NAME)
        try:
            with stage(*_told(whole.shape[0], module.NAME, found)):
                factor: Factor = module.factorize(whole, found)
        except NotPositiveError:
            continue
        except MemoryError as error:
            raise NumericalError(
                f"factorisation of {whole.shape[0]:,} dofs",
                f"ran out of memory, or of {module.NAME}'s indices.",
                "Mesh coarser, or choose another solver.",
            ) from error
        if found is None:
            return factor
        return replace(factor, fill=found.fill, memory=memory, flops=found.flops)
    raise ModelError(
        f"solver {solver}",
        "accepts only positive definite matrices.",
        f"Choose one of {', '.join(n for n in installed_solvers() if SOLVERS[n].INDEFINITE)}.",
    )


def _told(size: int, name: str, found: ordering.Ordering | None) -> tuple[str, float | None]:
    """What to say of a factorisation, and how long it takes, s."""
    return f"factorises {size:,} degrees of freedom with {name}", (
        None if found is None else found.flops / FLOPS.get(name, OTHERS)
    )


def _candidates(matrix: sp.csc_array, solver: str | None, positive: bool) -> tuple[str, ...]:
    installed = installed_solvers()
    is_complex = matrix.dtype.kind == "c"
    if solver is None:
        return tuple(
            name
            for name in installed
            if (SOLVERS[name].COMPLEX or not is_complex) and (SOLVERS[name].INDEFINITE or positive)
        )
    if solver not in SOLVERS:
        raise ModelError(f"solver {solver}", "is unknown.", f"Choose one of {', '.join(SOLVERS)}.")
    if solver not in installed:
        raise ModelError(
            f"solver {solver}",
            "is not installed.",
            (
                f"Install strutwork[accel], or: {INSTALL[solver]}. Installed here: "
                f"{', '.join(installed)}."
            ),
        )
    if is_complex and not SOLVERS[solver].COMPLEX:
        able = [n for n in installed if SOLVERS[n].COMPLEX]
        raise ModelError(
            f"solver {solver}", "accepts no complex matrices.", f"Choose one of {', '.join(able)}."
        )
    return (solver,)
