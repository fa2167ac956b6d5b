"""Small machines for tests of calibrations, and experiments on them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.studies.experiment import Experiment
from strutwork.studies.measured_deflections import MeasuredDeflections
from strutwork.studies.measured_frequencies import MeasuredFrequencies
from strutwork.studies.measurement import Measurement
from strutwork.studies.parametric import Parametric
from strutwork.studies.unknown import Unknown

Array = NDArray[Any]

#: Two springs in series to a mass of 5 kg, on which two springs in parallel pull along y.
SPRINGS = """
[nodes]
root = [0, 0, 0]
middle = [0, 0, 0]
tip = [0, 0, 0]
[[joints]]
name = "a"
type = "prismatic"
between = ["root", "middle"]
axis = [1, 0, 0]
stiffness = { z = "2 N/um" }
[[joints]]
name = "b"
type = "prismatic"
between = ["middle", "tip"]
axis = [1, 0, 0]
stiffness = { z = "3 N/um", x = "9 N/um", y = "9 N/um" }
[[springs]]
name = "c"
node = "tip"
stiffness = { y = "4 N/um" }
[[springs]]
name = "d"
node = "tip"
stiffness = { y = "5 N/um" }
[[masses]]
node = "tip"
mass = "5 kg"
[[supports]]
node = "root"
fixed = "all"
[tool]
tcp = "tip"
"""


def unknowns(machine: Parametric, *paths: str, **options: Any) -> tuple[Unknown, ...]:
    """The numbers of paths, free by a factor of ten."""
    return tuple(Unknown.of(machine, path, **options) for path in paths)


def pulled(
    directions: Sequence[str], scatter: float, load: Sequence[float], node: str = "tip"
) -> MeasuredDeflections:
    """Displacements of a node under a load on it, their values still to be filled in."""
    n = len(directions)
    at = tuple((node, d) for d in directions)
    return MeasuredDeflections("pull", {}, node, tuple(load), at, np.zeros(n), np.full(n, scatter))


def heard(count: int, share: float) -> MeasuredFrequencies:
    """The lowest frequencies, their values still to be filled in."""
    numbers = tuple(range(1, count + 1))
    return MeasuredFrequencies("heard", {}, np.ones(count), np.full(count, share), numbers)


def synthetic(
    experiment: Experiment, truth: Sequence[float], seed: int | None = None
) -> Experiment:
    """The experiment with what a machine of other numbers gives, and noise of a seed."""
    from dataclasses import replace  # noqa: PLC0415

    rng = np.random.default_rng(seed)
    made: list[Measurement] = []
    for m, value in zip(
        experiment.measurements, experiment.computed(np.asarray(truth)), strict=True
    ):
        scatter = m.scatter * value if m.kind == "frequencies" else m.scatter
        noise = 0.0 if seed is None else scatter * rng.standard_normal(len(value))
        any_: Any = m
        made.append(replace(any_, values=value + noise, scatter=scatter))
    return replace(experiment, measurements=tuple(made))
