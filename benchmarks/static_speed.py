"""Poses per second of the static stiffness, beside OpenSeesPy and PyNite in one run.

Run `python -m benchmarks.static_speed`; with `--write` its table goes to
docs/performance-statics.md. It stops with an error where the programs or solvers disagree, or where
a hexapod is slower than `LEAST` of the three-legged frame.
"""

from __future__ import annotations

import subprocess
import sys
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.frame import poses_of, three_legged_frame
from benchmarks.hexapods import HEXAPODS
from benchmarks.measure import (
    DOCUMENTS,
    installed,
    joined,
    machine_line,
    one_thread,
    parsed,
    parser,
    rate,
    require,
    shown,
    wall_rate,
)
from strutwork.kinematics import Poses
from strutwork.machines.catalogue import CATALOGUE, Machine
from strutwork.msa import PlacedStructure, system_of, tool_compliance
from strutwork.msa.compiled import compiled_compliance, program_of
from strutwork.msa.tool import ToolMethod

Array = NDArray[Any]

DOCUMENT = DOCUMENTS / "performance-statics.md"

#: Entries agree to this share of the largest, rotations times 1 m.
AGREEMENT = 1e-9
#: Of the rate of the three-legged frame that every hexapod must reach.
LEAST = 0.3
#: GB that a million poses may take.
MEMORY = 2.0
#: Poses that are solved by the saddle-point system beside the kernel.
FEW = 64


@dataclass(frozen=True)
class Row:
    """Rates of one structure, poses/s; share of poses that the kernel vouches for; largest gap."""

    name: str
    placements: float
    saddle_point: float
    vouched: float
    gap: float
    poses: float = np.nan


def apart(found: Array, expected: Array) -> float:
    """Largest difference of an entry, as a share of the largest of its pose."""
    size = np.abs(expected).max(axis=(1, 2), keepdims=True)
    return float((np.abs(found - expected) / size).max())


def frame_rates(poses: int) -> tuple[list[tuple[str, float]], dict[str, float]]:
    """Rates on the 84-dof frame, and the largest difference from each peer."""
    structure, positions = three_legged_frame()
    placement = poses_of(structure, positions, poses)

    def ours(workers: int, method: str | None = None, count: int = poses) -> Array:
        placed = structure.at(placement[:count])
        return tool_compliance(placed, method, workers)  # type: ignore[arg-type]

    many = min(poses, 512)
    clock = "Strutwork, compiled, two threads, by the clock"
    rates = [
        ("Strutwork, compiled, one thread", rate(lambda: ours(1, "compiled"), poses)),
        (clock, wall_rate(lambda: ours(2, "compiled"), poses)),
        (
            "Strutwork, stacked NumPy, saddle-point",
            rate(lambda: ours(1, "saddle_point", many), many, 3),
        ),
    ]
    own = ours(1, "compiled")
    gaps = {"stacked NumPy": apart(own[:many], ours(1, "saddle_point", many))}
    few = placement.positions[: min(poses, 3000)]
    if installed("openseespy", "OpenSeesPy"):
        from benchmarks.peers import opensees_compliance  # noqa: PLC0415 - a benchmark extra

        peer = rate(lambda: opensees_compliance(structure, few), len(few), 3)
        rates.append(("OpenSeesPy, factorised once a pose", peer))
        gaps["OpenSeesPy"] = apart(own[: len(few)], opensees_compliance(structure, few))
    if installed("Pynite", "PyNite"):
        from benchmarks.peers import pynite_compliance  # noqa: PLC0415 - a benchmark extra

        rates.append(("PyNite", rate(lambda: pynite_compliance(structure, few[:20]), 20, 3)))
        gaps["PyNite"] = apart(own[:20], pynite_compliance(structure, few[:20]))
    for name, gap in gaps.items():
        require(gap <= AGREEMENT, f"the frame is {gap:.1e} from {name}")
    return rates, gaps


