"""Powers of a machine's size: straight lines where both axes are logarithmic."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from strutwork.reports.figures.curves import Curve, curves
from strutwork.reports.figures.theme import LEGEND, PALETTE, axis
from strutwork.reports.numbers import fixed
from strutwork.studies.removal_rate import ACTUATOR_EXPONENTS, relative_deflection
from strutwork.studies.scale import ScaleStudy

Array = NDArray[Any]

#: Lines of the laws, in their order.
DASHES = ("solid", "dash", "dot", "dashdot")

SIZE = "size L over the machine's own"


def powers(
    factors: ArrayLike, some: Sequence[Curve], title: str, exponents: Sequence[float]
) -> dict[str, Any]:
    """Lines over the size, both axes logarithmic; each name ends with its exponent.

    Parameters
    ----------
    factors : (f,)
    some : sequence of Curve
    title : str
        Of the vertical axis, with the unit.
    exponents : sequence of float
        Fitted, one a curve.
    """
    named = [
        Curve(f"{c.name}: L^{fixed(p, 2)}", c.y, c.colour, c.dash, c.width)
        for c, p in zip(some, (0.0 + round(p, 9) for p in exponents), strict=True)
    ]
    figure = curves(factors, named, (SIZE, title))
    ticks = [v for v in (0.25, 0.5, 1.0, 2.0, 4.0) if np.min(factors) <= v <= np.max(factors)]
    figure["layout"]["xaxis"] = axis(SIZE, type="log", tickvals=ticks)
    rounds = _round_numbers(np.concatenate([np.ravel(c.y) for c in named]))
    figure["layout"]["yaxis"] = axis(title, type="log", tickvals=rounds)
    figure["layout"]["legend"] = LEGEND | {"traceorder": "normal"}
    return figure


def _round_numbers(values: Array) -> list[float]:
    """1, 2 and 5 times powers of ten that span the values; all written out, unlike plotly's."""
    low, high = np.floor(np.log10(values.min())), np.ceil(np.log10(values.max()))
    decades = np.arange(low, high + 1)
    return [float(f"{m}e{int(d)}") for d in decades for m in (1, 2, 5)]


def stiffness_powers(study: ScaleStudy, axes: Sequence[int] = (0, 1, 2)) -> dict[str, Any]:
    """Stiffness at the tool along axes against size, for each law of the joints; N/µm."""
    some, exponents = [], []
    for i, law in enumerate(study.laws):
        fitted = study.stiffness_law(i).exponent
        for k in axes:
            name = f"{'xyz'[k]}, {law}"
            values = 1e-6 * study.stiffness[i, :, k]
            some.append(Curve(name, values, PALETTE[k], DASHES[i % len(DASHES)]))
            exponents.append(float(fitted[k]))
    return powers(study.factors, some, "stiffness at the tool (N/µm)", exponents)


def frequency_powers(study: ScaleStudy, modes: Sequence[int]) -> dict[str, Any]:
    """Frequencies of modes against size, for each law of the joints; Hz.

    Parameters
    ----------
    study : ScaleStudy
        Of one pose.
    modes : sequence of int
        From 0, in ascending order of frequency at every size.
    """
    some, exponents = [], []
    for i, law in enumerate(study.laws):
        fitted = study.frequency_law(i).exponent
        for c, k in enumerate(modes):
            name = f"mode {k + 1}, {law}"
            colour = PALETTE[c % len(PALETTE)]
            some.append(Curve(name, study.frequencies[i, :, k], colour, DASHES[i % len(DASHES)]))
            exponents.append(float(fitted[k]))
    return powers(study.factors, some, "natural frequency (Hz)", exponents)


def deflection_powers(
    study: ScaleStudy, direction: int = 0, drives: Sequence[float] = ACTUATOR_EXPONENTS
) -> dict[str, Any]:
    """Deflection at constant removal rate against size, beside that of the machine's own size.

    Parameters
    ----------
    study : ScaleStudy
        Of one pose, with the factor 1 among its sizes.
    direction : int
        Of the deflection: 0, 1, 2 for x, y, z.
    drives : sequence of float
        Exponents n of the drives' force.
    """
    own = int(np.abs(np.log(study.factors)).argmin())
    some, exponents = [], []
    for i, law in enumerate(study.laws):
        stiffness = study.stiffness[i, :, direction]
        for k, n in enumerate(drives):
            values = relative_deflection(study.factors, stiffness / stiffness[own], n)
            name = f"n = {n:g}, {law}"
            some.append(Curve(name, values, PALETTE[k], DASHES[i % len(DASHES)]))
            fitted = study.removal(i, (n,))["xyz"[direction]][0]
            exponents.append(fitted.deflection)
    return powers(study.factors, some, "deflection over that at L = 1", exponents)
