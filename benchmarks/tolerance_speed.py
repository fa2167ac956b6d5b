"""Worst case, distribution and allocation of assembly forces, beside a plain loop in one run.

Run `python -m benchmarks.tolerance_speed`; with `--write` its table goes to
docs/performance-tolerances.md.
"""

from __future__ import annotations

import math
import resource
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

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
from strutwork.overconstraint import (
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

Array = NDArray[Any]

DOCUMENT = DOCUMENTS / "performance-tolerances.md"

MILLION, HUNDRED_THOUSAND = 1_000_000, 100_000

#: Share by which a sample may pass the worst case: that of its certificate.
CERTIFIED = 1e-9
#: Certified gap of an allocation.
GAP = 1e-6


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


def plain_loop(responses: Responses, samples: int) -> tuple[float, Array]:
    """Seconds for a plain loop over samples and quantities, NumPy within a sample.

    Returns
    -------
    seconds : float
    largest : (q,)
        Of every quantity.
    """
    generator = np.random.default_rng(0)
    largest = np.zeros(len(responses.quantities))
    start = time.perf_counter()
    for _ in range(samples):
        z = draw(responses.sources, generator.random(responses.sources.parameters))
        for q in range(len(largest)):
            parts = responses.gain[q] @ z + responses.mean[q]
            largest[q] = max(largest[q], math.hypot(*parts))
    return time.perf_counter() - start, largest


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


def table(samples: int, assemblies: int) -> str:
    """Measure everything and return the page.

    Parameters
    ----------
    samples : int
        Of the distributions.
    assemblies : int
        Of the allocations.

    Raises
    ------
    RuntimeError
        A sample exceeds the worst case, or an allocation's certificate leaves a gap.
    """
    model = struts()
    loop, largest = plain_loop(model, 2000)
    loop /= 2000
    found = worst_case(model)
    require(
        bool(np.all(largest <= found.bound * (1.0 + CERTIFIED))),
        "a sample exceeds the worst case",
    )
    rows = []
    for kind in ("surface", "uniform", "normal"):
        responses = struts(kind)
        for method in ("monte_carlo", "quasi_monte_carlo"):
            count = distribution(responses, samples, method).samples
            taken = seconds(lambda r=responses, m=method: distribution(r, samples, m), 3)
            words = "Monte Carlo" if method == "monte_carlo" else "quasi-Monte Carlo"
            rows.append(
                f"| {words}, {kind} | {count:,} | {taken:.2f} | {loop / (taken / count):,.0f} |"
            )
    worst = seconds(lambda: worst_case(model), 50)
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
            (f"one factor, 99 % of {assemblies:,}", {"quantile": 0.99}),
            (f"least cost, 99 % of {assemblies:,}", {"objective": "cost", "quantile": 0.99}),
        ):
            result = allocate(responses, limit, costs=cost, samples=assemblies, **options)
            taken = seconds(
                lambda r=responses, m=limit, c=cost, o=options: allocate(
                    r, m, costs=c, samples=assemblies, **o
                ),
                3,
            )
            require(
                result.gap is None or result.gap <= GAP,
                f"{name}, {words}: the certificate leaves a gap of {result.gap}",
            )
            gap = "none claimed" if result.gap is None else f"{result.gap:.1e}"
            allocations.append(f"| {name} | {words} | {1e3 * taken:,.1f} | {gap} |")
    memory = [f"{n:,}: {peak_memory(n):.0f} MB" for n in (1000, samples, 4 * samples)]
    return joined(
        [
            "# Performance: tolerances",
            "",
            "Written by `python -m benchmarks.tolerance_speed --write`: compare ratios.",
            "One thread.",
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
            f"The plain loop takes {1e6 * loop:.0f} µs per sample to find the largest value.",
            "",
            f"Largest memory of the process by samples: {'; '.join(memory)}.",
            "",
            "| allocation | | ms | certified gap |",
            "|---|---|---:|---:|",
            *allocations,
        ]
    )


def main() -> None:
    """Measure, print and perhaps write the table."""
    arguments = parsed(parser(__doc__, DOCUMENT))
    text = table(2000, 2000) if arguments.smallest else table(MILLION, HUNDRED_THOUSAND)
    shown(text, DOCUMENT, arguments)


if __name__ == "__main__":
    one_thread(main)
