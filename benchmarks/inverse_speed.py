"""Inverse kinematics per second: closed form, Newton leg by leg, on all bodies, and Pinocchio.

Run `python -m benchmarks.inverse_speed`; with `--write` its table goes to
docs/performance-inverse.md. It stops with an error where two of them disagree, or where the legs
are not faster than all bodies by `LEAST`. Pinocchio (the extra `bench`) is left out where it is
not installed; `--compile` takes it from C++ too, which takes minutes to compile.
"""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.kinematics_speed import poses_around
from benchmarks.measure import (
    DOCUMENTS,
    installed,
    left_out,
    machine_line,
    one_thread,
    parsed,
    parser,
    rate,
    require,
    shown,
)
from benchmarks.pinocchio_compiled import CompiledLegs, compiled, missing
from benchmarks.pinocchio_peer import Answer, PinocchioLegs
from strutwork.kinematics.inverse_survey import InverseSurvey, inverse_survey
from strutwork.kinematics.motion import Motion
from strutwork.machines import HexelHexapod, Machine, Proposed3PPRS
from strutwork.machines.load import machine_model

Array = NDArray[Any]

DOCUMENT = DOCUMENTS / "performance-inverse.md"

MACHINES: dict[str, Machine] = {
    "hexel-hexapod": HexelHexapod(),
    "proposed-3pprs": Proposed3PPRS(),
}

#: Margins and reach of closed form and legs agree to this.
AGREEMENT = 1e-9
#: How many times the rate of Newton on all bodies the legs must reach; twenty to sixty are usual.
LEAST = 5.0
#: Poses of Newton on all bodies.
FEW = 512


@dataclass(frozen=True)
class Rates:
    """Poses per second of processor time; of a peer that is left out, None."""

    closed: float
    legs: float
    bodies: float
    gap: float
    python: float | None = None
    cpp: float | None = None
    peers_gap: float = 0.0


class _AllBodies(Motion):
    """The same motion without its legs."""

    legs = None


def measured(machine: Machine, count: int, peer: bool, library: Path | None) -> Rates:
    """Rates of one machine: coordinates, joint ranges and singularity margin of every pose.

    Parameters
    ----------
    machine : Machine
    count : int
        Poses.
    peer : bool
        Whether Pinocchio is asked too.
    library : Path or None
        Its compiled legs.

    Raises
    ------
    RuntimeError
        Two ways disagree, or legs are not faster.
    """
    name = type(machine).__name__
    motion = machine_model(machine, name).motion
    require(motion.legs is not None, f"{name}: does not fall into legs")
    poses = poses_around(machine, count)
    few = poses[: min(FEW, count)]
    one, other = inverse_survey(machine, poses), inverse_survey(motion, poses)
    both = one.reachable & other.reachable
    require(bool(both.mean() > 0.5), f"{name}: few poses are taken")
    gap = float(np.abs(one.margin - other.margin)[both].max())
    require(gap < AGREEMENT, f"{name}: margins differ by {gap:.1e}")
    slow = _AllBodies(motion.linkage, motion.home, motion.rotation)
    # one after the other, so that what else the machine does falls on all alike
    peers: list[PinocchioLegs | CompiledLegs] = [PinocchioLegs(motion)] if peer else []
    if library is not None:
        peers.append(CompiledLegs(motion, library))
    gaps = [_apart(motion, other, each.survey(poses, other.length)) for each in peers]
    require(max(gaps, default=0.0) < AGREEMENT, f"{name}: Pinocchio differs by {gaps}")
    rates = [rate(lambda each=each: each.survey(poses, other.length), count) for each in peers]
    return Rates(
        rate(lambda: inverse_survey(machine, poses), count),
        rate(lambda: inverse_survey(motion, poses), count),
        rate(lambda: inverse_survey(slow, few), len(few.position), 3),
        gap,
        *[*rates, None, None][:2],
        max(gaps, default=0.0),
    )


def _apart(motion: Motion, ours: InverseSurvey, theirs: Answer) -> float:
    """How far drives and margins are apart, m, rad and 1; the same poses must be good."""
    if not np.array_equal(ours.reachable, theirs.good):
        return float("inf")
    home = dict(zip(motion.joints.names, motion.home_values, strict=True))
    zero = np.array([home[name] for name in motion.linkage.driven])
    good = theirs.good
    drives = np.abs(ours.values - zero - theirs.drives)[good].max()
    return float(max(drives, np.abs(ours.margin - theirs.margin)[good].max()))


