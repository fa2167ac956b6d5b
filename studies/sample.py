"""Which machines a study makes: a grid, rows of a list, or points spread over ranges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.names import listed
from strutwork.studies.parameter import Varied
from strutwork.studies.sobol_blocks import block_shares, rows_of

Array = NDArray[Any]

KINDS = ("grid", "list", "sobol", "latin-hypercube", "random", "saltelli")

#: Machines of a study at most.
MOST = 10_000_000


@dataclass(frozen=True)
class Sample:
    """How the values of parameters are combined.

    Parameters
    ----------
    kind : str
        "grid": each value with each. "list": first values together, then second ones, and so on.
        "sobol" and "latin-hypercube": points over the ranges. "random": independent points.
        "saltelli": blocks of points for Sobol indices. Empty: a grid, where all have values or no
        count is given, else Sobol's points, or random ones where a parameter has a distribution.
    count : int or None
        Of points over ranges; of blocks, each of k + 2 points or, with second order, 2 k + 2.
    seed : int
        Of the randomisation; the same seed gives the same points.
    second_order : bool
        Whether blocks serve indices of second order as well.

    Raises
    ------
    ModelError
        A seed below zero.
    """

    kind: str = ""
    count: int | None = None
    seed: int = 0
    second_order: bool = False

    def __post_init__(self) -> None:
        if self.seed < 0:
            raise ModelError("sample.seed", f"is {self.seed}.", "Give 0 or more.")


@dataclass(frozen=True)
class Drawn:
    """The machines of a study.

    Parameters
    ----------
    kind : str
    values : (n, k)
        Of each parameter, each in its unit, any unit.
    shape : tuple of int
        Points along each parameter of a grid; else (n,).
    """

    kind: str
    values: Array
    shape: tuple[int, ...]


def drawn(sample: Sample, parameters: Sequence[Varied]) -> Drawn:
    """The machines of a sample.

    Sobol's points are scrambled (Owen), the Latin hypercube is that of `scipy.stats.qmc`.

    Parameters
    ----------
    sample : Sample
    parameters : sequence of k Varied

    Raises
    ------
    ModelError
        An unknown kind; values where a range is needed or the other way round; lists of different
        lengths; no count, or too many machines; SALib is needed and is not installed.
    """
    scattered = [p for p in parameters if p.distribution is not None]
    spread = "random" if scattered else "sobol"
    kind = sample.kind or (spread if sample.count is not None or scattered else "grid")
    if kind not in KINDS:
        raise ModelError("sample", f'is of the unknown kind "{kind}".', f"Kinds: {listed(KINDS)}.")
    if kind in ("grid", "list") and sample.count is not None:
        raise ModelError(
            "sample.count",
            f"stands beside a {kind}, which has as many machines as its values.",
            'Leave it out, or choose kind = "sobol".',
        )
    if kind in ("grid", "list") and scattered:
        raise ModelError(
            f"parameter {scattered[0].name}",
            f"has a distribution, and the sample is a {kind}.",
            'Choose kind = "random" with a count, or give values.',
        )
    if sample.second_order and kind != "saltelli":
        raise ModelError(
            "sample.second_order",
            f"stands beside {kind} points, which give no indices.",
            'Leave it out, or choose kind = "saltelli".',
        )
    if kind == "grid":
        axes = [p.grid for p in parameters]
        count = prod(len(a) for a in axes)
        _require_count(count, "Take fewer values of a parameter.")
        grids = np.meshgrid(*axes, indexing="ij")
        values = np.stack([g.ravel() for g in grids], axis=-1)
        return Drawn(kind, values, tuple(len(a) for a in axes))
    if kind == "list":
        return _rows(parameters)
    ranges = [p for p in parameters if p.values]
    if ranges:
        raise ModelError(
            f"parameter {ranges[0].name}",
            f"has values, and the sample is {kind}.",
            'Give range = ["LOW", "HIGH"], or choose kind = "grid".',
        )
    if sample.count is None or sample.count < 1:
        raise ModelError(
            "sample.count",
            "is missing." if sample.count is None else f"is {sample.count}.",
            "Say how many machines, a power of two for Sobol's points.",
        )
    rows = rows_of(len(parameters), sample.second_order) if kind == "saltelli" else 1
    _require_count(sample.count * rows, "Take fewer.")
    share = _shares(kind, sample, len(parameters))
    values = np.stack([p.scaled(share[:, i]) for i, p in enumerate(parameters)], axis=-1)
    return Drawn(kind, values, (len(values),))


def _shares(kind: str, sample: Sample, parameters: int) -> Array:
    count, seed = sample.count or 0, sample.seed
    if kind == "saltelli":
        return block_shares(count, parameters, seed, second_order=sample.second_order)
    if kind == "random":
        return np.random.default_rng(seed).random((count, parameters))
    # SciPy's statistics take longer to load than a small study to run
    from scipy.stats import qmc  # noqa: PLC0415

    if kind == "latin-hypercube":
        return np.asarray(
            qmc.LatinHypercube(parameters, rng=np.random.default_rng(seed)).random(count)
        )
    power = int(np.ceil(np.log2(max(count, 1))))
    made = qmc.Sobol(parameters, scramble=True, rng=np.random.default_rng(seed)).random_base2(power)
    return np.asarray(made)[:count]


def _rows(parameters: Sequence[Varied]) -> Drawn:
    for p in parameters:
        if not p.values:
            raise ModelError(
                f"parameter {p.name}", "has a range, and the sample is a list.", "Give its values."
            )
        if len(p.values) != len(parameters[0].values):
            raise ModelError(
                f"parameter {p.name}",
                f"has {len(p.values)} values, and {parameters[0].name} has "
                f"{len(parameters[0].values)}.",
                'Give as many of each in a list, or choose kind = "grid".',
            )
    values = np.array([p.values for p in parameters], dtype=float).T
    return Drawn("list", values, (len(values),))


def _require_count(count: int, remedy: str) -> None:
    if count > MOST:
        raise ModelError("sample", f"has {count:,} machines; {MOST:,} are the most.", remedy)
