"""Velocity Jacobians per second: leg by leg in compiled code beside all rows of the linkage.

Run `python -m benchmarks.kinematics_speed`; with `--write` its table goes to
docs/performance-kinematics.md. It stops with an error where the two disagree, or where the legs
are not faster by `LEAST`. The planar machine has no such legs; its row shows the rate of all rows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

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
from strutwork.kinematics import Placement, Poses, jacobians
from strutwork.machines import (
    Alizade3PRPS,
    Eclipse3PPRS,
    Glozman3PRRS,
    HexelHexapod,
    Machine,
    MitSS1,
    Proposed3PPRS,
    Prototype3PPPRS,
    check_limits,
)

Array = NDArray[Any]

DOCUMENT = DOCUMENTS / "performance-kinematics.md"

MACHINES: dict[str, Callable[[], Machine]] = {
    "proposed-3pprs": Proposed3PPRS,
    "eclipse-3pprs": Eclipse3PPRS,
    "alizade-3prps": Alizade3PRPS,
    "glozman-3prrs": Glozman3PRRS,
    "prototype-3ppprs, stages locked": lambda: Prototype3PPPRS().locked(),
    "prototype-3ppprs, nine drives": Prototype3PPPRS,
    "hexel-hexapod": HexelHexapod,
}

#: Rows of both agree to this share of each drive's largest rate, conditions to this share.
AGREEMENT = 1e-10
#: How many times the rate of all rows the legs must reach; some ten to twenty are usual.
LEAST = 3.0
#: Length that makes angles comparable, m, and poses that are solved by all rows.
LENGTH, FEW = 0.1, 256
#: Poses that are taken at once: what they take of memory stays near the processor.
PIECE = 4096


@dataclass(frozen=True)
class Rates:
    """Poses per second of processor time, and how far the two ways are apart."""

    poses: float
    placements: float
    rows: float
    gap: float


def poses_around(machine: Machine, count: int) -> Poses:
    """Poses near home that the machine can take."""
    random = np.random.default_rng(7)
    home = machine.home()
    if isinstance(machine, MitSS1):
        x, z, b = random.uniform(-0.02, 0.02, (3, count))
        return machine.poses(x, z, 5.0 * b)
    reach = 0.05 if isinstance(machine, HexelHexapod) else 0.004
    poses = Poses.of(np.tile(home.position, (2 * count, 1)), home.rotation).moved(
        np.concatenate(
            [
                random.uniform(-reach, reach, (2 * count, 3)),
                random.uniform(-0.4, 0.4, (2 * count, 3)),
            ],
            axis=-1,
        )
    )
    good = poses[machine.place(poses).reachable]
    return good[:count]


def measured(machine: Machine, count: int) -> Rates:
    """Rates of one machine: Jacobian, joint ranges and singularity margin of every pose.

    Raises
    ------
    RuntimeError
        The two ways disagree.
    """
    poses = poses_around(machine, count)
    placement = machine.place(poses)
    few = placement[: min(FEW, count)]

    def by(method: Any, some: Placement) -> Array:
        checked = check_limits(machine.limits, some)
        found = jacobians(machine.linkage, checked, method)
        return np.where(checked.reachable, found.margin(LENGTH), 0.0)

    def from_poses() -> Array:
        pieces = range(0, number, PIECE)
        return np.concatenate([by("legs", machine.place(poses[i : i + PIECE])) for i in pieces])

    number = len(poses.position)
    gap = difference(machine, few)
    require(gap < AGREEMENT, f"{type(machine).__name__}: legs and rows differ by {gap:.1e}")
    whole = by("legs", placement)
    require(
        np.array_equal(from_poses(), whole) and bool(np.all(whole >= 0.0)) and whole.max() > 0.0,
        f"{type(machine).__name__}: margins of pieces are not those of the whole",
    )
    return Rates(
        rate(from_poses, number),
        rate(lambda: by("legs", placement), number),
        rate(lambda: by("rows", few), len(few.positions), 3),
        gap,
    )


def difference(machine: Machine, placement: Placement) -> float:
    """How far legs and rows are apart, as a share of each drive's largest rate."""
    legs = jacobians(machine.linkage, placement, "legs")
    require(legs.by_rank is None, f"{type(machine).__name__}: not eliminated leg by leg")
    rows = jacobians(machine.linkage, placement, "rows")
    if legs.inverse.shape[-2] > 6:
        # least rates depend on the arm of turning drives, and the two have each their own; the
        # motions of the tool by rates do not
        size = np.abs(rows.forward).max(axis=-1, keepdims=True)
        back = np.abs(legs.forward @ legs.inverse - np.eye(6)).max()
        return float(max(back, (np.abs(legs.forward - rows.forward) / size).max()))
    size = np.abs(rows.inverse).max(axis=-1, keepdims=True)
    gap = float((np.abs(legs.inverse - rows.inverse) / size).max())
    return max(gap, float(np.abs(legs.condition(LENGTH) / rows.condition(LENGTH) - 1.0).max()))