def table(found: dict[str, Rates]) -> str:
    """The page with the results."""
    head = (
        "",
        "closed form, poses/s",
        "legs, poses/s",
        "all bodies, poses/s",
        "closed : legs",
        "legs : all",
        "largest difference",
    )
    lines = [
        "# Performance of inverse kinematics",
        "",
        "Written by `python -m benchmarks.inverse_speed --compile --write`: compare ratios.",
        "One thread,",
        "processor time.",
        machine_line(),
        "",
        "For every pose the drive coordinates, a check of the joint ranges, and the",
        "distance from the nearest singularity. *Closed form* is the machine's own; *legs*",
        "is compiled and uses Newton's method on the joints of each leg, from home to every",
        "pose; *all bodies* does the same with the joints of all legs together, in stacked",
        "NumPy.",
        "",
        f"| {' | '.join(head)} |",
        "|---|---:|---:|---:|---:|---:|---:|",
    ]
    lines += [
        f"| {name} | {r.closed:,.0f} | {r.legs:,.0f} | {r.bodies:,.0f} | "
        f"{r.closed / r.legs:.1f} | {r.legs / r.bodies:.0f} | {r.gap:.0e} |"
        for name, r in found.items()
    ]
    return "\n".join([*lines, *beside(found), ""])


def beside(found: dict[str, Rates]) -> list[str]:
    """The part of the page with Pinocchio."""
    if all(r.python is None for r in found.values()):
        return []
    head = (
        "",
        "legs, poses/s",
        "Pinocchio from Python, poses/s",
        "Pinocchio in C++, poses/s",
        "legs : from Python",
        "legs : in C++",
        "largest difference",
    )
    lines = [
        "",
        "## Comparison with Pinocchio",
        "",
        f"Pinocchio {version('pin')} in the same run, for the same results: drive",
        "coordinates, joint ranges, Jacobian and margin, with each leg closed to 1e-12 m.",
        "The legs are branches of one tree, all memory is allocated once, and Newton's",
        "method starts at home. *From Python* makes one call of `computeJointJacobians` per",
        "pose and step, and NumPy solves the equations of 512 poses at once; *in C++* makes",
        "one compiled call on Pinocchio's headers (`-O3 -march=native`). Both compute their",
        "margins from Strutwork's singular values, which are faster than NumPy's. Newton's",
        "method alone may converge to another working mode than that of home, and gives",
        "only the drive coordinates; *legs* follows the path where necessary, keeps the",
        "mode, reports which joint limits the path, and places all bodies.",
        "",
        f"| {' | '.join(head)} |",
        "|---|---:|---:|---:|---:|---:|---:|",
    ]
    for name, r in found.items():
        theirs = [f"{x:,.0f}" if x else "not asked" for x in (r.python, r.cpp)]
        ratios = [f"{r.legs / x:.2g}" if x else "" for x in (r.python, r.cpp)]
        lines.append(
            f"| {' | '.join([name, f'{r.legs:,.0f}', *theirs, *ratios])} | {r.peers_gap:.0e} |"
        )
    return lines


def main() -> None:
    """Measure, print and perhaps write the table."""
    options = parser(__doc__, DOCUMENT)
    options.add_argument("--poses", type=int, default=20_000)
    options.add_argument("--compile", action="store_true", help="Pinocchio from C++ too")
    arguments = parsed(options)
    poses = 64 if arguments.smallest else arguments.poses
    peer = installed("pinocchio", "Pinocchio")
    with tempfile.TemporaryDirectory() as folder:
        library = None
        if peer and arguments.compile:
            lacks = missing()
            if lacks:
                left_out(f"Pinocchio in C++ lacks {lacks}, which")
            else:
                library = compiled(Path(folder))
        found = {
            name: measured(machine, poses, peer, library) for name, machine in MACHINES.items()
        }
    shown(table(found), DOCUMENT, arguments)
    if not arguments.smallest:
        slow = [name for name, r in found.items() if r.legs < LEAST * r.bodies]
        require(not slow, f"less than {LEAST:g} times the rate of all bodies: {', '.join(slow)}")


if __name__ == "__main__":
    one_thread(main)
