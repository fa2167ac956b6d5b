"""Memory that a factorisation will take, against what the machine has, before it starts."""

from __future__ import annotations

from strutwork.errors import NumericalError
from strutwork.memory import available_memory

#: Bytes per entry of the Cholesky factor and per entry of the matrix at a factorisation's peak,
#: measured on bricks of 22 000 to 295 000 dofs: values and supernodes' padding, and indices,
#: copies and working space.
BYTES = {
    "CHOLMOD": (8.6, 33.0),
    "MUMPS": (11.0, 25.0),
    "PARDISO": (8.8, 28.0),
    "SuperLU": (16.0, 55.0),
}

def foreseen_memory(fill: int, entries: int, library: str, scalar: int = 8) -> float:
    """Bytes at the peak of a factorisation.

    Parameters
    ----------
    fill : int
        Entries of the Cholesky factor.
    entries : int
        Entries of the matrix.
    library : str
        Key of `BYTES`.
    scalar : int
        Bytes of a number: 8 real, 16 complex.
    """
    factor, matrix = BYTES[library]
    return (fill * factor + entries * matrix) * scalar / 8.0


def require_memory(size: int, need: float, name: str) -> None:
    """Refuse a factorisation that will not fit.

    Raises
    ------
    NumericalError
        The estimate is above what is available.
    """
    available = available_memory()
    if need > available:
        raise NumericalError(
            f"factorisation of {size:,} dofs",
            f"will take about {need / 1e9:.3g} GB with {name}; "
            f"{available / 1e9:.3g} GB are available.",
            "Mesh coarser (memory grows as dofs to the power 4/3), reduce the parts one by one, "
            "install strutwork[accel], which takes half of SuperLU's memory, or share the work "
            'among machines with solver="slepc", which needs petsc4py, slepc4py and MPI.',
        )
