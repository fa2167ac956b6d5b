"""Sobol indices of a study: which parameter the variance of each answer comes from."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.studies.sobol_blocks import rows_of, salib

Array = NDArray[Any]

#: Level of the confidence intervals, and bootstrap samples that give them.
LEVEL, RESAMPLES = 0.95, 100

#: Share of the blocks that must be complete, and how many at least.
COMPLETE, FEWEST = 0.5, 8

#: Range of an answer, as a share of its size, below which it does not vary.
CONSTANT = 1e-9


@dataclass(frozen=True)
class Indices:
    """Sobol indices of one answer.

    Parameters
    ----------
    first, total : (k,)
        Share of the variance that comes from each parameter alone, and with all its interactions;
        no unit. NaN where there are none, for the reason `refused`.
    first_confidence, total_confidence : (k,)
        Half widths of their intervals at `LEVEL`, no unit.
    second, second_confidence : (k, k)
        Of two parameters together, above the diagonal, no unit; NaN without second order.
    dropped : tuple of int
        Numbers of the blocks that were left out, since a machine of each has no finite answer.
    refused : str
        Why there are no indices; empty where there are.
    """

    first: Array
    first_confidence: Array
    total: Array
    total_confidence: Array
    second: Array
    second_confidence: Array
    dropped: tuple[int, ...]
    refused: str = ""


def indices(values: Array, parameters: int, *, second_order: bool, seed: int = 0) -> Indices:
    """Sobol indices of an answer over blocks of points.

    First order after Saltelli et al. (2010, table 2 b), total after Jansen (ibid., table 2 f),
    second order after Saltelli (2002), intervals by bootstrap over the blocks: SALib.

    Parameters
    ----------
    values : (n,)
        Of all points of the blocks in the order of
        `strutwork.studies.sobol_blocks.block_shares`, any unit; a value that is not finite leaves
        its block out.
    parameters : int
        k.
    second_order : bool
        As in the sample.
    seed : int
        Of the bootstrap.

    Returns
    -------
    Indices

    Raises
    ------
    ModelError
        SALib is not installed.
    """
    rows = rows_of(parameters, second_order)
    blocks = np.asarray(values, dtype=float).reshape(-1, rows)
    complete = np.isfinite(blocks).all(axis=1)
    dropped = tuple(np.flatnonzero(~complete).tolist())
    kept = blocks[complete]
    refused = ""
    if len(kept) < max(FEWEST, COMPLETE * len(blocks)):
        refused = (
            f"{len(dropped)} of {len(blocks)} blocks hold a machine without this answer; half of "
            "them are needed. Narrow the ranges."
        )
    elif np.ptp(kept) <= CONSTANT * np.abs(kept).max():
        refused = "it does not vary."
    if refused:
        none, square = np.full(parameters, np.nan), np.full((parameters, parameters), np.nan)
        return Indices(none, none, none, none, square, square, dropped, refused)
    with warnings.catch_warnings():
        # of a resample without variance SALib says so and gives none
        warnings.simplefilter("ignore")
        found = salib("analyze.sobol").analyze(
            {"num_vars": parameters, "names": [str(i) for i in range(parameters)]},
            kept.ravel(),
            calc_second_order=second_order,
            num_resamples=RESAMPLES,
            conf_level=LEVEL,
            # its zero stands for no seed
            seed=seed + 1,
        )
    square = np.full((parameters, parameters), np.nan)
    return Indices(
        np.asarray(found["S1"]),
        np.asarray(found["S1_conf"]),
        np.asarray(found["ST"]),
        np.asarray(found["ST_conf"]),
        np.asarray(found["S2"]) if second_order else square,
        np.asarray(found["S2_conf"]) if second_order else square,
        dropped,
    )


def dropped_words(dropped: Sequence[tuple[int, ...]], blocks: int) -> str:
    """Which blocks were left out of all answers, in words; empty where none was.

    Parameters
    ----------
    dropped : sequence of tuple of int
        For each answer.
    blocks : int
        Of the sample.
    """
    counts = Counter(d for some in dropped for d in some)
    if not counts:
        return ""
    numbers = sorted(counts)
    shown = ", ".join(map(str, numbers[:20])) + (" …" if len(numbers) > 20 else "")
    return f"{len(numbers)} of {blocks} blocks are incomplete and left out: {shown}"
