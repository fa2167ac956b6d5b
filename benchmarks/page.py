"""Every benchmark in one run, on one page: docs/benchmarks.md.

Run `python -m benchmarks.page`; it takes about a quarter of an hour on two cores. Each program of
`benchmarks` runs in a process of its own, as it does alone, and its tables are taken from what it
prints; one that fails is named on the page, which ends with an error. `--quick` runs all at their
smallest size and writes nothing. `--only NAME` runs some; `--output FILE` writes elsewhere.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from benchmarks.measure import DOCUMENTS, joined, machine_line

DOCUMENT = DOCUMENTS / "benchmarks.md"
#: What OpenSees says at its end, behind the error of a program.
FAREWELL = "Process 0 Terminating"


@dataclass(frozen=True)
class Part:
    """A program, its arguments in this run, and what is said of it."""

    program: str
    title: str
    page: str
    peers: str
    limit: str
    arguments: tuple[str, ...] = ()


PARTS = (
    Part(
        "static_speed",
        "Static stiffness",
        "performance-statics.md",
        "OpenSeesPy, PyNite",
        "Arithmetic of the compiled elimination. Poses near a singularity are solved again by the "
        "stacked solver at its own rate, which the first table states.",
        ("--poses", "16384"),
    ),
    Part(
        "kinematics_speed",
        "Velocity Jacobians",
        "performance-kinematics.md",
        "all constraint rows in NumPy",
        "The inverse kinematics of each leg takes about half; the rest is arithmetic of 6 x 6 "
        "matrices.",
        ("--poses", "16384"),
    ),
    Part(
        "inverse_speed",
        "Inverse kinematics",
        "performance-inverse.md",
        "Pinocchio",
        "Newton steps of every leg from home to every pose.",
        ("--poses", "8192"),
    ),
    Part(
        "assembly_speed",
        "Assembly modes",
        "performance-assembly.md",
        "eigenvalues by LAPACK",
        "Roots of one polynomial of degree sixteen per pose.",
        ("--poses", "2048"),
    ),
    Part(
        "modal_speed",
        "Vibration",
        "performance-vibration.md",
        "OpenSeesPy",
        "LAPACK's dense eigensolver, with the third power of the degrees of freedom.",
        ("--poses", "512"),
    ),
    Part(
        "tolerance_speed",
        "Tolerances",
        "performance-tolerances.md",
        "a plain loop",
        "Random numbers and one pass over memory; allocations by quantile repeat it.",
    ),
    Part(
        "cutting_speed",
        "Stability of cutting",
        "performance-cutting.md",
        "a semi-discretisation",
        "Eigenvalues of the map of one tooth period, which a helix changes at every depth.",
    ),
    Part(
        "gradient_speed",
        "Gradients",
        "performance-gradients.md",
        "differences",
        "Parameters of geometry place the machine twice each; all others cost next to nothing.",
    ),
    Part(
        "executor_speed",
        "Studies",
        "performance-studies.md",
        "one worker",
        "Number of processors: the chunks hold Python's global lock for a small share of their "
        "time, which the table states.",
    ),
    Part(
        "variant_speed",
        "Variants",
        "performance-variants.md",
        "each machine by itself",
        "Python, which makes each machine from its numbers and which one thread at a time can run; "
        "then the compiled elimination, and dense matrices of the modes.",
    ),
    Part(
        "solid_speed",
        "Solids",
        "performance-solids.md",
        "CalculiX, SLEPc",
        "Arithmetic of the factorisation, with the second power of the degrees of freedom, and "
        "memory with the power 1.4.",
        ("--size", "22k"),
    ),
    Part(
        "growth_speed",
        "How cost grows",
        "performance-growth.md",
        "smaller runs",
        "Stated below each table.",
    ),
)

#: Packages whose versions decide the figures.
PACKAGES = (
    "strutwork",
    "numpy",
    "scipy",
    "numba",
    "openseespy",
    "PyNiteFEA",
    "pin",
    "dask",
    "distributed",
    "zarr",
    "scikit-sparse",
    "PyMUMPS",
    "pypardiso",
)

#: The head of a program's page, which this page has once: from its title to the machine.
_HEAD = re.compile(r"\A# .*?^Machine: [^\n]*\n", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Result:
    """What a program printed, how long it took, and the last line of its error."""

    part: Part
    text: str
    seconds: float
    error: str = ""
    arguments: tuple[str, ...] = ()


def run(part: Part, *, quick: bool) -> Result:
    """One program in a process of its own."""
    one = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL")}
    arguments = ("--smallest",) if quick else part.arguments
    begun = time.perf_counter()
    done = subprocess.run(
        [sys.executable, "-m", f"benchmarks.{part.program}", *arguments],
        cwd=DOCUMENTS.parent,
        env={**os.environ, **one},
        capture_output=True,
        text=True,
        check=False,
    )
    taken = time.perf_counter() - begun
    lines = [line for line in done.stderr.splitlines() if line.strip() and FAREWELL not in line]
    error = (lines[-1] if lines else f"status {done.returncode}") if done.returncode else ""
    return Result(part, done.stdout, taken, error, arguments)


def section(result: Result) -> list[str]:
    """The program's tables under a heading of this page."""
    part = result.part
    body = _HEAD.sub("", result.text).replace(f" {machine_line()}", "")
    text = re.sub(r"^(#+) ", r"#\1 ", body, flags=re.MULTILINE).strip()
    command = " ".join(["python -m", f"benchmarks.{part.program}", *result.arguments])
    failed = [f"**This run failed: {result.error}**", ""] if result.error else []
    return [
        f"## {part.title}",
        "",
        f"`{command}`, {result.seconds:.0f} s. Compared with {part.peers}; [more]({part.page}).",
        "",
        *failed,
        *([text, ""] if text else []),
        f"*What limits it:* {part.limit}",
        "",
    ]


