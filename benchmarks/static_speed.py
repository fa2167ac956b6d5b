"""Poses per second of the static stiffness, beside OpenSeesPy and PyNite in one run.

Run `python -m benchmarks.static_speed`; it writes its table to docs/performance.md.
"""

from __future__ import annotations

import argparse
import os
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.frame import poses_of, three_legged_frame
from kinematics import Poses
from machines.catalogue import CATALOGUE
from machines.check_points import hemisphere_poses
from msa import tool_compliance

Array = NDArray[Any]

DOCUMENT = Path(__file__).resolve().parent.parent / "docs" / "performance.md"


def rate(task: Callable[[], object], poses: int, rounds: int = 5) -> float:
    """Median poses per second over some rounds, after one that does not count."""
    task()
    seconds = []
    for _ in range(rounds):
        start = time.perf_counter()
        task()
        seconds.append(time.perf_counter() - start)
    return poses / statistics.median(seconds)


def machine_line() -> str:
    """What the figures were taken on."""
    return (
        f"Machine: {platform.machine()}, {os.cpu_count()} cores, "
        f"Python {platform.python_version()}, NumPy {np.__version__}."
    )


def frame_rates(poses: int) -> tuple[list[tuple[str, float]], dict[str, float]]:
    """Rates on the 84-dof frame, and the largest difference from each peer."""
    from benchmarks.peers import opensees_compliance, pynite_compliance  # noqa: PLC0415

    structure, positions = three_legged_frame()
    placement = poses_of(structure, positions, poses)

    def ours(workers: int, method: str | None = None, count: int = poses) -> Array:
        placed = structure.at(placement[:count])
        return tool_compliance(placed, method, workers)  # type: ignore[arg-type]

    few = placement.positions[: min(poses, 3000)]
    rates = [
        (
            "OpenSeesPy, factorised once a pose",
            rate(lambda: opensees_compliance(structure, few), len(few), 3),
        ),
        ("PyNite", rate(lambda: pynite_compliance(structure, few[:20]), 20, 3)),
        ("Strutwork, compiled, one thread", rate(lambda: ours(1), poses)),
        ("Strutwork, compiled, two threads", rate(lambda: ours(2), poses)),
        (
            "Strutwork, stacked NumPy, saddle-point",
            rate(lambda: ours(1, "saddle_point", 512), 512, 3),
        ),
    ]
    reference = opensees_compliance(structure, few)
    own = ours(1, count=len(few))
    size = np.abs(reference).max(axis=(1, 2), keepdims=True)
    other = pynite_compliance(structure, few[:20])
    gaps = {
        "OpenSeesPy": float((np.abs(own - reference) / size).max()),
        "PyNite": float((np.abs(own[:20] - other) / size[:20]).max()),
        "stacked NumPy": float(
            (np.abs(own[:512] - ours(1, "saddle_point", 512)) / size[:512]).max()
        ),
    }
    return rates, gaps


def machine_rates(poses: int) -> list[tuple[str, float, float]]:
    """Rates of the machines on one thread: with and without their inverse kinematics."""
    result = []
    for name, entry in CATALOGUE.items():
        machine = entry.factory()
        points = hemisphere_poses(machine.home().position[2])
        pick = np.arange(poses) % points.position[..., 0].size
        some = Poses(points.position.reshape(-1, 3)[pick], points.rotation.reshape(-1, 3, 3)[pick])
        some = some[machine.place(some).reachable]
        count = len(some.position)
        if not count:
            # a planar machine takes none of these poses
            continue
        placement = machine.place(some)
        alone = rate(lambda p=placement, m=machine: tool_compliance(m.structure.at(p)), count)
        whole = rate(lambda q=some, m=machine: tool_compliance(m.structure.at(m.place(q))), count)
        result.append((name, whole, alone))
    return result


def million_poses_memory() -> float:
    """Peak memory, GB, of a process that does a million poses of the frame."""
    code = (
        "from benchmarks.frame import *; from msa import tool_compliance; import resource\n"
        "s, x = three_legged_frame(); p = poses_of(s, x, 1_000_000)\n"
        "c = tool_compliance(s.at(p)); assert c.shape == (1_000_000, 6, 6)\n"
        "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        cwd=DOCUMENT.parent.parent,
    )
    return float(done.stdout) * 1024 / 1e9


def table(
    rates: list[tuple[str, float]], gaps: dict[str, float], machines: list[Any], memory: float
) -> str:
    """The page with the results."""
    peer = rates[0][1]
    case = (
        "84 free degrees of freedom, 20 beams, new geometry at every pose, six unit loads at the "
        "tool. Times go from node positions to the 6 x 6 compliance, with the residual checked "
        "at every pose."
    )
    agreement = ", ".join(f"{name} {gap:.1e}" for name, gap in gaps.items())
    own = [f"| {name} | {value:,.0f} | {value / peer:.2f} |" for name, value in rates]
    rows = [
        f"| {name} | {whole:,.0f} | {whole / peer:.1f} | {alone:,.0f} |"
        for name, whole, alone in machines
    ]
    lines = [
        "# Performance",
        "",
        "Made by `python -m benchmarks.static_speed --write`: read ratios. BLAS on one thread.",
        machine_line(),
        "",
        "## Three-legged frame",
        "",
        case,
        "",
        "| | poses/s | times OpenSeesPy |",
        "|---|---:|---:|",
        *own,
        "",
        f"Largest difference of an entry, as a share of the largest entry: {agreement}.",
        "",
        f"A million poses of the frame: {memory:.2f} GB at the peak, with data and results.",
        "",
        "## Machines, from their joints, one thread",
        "",
        "| | poses/s from tool poses | times OpenSeesPy's frame | poses/s from placements |",
        "|---|---:|---:|---:|",
        *rows,
        "",
        "Velocity Jacobians of the same machines, with joint ranges and the distance from the next",
        "singularity: [performance-kinematics.md](performance-kinematics.md).",
        "",
    ]
    return "\n".join(lines)


def main() -> None:
    """Measure, print and write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--poses", type=int, default=65_536)
    parser.add_argument("--write", action="store_true", help="write docs/performance.md")
    arguments = parser.parse_args()
    rates, gaps = frame_rates(arguments.poses)
    text = table(rates, gaps, machine_rates(arguments.poses), million_poses_memory())
    sys.stdout.write(text)
    if arguments.write:
        from strutwork.files import write_text  # noqa: PLC0415 - only when asked

        write_text(DOCUMENT, text)


if __name__ == "__main__":
    # pinned before any BLAS call: stacks of small systems want one thread
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1, user_api="blas"):
        main()
