"""Stiffness of a machine over check points, with the best roll at each."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from strutwork.errors import ModelError
from strutwork.machines import Machine, roll_angles
from strutwork.msa import axis_stiffness_blocked
from strutwork.studies.check_points import CheckPoints, hemisphere
from strutwork.studies.chunks import Arrays
from strutwork.studies.description import attributes, plain, study_key
from strutwork.studies.evaluation import SAMPLE, Evaluated, Evaluator, keep_said, said, spread
from strutwork.studies.executor import Executor
from strutwork.studies.filters import REASONS, Filters, PoseStatus
from strutwork.studies.progress import Progress
from strutwork.studies.run import Chunk, Run, fill
from strutwork.studies.variables import AXES, named, stiffness_variables

Array = NDArray[Any]

#: Least and most poses evaluated at once: up to a hundred megabytes a worker. Threads wait for
#: one another between the steps of a chunk, the less often the larger it is.
LEAST, CHUNK = 2048, 16384

#: Chunks that a map is cut into before they grow: enough for the workers of a small machine.
PARTS = 16

#: Rolls whose stiffness is this near to the best one's are as good; the first is taken, so that
#: rounding decides nothing.
TIE = 1e-9


def stiffness_map(
    machine: Machine,
    points: CheckPoints | None = None,
    rolls: ArrayLike | None = None,
    filters: Filters | None = None,
    *,
    workers: int | None = None,
    progress: Progress | None = None,
    folder: Path | None = None,
    executor: Executor | None = None,
) -> xr.Dataset:
    """Stiffness over check points, the roll γ chosen for the largest blocked Kxx.

    At each point every roll is a candidate. Candidates out of reach, out of joint ranges, near
    a singularity or without a solution are dropped and counted; of the others the one with the
    largest (C⁻¹)_xx is taken (Azulay 2014, section 3.3.1).

    Parameters
    ----------
    machine : Machine
    points : CheckPoints, optional
        Default: `hemisphere(machine)`.
    rolls : (r,), optional
        rad. Default: 24 over a third of a turn, `strutwork.machines.roll_angles()`.
    filters : Filters, optional
        Default: all joint ranges, condition number below 100.
    workers : int, optional
        Threads; default one per processor.
    progress : callable, optional
        Called with how many candidates are done, and of how many.
    folder : Path, optional
        Keeps finished chunks there; a later call with the same inputs goes on from them.
    executor : Executor, optional
        In place of threads.

    Returns
    -------
    xarray.Dataset
        Dimensions point, axis, direction, wrench, principal, reason, joint_kind; every variable
        states its unit. `status` says for each point whether a candidate was left; where none
        was, the point's numbers are missing (NaN) and the status is the one of the candidate
        that got furthest.

    Raises
    ------
    ModelError
        No rolls, or a machine whose model is wrong.
    """
    asked = map_function(machine, points, rolls, filters)
    points, turns = asked.points, asked.rolls
    size = chunk_size(len(points) * len(turns), len(turns))
    settings = {"filters": asked.evaluator.filters, "chunk": size}
    run = Run(workers, executor, folder, progress)
    arrays: Arrays = {}
    words: Counter[str] = Counter()
    examples: dict[str, str] = {}
    for chunk, part in run.chunks(
        asked,
        len(points),
        size,
        lambda: study_key(
            "stiffness map", machine, settings, points.position, points.normal, turns
        ),
        len(turns),
    ):
        counts = part.pop("reason_counts")
        keep_said(examples, part)
        words.update(dict(zip(part.pop("reasons").tolist(), counts.tolist(), strict=True)))
        fill(arrays, chunk, part, len(points))
    arrays["position"], arrays["normal"] = points.position, points.normal
    return asked.dataset(arrays, {w: n for w, n in words.items() if n}, examples)


def chunk_size(poses: int, rolls: int) -> int:
    """Points of a chunk, whatever the workers: their number changes no result.

    Parameters
    ----------
    poses : int
        Of the whole map.
    rolls : int
    """
    return max(1, min(CHUNK, max(LEAST, poses // PARTS)) // rolls)


@dataclass(frozen=True)
class MapFunction:
    """What a stiffness map asks of a chunk of its points.

    Parameters
    ----------
    evaluator : Evaluator
    points : CheckPoints
    rolls : (r,)
        rad.
    """

    evaluator: Evaluator
    points: CheckPoints
    rolls: Array

    def __call__(self, chunk: Chunk) -> Arrays:
        """Arrays of the chunk's points."""
        return _best_rolls(self.evaluator(self.points.poses(chunk.items, self.rolls)), self.rolls)

    def dataset(
        self, arrays: Arrays, words: Mapping[str, int], examples: Mapping[str, str]
    ) -> xr.Dataset:
        """The map of points whose arrays are given.

        Parameters
        ----------
        arrays : dict of str to (points, ...)
            Of the chunks, one behind the other, with position and normal.
        words : mapping of str to int
            Candidates dropped, by reason.
        examples : mapping of str to str
            What was said of the first of them.
        """
        return _dataset(self.evaluator, arrays, self.rolls, words, examples)


