"""How fast variants of a machine are asked over many poses, and a Pareto front of them is found.

Run `python -m benchmarks.variant_speed`; with `--write` its table goes to
docs/performance-variants.md. Machines solved one by one, each by itself, are compared with it.
`--machines 20000` searches the front with all machines that the aim states, in some minutes;
without it a tenth is searched, and its time extrapolated.
"""

from __future__ import annotations

import os
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

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
from strutwork.fea.lowest import natural_frequencies
from strutwork.machines.model import Model
from strutwork.machines.model_poses import moved
from strutwork.msa import axis_stiffness_free, compliance_and_outcome
from strutwork.studies.design import Design
from strutwork.studies.design_store import run_design
from strutwork.studies.parameter import Parameter
from strutwork.studies.variants import Variants

DOCUMENT = DOCUMENTS / "performance-variants.md"

HEXAPOD = str(DOCUMENTS.parent / "examples" / "machines" / "6-ups.toml")
#: Numbers that are varied, and what the machine states.
PATHS = (
    "sections.ram.diameter",
    "sections.cylinder.outer_diameter",
    "sections.cylinder.inner_diameter",
    "materials.steel.youngs_modulus",
    "joints.ball*.stiffness.*",
    "joints.cardan*.stiffness.x",
    "joints.cardan*.stiffness.z",
    "joints.drive*.stiffness.z",
)
POINTS = np.linspace(-0.15, 0.15, 10)
#: Poses of one machine.
POSES = len(POINTS) ** 2
#: Machines of the front that was asked for, and in how many seconds on two cores.
GOAL, AIM = 20_000, 300
#: Machines of a generation, and objectives.
POPULATION = 400
OBJECTIVES = ("stiffness_z", "first_frequency", "mass")


@dataclass(frozen=True)
class Row:
    """What was done with how many machines, seconds by the clock and of processors."""

    what: str
    threads: int
    machines: int
    clock: float
    processors: float


@contextmanager
def _timed(rows: list[Row], what: str, threads: int, machines: int) -> Iterator[None]:
    """Add a row of what is done inside."""
    clock, processors = time.perf_counter(), time.process_time()
    yield
    clock, processors = time.perf_counter() - clock, time.process_time() - processors
    rows.append(Row(what, threads, machines, clock, processors))


def _samples(count: int, stated: list[float]) -> np.ndarray:
    return np.array(stated) * np.random.default_rng(13).uniform(0.9, 1.1, (count, len(stated)))


def measured(machines: int, alone: int) -> list[Row]:
    """Each way of asking; together and alone agree to 1e-9."""
    rows: list[Row] = []
    workspace = {"x": POINTS, "y": POINTS}
    for answers in (("stiffness",), ("stiffness", "frequency", "mass")):
        variants = Variants.of(HEXAPOD, PATHS, *answers, workspace=workspace)
        machine = variants.study.machine
        samples = _samples(machines, [machine.matching(path)[0].value for path in PATHS])
        # the kernel is loaded before
        found = variants.values(samples[:4], workers=1)
        for workers in (1, 2):
            with _timed(rows, ", ".join(answers), workers, machines):
                found = variants.values(samples, workers=workers)
            require(bool((found["status"] == 0).all()), "some machines were not solved")
        each = [dict(zip(PATHS, row, strict=True)) for row in samples[:alone].tolist()]
        if answers == ("stiffness",):
            with _timed(rows, "stiffness, each machine by itself", 1, alone):
                _stiffness_alone([machine.model(m) for m in each], found["stiffness_free_worst"])
        else:
            with _timed(rows, "frequency at home, each machine by itself", 1, alone):
                _frequency_alone([machine.model(m) for m in each], found["first_frequency"])
    return rows


def _stiffness_alone(models: list[Model], found: np.ndarray) -> None:
    axes = [a.ravel() for a in np.meshgrid(POINTS, POINTS, indexing="ij")]
    for i, model in enumerate(models):
        _, placement = moved(model, dict(zip("xy", axes, strict=True)))
        compliance, _ = compliance_and_outcome(model.structure.at(placement))
        worst = axis_stiffness_free(compliance).min(axis=0)
        np.testing.assert_allclose(found[i], worst, rtol=1e-9)


