"""Gain and phase margins of an opened loop."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.fea.state_space import StateSpace

Array = NDArray[Any]

#: Frequencies for a factor of ten, and about every pole by its distance from the axis.
DECADE = 60
ABOUT = (-30.0, -10.0, -4.0, -2.0, -1.0, -0.5, -0.2, 0.0, 0.2, 0.5, 1.0, 2.0, 4.0, 10.0, 30.0)

#: An imaginary part below this share of the response is rounding.
ROUNDED = 1e-9

#: Bisections of a crossing.
HALVINGS = 50


@dataclass(frozen=True)
class Margins:
    """How far a loop is from instability.

    Parameters
    ----------
    gain : float
        By this factor the loop's gain may grow; infinite without a limit.
    gain_frequency : float
        Where the phase is −180° at that limit, Hz; NaN without one.
    reduction : float
        To this share the gain may fall; zero without a limit.
    phase : float
        By this angle the phase may lag, rad; infinite where the gain is never one. The smallest of
        all crossings of gain one; negative where the phase is already behind.
    phase_frequency : float
        Of that crossing, Hz; NaN without one.
    crossover : float
        Lowest frequency at which the gain is one, Hz: the bandwidth of the loop, above which a
        resonance may bring the gain back to one; NaN without.
    """

    gain: float
    gain_frequency: float
    reduction: float
    phase: float
    phase_frequency: float
    crossover: float


def loop_margins(loop: StateSpace) -> Margins:
    """Margins of L(s) for the closed loop 1 + L(s) = 0 of one input and one output.

    Crossings are searched on a grid that is dense about every pole, then bisected to rounding.

    Parameters
    ----------
    loop : StateSpace
        L.
    """
    grid = _grid(loop.poles)
    value = _response(loop, grid)
    size = np.log(np.abs(value))
    # towards zero and infinity the phase only approaches −180°: there its sign is rounding
    dull = np.abs(value.imag) < ROUNDED * np.abs(value)
    unity = _bisected(loop, grid, size, lambda v: np.log(np.abs(v)), np.zeros_like(dull))
    turned = _bisected(loop, grid, value.imag, lambda v: v.imag, dull)
    at = _response(loop, turned)
    opposite = (at.real < 0) & (np.abs(at.imag) < 1e-6 * np.abs(at.real))
    turned, back = turned[opposite], -at.real[opposite]
    above, below = back < 1.0, back > 1.0
    gain, gain_frequency = np.inf, np.nan
    if above.any():
        k = int(back[above].argmax())
        gain, gain_frequency = float(1.0 / back[above][k]), float(turned[above][k])
    phases = np.angle(-_response(loop, unity))
    phase, phase_frequency, crossover = np.inf, np.nan, np.nan
    if len(unity):
        k = int(np.abs(phases).argmin())
        phase, phase_frequency = float(phases[k]), float(unity[k])
        crossover = float(unity.min())
    return Margins(
        gain,
        gain_frequency,
        float(1.0 / back[below].min()) if below.any() else 0.0,
        phase,
        phase_frequency,
        crossover,
    )


def _grid(poles: Array) -> Array:
    """Frequencies, Hz, ascending."""
    size = np.abs(poles)
    moving = size[size > 1e-6 * size.max(initial=1.0) * 1e-3]
    low, high = 1e-3 * moving.min(initial=1.0), 1e2 * moving.max(initial=1.0)
    even = np.geomspace(low, high, int(DECADE * np.log10(high / low)))
    upper = poles[poles.imag > 0]
    near = upper.imag[:, None] + np.abs(upper.real)[:, None] * np.array(ABOUT)
    near = near[(near > low) & (near < high)]
    return np.unique(np.concatenate([even, near.ravel()])) / (2.0 * np.pi)


def _response(loop: StateSpace, frequencies: Array) -> Array:
    if not len(frequencies):
        return np.zeros(0, dtype=complex)
    return loop.response(frequencies)[:, 0, 0]


def _bisected(loop: StateSpace, grid: Array, values: Array, of: Any, dull: Array) -> Array:
    """Where a real function of the response changes its sign, Hz."""
    change = np.flatnonzero(
        (np.sign(values[:-1]) * np.sign(values[1:]) < 0) & ~(dull[:-1] | dull[1:])
    )
    low, high, sign = grid[change], grid[change + 1], np.sign(values[change])
    if not len(low):
        return low
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        same = np.sign(of(_response(loop, middle))) == sign
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.asarray(0.5 * (low + high))