def map_function(
    machine: Machine,
    points: CheckPoints | None = None,
    rolls: ArrayLike | None = None,
    filters: Filters | None = None,
) -> MapFunction:
    """That of a machine, with everything made that threads share.

    Parameters
    ----------
    machine : Machine
    points : CheckPoints, optional
    rolls : (r,), optional
        rad.
    filters : Filters, optional
        All as `stiffness_map`.

    Raises
    ------
    ModelError
        As `stiffness_map`.
    """
    turns = np.atleast_1d(np.asarray(roll_angles() if rolls is None else rolls, dtype=float))
    if turns.ndim != 1 or not turns.size or not np.all(np.isfinite(turns)):
        raise ModelError("rolls", "are none, or not finite.", "Give a list of angles, rad.")
    points = points or hemisphere(machine)
    evaluator = Evaluator(machine, filters or Filters(), len(points) * len(turns))
    some = points.poses(spread(len(points), max(1, SAMPLE // len(turns))), turns)
    return MapFunction(evaluator.prepared(some), points, turns)


def stiffest_roll(found: Evaluated, rolls: int) -> tuple[NDArray[np.intp], NDArray[np.int8]]:
    """For each point the roll with the largest blocked Kxx, and what became of the point.

    Parameters
    ----------
    found : Evaluated
        Points times rolls, roll fastest.
    rolls : int

    Returns
    -------
    chosen : (points,)
        Index of the roll; without meaning where no candidate counts.
    status : (points,) of int8
        `PoseStatus`; of the candidate that got furthest where none counts.
    """
    status, good = found.status.reshape(-1, rolls), found.good.reshape(-1, rolls)
    each = np.full(found.status.shape, -np.inf)
    each[found.good] = axis_stiffness_blocked(found.compliance[found.good])[:, 0]
    stiffness = each.reshape(-1, rolls)
    best = stiffness.max(axis=1, keepdims=True)
    # where a direction is locked the best is infinite, and only its equals are as good
    level = np.where(np.isfinite(best), best * (1 - TIE * np.sign(best)), best)
    candidate = good & (stiffness >= level)
    outcome = np.where(good.any(axis=1), PoseStatus.GOOD, status.max(axis=1)).astype(np.int8)
    return candidate.argmax(axis=1), outcome


def _best_rolls(found: Evaluated, rolls: Array) -> Arrays:
    """For each point of a chunk the candidate with the largest Kxx, and what was dropped."""
    shape = (-1, len(rolls))
    status = found.status.reshape(shape)
    chosen, outcome = stiffest_roll(found, len(rolls))
    row = np.arange(len(chosen))
    points = len(chosen)
    lost = outcome != PoseStatus.GOOD
    result: Arrays = {
        "status": outcome,
        "roll": np.where(lost, np.nan, rolls[chosen]),
        "condition_number": np.where(lost, np.nan, found.condition.reshape(shape)[row, chosen]),
        "compliance": found.compliance.reshape(points, -1, 6, 6)[row, chosen],
        "dropped": np.stack([(status == code).sum(axis=1) for code in REASONS], axis=-1),
        "outside_range": found.outside.reshape(points, len(rolls), -1).sum(axis=1),
    }
    used = np.bincount(found.reason, minlength=len(found.reasons) + 1)[1:]
    result |= {"reasons": np.array(found.reasons), "reason_counts": used}
    return result | said(found)


def _dataset(
    evaluator: Evaluator,
    arrays: Arrays,
    rolls: Array,
    words: Mapping[str, int],
    examples: Mapping[str, str],
) -> xr.Dataset:
    status = arrays["status"]
    points = len(status)
    variables = {
        "position": named(("point", "axis"), arrays["position"], "m", "tool position"),
        "normal": named(("point", "axis"), arrays["normal"], "1", "direction of the tool's z axis"),
        "roll": named("point", arrays["roll"], "rad", "roll about the normal (Euler angle γ)"),
        **stiffness_variables("point", arrays["compliance"], status),
        "condition_number": named(
            "point", arrays["condition_number"], "1", "condition number of the inverse Jacobian"
        ),
        "dropped": named(
            ("point", "reason"), arrays["dropped"], "1", "candidates dropped, by reason"
        ),
        "outside_range": named(
            ("point", "joint_kind"),
            arrays["outside_range"],
            "1",
            "candidates outside the ranges of a kind of joint, whether the ranges are kept or not",
        ),
    }
    kept = "all" if evaluator.filters.joint_kinds is None else evaluator.filters.joint_kinds
    details = {
        "roll_criterion": "largest blocked Kxx, (C^-1)_xx, of the candidates that count",
        "candidates": points * len(rolls),
        "candidates_kept": int(points * len(rolls) - arrays["dropped"].sum()),
        "points_kept": int(np.count_nonzero(status == PoseStatus.GOOD)),
        "dropped_by_reason": json.dumps(words),
        "first_of_reason": json.dumps(examples),
        "rolls": json.dumps(plain(rolls)),
        "joint_ranges_kept": json.dumps(kept),
        "condition_limit": evaluator.filters.condition_limit or "none",
        "condition_length": evaluator.length,
    }
    return xr.Dataset(
        variables,
        coords={
            "axis": list(AXES),
            "reason": [code.word for code in REASONS],
            "joint_kind": list(evaluator.kinds),
        },
        attrs=attributes("stiffness map", evaluator.machine) | details,
    ).assign_coords(point=np.arange(points))