def _frequency_alone(models: list[Model], found: np.ndarray) -> None:
    for i, model in enumerate(models):
        frequencies, _ = natural_frequencies(model.vibrating, 1)
        np.testing.assert_allclose(found[i], frequencies.item(), rtol=1e-9)


def front(machines: int) -> tuple[Row, int]:
    """A search with so many machines on two threads, and the machines of its front."""
    population = min(POPULATION, machines // 2)
    design = Design.of(
        HEXAPOD,
        [Parameter(path, low=0.8, high=1.2, relative=True) for path in PATHS],
        *OBJECTIVES,
        workspace={"x": POINTS, "y": POINTS},
        population=population,
        generations=machines // population,
    )
    # pymoo and the kernel are loaded before
    design.judge(np.ones((4, len(PATHS))))
    rows: list[Row] = []
    total = design.search.population * design.search.generations
    with _timed(rows, "front", 2, total):
        found = run_design(design, workers=2)
    return rows[0], int(found["front"].size)


def table(rows: list[Row], search: Row, best: int, load: float) -> str:
    """The page."""
    lines = [
        "# Performance of variants",
        "",
        "Written by `python -m benchmarks.variant_speed --write`: compare ratios.",
        f"{machine_line()} Load of other work at the start: {load:.1f}.",
        "",
        f"The hexapod of `examples/machines/6-ups.toml` with {len(PATHS)} varied sections and",
        f"stiffnesses, at {POSES} poses; frequency under preload at home alone. The clock counts",
        "what other work delays; processor time is that of all threads together. Times",
        f"of {GOAL:,} machines are extrapolated from the machines of the table.",
        "",
        (
            "| answers | threads | machines | machines x poses per second "
            f"| {GOAL:,} machines | processor time of these |"
        ),
        "| --- | --- | --- | --- | --- | --- |",
    ]
    for row in rows:
        many = GOAL / row.machines
        poses = 1 if "at home" in row.what else POSES
        lines.append(
            f"| {row.what} | {row.threads} | {row.machines} "
            f"| {row.machines * poses / row.clock:,.0f} "
            f"| {many * row.clock:,.0f} s | {many * row.processors:,.0f} s |"
        )
    many = GOAL / search.machines
    how = "measured" if many == 1 else f"extrapolated from {search.machines:,} machines"
    lines += [
        "",
        "## A Pareto front",
        "",
        f"Worst stiffness along z over {POSES} poses, first frequency at home and mass, by NSGA-II",
        f"of pymoo with {len(PATHS)} parameters and {GOAL:,} machines on two threads, pymoo's own",
        f"time included: **{many * search.clock:,.0f} s** by the clock,",
        f"{many * search.processors:,.0f} s of processor time ({how}; the aim is {AIM} s).",
        f"The front has {best} machines.",
        "",
        "## What takes the time",
        "",
        "Machines that differ in sections, materials, stiffnesses and masses share the program of",
        "elimination that gives their stiffness; their preloads, modes and masses are computed as",
        "one stack of matrices, whose rank, coordinates and free motions are determined once. What",
        "remains in Python, which one thread at a time can run, makes each machine from its",
        "numbers.",
        "With `--cluster local` each processor has a process of its own.",
    ]
    return joined(lines)


def main() -> None:
    """Measure, print and perhaps write the table."""
    options = parser(__doc__, DOCUMENT)
    options.add_argument("--machines", type=int, default=GOAL // 10, metavar="COUNT")
    arguments = parsed(options)
    machines, alone = (4, 1) if arguments.smallest else (512, 8)
    load = os.getloadavg()[0]
    rows = measured(machines, alone)
    search, best = front(8 if arguments.smallest else arguments.machines)
    shown(table(rows, search, best, load), DOCUMENT, arguments)


if __name__ == "__main__":
    one_thread(main)
