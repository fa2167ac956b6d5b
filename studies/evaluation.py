"""Tool compliance of a stack of poses, with what became of each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import MechanismError, StrutworkError
from strutwork.kinematics import Placement, Poses, jacobians
from strutwork.machines import Limit, Machine, check_limits
from strutwork.msa import Structure, compliance_and_outcome, prepare_compliance
from strutwork.outcome import Outcome
from strutwork.studies.filters import Filters, PoseStatus, moving_machine

Array = NDArray[Any]

#: Poses whose Jacobians are made at once: keeps a stack of constraint matrices in the cache.
JACOBIAN_PIECE = 512

#: Poses of a study on which what its chunks share is made.
SAMPLE = 256


@dataclass(frozen=True)
class Evaluated:
    """What `Evaluator` computes at p poses.

    Parameters
    ----------
    status : (p,) of int8
        `PoseStatus`.
    reason : (p,) of int16
        0 where the pose counts, else 1 + index into `reasons`.
    reasons : tuple of str
        Why poses were dropped, in words.
    examples : mapping of str to str
        For a reason that the solver gave, all that it said of the first such pose.
    outside : (p, k) of bool
        Whether a range of each kind of joint is exceeded, kept or not; False where the pose
        cannot be reached at all.
    condition : (p,)
        Condition number of the inverse Jacobian, no unit; NaN where not looked at.
    compliance : (p, 6, 6)
        m/N, 1/N, rad/(N·m); NaN where the pose does not count.
    """

    status: NDArray[np.int8]
    reason: NDArray[np.int16]
    reasons: tuple[str, ...]
    examples: Mapping[str, str]
    outside: NDArray[np.bool_]
    condition: Array
    compliance: Array

    @property
    def good(self) -> NDArray[np.bool_]:
        """True where the pose counts, (p,)."""
        return np.asarray(self.status == PoseStatus.GOOD)


@dataclass(frozen=True)
class Evaluator:
    """Evaluates stacks of poses of one machine; may be called from several threads.

    Parameters
    ----------
    machine : Machine
    filters : Filters
    poses : int
        Of the whole study, of which a stack is a part: every stack is solved as the study is.
    """

    machine: Machine
    filters: Filters
    poses: int = 0

    @cached_property
    def kinds(self) -> tuple[str, ...]:
        """Kinds of joints that have ranges."""
        return tuple(dict.fromkeys(limit.kind for limit in self.machine.limits))

    @cached_property
    def limits(self) -> tuple[Limit, ...]:
        """The ranges that are kept."""
        return self.filters.limits(self.machine)

    @cached_property
    def moving(self) -> Machine:
        """The machine whose Jacobian is looked at."""
        return moving_machine(self.machine)

    @cached_property
    def length(self) -> float:
        """Length of the condition number, m."""
        return self.filters.length_for(self.machine)

    def prepared(self, sample: Poses) -> Evaluator:
        """The same, with everything made that the threads share.

        Parameters
        ----------
        sample : Poses
            A flat stack of some poses, spread over the study.
        """
        _ = self.kinds, self.limits, self.moving.linkage, self.length
        structure = self.machine.structure
        _ = structure.segments, structure.vertex_of_node
        placement = self.machine.place(sample)
        reached = np.flatnonzero(placement.reachable)
        if reached.size:
            prepare_compliance(structure.at(placement[reached]).among(self.poses))
        return self

    def __call__(self, poses: Poses) -> Evaluated:
        """Evaluate a flat stack of poses.

        Poses that cannot be reached, are out of range, near-singular or mechanisms never
        raise: they are marked.

        Raises
        ------
        ModelError
            The machine's model is wrong whatever the pose.
        """
        placement = self.machine.place(poses)
        ranged = check_limits(self.limits, placement)
        reasons = [*ranged.reasons]
        reason = np.asarray(ranged.status).astype(np.int16)
        status = np.where(
            ranged.reachable,
            PoseStatus.GOOD,
            np.where(placement.reachable, PoseStatus.JOINT_RANGE, PoseStatus.UNREACHABLE),
        ).astype(np.int8)
        count = len(status)
        condition = np.full(count, np.nan)
        limit = self.filters.condition_limit
        if limit is not None:
            good = np.flatnonzero(status == PoseStatus.GOOD)
            condition[good] = self._condition(poses[good])
            near = good[~(condition[good] < limit)]
            status[near] = PoseStatus.NEAR_SINGULAR
            reasons.append(f"condition number of the inverse Jacobian at least {limit:g}")
            reason[near] = len(reasons)
        good = np.flatnonzero(status == PoseStatus.GOOD)
        compliance = np.full((count, 6, 6), np.nan)
        compliance[good], status[good], outcome = compliance_where_possible(
            self.machine.structure, ranged[good], self.poses
        )
        failed = np.flatnonzero(~outcome.solved)
        reason[good[failed]] = len(reasons) + outcome.status[failed]
        examples = dict(zip(outcome.reasons, map(_in_words, outcome.errors), strict=True))
        reasons += outcome.reasons
        outside = (
            np.stack(
                [
                    ~check_limits(
                        (m for m in self.machine.limits if m.kind == kind), placement
                    ).reachable
                    for kind in self.kinds
                ],
                axis=-1,
            )
            if self.kinds
            else np.zeros((count, 0), dtype=bool)
        )
        outside &= placement.reachable[:, None]
        return Evaluated(status, reason, tuple(reasons), examples, outside, condition, compliance)

    def _condition(self, poses: Poses) -> Array:
        result = np.empty(poses.batch)
        linkage = self.moving.linkage
        placement = self.moving.place(poses)
        for start in range(0, len(result), JACOBIAN_PIECE):
            piece = slice(start, start + JACOBIAN_PIECE)
            result[piece] = jacobians(linkage, placement[piece]).condition(self.length)
        return result


def compliance_where_possible(
    structure: Structure, placement: Placement, poses: int = 0
) -> tuple[Array, NDArray[np.int8], Outcome]:
    """Tool compliance of a stack of poses, some of which may be mechanisms.

    Parameters
    ----------
    structure : Structure
    placement : Placement
        One batch axis, p poses, all reachable.
    poses : int
        Of the whole study of which these are a part.

    Returns
    -------
    compliance : (p, 6, 6)
        NaN where a pose could not be solved.
    status : (p,) of int8
        `PoseStatus`: good, mechanism or unsolved.
    outcome : Outcome
        (p,): the reasons.
    """
    compliance, outcome = compliance_and_outcome(structure.at(placement).among(poses))
    failed = np.where(outcome.of_kind(MechanismError), PoseStatus.MECHANISM, PoseStatus.UNSOLVED)
    status = np.where(outcome.solved, PoseStatus.GOOD, failed).astype(np.int8)
    return compliance, status, outcome


def spread(count: int, most: int = SAMPLE) -> NDArray[np.intp]:
    """Numbers of evenly spaced ones of some items, (k,), ascending.

    Parameters
    ----------
    count : int
        Of the items.
    most : int
        Of those that are taken.
    """
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(np.intp))


def _in_words(error: StrutworkError) -> str:
    return f"{error.part}: {error.problem}" if error.part else error.problem


def said(found: Evaluated) -> dict[str, Array]:
    """The examples of a chunk as arrays (k, 2) of str, which a folder can keep.

    Parameters
    ----------
    found : Evaluated
    """
    pairs = [[reason, words] for reason, words in found.examples.items()]
    return {"said": np.array(pairs, dtype=np.str_).reshape(-1, 2)}


def keep_said(examples: dict[str, str], part: dict[str, Array]) -> None:
    """Take the examples out of a chunk; of each reason the first chunk's is kept.

    Parameters
    ----------
    examples : dict of str to str
        By reason; added to in place.
    part : dict of str to (...)
        Arrays of a chunk, any unit, from which `said` is taken out.
    """
    for reason, words in part.pop("said").tolist():
        examples.setdefault(reason, words)
