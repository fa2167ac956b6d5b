"""Points for Sobol indices: blocks in which one parameter after the other is exchanged."""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError

Array = NDArray[Any]

#: Least number of blocks: with fewer an index says nothing.
LEAST = 8


def rows_of(parameters: int, second_order: bool) -> int:
    """Points of a block.

    Parameters
    ----------
    parameters : int
    second_order : bool
    """
    return 2 * parameters + 2 if second_order else parameters + 2


def salib(name: str) -> ModuleType:
    """A module of SALib.

    Parameters
    ----------
    name : str
        As "sample.sobol".

    Raises
    ------
    ModelError
        SALib is not installed.
    """
    # it loads pandas and SciPy's statistics, a second
    from importlib import import_module  # noqa: PLC0415

    try:
        return import_module(f"SALib.{name}")
    except ImportError:
        raise ModelError(
            "sample",
            "is for Sobol indices, and the library SALib is not installed.",
            'Install it: pip install "strutwork[design]"; or choose kind = "sobol".',
        ) from None


def block_shares(count: int, parameters: int, seed: int, *, second_order: bool) -> Array:
    """Points of all blocks, (count × rows, k), between 0 and 1.

    The blocks are those of Saltelli (2010) over a scrambled Sobol sequence, from SALib.

    Parameters
    ----------
    count : int
        Blocks, a power of two.
    parameters : int
        k.
    seed : int
    second_order : bool

    Raises
    ------
    ModelError
        Too few blocks, no power of two, a single parameter, or SALib is not installed.
    """
    if count < LEAST or count & (count - 1):
        below = max(LEAST, 1 << (count.bit_length() - 1))
        raise ModelError(
            "sample.count",
            f"is {count}; blocks for Sobol indices are a power of two, {LEAST} or more.",
            f"Take {below} or {2 * below}.",
        )
    if parameters < 2:
        raise ModelError(
            "sample",
            "is for Sobol indices, and there is one parameter, which decides everything.",
            'Vary two at least, or choose kind = "sobol".',
        )
    made = salib("sample.sobol").sample(
        {
            "num_vars": parameters,
            "names": [str(i) for i in range(parameters)],
            "bounds": [[0.0, 1.0]] * parameters,
        },
        count,
        calc_second_order=second_order,
        seed=np.random.default_rng(seed),
    )
    return np.asarray(made, dtype=float)
