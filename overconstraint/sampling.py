"""Points in tolerance zones, drawn as their tolerances say.

A point is its place on a surface and a share of the way out to it, the set's gauge ρ in [0, 1].
On the surface ρ is 1. Uniform in a set of d parameters, ρ^d is uniform. Normal means of density
exp(−½ (3ρ)²) in the set and nothing beyond: for an interval, a disc and a ball the normal
distribution whose three standard deviations reach the limit, cut there.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.overconstraint.sources import MisfitSources
from strutwork.overconstraint.unit_sets import UnitSet

Array = NDArray[Any]

#: Standard deviations from the middle of a zone to its limit.
CUT = 3.0

#: How numbers are drawn.
METHODS = ("monte_carlo", "quasi_monte_carlo")

#: Independently scrambled Sobol' sequences; their scatter is the confidence.
SCRAMBLES = 16


def uniform_numbers(
    method: str, parameters: int, samples: int, seed: int, chunk: int
) -> Iterator[tuple[int, Array]]:
    """Numbers uniform in [0, 1), a chunk at a time, whatever the chunk the same ones.

    Parameters
    ----------
    method : str
        "monte_carlo": one stream of a PCG-64 generator. "quasi_monte_carlo": `SCRAMBLES` Sobol'
        sequences with independent scrambles (Owen 1998), each of the power of two that brings
        all together to at least `samples`.
    parameters, samples, seed : int
    chunk : int
        Largest number of points at a time, a power of two.

    Yields
    ------
    scramble : int
        Zero for Monte Carlo.
    uniform : (n, parameters)

    Raises
    ------
    ModelError
        An unknown method, nothing to draw, or fewer than one sample.
    """
    # read when asked for: statistics take longer to load than all else that a command needs
    from scipy.stats import qmc  # noqa: PLC0415

    if method not in METHODS:
        raise ModelError(
            "sampling", f'unknown method "{method}".', f"Choose one of: {', '.join(METHODS)}."
        )
    if samples < 1:
        raise ModelError("sampling", f"{samples} samples were requested.", "Request one or more.")
    if parameters == 0:
        raise ModelError("sampling", "there is no tolerance to sample.", "Give a tolerance.")
    generator = np.random.default_rng(seed)
    if method == "monte_carlo":
        for start in range(0, samples, chunk):
            yield 0, generator.random((min(chunk, samples - start), parameters))
        return
    each = points_per_scramble(samples)
    for scramble, stream in enumerate(generator.spawn(SCRAMBLES)):
        engine = qmc.Sobol(parameters, scramble=True, seed=stream)
        for _ in range(0, each, chunk):
            yield scramble, engine.random(min(chunk, each))


def points_per_scramble(samples: int) -> int:
    """Least power of two that fills the samples, and no fewer than two.

    Parameters
    ----------
    samples : int
        Of all scrambles together.
    """
    return int(2 ** max(1, np.ceil(np.log2(max(samples, 1) / SCRAMBLES))))


def draw(sources: MisfitSources, uniform: Array) -> Array:
    """Sample the parameters z from the distributions of their tolerances.

    Parameters
    ----------
    sources : MisfitSources
    uniform : (..., k)
        In [0, 1], no unit.

    Returns
    -------
    z : (..., k)
        Every block within its unit set.
    """
    z = np.empty(uniform.shape)
    for shape, members, index in sources.by_shape:
        named = np.array(
            [sources.tolerances[t].distribution for t in sources.owner[members]], dtype=object
        )
        for distribution in dict.fromkeys(named):
            here = index[named == distribution]
            z[..., here] = _DRAWS[distribution](shape, uniform[..., here])
    return z


def variances(sources: MisfitSources) -> Array:
    """Variance of every parameter, (k,); none is correlated with another.

    The second moment of a parameter over the surface times that of the gauge.

    Parameters
    ----------
    sources : MisfitSources
        With k parameters.
    """
    result = np.empty(sources.parameters)
    for block in sources.blocks:
        size, d = block.shape.surface_variance, block.shape.dimension
        share = _second_moment(sources.tolerances[block.tolerance].distribution, d)
        result[block.start : block.start + d] = size * share
    return result


def _second_moment(distribution: str, dimension: int) -> float:
    """Mean of ρ²."""
    if distribution == "surface":
        return 1.0
    if distribution == "uniform":
        return dimension / (dimension + 2)
    from scipy.special import gammainc  # noqa: PLC0415 - slow to import, needed by samples alone

    # a chi distribution of `dimension` degrees of freedom, cut at CUT and scaled to one
    half, end = dimension / 2, CUT**2 / 2
    return float(dimension / CUT**2 * gammainc(half + 1, end) / gammainc(half, end))


def _surface(shape: UnitSet, uniform: Array) -> Array:
    return shape.surface(uniform)


def _inside(shape: UnitSet, uniform: Array) -> Array:
    return shape.inside(uniform)


def _normal(shape: UnitSet, uniform: Array) -> Array:
    """Points uniform in the set, moved along their rays until they are normal."""
    point = shape.inside(uniform)
    gauge = np.minimum(shape.gauge(point), 1.0)
    moved = _normal_gauge(gauge**shape.dimension, shape.dimension)
    return np.asarray(point * (moved / np.where(gauge > 0, gauge, 1.0))[..., None])


def _normal_gauge(share: Array, dimension: int) -> Array:
    """The gauge within which a share of the points lies; closed forms where there are."""
    from scipy.special import gammainc, gammaincinv, ndtr, ndtri  # noqa: PLC0415 - as above

    if dimension == 1:
        found = ndtri(0.5 + share * (ndtr(CUT) - 0.5))
    elif dimension == 2:
        found = np.sqrt(-2 * np.log1p(share * np.expm1(-(CUT**2) / 2)))
    else:
        half = dimension / 2
        found = np.sqrt(2 * gammaincinv(half, share * gammainc(half, CUT**2 / 2)))
    return np.asarray(np.minimum(found / CUT, 1.0))


_DRAWS = {"surface": _surface, "uniform": _inside, "normal": _normal}
