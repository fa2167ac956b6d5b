"""Worst case, distribution and allocation of assembly forces, beside a plain loop in one run.

Run `python -m benchmarks.tolerance_speed`; with `--write` its table goes to
docs/performance-tolerances.md.
"""

from __future__ import annotations

import argparse
import math
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.static_speed import machine_line
from overconstraint import (
    Responses,
    allocate,
    distribution,
    draw,
    joint_quantities,
    tolerance_responses,
    tool_deviation,
    worst_case,
)
from tests.random_zones import random_responses
from tests.three_struts import LIMITS, three_struts, tilted_axes

DOCUMENT = Path(__file__).resolve().parent.parent / "docs" / "performance-tolerances.md"

MILLION = 1_000_000


def struts(kind: str = "surface") -> Responses:
    """Radial and axial forces of six bearings under three tilted axes."""
    placed = three_struts()
    quantities = joint_quantities(placed.structure.linkage)
    return tolerance_responses(placed, tilted_axes(kind), quantities)


def seconds(task: Callable[[], object], rounds: int = 5) -> float:
    """Median time of some rounds, after one that does not count."""
    task()
    found = []
    for _ in range(rounds):
        start = time.perf_counter()
        task()
        found.append(time.perf_counter() - start)
    return statistics.median(found)


def plain_loop(responses: Responses, samples: int) -> float:
    """Seconds for a plain loop over samples and quantities, NumPy within a sample."""
    generator = np.random.default_rng(0)
    largest = np.zeros(len(responses.quantities))
    start = time.perf_counter()
    for _ in range(samples):
        z = draw(responses.sources, generator.random(responses.sources.parameters))
        for q in range(len(largest)):
            parts = responses.gain[q] @ z + responses.mean[q]
            largest[q] = max(largest[q], math.hypot(*parts))
    return time.perf_counter() - start


def peak_memory(samples: int) -> float:
    """Largest memory of a process that samples so many times, MB."""
    code = (
        "from benchmarks.tolerance_speed import struts, peak_here, distribution\n"
        f"distribution(struts(), {samples})\nprint(peak_here())"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return float(run.stdout)


def peak_here() -> float:
    """Largest memory of this process so far, MB."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def table() -> str:
    """Measure everything and return the page."""
    model = struts()
    loop = plain_loop(model, 2000) / 2000
    rows = []
    for kind in ("surface", "uniform", "normal"):
        responses = struts(kind)
        for method in ("monte_carlo", "quasi_monte_carlo"):
            count = distribution(responses, MILLION, method).samples
            taken = seconds(lambda r=responses, m=method: distribution(r, MILLION, m), 3)
            words = "Monte Carlo" if method == "monte_carlo" else "quasi-Monte Carlo"
            rows.append(
                f"| {words}, {kind} | {count:,} | {taken:.2f} | {loop / (taken / count):,.0f} |"
            )
    worst = seconds(lambda: worst_case(model), 50)
    found = worst_case(model)
    tool = seconds(lambda: tool_deviation(found), 20)
    rng = np.random.default_rng(0)
    large = random_responses(rng, 40, 60)
    value = worst_case(large).value * rng.uniform(0.5, 2, 60)
    limits = {(q.joint, q.kind): float(v) for q, v in zip(large.quantities, value, strict=True)}
    costs = {f"t{i}": float(c) for i, c in enumerate(10 ** rng.uniform(-1, 1, 40))}
    allocations = []
    for name, responses, limit, cost in (
        ("three struts, 3 tolerances, 12 limits", model, LIMITS, None),
        ("random, 40 tolerances, 60 limits", large, limits, costs),
    ):
        for words, options in (
            ("one factor", {}),
            ("least cost", {"objective": "cost"}),
            ("one factor, 99 % of 100 000", {"quantile": 0.99}),
            ("least cost, 99 % of 100 000", {"objective": "cost", "quantile": 0.99}),
        ):
            result = allocate(responses, limit, costs=cost, **options)
            taken = seconds(
                lambda r=responses, m=limit, c=cost, o=options: allocate(r, m, costs=c, **o), 3
            )
            gap = "none claimed" if result.gap is None else f"{result.gap:.1e}"
            allocations.append(f"| {name} | {words} | {1e3 * taken:,.1f} | {gap} |")
    memory = [f"{n:,}: {peak_memory(n):.0f} MB" for n in (1000, MILLION, 4 * MILLION)]
    return "\n".join(
        [
            "# Performance: tolerances",
            "",
            "Made by `python -m benchmarks.tolerance_speed --write`: read ratios. One thread.",
            machine_line(),
            "",
            "Three struts on six elastic bearings, three tilted axes; both forces of each bearing.",
            "",
            f"Exact worst case of the twelve forces, certified to 1e-9: {1e3 * worst:.2f} ms.",
            f"The tool's in any direction, certified to 1e-4: {1e3 * tool:.2f} ms.",
            "",
            "| distribution | samples | s | times a plain loop |",
            "|---|---:|---:|---:|",
            *rows,
            "",
            f"The plain loop takes {1e6 * loop:.0f} µs a sample, force by force, for the largest.",
            "",
            f"Largest memory of the whole process by samples: {'; '.join(memory)}.",
            "",
            "| allocation | | ms | certified gap |",
            "|---|---|---:|---:|",
            *allocations,
            "",
        ]
    )


def main() -> None:
    """Measure, print and perhaps write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help=f"write docs/{DOCUMENT.name}")
    arguments = parser.parse_args()
    text = table()
    sys.stdout.write(text)
    if arguments.write:
        from strutwork.files import write_text  # noqa: PLC0415 - only when asked

        write_text(DOCUMENT, text)


if __name__ == "__main__":
    # pinned before any BLAS call: products of small matrices want one thread
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1, user_api="blas"):
        main()
