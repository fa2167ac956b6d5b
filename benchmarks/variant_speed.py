"""How fast variants of a machine are asked over many poses.

Run `python -m benchmarks.variant_speed`; with `--write` its table goes to
docs/performance-variants.md. Machines solved one by one, each by itself, are compared with it.
"""

from __future__ import annotations

import time

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
from strutwork.machines.model_poses import moved
from strutwork.msa import axis_stiffness_free, compliance_and_outcome
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
#: The population that was asked for.
GOAL = 20_000


def _samples(count: int, stated: list[float]) -> np.ndarray:
    return np.array(stated) * np.random.default_rng(13).uniform(0.9, 1.1, (count, len(stated)))


def measured(machines: int, alone: int) -> list[tuple[str, int, int, float]]:
    """What is asked, threads, machines, and seconds of each run; both ways agree to 1e-9."""
    rows = []
    workspace = {"x": POINTS, "y": POINTS}
    for answers in (("stiffness",), ("stiffness", "frequency", "mass")):
        variants = Variants.of(HEXAPOD, PATHS, *answers, workspace=workspace)
        machine = variants.study.machine
        samples = _samples(machines, [machine.matching(path)[0].value for path in PATHS])
        # the kernel is loaded before
        variants.values(samples[:4], workers=1)
        for workers in (1, 2):
            start = time.perf_counter()
            found = variants.values(samples, workers=workers)
            taken = time.perf_counter() - start
            require(bool((found["status"] == 0).all()), "some machines were not solved")
            rows.append((", ".join(answers), workers, machines, taken))
        if answers == ("stiffness",):
            axes = [a.ravel() for a in np.meshgrid(POINTS, POINTS, indexing="ij")]
            start = time.perf_counter()
            for i in range(alone):
                model = machine.model(dict(zip(PATHS, samples[i].tolist(), strict=True)))
                _, placement = moved(model, dict(zip("xy", axes, strict=True)))
                compliance, _ = compliance_and_outcome(model.structure.at(placement))
                worst = axis_stiffness_free(compliance).min(axis=0)
                np.testing.assert_allclose(found["stiffness_free_worst"][i], worst, rtol=1e-9)
            taken = time.perf_counter() - start
            rows.append(("stiffness, each machine by itself", 1, alone, taken))
    return rows


def table(rows: list[tuple[str, int, int, float]]) -> str:
    """The page."""
    lines = [
        "# Performance of variants",
        "",
        "Written by `python -m benchmarks.variant_speed --write`: compare ratios.",
        machine_line(),
        "",
        f"The hexapod of `examples/machines/6-ups.toml` with {len(PATHS)}",
        f"varied sections and stiffnesses, at {POSES}",
        "poses and at home; the frequency is computed at home alone. The times of 20,000 machines",
        "are extrapolated from the machines of the table; 300 s on two cores are the aim.",
        "",
        "| answers | threads | machines | machines x poses per second | 20,000 machines |",
        "| --- | --- | --- | --- | --- |",
    ]
    for what, workers, count, taken in rows:
        rate, every = count * POSES / taken, GOAL * taken / count
        lines.append(f"| {what} | {workers} | {count} | {rate:,.0f} | {every:,.0f} s |")
    lines += [
        "",
        "The frequency limits the last rows: its static solution under the preload and its modes",
        "are computed machine by machine, mostly in Python, which one thread at a time can run.",
        "With `--cluster local` each processor has a process of its own.",
    ]
    return joined(lines)


def main() -> None:
    """Measure, print and perhaps write the table."""
    arguments = parsed(parser(__doc__, DOCUMENT))
    machines, alone = (4, 1) if arguments.smallest else (500, 5)
    shown(table(measured(machines, alone)), DOCUMENT, arguments)


if __name__ == "__main__":
    one_thread(main)
