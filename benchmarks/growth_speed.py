"""How cost grows: with poses, degrees of freedom, samples, machines of a study, and workers.

Run `python -m benchmarks.growth_speed`; with `--write` its tables go to
docs/performance-growth.md. It stops with an error where a result of a large run is not that of a
small one.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.executor_speed import lock_share, map_seconds
from benchmarks.frame import SECTION, STEEL, poses_of, three_legged_frame
from benchmarks.measure import (
    DOCUMENTS,
    joined,
    machine_line,
    one_thread,
    parsed,
    parser,
    require,
    shown,
)
from benchmarks.tolerance_speed import struts
from strutwork.fea import modes
from strutwork.fea.sparse_modes import SPARSE_FROM as MODES_SPARSE
from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement
from strutwork.msa import Beam, PlacedStructure, Structure, tool_compliance
from strutwork.msa.sparse import SPARSE_FROM as STATIC_SPARSE
from strutwork.overconstraint import distribution
from strutwork.studies.executor import Threads
from strutwork.studies.study import Study

Array = NDArray[Any]

DOCUMENT = DOCUMENTS / "performance-growth.md"

#: Small enough that the largest run of a table takes some ten seconds.
POSES = (1_000, 10_000, 100_000, 400_000)
LEVELS = (4, 16, 64, 256, 1024)
SAMPLES = (10_000, 100_000, 1_000_000, 10_000_000)
VARIANTS = (16, 64, 256)
#: The largest towers whose modes are computed.
MODES, MODE_LEVELS = 10, 256
#: Results of runs of different sizes agree to this share.
AGREEMENT = 1e-9

HEAD = DOCUMENTS.parent / "examples" / "machines" / "3-rps.toml"
VARIED = {"sections.ram.diameter": ("30 mm", "48 mm"), "joints.ball*.stiffness.*": (1e8, 1e9)}


@dataclass(frozen=True)
class Cost:
    """Seconds of processor time for so many items."""

    items: int
    seconds: float


def seconds(task: Callable[[], object], rounds: int = 3) -> float:
    """Least processor time of some rounds; of one alone where it takes long."""
    found: list[float] = []
    for _ in range(rounds):
        start = time.process_time()
        task()
        found.append(time.process_time() - start)
        if found[-1] > 2.0:
            break
    return max(min(found), 1e-6)


def exponents(costs: Sequence[Cost]) -> list[str]:
    """Power of the number of items with which the cost grew from the row before."""
    found = [""]
    for one, other in pairwise(costs):
        power = np.log(other.seconds / one.seconds) / np.log(other.items / one.items)
        found.append(f"{power:.2f}")
    return found


def rows(costs: Sequence[Cost]) -> list[str]:
    """Lines of a table: items, seconds, items per second, exponent."""
    return [
        f"| {c.items:,} | {c.seconds:.3g} | {c.items / c.seconds:,.0f} | {power} |"
        for c, power in zip(costs, exponents(costs), strict=True)
    ]


def over_poses(counts: Sequence[int]) -> list[Cost]:
    """Static stiffness of the three-legged frame.

    Raises
    ------
    RuntimeError
        The first pose has another compliance in a large batch.
    """
    structure, positions = three_legged_frame()
    placement = poses_of(structure, positions, max(counts))
    first = tool_compliance(structure.at(placement[: counts[0]]), "compiled")[0]
    found = []
    for count in counts:
        placed = structure.at(placement[:count])
        again: list[Array] = []

        def solved(placed: PlacedStructure = placed, again: list[Array] = again) -> None:
            again[:] = [tool_compliance(placed, "compiled")[0]]

        found.append(Cost(count, seconds(solved)))
        require(np.allclose(again[0], first, rtol=AGREEMENT, atol=0.0), f"{count} poses differ")
    return found


def tower(levels: int) -> PlacedStructure:
    """A mast of triangles, clamped below: 18 degrees of freedom and 9 beams for each level."""
    places = {
        f"{k}.{i}": np.array([0.15 * np.cos(a), 0.15 * np.sin(a), 0.2 * k])
        for k in range(levels + 1)
        for i, a in enumerate(2.0 * np.pi * np.arange(3) / 3.0)
    }
    pairs = []
    for k in range(1, levels + 1):
        for i in range(3):
            j = (i + 1) % 3
            pairs += [
                (f"{k - 1}.{i}", f"{k}.{i}"),
                (f"{k}.{i}", f"{k}.{j}"),
                (f"{k - 1}.{i}", f"{k}.{j}"),
            ]
    nodes = (*(f"ground {i}" for i in range(3)), *places)
    linkage = Linkage(
        nodes,
        (Body(GROUND, nodes[:3]), Body("mast", nodes[3:])),
        tuple(Joint(f"support {i}", "fixed", (f"ground {i}", f"0.{i}")) for i in range(3)),
        tool=f"{levels}.0",
    )
    beams = tuple(Beam(f"{a}-{b}", (a, b), STEEL, SECTION, shear=False) for a, b in pairs)
    positions = np.array([places[f"0.{i}"] for i in range(3)] + list(places.values()))
    placement = Placement(positions, np.broadcast_to(np.eye(3), (3, 3, 3)), np.zeros(0))
    return Structure(linkage, beams=beams).at(placement)


def over_dofs(levels: Sequence[int]) -> tuple[list[Cost], list[Cost]]:
    """Stiffness at the tip of towers, and their ten lowest modes."""
    static, vibrating = [], []
    for count in levels:
        placed = tower(count)
        static.append(Cost(18 * count, seconds(lambda p=placed: tool_compliance(p))))  # type: ignore[misc]
        if count <= MODE_LEVELS:
            vibrating.append(Cost(18 * count, seconds(lambda p=placed: modes(p, MODES))))  # type: ignore[misc]
    return static, vibrating


def over_samples(counts: Sequence[int]) -> list[Cost]:
    """Random samples of assembly forces."""
    model = struts("uniform")
    distribution(model, counts[0])
    return [Cost(n, seconds(lambda n=n: distribution(model, n), 2)) for n in counts]  # type: ignore[misc]


def over_variants(counts: Sequence[int]) -> list[Cost]:
    """Variants of the 3-RPS head, each at home and at nine poses."""
    tilts = {"rx": np.linspace(-0.2, 0.2, 3), "ry": np.linspace(-0.2, 0.2, 3)}

    def study(count: int) -> object:
        found = Study.of(
            str(HEAD), VARIED, "stiffness", count=count, sample="sobol", workspace=tilts
        )
        return found.run(workers=1)

    study(counts[0])
    return [Cost(n, seconds(lambda n=n: study(n), 1)) for n in counts]  # type: ignore[misc]


def over_workers(most: int, lattice: int) -> list[tuple[int, float]]:
    """Seconds by the clock of a stiffness map on one thread and more."""
    counts = [n for n in (1, 2, 4, 8, 16, 32) if n <= most]
    return [(n, map_seconds(lattice, Threads(n))) for n in counts]


def table(*, smallest: bool) -> str:
    """The page."""
    cut = 2 if smallest else None
    load = os.getloadavg()[0]
    poses = over_poses((100, 1000) if smallest else POSES)
    static, vibrating = over_dofs(LEVELS[:cut])
    samples = over_samples((1000, 10_000) if smallest else SAMPLES)
    variants = over_variants((2, 4) if smallest else VARIANTS)
    lattice = 3 if smallest else 28
    workers = over_workers(os.cpu_count() or 1, lattice)
    held = lock_share(lattice)
    alone = workers[0][1]
    head = "processor s |"
    return joined(
        [
            "# Performance: how cost grows",
            "",
            "Written by `python -m benchmarks.growth_speed --write`. Processor time on one thread",
            "except for workers. *Exponent* is the power of the size with which the cost grew from",
            "the row above: 1 is proportional.",
            machine_line(),
            "",
            "## Poses",
            "",
            "Static stiffness of the three-legged frame of 84 degrees of freedom.",
            "",
            f"| poses | {head} poses/s | exponent |",
            "|---:|---:|---:|---:|",
            *rows(poses),
            "",
            "Poses are independent and are computed in pieces that stay in the cache. A result",
            "takes 288 bytes per pose, which limits a single array; a streamed map has no such",
            "limit.",
            "",
            "## Degrees of freedom",
            "",
            "Stiffness at the tip of masts of beams at a single pose, including the assembly.",
            "",
            f"| degrees of freedom | {head} dofs/s | exponent |",
            "|---:|---:|---:|---:|",
            *rows(static),
            "",
            f"Their {MODES} lowest modes:",
            "",
            f"| degrees of freedom | {head} dofs/s | exponent |",
            "|---:|---:|---:|---:|",
            *rows(vibrating),
            "",
            "Small structures are limited by calls of Python and NumPy, which do not grow. Above",
            f"{STATIC_SPARSE:,} (statics) and {MODES_SPARSE:,} (modes) degrees of freedom a single",
            "pose is factorised sparse, for which a slender mast is the best case: its factor",
            "grows in proportion. Below, cost grows with the third power at last; solids grow",
            "with the second, see [performance-solids.md](performance-solids.md).",
            "",
            "## Samples of tolerances",
            "",
            "Distribution of the forces of six bearings under three tilted axes.",
            "",
            f"| samples | {head} samples/s | exponent |",
            "|---:|---:|---:|---:|",
            *rows(samples),
            "",
            "Samples are drawn and reduced in pieces: memory does not grow. The limit is the",
            "generation of random numbers and one pass over memory.",
            "",
            "## Variants of a study",
            "",
            "The 3-RPS head with other rams and ball joints, each variant at home and nine poses.",
            "",
            f"| variants | {head} variants/s | exponent |",
            "|---:|---:|---:|---:|",
            *rows(variants),
            "",
            "Each variant is built and solved on its own, so that calls of Python limit a study of",
            "few poses.",
            "",
            "## Workers",
            "",
            "A stiffness map of the proposed machine, by the clock. Other work on the machine",
            f"takes processors away; its load at the start: {load:.1f}.",
            "",
            "| threads | s | times one thread |",
            "|---:|---:|---:|",
            *(f"| {n} | {s:.2f} | {alone / s:.2f} |" for n, s in workers),
            "",
            f"Python's global lock is held during at most {held:.0%} of a chunk, which bounds the",
            "number of threads that can be kept busy; beyond it, and for other computers, use",
            "[a cluster](how-to/cluster.md). Poses near singularities that the compiled kernel",
            "does not vouch for are solved by a stacked solver: three percent of this map take",
            "half of its time.",
        ]
    )


def main() -> None:
    """Measure, print and perhaps write the tables."""
    arguments = parsed(parser(__doc__, DOCUMENT))
    shown(table(smallest=arguments.smallest), DOCUMENT, arguments)


if __name__ == "__main__":
    one_thread(main)
