"""Cost of gradients beside that of the value: one pose's worst stiffness to many parameters.

Run `python -m benchmarks.gradient_speed`; with `--write` its table goes to
docs/performance-gradients.md. The value is the least of the three translational stiffnesses of the
tool at a pose away from home; the gradient is that of the same number. Differences in which each
parameter costs two values are compared with it. It stops with an error where the two disagree, or
where the gradient to thirty parameters costs `MOST` values or more.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from benchmarks.measure import DOCUMENTS, machine_line, one_thread, parsed, parser, require, shown
from benchmarks.measure import rate as per_second
from strutwork.machines.model import Model
from strutwork.machines.model_poses import at_pose
from strutwork.msa import axis_stiffness_free, tool_compliance
from strutwork.msa.sensitivity import compliance_sensitivity
from strutwork.studies.dimension import Dimension, dimensions
from strutwork.studies.parametric import Parametric
from strutwork.studies.tangents import PlacedTangents, Tangents

DOCUMENT = DOCUMENTS / "performance-gradients.md"

#: The gradient to thirty parameters costs fewer values than this.
MOST = 5.0

#: Parameters of the reach.
COUNT = 30
#: Of the smallest size.
FEW = 10


#: Model files of the project.
MACHINES = DOCUMENTS.parent / "examples" / "machines"


@dataclass(frozen=True)
class Case:
    """A machine, a pose of its tool, and lists of paths that move together."""

    source: str
    pose: dict[str, float]
    places: tuple[str, ...] = ()


CASES = {
    "6-UPS hexapod": Case(
        str(MACHINES / "6-ups.toml"),
        {"x": 0.02, "rx": 0.05},
        tuple(f"nodes.base{k}.{d}+nodes.foot{k}.{d}" for k in range(1, 7) for d in "xy"),
    ),
    "3-RPS head": Case(
        str(MACHINES / "3-rps.toml"),
        {"z": 0.69, "rx": 0.1, "ry": 0.05},
        tuple(f"nodes.base{k}.{d}+nodes.foot{k}.{d}" for k in (1, 2, 3) for d in "xy"),
    ),
    "3-PPRS, placed by formulas": Case("eclipse-3pprs", {"x": 0.02, "rx": 0.1}),
}


@dataclass(frozen=True)
class Costs:
    """Seconds of processor time, and how far gradient and differences are apart."""

    parameters: int
    moving: int
    value: float
    gradient: float
    placing: float
    set_up: float
    differences: float
    gap: float


def _worst(model: Model, pose: dict[str, float]) -> float:
    placed = at_pose(model, pose).placed
    return float(axis_stiffness_free(tool_compliance(placed))[:3].min())


def _gradient(found: PlacedTangents) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    tool = compliance_sensitivity(found.placed, found.changes)
    worst = int(axis_stiffness_free(tool.compliance)[0, :3].argmin())
    return np.asarray(tool.free[:, 0, worst])


def _seconds(task: Callable[[], object]) -> float:
    return 1.0 / per_second(task, 1)


def measured(case: Case, count: int) -> Costs:
    """Costs of one machine.

    Raises
    ------
    RuntimeError
        The gradient is not that of differences.
    """
    machine = Parametric.of(case.source)
    moving = [Dimension.of(machine, name) for name in case.places]
    still = [p for p in dimensions(machine) if p.name not in case.places]
    parameters = [*moving, *still][:count]
    tangents = Tangents.of(machine.model, parameters)
    require(not tangents.refused, f"{case.source}: {dict(tangents.refused)}")
    model = tangents.model
    pose = {d: np.array([v]) for d, v in case.pose.items()}
    found = tangents.at(pose)
    _ = [change.geometry for change in found.changes]
    step = 1e-4
    gap = 0.0
    exact = _gradient(found)
    for parameter, slope in list(zip(tangents.parameters, exact, strict=True))[::7]:
        h = step * max(abs(parameter.value), 1e-3)
        ends = [_worst(machine.model(parameter.moved(s * h)), case.pose) for s in (1.0, -1.0)]
        size = abs(_worst(model, case.pose)) / max(abs(parameter.value), 1e-3)
        gap = max(gap, abs((ends[0] - ends[1]) / (2 * h) - slope) / size)
    require(gap < 1e-6, f"{case.source}: gradient and differences are {gap:.1e} apart")
    value = _seconds(lambda: _worst(model, case.pose))
    return Costs(
        len(tangents.parameters),
        sum(change.geometry is not None for change in found.changes),
        value,
        _seconds(lambda: _gradient(tangents.at(pose))),
        _seconds(lambda: tangents.at(pose)),
        _seconds(lambda: Tangents.of(machine.model, parameters)),
        2.0 * len(parameters) * value,
        gap,
    )


def table(found: dict[str, Costs]) -> str:
    """The page with the results."""
    head = (
        "",
        "parameters",
        "of geometry",
        "value, ms",
        "gradient, ms",
        "gradient per value",
        "of it placing, ms",
        "differences per value",
        "set-up, ms",
        "apart, share",
    )
    lines = [
        "# Performance of gradients",
        "",
        "Made by `python -m benchmarks.gradient_speed --write`: read ratios. One thread,",
        "processor time.",
        machine_line(),
        "",
        "The value is the worst translational stiffness of the tool at one pose: the machine is",
        "placed there and solved. The gradient is that of this number to all parameters at once:",
        "one placement, one solution, and two placements more for each parameter of geometry.",
        "Differences need two values for each parameter. The set-up makes the machine a step to",
        "either side of each parameter; it is done once for all poses and quantities. The last",
        "column is how far gradient and differences are apart, as a share of value per parameter.",
        "",
        f"| {' | '.join(head)} |",
        "|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    lines += [
        f"| {name} | {c.parameters} | {c.moving} | {1e3 * c.value:.1f} | {1e3 * c.gradient:.1f} | "
        f"{c.gradient / c.value:.1f} | {1e3 * c.placing:.1f} | {c.differences / c.value:.0f} | "
        f"{1e3 * c.set_up:.0f} | {c.gap:.0e} |"
        for name, c in found.items()
    ]
    return "\n".join([*lines, ""])


def main() -> None:
    """Measure, print and perhaps write the table."""
    arguments = parsed(parser(__doc__, DOCUMENT))
    cases = dict(list(CASES.items())[1:2]) if arguments.smallest else CASES
    count = FEW if arguments.smallest else COUNT
    found = {name: measured(case, count) for name, case in cases.items()}
    shown(table(found), DOCUMENT, arguments)
    if not arguments.smallest:
        slow = [n for n, c in found.items() if c.gradient >= MOST * c.value]
        require(not slow, f"the gradient costs {MOST:g} values or more: {', '.join(slow)}")


if __name__ == "__main__":
    one_thread(main)
