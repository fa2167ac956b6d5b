"""Inverse kinematics per second: closed form, Newton leg by leg, Newton on all bodies.

Run `python -m benchmarks.inverse_speed`; with `--write` its table goes to
docs/performance-inverse.md. It stops with an error where two of them disagree, or where the legs
are not faster than all bodies by `LEAST`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.kinematics_speed import poses_around
from benchmarks.measure import (
    DOCUMENTS,
    machine_line,
    one_thread,
    parsed,
    parser,
    rate,
    require,
    shown,
)
from strutwork.kinematics.inverse_survey import inverse_survey
from strutwork.kinematics.motion import Motion
from strutwork.machines import HexelHexapod, Machine, Proposed3PPRS
from strutwork.machines.load import machine_model

Array = NDArray[Any]

DOCUMENT = DOCUMENTS / "performance-inverse.md"

MACHINES: dict[str, Machine] = {
    "hexel-hexapod": HexelHexapod(),
    "proposed-3pprs": Proposed3PPRS(),
}

#: Margins and reach of closed form and legs agree to this.
AGREEMENT = 1e-9
#: How many times the rate of Newton on all bodies the legs must reach; twenty to sixty are usual.
LEAST = 5.0
#: Poses of Newton on all bodies.
FEW = 512


@dataclass(frozen=True)
class Rates:
    """Poses per second of processor time."""

    closed: float
    legs: float
    bodies: float
    gap: float


class _AllBodies(Motion):
    """The same motion without its legs."""

    legs = None


def measured(machine: Machine, count: int) -> Rates:
    """Rates of one machine: coordinates, joint ranges and singularity margin of every pose.

    Raises
    ------
    RuntimeError
        Two ways disagree, or legs are not faster.
    """
    name = type(machine).__name__
    motion = machine_model(machine, name).motion
    require(motion.legs is not None, f"{name}: does not fall into legs")
    poses = poses_around(machine, count)
    few = poses[: min(FEW, count)]
    one, other = inverse_survey(machine, poses), inverse_survey(motion, poses)
    both = one.reachable & other.reachable
    require(bool(both.mean() > 0.5), f"{name}: few poses are taken")
    gap = float(np.abs(one.margin - other.margin)[both].max())
    require(gap < AGREEMENT, f"{name}: margins differ by {gap:.1e}")
    slow = _AllBodies(motion.linkage, motion.home, motion.rotation)
    return Rates(
        rate(lambda: inverse_survey(machine, poses), count),
        rate(lambda: inverse_survey(motion, poses), count),
        rate(lambda: inverse_survey(slow, few), len(few.position), 3),
        gap,
    )


def table(found: dict[str, Rates]) -> str:
    """The page with the results."""
    head = (
        "",
        "closed form, poses/s",
        "legs, poses/s",
        "all bodies, poses/s",
        "closed : legs",
        "legs : all",
        "largest difference",
    )
    lines = [
        "# Performance of inverse kinematics",
        "",
        "Made by `python -m benchmarks.inverse_speed --write`: read ratios. One thread,",
        "processor time.",
        machine_line(),
        "",
        "For every pose the drives' coordinates, whether a joint is out of its range, and the",
        "distance from the next singularity. *Closed form* is the machine's own; *legs* is",
        "Newton's method on the joints of each leg, from home to every pose, compiled;",
        "*all bodies* the same with the joints of all legs together, stacked NumPy.",
        "",
        f"| {' | '.join(head)} |",
        "|---|---:|---:|---:|---:|---:|---:|",
    ]
    lines += [
        f"| {name} | {r.closed:,.0f} | {r.legs:,.0f} | {r.bodies:,.0f} | "
        f"{r.closed / r.legs:.1f} | {r.legs / r.bodies:.0f} | {r.gap:.0e} |"
        for name, r in found.items()
    ]
    return "\n".join([*lines, ""])


def main() -> None:
    """Measure, print and perhaps write the table."""
    options = parser(__doc__, DOCUMENT)
    options.add_argument("--poses", type=int, default=20_000)
    arguments = parsed(options)
    poses = 64 if arguments.smallest else arguments.poses
    found = {name: measured(machine, poses) for name, machine in MACHINES.items()}
    shown(table(found), DOCUMENT, arguments)
    if not arguments.smallest:
        slow = [name for name, r in found.items() if r.legs < LEAST * r.bodies]
        require(not slow, f"less than {LEAST:g} times the rate of all bodies: {', '.join(slow)}")


if __name__ == "__main__":
    one_thread(main)
