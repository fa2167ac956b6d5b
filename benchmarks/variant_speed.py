"""How fast variants of a machine are asked over many poses.

`python -m benchmarks.variant_speed` prints the page part; `--machines N` sets the population,
`--alone N` how many machines the loop through the ordinary door takes.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from strutwork.machines.model_poses import moved
from strutwork.msa import axis_stiffness_free, compliance_and_outcome
from strutwork.studies.variants import Variants

HEXAPOD = "examples/machines/6-ups.toml"
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


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--machines", type=int, default=500)
    parser.add_argument("--alone", type=int, default=5)
    chosen = parser.parse_args()
    workspace = {"x": POINTS, "y": POINTS}
    rows = []
    for answers in (("stiffness",), ("stiffness", "frequency", "mass")):
        variants = Variants.of(HEXAPOD, PATHS, *answers, workspace=workspace)
        machine = variants.study.machine
        samples = _samples(chosen.machines, [machine.matching(path)[0].value for path in PATHS])
        # at least as many as use the compiled kernel, so that it is loaded
        variants.values(samples[:4], workers=1)
        for workers in (1, 2):
            start = time.perf_counter()
            found = variants.values(samples, workers=workers)
            taken = time.perf_counter() - start
            good = int((found["status"] == 0).sum())
            rows.append((" and ".join(answers), workers, chosen.machines, good, taken))
        if answers == ("stiffness",):
            worst = found["stiffness_free_worst"]
            axes = np.meshgrid(POINTS, POINTS, indexing="ij")
            start = time.perf_counter()
            for i in range(chosen.alone):
                values = dict(zip(PATHS, samples[i].tolist(), strict=True))
                model = machine.model(values)
                _, placement = moved(model, {d: a.ravel() for d, a in zip("xy", axes, strict=True)})
                compliance, _ = compliance_and_outcome(model.structure.at(placement))
                alone = axis_stiffness_free(compliance).min(axis=0)
                np.testing.assert_allclose(worst[i], alone, rtol=1e-9)
            each = (time.perf_counter() - start) / chosen.alone
            rows.append(
                ("stiffness, each alone", 1, chosen.alone, chosen.alone, each * chosen.alone)
            )
    print(
        "| answers | threads | machines | solved | machines x poses per second | 20,000 machines |"
    )
    print("| --- | --- | --- | --- | --- | --- |")
    for what, workers, count, good, taken in rows:
        rate = count * POSES / taken
        whole = GOAL * taken / count
        print(f"| {what} | {workers} | {count} | {good} | {rate:,.0f} | {whole:,.0f} s |")


if __name__ == "__main__":
    main()
