"""A factorised matrix, whichever library made it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import NumericalError

Array = NDArray[Any]


@dataclass(frozen=True)
class Factor:
    """A factorised matrix.

    Parameters
    ----------
    solve : callable
        From a right-hand side (n,) or (n, m), real or complex, to the solution.
    name : str
        Which factorisation ran.
    negative_pivots : callable
        Number of negative pivots, which is that of negative eigenvalues (Sylvester's law of
        inertia). SuperLU copies the factors for it: for the few cases that need it.
    fill : int or None
        Entries of the Cholesky factor foreseen before it was computed; None where nothing
        orders the matrix in advance.
    memory : float or None
        Bytes foreseen.
    flops : float or None
        Multiplications and additions foreseen, their number: no unit.
    """

    solve: Callable[[Array], Array]
    name: str
    negative_pivots: Callable[[], int]
    fill: int | None = None
    memory: float | None = None
    flops: float | None = None

    def __repr__(self) -> str:
        if self.memory is None:
            return f"<Factor: {self.name}>"
        return f"<Factor: {self.name}, {self.memory / 1e6:,.0f} MB foreseen>"


def complex_too(solve: Callable[[Array], Array]) -> Callable[[Array], Array]:
    """Let a real factor solve complex right-hand sides, both parts in one go.

    Parameters
    ----------
    solve : callable
        From a real right-hand side (n,) or (n, m) to the solution.
    """

    def both(right: Array) -> Array:
        right = np.asarray(right)
        if not np.iscomplexobj(right):
            return solve(np.asarray(right, dtype=float))
        columns = right.reshape(len(right), -1)
        parts = solve(np.concatenate([columns.real, columns.imag], axis=1))
        half = columns.shape[1]
        return np.asarray((parts[:, :half] + 1j * parts[:, half:]).reshape(right.shape))

    return both


def singular() -> NumericalError:
    """The error of every library that meets a zero pivot."""
    return NumericalError(
        "factorisation", "met a singular matrix.", "Check for a part that nothing holds."
    )


class NotPositiveError(NumericalError):
    """Cholesky's method met a pivot that is not positive; another method may do."""

    def __init__(self) -> None:
        super().__init__(
            "factorisation",
            "encountered a pivot that is not positive.",
            "Check for a part that nothing holds, or use another solver.",
        )
