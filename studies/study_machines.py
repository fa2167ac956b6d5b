"""The machines of a study: each is made, placed and asked, and what is kept of its poses."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import StrutworkError
from strutwork.machines.model import Model
from strutwork.msa.compiled import programs_on
from strutwork.msa.variant_of import Programs, expect_poses
from strutwork.studies.answers import Column
from strutwork.studies.chunks import Arrays
from strutwork.studies.filters import PoseStatus
from strutwork.studies.models_together import Stands
from strutwork.studies.parameter import Varied
from strutwork.studies.parametric import Parametric
from strutwork.studies.question import Question
from strutwork.studies.run import Chunk
from strutwork.studies.standing import Stand

Array = NDArray[Any]

#: What may be kept of the poses of a machine.
REDUCTIONS = ("worst", "best", "mean", "home", "poses")
#: What is kept of an answer that no pose changes, and such answers.
MACHINE = "machine"
ONE_NUMBER = ("mass", "first_frequency")
#: What is kept of an answer whose ends count, whatever is asked for: these and their distance.
ENDS = ("least", "greatest", "travel")

#: What became of a machine.
SOLVED, FAILED, NO_POSE = np.int8(0), np.int8(1), np.int8(2)


@dataclass(frozen=True)
class Kept:
    """One of the arrays of a study.

    Parameters
    ----------
    name : str
        As in the dataset.
    question : str
        Whose answer it is.
    column : Column
    reduction : str
    shape : tuple of int
        For one machine.
    """

    name: str
    question: str
    column: Column
    reduction: str
    shape: tuple[int, ...]

    @property
    def column_shape(self) -> tuple[int, ...]:
        """At one pose."""
        return self.shape[1:] if self.reduction == "poses" else self.shape


@dataclass(frozen=True)
class Machines:
    """Makes and asks the machines of a study, chunk by chunk; may be sent to other processes.

    Parameters
    ----------
    machine : Parametric
    varied : tuple of k Varied
    values : (n, k)
        Of the parameters, each in its unit, any unit.
    questions : tuple of Question
    stand : Stand
    reductions : tuple of str
    """

    machine: Parametric
    varied: tuple[Varied, ...]
    values: Array
    questions: tuple[Question, ...]
    stand: Stand
    reductions: tuple[str, ...]

    def model(self, number: int) -> Model:
        """One machine.

        Parameters
        ----------
        number : int
            Of its row.

        Raises
        ------
        ModelError
            It cannot be.
        """
        changes: dict[str, float | str] = {}
        for parameter, value in zip(self.varied, self.values[number].tolist(), strict=True):
            changes |= parameter.changes(value)
        return self.machine.model(changes)

    @cached_property
    def kept(self) -> tuple[Kept, ...]:
        """The arrays of the study, in order."""
        model = self.machine.origin.model
        asked = [(q.name, q.of(model)) for q in self.questions]
        names = [c.name for _, answer in asked for c in answer.columns]
        found = []
        for question, answer in asked:
            for column in answer.columns:
                # accuracy and assembly forces both have a worst case
                twice = names.count(column.name) > 1
                name = f"{question}_{column.name}" if twice else column.name
                shape = tuple(len(answer.coordinates[d]) for d in column.dims)
                found += [
                    Kept(
                        name if reduction in ("poses", MACHINE) else f"{name}_{reduction}",
                        question,
                        column,
                        reduction,
                        (self.poses - 1, *shape) if reduction == "poses" else shape,
                    )
                    for reduction in self._of_column(column)
                ]
        return tuple(found)

    @cached_property
    def programs(self) -> Programs:
        """What the machines share in their elimination, made at the poses of the stated machine.

        Which machine or which part of the study comes first then decides nothing.
        """
        model = self.machine.origin.model
        try:
            standing = self.stand(model, self.every)
            placed = model.structure.at(standing.placement)
            return programs_on(placed) if standing.good.size else {}
        except StrutworkError:
            # the machine as it is stated need not be one of the study: each then has its own
            return {}

    @property
    def poses(self) -> int:
        """Poses at which each machine is asked, home being the last."""
        return 1 if self.stand.grid is None else len(self.stand.grid) + 1

    @property
    def every(self) -> int:
        """Poses of all machines together, which decide how each is placed and solved."""
        return len(self.values) * self.poses

    def _of_column(self, column: Column) -> tuple[str, ...]:
        """What is kept of an answer: none is the worst where no value is worse than another."""
        if column.name in ONE_NUMBER:
            # one number a machine, wherever it stands
            return (MACHINE,)
        if self.stand.grid is None:
            return ("home",)
        if column.ends:
            return (*ENDS, *(r for r in self.reductions if r in ("home", "poses")))
        return tuple(r for r in self.reductions if column.worst or r not in ("worst", "best"))

    def __call__(self, chunk: Chunk) -> Arrays:
        """Arrays of some machines; the reasons of those that cannot be among them.

        Parameters
        ----------
        chunk : Chunk
        """
        count = chunk.stop - chunk.start
        found: Arrays = {"status": np.full(count, FAILED), "reason": np.zeros(count, np.int32)}
        found["poses_kept"] = np.zeros(count, np.int32)
        for kept in self.kept:
            found[kept.name] = np.full((count, *kept.shape), np.nan)
            if kept.reduction == "worst" and self.poses > 1:
                found[f"{kept.name}_pose"] = np.full((count, *kept.shape), -1, np.int32)
        if "poses" in self.reductions:
            missing = np.int8(PoseStatus.UNSOLVED)
            found["pose_status"] = np.full((count, self.poses - 1), missing)
        words = [""]
        every = [self._standing(number) for number in range(chunk.start, chunk.stop)]
        known = self._together([one for one, _ in every])
        for i, (one, wrong) in enumerate(every):
            why = wrong if one is None else self._why(one, i, found, known)
            if why not in words:
                words.append(why)
            found["reason"][i] = words.index(why)
        return found | {"reasons": np.array(words[1:], dtype=str)}

    def _standing(self, number: int) -> tuple[Stands | None, str]:
        """One machine at its poses, or why it cannot be."""
        try:
            model = self.model(number)
            return (model, self.stand(model, self.every)), ""
        except StrutworkError as error:
            return None, _words(error)

    def _together(self, standing: list[Stands | None]) -> Arrays:
        """Answers of one number a machine that all can be asked at once, by question, (n,)."""
        found: Arrays = {}
        for question in self.questions:
            many = getattr(question.of(self.machine.origin.model), "of_many", None)
            if many is not None:
                found[question.name] = many(standing)
        return found

    def _why(self, one: Stands, row: int, found: Arrays, known: Arrays) -> str:
        try:
            return self._ask(one, row, found, known)
        except StrutworkError as error:
            return _words(error)

    def _ask(self, one: Stands, row: int, found: Arrays, known: Arrays) -> str:
        """Fill the row of one machine; why it has no numbers, empty where it has."""
        model, standing = one
        status = standing.status.copy()
        reasons = [r for r in standing.reasons if r]
        if standing.good.size:
            # of all machines, so that every one of them is solved the same way
            expect_poses(model.structure, self.every, lambda: self.programs)
            placed = model.structure.at(standing.placement)
            answers: dict[str, dict[str, Array]] = {}
            for question in self.questions:
                answer = question.of(model)
                if question.name in known and np.isfinite(known[question.name][row]):
                    value = np.full(placed.batch, known[question.name][row])
                    answers[question.name] = {answer.columns[0].name: value}
                    continue
                values, outcome = answer(placed)
                answers[question.name] = values
                reasons += [outcome.reason(int(i)) for i in np.flatnonzero(~outcome.solved)]
                status[standing.good[~outcome.solved]] = PoseStatus.UNSOLVED
            for kept in self.kept:
                every = np.full((self.poses, *kept.column_shape), np.nan)
                every[standing.good] = answers[kept.question][kept.column.name]
                self._keep(kept, every, row, found)
        good = status == PoseStatus.GOOD
        found["poses_kept"][row] = np.count_nonzero(good[:-1])
        if "pose_status" in found:
            found["pose_status"][row] = status[:-1]
        found["status"][row] = SOLVED if good.any() else NO_POSE
        return "" if good.any() else Counter(reasons).most_common(1)[0][0]

    def _keep(self, kept: Kept, every: Array, row: int, found: Arrays) -> None:
        """Keep of all poses (p, ...) what the study asks for; home is the last of them."""
        poses, out = every[:-1], found[kept.name]
        match kept.reduction:
            case "home":
                out[row] = every[-1]
            case "poses":
                out[row] = poses
            case "least" | "greatest" | "travel":
                out[row] = _end(kept.reduction, poses)
            case "mean":
                some = np.isfinite(poses).any(axis=0)
                count = np.maximum((~np.isnan(poses)).sum(axis=0), 1)
                out[row] = np.where(some, np.nansum(poses, axis=0) / count, np.nan)
            case "machine":
                some = every[~np.isnan(every)]
                out[row] = some[0] if some.size else np.nan
            case reduction:
                least = (kept.column.worst == "least") == (reduction == "worst")
                filled = np.where(np.isnan(poses), np.inf if least else -np.inf, poses)
                at = (np.argmin if least else np.argmax)(filled, axis=0)
                value = np.take_along_axis(poses, at[None], axis=0)[0]
                out[row] = value
                if reduction == "worst":
                    found[f"{kept.name}_pose"][row] = np.where(np.isnan(value), -1, at)


def _end(which: str, poses: Array) -> Array:
    """An end of values (p, ...) over the poses that count, or how far the two are apart."""
    some = np.isfinite(poses).any(axis=0)
    low = np.where(np.isnan(poses), np.inf, poses).min(axis=0)
    high = np.where(np.isnan(poses), -np.inf, poses).max(axis=0)
    if which == "travel":
        # of no pose both are infinite
        return np.where(some, np.where(some, high, 0.0) - np.where(some, low, 0.0), np.nan)
    return np.where(some, low if which == "least" else high, np.nan)


def _words(error: StrutworkError) -> str:
    return " ".join(f"{error.part}: {error.problem}".split())
