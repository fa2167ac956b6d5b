"""Modes, dynamic stiffness and frequency response per second, beside OpenSeesPy in one run.

Run `python -m benchmarks.modal_speed`; with `--write` its table goes to
docs/performance-vibration.md.
"""

from __future__ import annotations

import numpy as np

from benchmarks.frame import poses_of, three_legged_frame
from benchmarks.measure import (
    DOCUMENTS,
    installed,
    joined,
    machine_line,
    one_thread,
    parsed,
    parser,
    rate,
    require,
    shown,
)
from strutwork.fea import ModalRatio, Port, minimum_dynamic_stiffness, modal_model, modes
from strutwork.fea.lowest import natural_frequencies
from strutwork.kinematics import DIRECTIONS

DOCUMENT = DOCUMENTS / "performance-vibration.md"

#: Frequencies agree to this share: OpenSees has no rotary inertia.
AGREEMENT = 1e-2
#: Our own ways of finding them agree to this.
OWN = 1e-9


def table(poses: int) -> str:
    """Measure everything and return the page.

    Raises
    ------
    RuntimeError
        Frequencies differ between our own ways, or from OpenSeesPy's.
    """
    structure, positions = three_legged_frame()
    placement = poses_of(structure, positions, poses)
    placed = structure.at(placement)
    few = placement.positions[:128]
    ports = [Port("T", d) for d in "xyz"]
    damping, band = ModalRatio(0.01), (1.0, 5000.0)
    rows = [
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
    ours = natural_frequencies(structure.at(placement[:128]))[0]
    own = np.abs(modes(structure.at(placement[:128]), 10).frequencies / ours - 1).max()
    require(bool(own < OWN), f"our own frequencies are {own:.1e} apart")
    difference = "OpenSeesPy is not installed: nothing to compare with."
    if installed("openseespy", "OpenSeesPy"):
        from benchmarks.peers import opensees_frequencies  # noqa: PLC0415 - a benchmark extra

        peer = rate(lambda: opensees_frequencies(structure, few, 10), len(few), 3)
        rows.append(("OpenSeesPy, ten modes, -fullGenLapack", peer))
        apart = np.abs(ours / opensees_frequencies(structure, few, 10) - 1).max()
        require(bool(apart < AGREEMENT), f"frequencies are {apart:.1e} from OpenSeesPy's")
        difference = (
            f"Largest difference of a frequency from OpenSeesPy's: {apart:.1e}; its mass has "
            "no rotary inertia."
        )
    model = modal_model(placed[:1], [Port("T", d) for d in DIRECTIONS], damping)
    lines = np.linspace(1.0, 2000.0, 1000)
    response = 1e3 / rate(lambda: model.receptance(lines), 1)
    first = rows[0][1]
    return joined(
        [
            "# Performance: vibration",
            "",
            "Written by `python -m benchmarks.modal_speed --write`: compare ratios. One thread, by",
            "processor time.",
            machine_line(),
            "",
            "The three-legged frame of 84 free degrees of freedom, new geometry at every pose.",
            "",
            "| | poses/s | of the first |",
            "|---|---:|---:|",
            *(f"| {name} | {value:,.0f} | {value / first:.2f} |" for name, value in rows),
            "",
            difference,
            "",
            f"1000 lines of the 6 x 6 receptance from known modes: {response:.2f} ms.",
        ]
    )


def main() -> None:
    """Measure, print and perhaps write the table."""
    options = parser(__doc__, DOCUMENT)
    options.add_argument("--poses", type=int, default=1024)
    arguments = parsed(options)
    shown(table(8 if arguments.smallest else arguments.poses), DOCUMENT, arguments)


if __name__ == "__main__":
    one_thread(main)
