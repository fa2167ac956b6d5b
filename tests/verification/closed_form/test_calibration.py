"""Calibration: data of known numbers give them back, and what data leave open is named.

@book{friswell1995,
  title     = {Finite Element Model Updating in Structural Dynamics},
  author    = {Friswell, Michael I. and Mottershead, John E.},
  publisher = {Kluwer},
  year      = {1995},
  note      = {chapter 2 (least squares, variance of the estimate), chapter 6 (identifiability)}
}

Two masses on two springs one behind the other: both frequencies determine both springs when the
masses are known, k_a k_b = m₁m₂ω₁²ω₂². A pull at the end determines 1/k_a + 1/k_b alone, one
frequency of one mass k/m alone. The deviation of a weighted least-squares estimate is
(Jᵀ V⁻¹ J)^(-1/2).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from strutwork.studies.calibration_fit import fit
from strutwork.studies.experiment import Experiment
from strutwork.studies.parametric import Parametric
from tests.calibrations import SPRINGS, heard, pulled, synthetic, unknowns
from tests.verification.closed_form.test_gradients import ONE_MASS, TWO_MASSES

A, B, MASS = "joints.a.stiffness.z", "joints.b.stiffness.z", "masses[0].mass"


def experiment(text: str, paths: tuple[str, ...], *measured: object) -> Experiment:
    machine = Parametric.of(text)
    return Experiment(machine, unknowns(machine, *paths), measured)  # type: ignore[arg-type]


def test_two_frequencies_determine_two_springs() -> None:
    truth = np.array([2.6e6, 2.1e6])
    found = fit(synthetic(experiment(TWO_MASSES, (A, B), heard(2, 1e-3)), truth), 3)
    assert [f.verdict for f in found.found] == ["identifiable"] * 2
    # noiseless data: the search ends at residuals of 1e-6 of the scatter
    np.testing.assert_allclose([f.value for f in found.found], truth, rtol=1e-6)


def test_the_interval_of_one_spring() -> None:
    """k of u = F/k: ln k has the deviation of u/u₀; the 95 % interval is 1.96 of it either way."""
    pull = pulled("x", 1e-7, (500.0, 0, 0, 0, 0, 0))
    machine = experiment(SPRINGS, (A,), pull)
    (found,) = fit(synthetic(machine, [2.5e6]), 2).found
    deviation = 1e-7 / (500.0 / 2.5e6)
    # linearised at the estimate
    np.testing.assert_allclose(found.deviation, deviation, rtol=1e-5)
    np.testing.assert_allclose(
        np.log(np.array(found.interval) / 2.5e6), [-1.96 * deviation, 1.96 * deviation], rtol=1e-3
    )


def test_two_estimates_from_two_frequencies_have_the_deviations_of_their_jacobian() -> None:
    """The rates of ln f with respect to ln k in closed form, after Fox and Kapoor."""
    a, b, one, two = 2e6, 3e6, 4.0, 5.0
    sum_ = one * b + two * (a + b)
    root = np.sqrt(sum_**2 - 4 * one * two * a * b)
    rows = []
    for square in ((sum_ - root) / (2 * one * two), (sum_ + root) / (2 * one * two)):
        shape = np.array([(b - two * square) / b, 1.0])
        shape /= np.sqrt(one * shape[0] ** 2 + two * shape[1] ** 2)
        rows.append([a * shape[0] ** 2, b * (shape[1] - shape[0]) ** 2])
        rows[-1] = [value / (2 * square) for value in rows[-1]]
    scatter = 1e-3
    wanted = scatter * np.sqrt(np.diag(np.linalg.inv(np.array(rows).T @ np.array(rows))))
    found = fit(synthetic(experiment(TWO_MASSES, (A, B), heard(2, scatter)), [a, b]), 2).found
    # the measured frequency carries the scatter, the computed one the rate: alike at the truth
    np.testing.assert_allclose([f.deviation for f in found], wanted, rtol=1e-5)


@pytest.mark.parametrize(
    ("text", "paths", "kind", "truth"),
    [
        (SPRINGS, (A, B), "series", (2.6e6, 2.8e6)),
        (ONE_MASS, (A, MASS), "ratio", (2.2e6, 5.5)),
    ],
)
def test_what_the_data_leave_open_is_named(
    text: str, paths: tuple[str, str], kind: str, truth: tuple[float, float]
) -> None:
    measured = pulled("x", 1e-7, (500.0, 0, 0, 0, 0, 0)) if kind == "series" else heard(1, 1e-3)
    made = synthetic(experiment(text, paths, measured), truth)
    again = replace(made.measurements[0], name="again")  # type: ignore[call-overload]
    found = fit(replace(made, measurements=(*made.measurements, again)), 2)
    assert [f.verdict for f in found.found] == ["not identifiable"] * 2
    assert [f.interval for f in found.found] == [None, None]
    (group,) = found.undetermined
    assert set(group.names) == set(paths)
    one, two = (f.value for f in found.found)
    if kind == "series":
        assert group.law == f"1/{A} + 1/{B}"
        # what is determined is met: noiseless data
        np.testing.assert_allclose(1 / one + 1 / two, 1 / truth[0] + 1 / truth[1], rtol=1e-6)
    else:
        # the same of k/m
        np.testing.assert_allclose(one / two, truth[0] / truth[1], rtol=1e-6)