def without_legs(machine: Machine, count: int) -> float:
    """Poses per second from tool poses of a machine that has no legs of six freedoms."""
    poses = poses_around(machine, count)

    def margins() -> Array:
        placement = check_limits(machine.limits, machine.place(poses))
        return jacobians(machine.linkage, placement).margin(LENGTH)

    require(bool(np.all(margins() > 0.0)), f"{type(machine).__name__}: singular near home")
    return rate(margins, count, 3)


def table(found: dict[str, Rates], planar: float) -> str:
    """The page with the results."""
    head = (
        "",
        "legs, poses/s from tool poses",
        "legs, poses/s from placements",
        "all rows, poses/s from placements",
        "legs : rows",
        "largest difference",
    )
    lines = [
        "# Performance of velocity Jacobians",
        "",
        "Written by `python -m benchmarks.kinematics_speed --write`: compare ratios. One thread,",
        "processor time.",
        machine_line(),
        "",
        "For every pose the inverse Jacobian, a check of the joint ranges, and the",
        "distance from the nearest singularity. *From tool poses* starts with the inverse",
        f"kinematics, {PIECE:,} poses at once.",
        "*All rows* solves for the twists of all bodies in stacked NumPy; *legs* is compiled and",
        "treats each leg separately.",
        "",
        f"| {' | '.join(head)} |",
        "|---|---:|---:|---:|---:|---:|",
    ]
    lines += [
        f"| {name} | {r.poses:,.0f} | {r.placements:,.0f} | {r.rows:,.0f} | "
        f"{r.placements / r.rows:.1f} | {r.gap:.0e} |"
        for name, r in found.items()
    ]
    lines += [
        "",
        "With nine drives a leg has one more than it needs, and its least rates are taken; the",
        "difference is that of the tool's motion by rates.",
        "",
        "## What has no legs to eliminate",
        "",
        f"MIT-SS-1: {planar:,.0f} poses/s from tool poses, by the null space of all rows. Each",
        "strut lets the tool move in three ways only, in the plane, and two bearings share each",
        "pin. What the tool can do is then where the motions of all legs meet, a rank of all of",
        "them together at every pose, which the elimination of single legs does not see.",
    ]
    return "\n".join([*lines, ""])


def main() -> None:
    """Measure, print and perhaps write the table."""
    options = parser(__doc__, DOCUMENT)
    options.add_argument("--poses", type=int, default=65_536)
    arguments = parsed(options)
    poses = 64 if arguments.smallest else arguments.poses
    found = {name: measured(make(), poses) for name, make in MACHINES.items()}
    planar = without_legs(MitSS1(), min(poses, FEW))
    shown(table(found, planar), DOCUMENT, arguments)
    if not arguments.smallest:
        slow = [n for n, r in found.items() if min(r.poses, r.placements) < LEAST * r.rows]
        require(not slow, f"less than {LEAST:g} times the rate of all rows: {', '.join(slow)}")


if __name__ == "__main__":
    one_thread(main)
