"""Functions compiled to machine code when first called, and kept for later runs where possible."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import njit

from strutwork.jit_cache import code_cache


def jit(*, contract: bool = False) -> Any:
    """Compile a function with numba: without the interpreter's lock, with NumPy's division by zero.

    Parameters
    ----------
    contract : bool
        Let a multiplication and an addition be one rounding, and the sign of zero be lost.

    Returns
    -------
    callable
        The decorator. What it returns is called as the function is.

    Warns
    -----
    CacheWarning
        Once per process, when a function is compiled whose code cannot be kept.

    Raises
    ------
    ImportError
        Of this module: numba is not installed.
    """
    fastmath = {"contract", "nsz"} if contract else False

    def decorate(function: Callable[..., Any]) -> Any:
        compiled: Any = njit(nogil=True, error_model="numpy", fastmath=fastmath)(function)
        # numba offers no other way to a cache of one's own
        compiled._cache = code_cache(function)  # noqa: SLF001
        return compiled

    return decorate
