"""The poses at which measurements would determine most: a D-optimal choice.

The information of measurements is the sum of JᵀJ, J the derivatives of their residuals by the
scaled parameters; its determinant is one over the squared volume of the confidence region. Poses
are added one after the other, each the one that raises the determinant most, and then exchanged
one for one until no exchange raises it (Fedorov 1972, Theory of optimal experiments, chapter 3).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.fea.ports import Port
from strutwork.kinematics import DIRECTIONS
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model_motion_schema import WorkspaceTable
from strutwork.machines.model_motion_tables import grid_of_table
from strutwork.studies.calibration_file import load_of
from strutwork.studies.calibration_result import NINETY_FIVE, MachineCalibration
from strutwork.studies.calibration_schema import CandidatesTable
from strutwork.studies.experiment import Experiment, reachable
from strutwork.studies.measured_deflections import MeasuredDeflections
from strutwork.studies.measured_frequencies import MeasuredFrequencies
from strutwork.studies.measured_frf import MeasuredFrf
from strutwork.studies.measurement import Measurement, at_words

Array = NDArray[Any]

#: Sets of poses picked at random for comparison.
RANDOM = 200

#: An exchange must raise the logarithm of the determinant by so much.
GAIN = 1e-9


def greedy_exchange(prior: Array, each: Array, count: int) -> tuple[int, ...]:
    """Places whose information together has a large determinant, ascending.

    Parameters
    ----------
    prior : (g, g)
        Information that is there before, positive definite, no unit.
    each : (n, g, g)
        Information of each place, no unit.
    count : int
        How many are chosen, at most n.
    """
    chosen: list[int] = []
    total = prior.copy()
    for _ in range(count):
        best = _best(total, each, chosen)
        chosen.append(best)
        total = total + each[best]
    while True:
        now = _size(total)
        for position, old in enumerate(chosen):
            rest = total - each[old]
            best = _best(rest, each, [c for c in chosen if c != old])
            if _size(rest + each[best]) > now + GAIN:
                chosen[position] = best
                total = prior + each[chosen].sum(axis=0)
                break
        else:
            return tuple(sorted(chosen))


def _best(total: Array, each: Array, taken: list[int]) -> int:
    sizes = np.linalg.slogdet(total + each)[1]
    sizes[taken] = -np.inf
    return int(sizes.argmax())


def _size(information: Array) -> float:
    return float(np.linalg.slogdet(information)[1])


@dataclass(frozen=True)
class PoseChoice:
    """The chosen poses, and what is expected of them.

    Parameters
    ----------
    names : tuple of g str
        Of the parameters.
    logs : tuple of g bool
        Whether the deviations are of a logarithm.
    task : mapping of direction to (n,)
        The candidates, m and rad.
    chosen : tuple of int
        Among them.
    lost : int
        Candidates that the machine cannot take, left out before.
    before, after, random : (g,)
        Expected half-widths of 95 % intervals of the scaled parameters, no unit: with what there
        is, with the chosen poses, and the median of poses picked at random.
    gain, gain_random : float
        By which factor the intervals become narrower on average, no unit.
    better : float
        Share of the random choices that are not better, no unit.
    kinds : tuple of str
        What is measured at each pose.
    notes : tuple of str
    """

    names: tuple[str, ...]
    logs: tuple[bool, ...]
    task: Mapping[str, Array]
    chosen: tuple[int, ...]
    lost: int
    before: Array
    after: Array
    random: Array
    gain: float
    gain_random: float
    better: float
    kinds: tuple[str, ...]
    notes: tuple[str, ...] = ()

    @property
    def candidates(self) -> int:
        """How many poses there are to choose from."""
        return len(next(iter(self.task.values())))

    @property
    def axes(self) -> tuple[str, ...]:
        """Headings of the coordinates of a pose, with units."""
        return tuple(f"{d}, deg" if d.startswith("r") else f"{d}, mm" for d in self.task)

    def pose_cells(self, k: int) -> tuple[float, ...]:
        """Coordinates of a candidate, in mm and degrees.

        Parameters
        ----------
        k : int
        """
        return tuple(
            float(np.degrees(v[k]) if d.startswith("r") else 1e3 * v[k])
            for d, v in self.task.items()
        )

    def spread_words(self, i: int, half: float) -> str:
        """A half-width in words: a percentage, or a factor where that of a logarithm is large.

        Parameters
        ----------
        i : int
            Of the parameter.
        half : float
            Of the parameter's logarithm, or as a share of its value, no unit.
        """
        if half < 0.5 or not self.logs[i]:
            return f"± {100 * half:.2g} %"
        return f"×÷ {np.exp(min(half, 300.0)):.3g}"

    @property
    def words(self) -> str:
        """What the choice is worth."""
        return (
            f"The intervals become narrower by a factor of {self.gain:.3g} on average; with as "
            f"many poses picked at random, by {self.gain_random:.3g} (the median of {RANDOM} "
            f"choices, of which {100 * self.better:.0f} % are not better)."
        )

    def to_dict(self) -> dict[str, Any]:
        """Plain values."""
        return {
            "candidates": self.candidates,
            "unreachable": self.lost,
            "measured": list(self.kinds),
            "chosen": [{d: float(v[k]) for d, v in self.task.items()} for k in self.chosen],
            "expected": {
                name: {"before": float(b), "after": float(a), "random": float(r)}
                for name, b, a, r in zip(
                    self.names, self.before, self.after, self.random, strict=True
                )
            },
            "gain": self.gain,
            "gain_random": self.gain_random,
            "random_not_better": self.better,
            "notes": list(self.notes),
        }


def choose_poses(
    experiment: Experiment,
    table: CandidatesTable | None,
    count: int,
    found: MachineCalibration | None = None,
    seed: int = 0,
    evaluate: Callable[[Experiment, Array], Array] = Experiment.jacobian,
) -> PoseChoice:
    """Choose the poses whose measurements determine the parameters best together.

    The parameters stand at their calibrated values, or at the guess. What was measured counts, and
    what is known before: a parameter without a prior is equally likely anywhere in its range.

    Parameters
    ----------
    experiment : Experiment
    table : CandidatesTable or None
        Poses and what is measured at each; else the machine's workspace and the kinds that were
        measured already.
    count : int
        How many poses.
    found : MachineCalibration, optional
        What the measurements that there are gave.
    seed : int
        Of the random choices.
    evaluate : callable
        The derivatives of an experiment, (t, g), no unit.

    Raises
    ------
    ModelError
        No candidates, fewer than poses to be chosen, nothing to measure, or as the measurements.
    """
    point = experiment.guess if found is None else found.point
    low, high = experiment.bounds
    # the derivatives at a bound would be one-sided
    point = np.clip(point, low + 1e-3 * (high - low), high - 1e-3 * (high - low))
    task, lost = _candidates(experiment, table, count)
    templates = _templates(experiment, table)
    n, g = len(next(iter(task.values()))), len(experiment.unknowns)
    each = np.zeros((n, g, g))
    for k in range(n):
        at = {d: float(v[k]) for d, v in task.items()}
        here = replace(experiment, measurements=tuple(_at(t, at) for t in templates))
        if k == 0:
            for m, standing in zip(
                here.measurements, here.standing(here.values(point)), strict=True
            ):
                m.check(standing)
        rows = evaluate(here, point)
        each[k] = rows.T @ rows
    prior = np.diag([1.0 / u.vague**2 for u in experiment.unknowns])
    if experiment.measurements:
        rows = evaluate(experiment, point)
        prior = prior + rows.T @ rows
    chosen = greedy_exchange(prior, each, count)
    rng = np.random.default_rng(seed)
    sets = [rng.choice(n, count, replace=False) for _ in range(RANDOM)]
    totals = np.array([prior + each[s].sum(axis=0) for s in sets])
    best = prior + each[list(chosen)].sum(axis=0)
    sizes = np.linalg.slogdet(totals)[1]
    base = _size(prior)
    scales = np.array(
        [
            1.0
            if u.parameter.scale == "log"
            else (u.parameter.high - u.parameter.low) / max(abs(float(v)), 1e-300)
            for u, v in zip(experiment.unknowns, experiment.values(point), strict=True)
        ]
    )
    return PoseChoice(
        experiment.names,
        tuple(u.parameter.scale == "log" for u in experiment.unknowns),
        task,
        chosen,
        lost,
        _half(prior) * scales,
        _half(best) * scales,
        np.median([_half(t) for t in totals], axis=0) * scales,
        float(np.exp((_size(best) - base) / (2 * g))),
        float(np.exp((np.median(sizes) - base) / (2 * g))),
        float(np.mean(sizes <= _size(best) + GAIN)),
        tuple(dict.fromkeys(t.kind for t in templates)),
        (f"{lost} candidate poses cannot be taken and are left out",) if lost else (),
    )


def _half(information: Array) -> Array:
    return np.asarray(NINETY_FIVE * np.sqrt(np.diag(np.linalg.inv(information))))


def _candidates(
    experiment: Experiment, table: CandidatesTable | None, count: int
) -> tuple[dict[str, Array], int]:
    spans = {} if table is None else {d: s for d in DIRECTIONS if (s := getattr(table, d))}
    grid: TaskGrid | None = experiment.machine.origin.model.workspace
    if spans:
        grid = grid_of_table(WorkspaceTable.model_construct(**spans))
    if grid is None:
        raise ModelError(
            "candidates",
            "are none: neither the calibration file nor the machine states poses.",
            'Add [candidates] with x = { from = "-100 mm", to = "100 mm", points = 3 }.',
        )
    task = {d: np.asarray(v, dtype=float) for d, v in grid.task().items()}
    good = np.flatnonzero(reachable(experiment, task))
    total = len(next(iter(task.values())))
    if len(good) < count:
        raise ModelError(
            "candidates",
            f"are {total}, of which {len(good)} can be taken: too few to choose {count}.",
            "Give more points, or move the grid.",
        )
    return {d: v[good] for d, v in task.items()}, total - len(good)


def _templates(experiment: Experiment, table: CandidatesTable | None) -> list[Measurement]:
    """What is measured at each candidate: what the table states, else what was measured."""
    found: list[Measurement] = []
    if table is not None and table.frequencies is not None:
        modes = table.frequencies.modes
        nothing = np.ones(modes)
        # the scatter is a share of what each pose gives
        found.append(
            _Frequencies(
                "candidates.frequencies",
                {},
                nothing,
                nothing * table.frequencies.relative_scatter,
                tuple(range(1, modes + 1)),
            )
        )
    if table is not None and table.deflections is not None:
        found.append(_deflections(table))
    if table is not None and table.frf is not None:
        f = table.frf
        lines = np.linspace(*f.band, f.lines)
        given = Port.parse(f.input)
        pairs = tuple((Port.parse(o), given) for o in f.outputs)
        size = np.full(len(pairs) * len(lines), 1.0)
        found.append(
            MeasuredFrf(
                *("candidates.frf", {}, pairs, lines, 0.0 * size, f.scatter * size, f.modal_ratio)
            )
        )
    if not found:
        kinds: dict[str, Measurement] = {}
        for m in experiment.measurements:
            kinds.setdefault(m.kind, m)
        found = list(kinds.values())
    if not found:
        raise ModelError(
            "candidates",
            "do not say what is measured.",
            "Add [candidates.frequencies], [candidates.deflections] or [candidates.frf].",
        )
    return found


class _Frequencies(MeasuredFrequencies):
    """Frequencies that are to be measured: their scatter is a share of the computed ones."""

    def rates(self, at: Any) -> Array | None:
        found = super().rates(at)
        return None if found is None else found / self.computed_plain(at)

    def computed(self, at: Any) -> Array:
        return np.log(self.computed_plain(at))

    def computed_plain(self, at: Any) -> Array:
        return MeasuredFrequencies.computed(self, at)


def _deflections(table: CandidatesTable) -> Measurement:
    d = table.deflections
    assert d is not None  # noqa: S101 - asked by the caller
    at, scatter = [], []
    for text in d.at:
        port = Port.parse(text)
        direction = str(port.direction)
        given = d.angular_scatter if direction.startswith("r") else d.scatter
        if given is None:
            key = "angular_scatter" if direction.startswith("r") else "scatter"
            raise ModelError(f"candidates.deflections.{key}", "is missing.", "Give it.")
        at.append((port.node, direction))
        scatter.append(given)
    return MeasuredDeflections(
        "candidates.deflections",
        {},
        d.load.node,
        load_of(d.load),
        tuple(at),
        np.zeros(len(at)),
        np.array(scatter, dtype=float),
    )


def _at(template: Measurement, task: Mapping[str, float]) -> Measurement:
    """The same measurement at another pose."""
    made: Any = template
    moved: Measurement = replace(made, task=dict(task), name=f"{made.name} at {at_words(task)}")
    return moved
