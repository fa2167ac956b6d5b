"""Modes, dynamic stiffness and frequency response per second, beside OpenSeesPy in one run.

Run `python -m benchmarks.modal_speed`; with `--write` its table goes to
docs/performance-vibration.md.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

import numpy as np

from benchmarks.frame import poses_of, three_legged_frame
from benchmarks.peers import opensees_frequencies
from benchmarks.static_speed import machine_line, rate
from fea import ModalRatio, Port, minimum_dynamic_stiffness, modal_model, modes
from fea.lowest import natural_frequencies
from kinematics import DIRECTIONS

DOCUMENT = Path(__file__).resolve().parent.parent / "docs" / "performance-vibration.md"


def table(poses: int) -> str:
    """Measure everything and return the page."""
    structure, positions = three_legged_frame()
    placement = poses_of(structure, positions, poses)
    placed = structure.at(placement)
    few = placement.positions[:128]
    ports = [Port("T", d) for d in "xyz"]
    damping, band = ModalRatio(0.01), (1.0, 5000.0)
    peer = rate(lambda: opensees_frequencies(structure, few, 10), len(few), 3)
    rows = [
        ("OpenSeesPy, ten modes, -fullGenLapack", peer),
        ("Strutwork, ten frequencies and shapes", rate(lambda: natural_frequencies(placed), poses)),
        (
            "Strutwork, ten modes with effective masses and energy shares",
            rate(lambda: modes(placed, 10), poses),
        ),
        (
            "Strutwork, all modes and exact minimum dynamic stiffness in x, y, z",
            rate(lambda: minimum_dynamic_stiffness(placed, ports, damping, band), poses),
        ),
    ]
    theirs = opensees_frequencies(structure, few, 10)
    ours = natural_frequencies(structure.at(placement[:128]))[0]
    model = modal_model(placed[:1], [Port("T", d) for d in DIRECTIONS], damping)
    lines = np.linspace(1.0, 2000.0, 1000)
    response = 1e3 / rate(lambda: model.receptance(lines), 1)
    apart = np.abs(ours / theirs - 1).max()
    difference = (
        f"Largest difference of a frequency from OpenSeesPy's: {apart:.1e}; its mass has "
        "no rotary inertia."
    )
    body = [f"| {name} | {value:,.0f} | {value / peer:.2f} |" for name, value in rows]
    return "\n".join(
        [
            "# Performance: vibration",
            "",
            "Made by `python -m benchmarks.modal_speed --write`: read ratios. One thread.",
            machine_line(),
            "",
            "The three-legged frame of 84 free degrees of freedom, new geometry at every pose.",
            "",
            "| | poses/s | times OpenSeesPy |",
            "|---|---:|---:|",
            *body,
            "",
            difference,
            "",
            f"1000 lines of the 6 x 6 receptance, modes at hand: {response:.2f} ms.",
            "",
        ]
    )


def main() -> None:
    """Measure, print and perhaps write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--poses", type=int, default=1024)
    parser.add_argument("--write", action="store_true", help="write docs/performance-vibration.md")
    arguments = parser.parse_args()
    text = table(arguments.poses)
    sys.stdout.write(text)
    if arguments.write:
        from strutwork.files import write_text  # noqa: PLC0415 - only when asked

        write_text(DOCUMENT, text)


if __name__ == "__main__":
    # pinned before any BLAS call: stacks of small systems want one thread
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1, user_api="blas"):
        main()
