"""Stability of milling, exact and by the zero-order method, beside a semi-discretisation.

Run `python -m benchmarks.cutting_speed`; with `--write` its table goes to
docs/performance-cutting.md.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.measure import (
    DOCUMENTS,
    joined,
    machine_line,
    one_thread,
    parsed,
    parser,
    rate,
    require,
    shown,
)
from strutwork.cutting import (
    Milling,
    TipModes,
    depth_limits,
    stability_chart,
    zero_order_lobes,
)
from strutwork.cutting.limits import TOLERANCE
from tests.cutting_cases import mill, mill_cut, mill_tip
from tests.semi_discretization import extrapolated, largest

Array = NDArray[Any]

DOCUMENT = DOCUMENTS / "performance-cutting.md"

#: Steps of the semi-discretisation per tooth period.
STEPS = 40

#: The spectral map, to 1e-6, is at least so many times as fast.
FASTER = 2.0

#: Radial immersions.
IMMERSIONS = (0.05, 0.1, 0.5, 1.0)


def chart_of(tip: TipModes, process: Milling, speeds: int, depths: int) -> Array:
    """Magnitudes over 5000 to 25 000 rpm and up to 4 mm."""
    found = stability_chart(
        tip, process, np.linspace(5e3, 25e3, speeds), np.linspace(4e-3 / depths, 4e-3, depths)
    )
    return np.asarray(np.abs(found.multipliers))


def semi_discretized(process: Milling, speeds: int, depths: int) -> Array:
    """The same by the semi-discretisation, point by point."""
    cut = mill_cut(process, 2)
    return np.array(
        [
            [largest(cut, n, a, STEPS) for a in np.linspace(4e-3 / depths, 4e-3, depths)]
            for n in np.linspace(5e3, 25e3, speeds)
        ]
    )


def row(immersion: float, speeds: int, depths: int) -> tuple[str, float]:
    """Points per second of both at one immersion, as a line, and their ratio."""
    tip, process = mill_tip(2), mill(immersion)
    exact = chart_of(tip, process, 3, 3)
    cut = mill_cut(process, 2)
    check = extrapolated(cut, 25e3, 4e-3, 160)
    require(
        abs(exact[-1, -1] / check - 1.0) < 2e-3,
        f"immersion {immersion:g}: {exact[-1, -1]:.6g} beside {check:.6g}",
    )
    off = float(np.max(np.abs(semi_discretized(process, 3, 3) / exact - 1.0)))
    fast = rate(lambda: chart_of(tip, process, speeds, depths), speeds * depths, 3)
    few = max(2, speeds // 10), max(2, depths // 10)
    slow = rate(lambda: semi_discretized(process, *few), few[0] * few[1], 3)
    line = f"| {immersion:g} | {fast:,.0f} | {slow:,.0f} | {fast / slow:.1f} | {off:.1e} |"
    return line, fast / slow


def table(speeds: int, depths: int, poses: int, *, timed: bool) -> str:
    """The page; ratios are required where it is timed."""
    measured = [row(immersion, speeds, depths) for immersion in IMMERSIONS]
    if timed:
        least = min(ratio for _, ratio in measured)
        require(least > FASTER, f"the spectral map is {least:.1f} times as fast")
    tip, process = mill_tip(2), mill(0.5)
    helical = rate(
        lambda: chart_of(tip, mill(0.5, helix=np.pi / 6.0), max(2, speeds // 10), depths),
        max(2, speeds // 10) * depths,
        3,
    )
    response = tip.receptance(np.linspace(500.0, 2000.0, 1000))
    absolute = rate(
        lambda: [zero_order_lobes(response, process).absolute for _ in range(poses)], poses
    )
    grid = np.linspace(5e3, 25e3, 200)
    full = rate(
        lambda: [zero_order_lobes(response, process).at(grid) for _ in range(poses // 10)],
        poses // 10,
    )
    limits = rate(lambda: depth_limits(tip, process, grid[::10], 4e-3), 20, 3)
    return joined(
        [
            "# Performance: stability of cutting",
            "",
            "Made by `python -m benchmarks.cutting_speed --write`: read ratios. One thread.",
            machine_line(),
            "",
            "Down-milling with two modes at 922 Hz and two straight teeth (Insperger and Stépán",
            f"2004), {speeds} speeds from 5000 to 25 000 rpm by {depths} depths up to 4 mm.",
            f"Magnitudes of the spectral map are certain to {TOLERANCE:.0e}; the check by more",
            "nodes is part of its time. The semi-discretisation propagates the state's rows alone",
            f"and takes {STEPS} steps per tooth period; the last column is its largest error.",
            "",
            "| radial immersion | points per second | semi-discretisation | ratio | its error |",
            "|---|---:|---:|---:|---:|",
            *(line for line, _ in measured),
            "",
            f"With a helix of 30° at immersion 0.5: {helical:,.0f} points per second, since the",
            "map is assembled again at every depth.",
            "",
            "| at immersion 0.5 | per second |",
            "|---|---:|",
            f"| absolute limits of poses, zero order, 1000 lines | {absolute:,.0f} |",
            f"| lobes of poses at 200 speeds, zero order, 1000 lines | {full:,.0f} |",
            f"| exact limiting depths of speeds, up to 4 mm | {limits:,.0f} |",
        ]
    )


def main() -> None:
    """Measure, print and perhaps write the table."""
    arguments = parsed(parser(__doc__, DOCUMENT))
    text = table(4, 4, 20, timed=False) if arguments.smallest else table(50, 40, 400, timed=True)
    shown(text, DOCUMENT, arguments)


if __name__ == "__main__":
    one_thread(main)