def row(name: str, placed: PlacedStructure) -> Row:
    """Rates of a structure at its poses, with the agreement of both solvers.

    Raises
    ------
    RuntimeError
        They disagree.
    """
    count = placed.batch[0]
    system = system_of(placed)
    program = program_of(system)
    vouched = 0.0
    if program is not None:
        _, again = compiled_compliance(system, program)
        vouched = float((~again).mean())
    number = min(FEW, max(count // 4, 1))
    few = placed[:: count // number][:number]
    expected = tool_compliance(few, "saddle_point")
    method: ToolMethod | None = None if program is None else "compiled"
    whole = tool_compliance(placed, method)
    gap = apart(whole[:: count // number][:number], expected)
    require(gap <= AGREEMENT, f"{name}: kernel and saddle point are {gap:.1e} apart")
    slow = rate(lambda: tool_compliance(few, "saddle_point"), few.batch[0], 3)
    return Row(name, rate(lambda: tool_compliance(placed, method), count), slow, vouched, gap)


def poses_around(machine: Machine, count: int) -> Poses:
    """Poses near home that a machine can take, in the directions in which it can move."""
    random = np.random.default_rng(3)
    home = machine.home()
    reach = np.repeat([0.01, 0.05], 3)
    one = Poses.of(np.tile(home.position, (6, 1)), home.rotation)
    moves = machine.place(one.moved(np.diag(reach / 10.0))).reachable
    steps = np.where(moves, reach * random.uniform(-1.0, 1.0, (2 * count, 6)), 0.0)
    tried = Poses.of(np.tile(home.position, (2 * count, 1)), home.rotation).moved(steps)
    good = tried[machine.place(tried).reachable]
    require(len(good.position) >= count, f"{type(machine).__name__} takes too few poses near home")
    return good[:count]


def machine_rows(poses: int) -> list[Row]:
    """Every machine of the catalogue, on one thread: with and without inverse kinematics."""
    found = []
    for name, entry in CATALOGUE.items():
        machine = entry.factory()
        some = poses_around(machine, poses)
        one = row(name, machine.structure.at(machine.place(some)))
        whole = rate(
            lambda q=some, m=machine: tool_compliance(m.structure.at(m.place(q))),  # type: ignore[misc]
            poses,
        )
        found.append(Row(name, one.placements, one.saddle_point, one.vouched, one.gap, whole))
    return found


def million_poses_memory(poses: int) -> float:
    """Peak memory, GB, of a process that does a million poses of the frame."""
    code = (
        "import resource\n"
        "from benchmarks.frame import *; from strutwork.msa import tool_compliance\n"
        f"s, x = three_legged_frame(); p = poses_of(s, x, {poses})\n"
        f"c = tool_compliance(s.at(p)); assert c.shape == ({poses}, 6, 6)\n"
        "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        cwd=DOCUMENTS.parent,
    )
    gigabytes = float(done.stdout) * 1024 / 1e9
    require(gigabytes < MEMORY, f"{poses:,} poses take {gigabytes:.2f} GB")
    return gigabytes


def table(
    rates: list[tuple[str, float]],
    gaps: dict[str, float],
    hexapods: list[Row],
    machines: list[Row],
    memory: str,
) -> str:
    """The page with the results."""
    frame = rates[0][1]
    agreement = ", ".join(f"{name} {gap:.1e}" for name, gap in gaps.items())
    return joined(
        [
            "# Performance: statics",
            "",
            "Written by `python -m benchmarks.static_speed --write`: compare ratios.",
            "One thread; processor time where stated; rates are poses per second.",
            machine_line(),
            "",
            "## Three-legged frame",
            "",
            "84 free degrees of freedom, 20 beams, new geometry at every pose, six unit loads at",
            "the tool. Times are from node positions to the 6 x 6 compliance, with the residual",
            "checked at every pose.",
            "",
            "| | poses/s | of the first |",
            "|---|---:|---:|",
            *(f"| {name} | {value:,.0f} | {value / frame:.4f} |" for name, value in rates),
            "",
            f"Largest difference of an entry, as a share of the largest: {agreement}.",
            "",
            memory,
            "",
            "## Hexapods",
            "",
            "Six legs from a universal (U) or spherical (S) joint over a driven prismatic joint to",
            "a ball, at random poses. *Of the frame* is the rate beside the three-legged frame's,",
            f"at least {LEAST:g}; *vouched* is the share of poses whose residual, pivots and",
            "closed loops let the kernel answer for them. The others are solved again by the",
            "saddle-point system, which *apart* compares.",
            "",
            "| | poses/s | of the frame | saddle-point | vouched | apart |",
            "|---|---:|---:|---:|---:|---:|",
            *(
                f"| {r.name} | {r.placements:,.0f} | {r.placements / frame:.2f} | "
                f"{r.saddle_point:,.0f} | {r.vouched:.0%} | {r.gap:.0e} |"
                for r in hexapods
            ),
            "",
            "## Machines, from their joints",
            "",
            "| | tool poses/s | of the frame | placements/s | saddle-point | vouched | apart |",
            "|---|---:|---:|---:|---:|---:|---:|",
            *(
                f"| {r.name} | {r.poses:,.0f} | {r.poses / frame:.2f} | {r.placements:,.0f} | "
                f"{r.saddle_point:,.0f} | {r.vouched:.0%} | {r.gap:.0e} |"
                for r in machines
            ),
            "",
            "## What the kernel does not take",
            "",
            "Reduced solids and other elements with matrices of their own, a tool that nothing",
            "moves, and structures whose elimination takes more than twenty million",
            "multiplications, or whose closing rows times unknowns are more than four hundred",
            "thousand. They go to the stacked solvers, or the sparse one. So do single poses: next",
            "to a singularity of a loop, or where stiffnesses differ by so much that a pivot keeps",
            "less than 1e-5 of its entry.",
        ]
    )


def main() -> None:
    """Measure, print and write the table."""
    options = parser(__doc__, DOCUMENT)
    options.add_argument("--poses", type=int, default=65_536)
    arguments = parsed(options)
    poses = 64 if arguments.smallest else arguments.poses
    million = 2000 if arguments.smallest else 1_000_000
    rates, gaps = frame_rates(poses)
    hexapods = [row(name, make(poses)) for name, make in HEXAPODS.items()]
    memory = (
        f"{million:,} poses of the frame: {million_poses_memory(million):.2f} GB at the peak, with "
        "data and results."
    )
    text = table(rates, gaps, hexapods, machine_rows(poses), memory)
    shown(text, DOCUMENT, arguments)
    if not arguments.smallest:
        slow = [r.name for r in hexapods if r.placements < LEAST * rates[0][1]]
        require(not slow, f"less than {LEAST:g} of the frame's rate: {', '.join(slow)}")


if __name__ == "__main__":
    one_thread(main)