def versions() -> str:
    """Packages with their versions; those that are not installed are said to be."""
    found, lacking = [], []
    for name in PACKAGES:
        try:
            found.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            lacking.append(name)
    rest = f" Not installed, and left out: {', '.join(lacking)}." if lacking else ""
    return f"{', '.join(found)}.{rest}"


def page(results: Sequence[Result], load: float) -> str:
    """The whole page."""
    lacking = [p.title for p in PARTS if p not in [r.part for r in results]]
    left_out = [f"Left out of this run: {', '.join(lacking)}.", ""] if lacking else []
    minutes = sum(r.seconds for r in results) / 60.0
    return joined(
        [
            "# Benchmarks",
            "",
            f"Benchmarks in one run of {minutes:.0f} minutes, by `python -m benchmarks.page`.",
            "Compare ratios: rates are those of one machine. Where nothing else is stated, one",
            "thread computes and times are processor time. [Performance](performance.md) lists the",
            "pages that explain each benchmark.",
            "",
            machine_line(),
            versions(),
            f"Load of other work at the start: {load:.1f}.",
            "",
            *left_out,
            *(line for result in results for line in section(result)),
        ]
    )


def main() -> int:
    """Run the programs, then print or write the page."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--quick", action="store_true", help="smallest sizes; writes no page")
    options.add_argument("--only", action="append", choices=[p.program for p in PARTS])
    options.add_argument("--output", type=Path, help=f"in place of docs/{DOCUMENT.name}")
    chosen = options.parse_args()
    if chosen.quick and chosen.output:
        options.error("--quick is a check; its figures are not written")
    if chosen.only and not (chosen.quick or chosen.output):
        options.error("--only makes no complete page; add --output FILE or --quick")
    load = os.getloadavg()[0]
    results = []
    for part in PARTS:
        if chosen.only and part.program not in chosen.only:
            continue
        results.append(run(part, quick=chosen.quick))
        last = results[-1]
        sys.stderr.write(f"{part.program}: {last.seconds:.0f} s {last.error}\n")
    text = page(results, load)
    if chosen.quick:
        sys.stdout.write(text)
    else:
        from strutwork.files import write_text  # noqa: PLC0415 - only when asked

        write_text(chosen.output or DOCUMENT, text)
    return int(any(result.error for result in results))


if __name__ == "__main__":
    sys.exit(main())
