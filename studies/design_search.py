"""The search for designs: NSGA-II of pymoo, SLSQP of SciPy along gradients, or both."""

from __future__ import annotations

import importlib
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.studies.design import Design
from strutwork.studies.design_judged import FEASIBLE, Judged
from strutwork.studies.design_slsqp import descent, finish, starts, steps_of
from strutwork.studies.design_terms import BOTH, GRADIENT

Array = NDArray[Any]

#: What was found before of a generation by its number: shares (n, k), and what they are worth.
Known = Callable[[int], tuple[Array, Judged] | None]


@dataclass(frozen=True)
class Generation:
    """The machines of one generation.

    Parameters
    ----------
    number : int
        Counted from zero.
    shares : (n, k)
        Where each machine stands in the range or list of each parameter, 0 to 1, no unit.
    samples : (n, k)
        Of the parameters, each in its unit, any unit.
    judged : Judged
    """

    number: int
    shares: Array
    samples: Array
    judged: Judged


def pymoo(name: str) -> Any:
    """A module of pymoo, imported when it is needed.

    Parameters
    ----------
    name : str
        Below `pymoo`.

    Raises
    ------
    ModelError
        It is not installed.
    """
    try:
        return importlib.import_module(f"pymoo.{name}")
    except ImportError:
        raise ModelError(
            "design", "needs pymoo, which is not installed.", 'pip install "strutwork[design]"'
        ) from None


def generations(
    design: Design,
    workers: int | None = None,
    known: Known = lambda _: None,
) -> Iterator[Generation]:
    """Search, one generation after the other; ends early where no other machine is left.

    Along gradients the machines on the way from one start are a generation.

    Parameters
    ----------
    design : Design
    workers : int, optional
        Threads; default one per processor.
    known : callable, optional
        What was found of a generation before, from its number: its shares (n, k) and what they
        are worth; None: nothing.

    Raises
    ------
    ModelError
        pymoo is not installed; the machine as described, as a start, cannot be.
    """
    method = design.search.method
    if method == GRADIENT:
        for number, start in enumerate(starts(design)):
            kept = known(number)
            if kept is None:
                shares, _ = steps_of(descent(design, start), first=number == 0)
                kept = shares, design.judge(design.samples(shares), workers)
            yield Generation(number, kept[0], design.samples(kept[0]), kept[1])
        return
    done = []
    for generation in _evolution(design, workers, known):
        done.append(generation)
        yield generation
    if method == BOTH:
        last = _finished(design, done, workers)
        if last is not None:
            yield last


def _finished(design: Design, done: Sequence[Generation], workers: int | None) -> Generation | None:
    """The machines that searches from the front along gradients end at."""
    shares = np.concatenate([g.shares for g in done])
    values = np.concatenate([g.judged.values for g in done])
    targets = np.concatenate([design.targets(g.judged) for g in done])
    good = np.flatnonzero(np.concatenate([g.judged.status for g in done]) == FEASIBLE)
    if not good.size:
        return None
    found = []
    for row in good[front_of(targets[good])].tolist():
        steps, _ = steps_of(finish(design, shares[row], values[row]), first=False)
        found.append(steps[-1:])
    ends = np.concatenate(found)
    judged = design.judge(design.samples(ends), workers)
    return Generation(len(done), ends, design.samples(ends), judged)


def _evolution(design: Design, workers: int | None, known: Known) -> Iterator[Generation]:
    """The generations of NSGA-II."""
    algorithm, problem = _algorithm(design)
    evaluator = pymoo("core.evaluator").Evaluator()
    static = pymoo("problems.static").StaticProblem
    for number in range(design.search.generations):
        asked = _next(algorithm)
        if asked is None or not len(asked):
            return
        shares = np.asarray(asked.get("X"), dtype=float)
        samples = design.samples(shares)
        kept = known(number)
        same = kept is not None and np.array_equal(kept[0], shares)
        judged = kept[1] if kept is not None and same else design.judge(samples, workers)
        targets = design.targets(judged)
        # numbers of such machines are not looked at: they go by what they miss
        targets[judged.status != FEASIBLE] = 0.0
        evaluator.eval(static(problem, F=targets, G=design.violations(judged)), asked)
        algorithm.tell(infills=asked)
        yield Generation(number, shares, samples, judged)


def _next(algorithm: Any) -> Any:
    with warnings.catch_warnings():
        # operators divide by the width of a population whose machines are all alike
        warnings.simplefilter("ignore", RuntimeWarning)
        return algorithm.ask()


def _algorithm(design: Design) -> tuple[Any, Any]:
    lists = [(i, len(p.values)) for i, p in enumerate(design.varied) if p.values]

    class Lists(pymoo("core.repair").Repair):  # type: ignore[misc]
        """Puts a value of a list in the middle of its part, so that equal ones are seen."""

        def _do(self, problem: Any, X: Array, **_: Any) -> Array:  # noqa: ARG002, N803
            for i, count in lists:
                X[:, i] = (np.minimum(np.floor(X[:, i] * count), count - 1) + 0.5) / count
            return X

    width = len(design.varied)
    limits = len(design.constraints) + 1 + design.every_pose
    problem = pymoo("core.problem").Problem(
        n_var=width, n_obj=len(design.objectives), n_ieq_constr=limits, xl=0.0, xu=1.0
    )
    algorithm = pymoo("algorithms.moo.nsga2").NSGA2(
        pop_size=design.search.population,
        sampling=pymoo("operators.sampling.lhs").LHS(),
        repair=Lists(),
    )
    ends = ("n_gen", design.search.generations + 1)
    algorithm.setup(problem, seed=design.search.seed, termination=ends, verbose=False)
    return algorithm, problem


def front_of(targets: Array) -> NDArray[np.intp]:
    """Those of n machines that no other one beats in everything, (f,).

    Of machines that are equal in everything the first one stays.

    Parameters
    ----------
    targets : (n, m)
        To be minimised, any unit.

    Returns
    -------
    (f,)
        Their numbers, in order of the first target.
    """
    if not len(targets):
        return np.zeros(0, dtype=np.intp)
    _, first = np.unique(targets, axis=0, return_index=True)
    sorting = pymoo("util.nds.non_dominated_sorting").NonDominatedSorting()
    best = first[sorting.do(targets[first], only_non_dominated_front=True)]
    return np.asarray(best[np.lexsort(targets[best].T[::-1])], dtype=np.intp)
