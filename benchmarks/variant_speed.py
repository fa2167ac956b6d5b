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
from strutwork.machines.load import machine_model
from strutwork.machines.machine_numbers import changed_machine
from strutwork.machines.model import Model
from strutwork.machines.model_builder import build_model
from strutwork.machines.model_numbers import changed_tables
from strutwork.machines.model_poses import moved
from strutwork.msa import axis_stiffness_free, compliance_and_outcome
from strutwork.studies.design import Design
from strutwork.studies.design_store import run_design
from strutwork.studies.parameter import Parameter
from strutwork.studies.parametric import Fields, Tables
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


#: Numbers that move nodes, each group by one factor: what varies, the machine, its paths.
GEOMETRY = (
    (
        "6-UPS from its file: joints of two legs",
        HEXAPOD,
        (("nodes.base1.x", "nodes.foot1.x"), ("nodes.tip3.y", "nodes.seat3.y")),
    ),
    (
        "linear Delta from its file: joints of a parallelogram",
        str(DOCUMENTS.parent / "examples" / "machines" / "linear-delta.toml"),
        (tuple(f"nodes.{n}1{s}.x" for n in ("lower", "seat") for s in "ab"),),
    ),
    ("linear Delta in Python: length of the rods", "linear-delta", (("rod_length",),)),
    (
        "3-PPRS in Python: base and length of the links",
        "proposed-3pprs",
        (("base_radius",), ("link_length",)),
    ),
)
#: Along x and y, m.
NEAR = np.array([-0.01, 0.0, 0.01])


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


def geometry(machines: int, alone: int) -> list[tuple[str, float, float]]:
    """What varies, and seconds per machine of a processor: together, and each by itself."""
    found = []
    for what, name, groups in GEOMETRY:
        parameters = [Parameter(paths, low=0.5, high=2.0, relative=True) for paths in groups]
        variants = Variants.of(
            name, parameters, "stiffness", workspace={"x": NEAR, "y": NEAR}, reductions=("poses",)
        )
        samples = _samples(machines, [1.0] * len(groups)) ** 0.2
        # the kernel is loaded before
        variants.values(samples[:8], workers=1)
        start = time.process_time()
        values = variants.values(samples, workers=1)
        together = (time.process_time() - start) / machines
        start = time.process_time()
        for i in range(alone):
            _geometry_alone(variants, samples[i].tolist(), values["stiffness_free"][i])
        found.append((what, together, (time.process_time() - start) / alone))
    return found


def built_alone(variants: Variants, factors: list[float]) -> Model:
    """A machine made from its own numbers, which shares nothing with the others."""
    changes: dict[str, float | str] = {}
    for parameter, factor in zip(variants.varied, factors, strict=True):
        changes |= parameter.changes(factor)
    machine = variants.study.machine
    read = machine.read(changes)
    places = {s: v for path, v in read.items() for s in machine.paths[path].places}
    origin = machine.origin
    if isinstance(origin, Tables):
        return build_model(changed_tables(origin.tables, places), origin.folder)
    if isinstance(origin, Fields):
        made = changed_machine(origin.machine, places)
        return machine_model(made, origin.title, origin.around_home)
    raise TypeError(f"{origin!r} is made of neither tables nor fields.")


def _geometry_alone(variants: Variants, factors: list[float], found: np.ndarray) -> None:
    """A machine built from its own numbers, placed and solved by the dense solvers."""
    model = built_alone(variants, factors)
    axes = [a.ravel() for a in np.meshgrid(NEAR, NEAR, indexing="ij")]
    _, placement = moved(model, dict(zip("xy", axes, strict=True)))
    good = placement.reachable
    compliance, _ = compliance_and_outcome(model.structure.at(placement[good]), "saddle_point")
    np.testing.assert_allclose(found[good], axis_stiffness_free(compliance), rtol=1e-9)


def table(
    rows: list[Row],
    search: Row,
    best: int,
    load: float,
    moving: list[tuple[str, float, float]],
) -> str:
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
        "## Geometry",
        "",
        f"Stiffness at {len(NEAR) ** 2} poses where nodes or joints move, on one thread. By itself",
        "each machine is built from its numbers, placed and solved by the dense solvers. The",
        "results agree to 1e-9.",
        "",
        "| varied | ms per machine | ms per machine by itself | ratio |",
        "| --- | --- | --- | --- |",
        *(
            f"| {what} | {1e3 * together:.1f} | {1e3 * alone:.1f} | {alone / together:.1f} |"
            for what, together, alone in moving
        ),
        "",
        "## What takes the time",
        "",
        "Machines that differ in sections, materials, stiffnesses and masses share the program of",
        "elimination that gives their stiffness; their preloads, modes and masses are computed as",
        "one stack of matrices, whose rank, coordinates and free motions are determined once. What",
        "remains in Python, which one thread at a time can run, makes each machine from its",
        "numbers.",
        "Where nodes and joints move, each machine is placed again, which is most of the time; its",
        "bodies, loops and program of elimination stay. The program is made on the poses of",
        "the machine as it is stated, so that no order and no division of a study changes a bit.",
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
    moving = geometry(*((8, 1) if arguments.smallest else (128, 8)))
    shown(table(rows, search, best, load, moving), DOCUMENT, arguments)


if __name__ == "__main__":
    one_thread(main)
