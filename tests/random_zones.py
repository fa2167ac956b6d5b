"""Responses of random gains, for tests of what is done with them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from strutwork.overconstraint import (
    Ball,
    Disc,
    Interval,
    MisfitSources,
    PlaneZone,
    Quantity,
    Responses,
    Tolerance,
)
from strutwork.overconstraint.sources import Block
from tests.three_struts import case

SHAPES = (Disc(), Interval(), Ball(), PlaneZone())


def random_responses(
    rng: np.random.Generator,
    tolerances: int,
    quantities: int,
    middle: float = 0.0,
    distribution: str = "uniform",
    batch: tuple[int, ...] = (),
) -> Responses:
    """Zones of all shapes in turn; every third quantity of one component.

    `middle` is the size of the means over that of the gains.
    """
    named = tuple(
        Tolerance(f"t{i}", "length", ("joint1",), size=1e-5, distribution=distribution)
        for i in range(tolerances)
    )
    blocks, start = [], 0
    for i in range(tolerances):
        shape = SHAPES[i % len(SHAPES)]
        blocks.append(Block(i, shape, start))
        start += shape.dimension
    gain = rng.normal(size=(*batch, quantities, 2, start))
    mean = middle * rng.normal(size=(*batch, quantities, 2))
    gain[..., ::3, 1, :] = 0
    mean[..., ::3, 1] = 0
    sources = MisfitSources(
        named, tuple(blocks), (), np.zeros((*batch, 0, start)), np.zeros((*batch, 0))
    )
    known = tuple(Quantity(f"j{q}", "radial force", ("x", "y"), "N") for q in range(quantities))
    return replace(case(), quantities=known, gain=gain, mean=mean, sources=sources)
