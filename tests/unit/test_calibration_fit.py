"""Calibration by measurements: what comes back, what is named, what is refused."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.studies.calibration_fit import fit
from strutwork.studies.experiment import Experiment
from strutwork.studies.parametric import Parametric
from tests.calibrations import SPRINGS, heard, pulled, synthetic, unknowns
from tests.gradients import CHAIN

A, B = "joints.a.stiffness.z", "joints.b.stiffness.z"
C, D = "springs.c.stiffness.y", "springs.d.stiffness.y"
MASS = "masses[0].mass"


def springs(*paths: str, measured: tuple = ()) -> Experiment:  # type: ignore[type-arg]
    machine = Parametric.of(SPRINGS)
    return Experiment(machine, unknowns(machine, *paths), measured)


def test_one_spring_in_closed_form() -> None:
    """k of u = F/k: relative deviation of k is that of u, and the interval 1.96 of it."""
    pull = pulled("x", 1e-6, (1000.0, 0, 0, 0, 0, 0))
    b = 3e6
    experiment = springs(A, measured=(pull,))
    u = 1000.0 / 2.5e6 + 1000.0 / b
    experiment = replace(experiment, measurements=(replace(pull, values=np.array([u])),))
    found = fit(experiment, 2).found[0]
    assert found.value == pytest.approx(2.5e6, rel=1e-6)
    assert found.verdict == "identifiable"
    # du/dln k = −F/k
    deviation = 1e-6 / (1000.0 / 2.5e6)
    assert found.interval == pytest.approx(
        (2.5e6 * np.exp(-1.96 * deviation), 2.5e6 * np.exp(1.96 * deviation)), rel=1e-5
    )
    assert found.ratio == pytest.approx(1.25, rel=1e-6)


@pytest.mark.parametrize(
    ("paths", "direction", "law", "truth"),
    [
        ((A, B), "x", f"1/{A} + 1/{B}", (2.6e6, 2.8e6)),
        ((C, D), "y", f"{C} + {D}", (4.4e6, 5.6e6)),
    ],
    ids=["series", "parallel"],
)
def test_springs_that_are_not_told_apart_are_named_with_their_law(
    paths: tuple[str, str], direction: str, law: str, truth: tuple[float, float]
) -> None:
    pull = pulled(direction, 1e-7, (500.0, 500.0, 0, 0, 0, 0))
    experiment = synthetic(springs(*paths, measured=(pull,)), truth)
    # one number cannot carry two parameters: a second pull tells no more
    other = replace(experiment.measurements[0], name="again")
    experiment = replace(experiment, measurements=(*experiment.measurements, other))
    found = fit(experiment, 2)
    assert [f.verdict for f in found.found] == ["not identifiable"] * 2
    assert [f.interval for f in found.found] == [None, None]
    (group,) = found.undetermined
    assert (set(group.names), group.law) == (set(paths), law)
    assert found.identified.rank == 1
    # what is determined was met
    assert found.chi_squared == pytest.approx(0.0, abs=1e-6)
    one, two = (f.value for f in found.found)
    met = 1 / one + 1 / two if law.startswith("1/") else one + two
    wanted = 1 / truth[0] + 1 / truth[1] if law.startswith("1/") else sum(truth)
    assert met == pytest.approx(wanted, rel=1e-5)


def test_frequencies_alone_give_the_ratio_of_stiffness_and_mass() -> None:
    experiment = synthetic(springs(A, MASS, measured=(heard(1, 1e-3),)), (2.2e6, 5.5))
    one = replace(experiment.measurements[0], name="again")
    found = fit(replace(experiment, measurements=(*experiment.measurements, one)), 2)
    (group,) = found.undetermined
    assert set(group.names) == {A, MASS}
    assert [f.verdict for f in found.found] == ["not identifiable"] * 2


def test_a_prior_settles_what_the_measurements_leave_open() -> None:
    machine = Parametric.of(SPRINGS)
    pull = pulled("x", 1e-7, (500.0, 0, 0, 0, 0, 0))
    with_prior = (*unknowns(machine, A), *unknowns(machine, B, prior=0.05))
    experiment = synthetic(Experiment(machine, with_prior, (pull,)), (2.5e6, 3e6))
    a, b = fit(experiment, 2).found
    assert a.interval is not None
    assert b.interval is not None
    assert b.value == pytest.approx(3e6, rel=1e-3)
    # deviations of u = F/a + F/b: the share of b comes over to a
    assert b.deviation == pytest.approx(0.05, rel=1e-2)
    assert a.deviation == pytest.approx(0.05 * a.value / b.value, rel=1e-2)
    assert b.verdict == "not identifiable"


def test_a_value_beyond_its_range_is_at_its_bound() -> None:
    machine = Parametric.of(SPRINGS)
    pull = pulled("x", 1e-7, (500.0, 0, 0, 0, 0, 0))
    narrow = unknowns(machine, A, bounds=("1 N/um", "2.2 N/um"))
    experiment = synthetic(Experiment(machine, narrow, (pull,)), (4e6,))
    (found,) = fit(experiment, 2).found
    assert found.verdict == "at its bound"
    assert found.value == pytest.approx(2.2e6, rel=1e-3)
    assert found.interval is None


def chain() -> Experiment:
    machine = Parametric.of(CHAIN)
    paths = ("joints.elbow.stiffness.rz", "joints.shoulder.stiffness.rx", MASS)
    pull = pulled("xyz", 2e-6, (100.0, 0.0, -200.0, 0, 0, 0))
    return Experiment(machine, unknowns(machine, *paths), (heard(4, 5e-3), pull))


@pytest.mark.slow
def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    """Of 50 noisy data sets of one truth: a share of 95 % is at least 44 of 50 but once in 500."""
    bare = chain()
    truth = np.array([1.1e5, 1.6e5, 4.5])
    inside = np.zeros(3)
    chances = []
    for seed in range(50):
        found = fit(synthetic(bare, truth, seed), 1)
        assert [f.verdict for f in found.found] == ["identifiable"] * 3
        ends = np.array([f.interval for f in found.found])
        inside += (ends[:, 0] <= truth) & (truth <= ends[:, 1])
        chances.append(found.probability)
    assert inside.min() >= 43
    # chi squared of right scatters is uniform: a mean of 50 such numbers is 0.5 ± 0.04
    assert np.mean(chances) == pytest.approx(0.5, abs=0.16)


def test_a_scatter_that_is_stated_too_small_is_noticed() -> None:
    experiment = synthetic(chain(), [1.1e5, 1.6e5, 4.5], 5)
    small = replace(
        experiment,
        measurements=tuple(replace(m, scatter=m.scatter / 10) for m in experiment.measurements),  # type: ignore[call-overload]
    )
    assert "times as large as the stated scatter" in fit(small, 1).scatter_words
    assert "agree with the stated scatter" in fit(experiment, 1).scatter_words


def test_derivatives_are_those_of_differences() -> None:
    experiment = synthetic(chain(), [1.1e5, 1.6e5, 4.5], 1)
    point = experiment.guess
    slopes = experiment.jacobian(point)
    assert experiment.differences.taken == {}
    for k in range(3):
        step = np.eye(3)[k] * 1e-4
        plain = (experiment.residuals(point + step) - experiment.residuals(point - step)) / 2e-4
        assert slopes[:, k] == pytest.approx(plain, rel=1e-5, abs=1e-5)


def test_fewer_numbers_than_parameters_and_shared_numbers_are_refused() -> None:
    pull = pulled("x", 1e-7, (500.0, 0, 0, 0, 0, 0))
    with pytest.raises(ModelError, match="has 1 measured numbers for 2 parameters"):
        fit(springs(A, B, measured=(pull,)))
    with pytest.raises(ModelError, match="has no measurement"):
        fit(springs(A))
    machine = Parametric.of(SPRINGS)
    with pytest.raises(ModelError, match=r"changes joints\.a\.stiffness\.z, as the parameter"):
        Experiment(machine, unknowns(machine, A, "joints.*.stiffness.z"))
    with pytest.raises(ModelError, match="Did you mean"):
        unknowns(machine, "joints.a.stifness.z")
