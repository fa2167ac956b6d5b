"""Assembly modes per second: all sixteen ways of platforms on three circles.

Run `python -m benchmarks.assembly_speed`; with `--write` its table goes to
docs/performance-assembly.md. Beside it stand the eigenvalues of as many companion matrices alone,
by LAPACK in one stack, which an elimination without a method of its own would begin with, and one
mode by continuation. It stops with an error where a start is not among its modes, or where fewer
than `LEAST` poses a second are found.
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
from strutwork.kinematics import drive_values, forward_kinematics
from strutwork.kinematics.assembly_modes import assembly_modes
from strutwork.machines import Eclipse3PPRS, HexelHexapod, Machine, Proposed3PPRS

Array = NDArray[Any]

DOCUMENT = DOCUMENTS / "performance-assembly.md"

MACHINES: dict[str, type[Machine]] = {
    "eclipse-3pprs": Eclipse3PPRS,
    "proposed-3pprs": Proposed3PPRS,
    "hexel-hexapod": HexelHexapod,
}

#: Poses a second and a thread that the modes must reach.
LEAST = 2000.0
#: Poses of which continuation finds one mode each.
FEW = 256


@dataclass(frozen=True)
class Rates:
    """Poses per second, how many real modes there are, and how far the start is from its own."""

    modes: float
    eigenvalues: float
    one: float
    real: float
    gap: float


def measured(machine: Machine, count: int) -> Rates:
    """Rates of one machine at poses near home.

    Raises
    ------
    RuntimeError
        A pose is not among its modes.
    """
    poses = poses_around(machine, count)
    placement = machine.place(poses)
    found = assembly_modes(machine.linkage, placement, poses.rotation)
    own = np.take_along_axis(found.position, found.home[:, None, None], axis=1)[:, 0]
    gap = float(np.abs(own - poses.position).max())
    require(gap < 1e-8, f"{type(machine).__name__}: a pose is {gap:.1e} m from its mode")
    random = np.random.default_rng(0)
    companions = np.zeros((count, 16, 16), dtype=complex)
    companions[:, 0] = random.normal(size=(count, 16)) + 1j * random.normal(size=(count, 16))
    companions[:, range(1, 16), range(15)] = 1.0
    few = poses[: min(FEW, count)]
    drives = drive_values(machine, machine.place(few))
    return Rates(
        rate(lambda: assembly_modes(machine.linkage, placement, poses.rotation), count),
        rate(lambda: np.linalg.eigvals(companions), count, 3),
        rate(lambda: forward_kinematics(machine, drives, machine.home()), len(few.position), 3),
        float(np.mean(found.real)),
        gap,
    )


def table(found: dict[str, Rates]) -> str:
    """The page with the results."""
    head = (
        "",
        "all modes, poses/s",
        "eigenvalues alone, poses/s",
        "one mode by continuation, poses/s",
        "real modes, mean",
        "start to its mode, m",
    )
    lines = [
        "# Performance of assembly modes",
        "",
        "Written by `python -m benchmarks.assembly_speed --write`: compare ratios. One thread,",
        "processor time.",
        machine_line(),
        "",
        "All sixteen assembly modes, including complex ones, of a platform on three ball",
        "joints that move on circles when the drives are held; each is refined to rounding",
        "error, starting from the machine's placement. For comparison: the eigenvalues of",
        "as many 16 x 16 companion matrices by LAPACK, without the steps before and after;",
        "and `forward_kinematics`, which follows one mode from home.",
        "",
        f"| {' | '.join(head)} |",
        "|---|---:|---:|---:|---:|---:|",
    ]
    lines += [
        f"| {name} | {r.modes:,.0f} | {r.eigenvalues:,.0f} | {r.one:,.0f} | {r.real:.1f} | "
        f"{r.gap:.0e} |"
        for name, r in found.items()
    ]
    return "\n".join([*lines, ""])


def main() -> None:
    """Measure, print and perhaps write the table."""
    options = parser(__doc__, DOCUMENT)
    options.add_argument("--poses", type=int, default=4096)
    arguments = parsed(options)
    poses = 64 if arguments.smallest else arguments.poses
    found = {name: measured(make(), poses) for name, make in MACHINES.items()}
    shown(table(found), DOCUMENT, arguments)
    if not arguments.smallest:
        slow = [n for n, r in found.items() if r.modes < LEAST]
        require(not slow, f"less than {LEAST:g} poses a second: {', '.join(slow)}")


if __name__ == "__main__":
    one_thread(main)
