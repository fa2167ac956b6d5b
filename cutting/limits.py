"""Exact stability: multipliers over speeds and depths, and the depth at which stability is lost."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import brentq

from strutwork.cutting.assembly import Assembly, assembly
from strutwork.cutting.numbers import positive, positive_list
from strutwork.cutting.period_map import PeriodMap
from strutwork.cutting.process import Process
from strutwork.cutting.spans import first_margin
from strutwork.cutting.tip_modes import TipModes
from strutwork.errors import NumericalError

Array = NDArray[Any]

#: Nodes beyond the first margin, tried in turn.
MORE = (0, 3, 6, 10, 14, 18, 23, 28)

#: Largest change of the magnitude of a multiplier by more nodes that is let pass.
TOLERANCE = 1e-6

#: Share of it at the depths of a chart that are checked: between them magnitudes change more.
BETWEEN = 0.5

#: Ratio of one trial depth to the one before.
STRIDE = 1.12

#: Parts of a stride in which the border is sought.
WITHIN = 4

#: A multiplier whose angle is nearer to 0 or π than this, rad, is real.
REAL = 1e-7

Kind = Literal["Hopf", "flip", "period-one", "stable"]


@dataclass(frozen=True)
class StabilityChart:
    """Largest multipliers over speeds and depths.

    Parameters
    ----------
    speeds : (s,)
        Of the spindle, rpm.
    depths : (d,)
        m.
    multipliers : (s, d)
        Complex, the largest in magnitude, no unit; the cut is stable where that is below 1.
    change : float
        Largest change of a magnitude by more nodes, relative to it or to 1, where it was checked:
        at the smallest, the middle and the largest depth of every speed.
    """

    speeds: Array
    depths: Array
    multipliers: Array
    change: float

    def __repr__(self) -> str:
        share = float(np.mean(self.stable))
        return (
            f"<StabilityChart: {len(self.speeds)} speeds x {len(self.depths)} depths, "
            f"{100 * share:.0f} % stable>"
        )

    @property
    def stable(self) -> Array:
        """Whether each cut is stable, (s, d), bool."""
        return np.asarray(np.abs(self.multipliers) < 1.0)

    @property
    def kinds(self) -> Array:
        """How each cut loses stability, as `kind_of`, (s, d), text."""
        found = [[kind_of(complex(m)) for m in row] for row in self.multipliers]
        return np.array(found, dtype=object)


@dataclass(frozen=True)
class DepthLimits:
    """The depth at which stability is first lost, by spindle speed.

    Parameters
    ----------
    speeds : (s,)
        rpm.
    depth : (s,)
        m; infinite where the cut is stable at all trial depths up to the deepest.
    multipliers : (s,)
        Complex, at the limit, no unit; zero where there is none.
    kinds : tuple of str
        "Hopf" (a new frequency), "flip" (twice the tooth period), "period-one" or "stable".
    modes : (s,)
        Index of the mode that moves the tip most at the limit, int; −1 where there is none.
    frequencies : (s,)
        Of chatter, Hz: of those that the multiplier allows, a tooth frequency apart, the one
        nearest to that mode; NaN where there is none.
    deepest : float
        Largest trial depth, m.
    """

    speeds: Array
    depth: Array
    multipliers: Array
    kinds: tuple[Kind, ...]
    modes: Array
    frequencies: Array
    deepest: float

    def __repr__(self) -> str:
        least = float(self.depth.min())
        return f"<DepthLimits: {len(self.speeds)} speeds, least {1e3 * least:.4g} mm>"


def kind_of(multiplier: complex) -> Kind:
    """How a cut with this largest multiplier loses stability, or "stable" below 1.

    Parameters
    ----------
    multiplier : complex
        No unit.
    """
    if abs(multiplier) < 1.0:
        return "stable"
    return _crossing(multiplier)


def _crossing(multiplier: complex) -> Kind:
    angle = abs(float(np.angle(multiplier)))
    if angle < REAL:
        return "period-one"
    return "flip" if np.pi - angle < REAL else "Hopf"


def stability_chart(
    modes: TipModes,
    process: Process,
    speeds: ArrayLike,
    depths: ArrayLike,
    tolerance: float = TOLERANCE,
) -> StabilityChart:
    """Largest multipliers at every speed and depth.

    Nodes are added at each speed until the magnitudes at its smallest, middle and largest depth
    change by no more than half the tolerance, which leaves the rest to the depths between.

    Parameters
    ----------
    modes : TipModes
    process : Process
    speeds : (s,)
        rpm.
    depths : (d,)
        m.
    tolerance : float
        Relative, of a magnitude above 1.

    Returns
    -------
    StabilityChart

    Raises
    ------
    ModelError
        Speeds or depths that are not positive, no mode that moves the chip.
    NumericalError
        Multipliers that do not converge; names the speed and the depth.
    """
    rpm = positive_list("spindle speeds", speeds, "rpm")
    deep = positive_list("depths of cut", depths, "m")
    order = np.argsort(deep)
    checked = np.unique(order[[0, len(deep) // 2, -1]])
    cut = assembly(modes, process)
    found = np.empty((len(rpm), len(deep)), dtype=complex)
    worst = 0.0
    for row, speed in enumerate(rpm / 60.0):
        margin, change = _margin(cut, speed, deep[checked], tolerance)
        worst = max(worst, change)
        at = _Maps(cut, speed, margin)
        found[row] = [at(depth).largest(depth) for depth in deep]
    return StabilityChart(rpm, deep, found, worst)


def depth_limits(
    modes: TipModes,
    process: Process,
    speeds: ArrayLike,
    deepest: float,
    shallowest: float | None = None,
    tolerance: float = TOLERANCE,
) -> DepthLimits:
    """The depth at which a cut first becomes unstable, at each speed.

    Trial depths rise by 12 % each from the shallowest to the deepest, and the border is
    refined between the last stable and the first unstable one, in quarters: an island of
    instability thinner than that is not seen. The multiplier at the border is checked with more
    nodes.

    Parameters
    ----------
    modes : TipModes
    process : Process
    speeds : (s,)
        rpm.
    deepest : float
        Largest depth of interest, m.
    shallowest : float or None
        First trial depth, m; None for a two-hundredth of the deepest. Where that is unstable the
        border is sought between zero and it.
    tolerance : float
        Of the magnitude of the multiplier, no unit.

    Returns
    -------
    DepthLimits

    Raises
    ------
    ModelError
        Speeds or depths that are not positive, no mode that moves the chip.
    NumericalError
        Multipliers that do not converge; names the speed and the depth.
    """
    rpm = positive_list("spindle speeds", speeds, "rpm")
    positive("depth of cut", "largest value", deepest)
    first = deepest / 200.0 if shallowest is None else shallowest
    positive("depth of cut", "smallest value", first)
    count = max(1, int(np.ceil(np.log(max(deepest / first, 1.0)) / np.log(STRIDE))))
    trials = np.append(0.0, np.geomspace(min(first, deepest), deepest, count + 1))
    depth = np.full(len(rpm), np.inf)
    multipliers = np.zeros(len(rpm), dtype=complex)
    kinds: list[Kind] = ["stable"] * len(rpm)
    leading = np.full(len(rpm), -1)
    frequencies = np.full(len(rpm), np.nan)
    cut = assembly(modes, process)
    for row, speed in enumerate(rpm / 60.0):
        limit, maps = _limit(cut, speed, trials, tolerance)
        if not np.isfinite(limit):
            continue
        multiplier, mode = _leading(maps(limit), limit, modes)
        depth[row], multipliers[row], leading[row] = limit, multiplier, mode
        kinds[row] = _crossing(multiplier)
        frequencies[row] = _nearest(multiplier, modes.poles[mode], speed * process.teeth)
    return DepthLimits(rpm, depth, multipliers, tuple(kinds), leading, frequencies, deepest)


class _Maps:
    """Maps of one speed by depth: one map where teeth are straight."""

    def __init__(self, cut: Assembly, speed: float, margin: int) -> None:
        self._cut, self._speed, self._margin = cut, speed, margin
        self._kept: PeriodMap | None = None

    def __call__(self, depth: float) -> PeriodMap:
        if self._kept is None or self._cut.chip.lag != 0:
            self._kept = self._cut.at(self._speed, depth, self._margin)
        return self._kept

    def excess(self, depth: float) -> float:
        """Logarithm of the largest magnitude."""
        return float(np.log(max(abs(self(depth).largest(depth)), 1e-300)))


def _margin(cut: Assembly, speed: float, depths: Array, tolerance: float) -> tuple[int, float]:
    """The first margin whose magnitudes the next one leaves, and by how much they change."""
    before: Array | None = None
    change, at = np.inf, 0
    first = first_margin(cut.chip, cut.fastest, speed, float(depths.max()), tolerance)
    for number, more in enumerate(MORE):
        margin = first + more
        maps = _Maps(cut, speed, margin)
        now = np.array([abs(maps(depth).largest(depth)) for depth in depths])
        if before is not None:
            off = np.abs(now - before) / np.maximum(now, 1.0)
            at = int(off.argmax())
            # two magnitudes that agree to rounding say no more than that
            change = max(float(off[at]), np.finfo(float).eps)
            if change <= BETWEEN * tolerance:
                return first + MORE[number - 1], change
        before = now
    raise _unsettled(speed, float(depths[at]), change)


def _limit(cut: Assembly, speed: float, trials: Array, tolerance: float) -> tuple[float, _Maps]:
    """The border at a speed, infinite for none, with the maps that gave it."""
    change, at = np.inf, 0.0
    first = first_margin(cut.chip, cut.fastest, speed, float(trials[-1]), tolerance)
    for more, further in pairwise(MORE):
        maps = _Maps(cut, speed, first + more)
        limit = at = float(trials[-1])
        stable = True
        for below, above in pairwise(trials):
            if maps.excess(above) >= 0:
                stable = False
                limit = at = _first_crossing(maps, below, above)
                break
        finer = _Maps(cut, speed, first + further)
        here, there = abs(maps(at).largest(at)), abs(finer(at).largest(at))
        change = max(abs(here - there) / max(here, 1.0), np.finfo(float).eps)
        if change <= tolerance:
            return (np.inf if stable else limit), maps
    raise _unsettled(speed, at, change)


def _first_crossing(maps: _Maps, below: float, above: float) -> float:
    """The least depth seen between a stable and an unstable one at which stability is lost."""
    between = np.linspace(below, above, WITHIN + 1)[1:]
    low = max(below, 1e-9 * above)
    for high in between:
        if maps.excess(high) >= 0:
            break
        low = high
    return float(brentq(maps.excess, low, high, xtol=1e-10 * above, rtol=1e-12))


def _unsettled(speed: float, depth: float, change: float) -> NumericalError:
    return NumericalError(
        f"multipliers at {60 * speed:g} rpm",
        f"do not converge at a depth of {1e3 * depth:.4g} mm: they still change by {change:.1e}.",
        "Ask for smaller depths or higher speeds, or allow a larger tolerance.",
    )


def _leading(at: PeriodMap, depth: float, modes: TipModes) -> tuple[complex, int]:
    """The multiplier at the border, and the mode that moves the tip most in its motion."""
    values, vectors = np.linalg.eig(at.matrix(depth))
    worst = int(np.argmax(np.abs(values)))
    n = len(modes.poles)
    real, imaginary = vectors[:n, worst], vectors[n : 2 * n, worst]
    state = np.hypot(np.abs(real + 1j * imaginary), np.abs(real - 1j * imaginary))
    mode = int(np.argmax(state * np.linalg.norm(modes.shapes, axis=1)))
    value = complex(values[worst])
    return complex(value.real, abs(value.imag)), mode


def _nearest(multiplier: complex, pole: complex, passing: float) -> float:
    """The frequency of the multiplier nearest to a mode, Hz."""
    share = float(np.angle(multiplier)) / (2.0 * np.pi)
    turns = abs(pole) / (2.0 * np.pi * passing)
    near = [sign * share + round(turns - sign * share) for sign in (1, -1)]
    away = [abs(x - turns) for x in near]
    return abs(near[0] if away[0] <= away[1] else near[1]) * passing
