"""The calibration study on synthetic data."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import pytest

from strutwork.errors import ModelError, NumericalError
from strutwork.studies.calibrate import assess, calibrate
from strutwork.studies.calibration_problem import Parameter, Target
from strutwork.studies.identifiability import identifiability


def silent(done: int, total: int, /) -> None:
    assert 0 <= done <= total


def two_masses(values: Mapping[str, float]) -> dict[str, float]:
    """Frequencies of ground - k1 - m1 - k2 - m2, and the stiffness at the second mass."""
    k1, k2, m1, m2 = (values[n] for n in ("k1", "k2", "m1", "m2"))
    stiffness = np.array([[k1 + k2, -k2], [-k2, k2]])
    mass = np.sqrt(np.array([m1, m2]))
    squares = np.linalg.eigvalsh(stiffness / np.outer(mass, mass))
    first, second = np.sqrt(squares) / (2 * np.pi)
    return {"first": first, "second": second, "static": 1.0 / (1.0 / k1 + 1.0 / k2)}


TRUTH = {"k1": 3e6, "k2": 8e5, "m1": 12.0, "m2": 2.0}


def parameters(*names: str, start: float = 1.5) -> tuple[Parameter, ...]:
    return tuple(Parameter(n, start * TRUTH[n], 0.2 * TRUTH[n], 5 * TRUTH[n]) for n in names)


def targets(*names: str, share: float = 0.01) -> tuple[Target, ...]:
    found = two_masses(TRUTH)
    return tuple(Target(n, found[n], share * found[n]) for n in names)


def with_known(values: Mapping[str, float]) -> dict[str, float]:
    return two_masses({**TRUTH, **values})


def test_synthetic_data_are_recovered() -> None:
    found = calibrate(
        with_known,
        # another set of the three fits as well, farther away: the nearer one is taken
        parameters("k1", "k2", "m2", start=1.1),
        targets("first", "second", "static"),
        starts=4,
        progress=silent,
    )
    # the data are exact and determine all three: what the solver's own tolerance leaves
    for name in ("k1", "k2", "m2"):
        assert found.best[name] == pytest.approx(TRUTH[name], rel=1e-5)
    assert found.met(1e-3)
    assert found.identified.rank == 3
    assert found.identified.determined == ("k1", "k2", "m2")
    assert np.isfinite(found.identified.standard_errors).all()
    assert found.on_bounds == ()


def test_standard_errors_are_those_of_many_noisy_calibrations() -> None:
    chosen, exact = parameters("k1", "k2", start=1.0), targets("first", "second", "static")
    found = calibrate(with_known, chosen, exact, starts=1, progress=silent)
    noise = np.random.default_rng(1)
    logs = []
    for _ in range(80):
        noisy = [Target(t.name, noise.normal(t.value, t.uncertainty), t.uncertainty) for t in exact]
        fit = calibrate(with_known, chosen, noisy, starts=1, progress=silent)
        logs.append(np.log(fit.values))
    # a standard deviation of 80 draws is good to 8 %; three times that
    np.testing.assert_allclose(np.std(logs, axis=0), found.identified.standard_errors, rtol=0.25)


def test_a_pair_that_the_data_do_not_part_is_found() -> None:
    # two springs in series: only the sum of their compliances is seen
    def series(values: Mapping[str, float]) -> dict[str, float]:
        return {"stiffness": 1.0 / (1.0 / values["a"] + 1.0 / values["b"]), "mass": values["m"]}

    chosen = (
        Parameter("a", 1.5, 0.1, 100.0),
        Parameter("b", 4.0, 0.1, 100.0),
        Parameter("m", 1.0, 0.1, 10.0),
    )
    wanted = (Target("stiffness", 1.0, 0.01), Target("mass", 2.0, 0.02))
    found = calibrate(series, chosen, wanted, starts=5, progress=silent)
    assert found.met(1e-3)
    assert found.identified.rank == 2
    assert found.identified.determined == ("m",)
    (free,) = found.identified.undetermined
    # at the optimum d(1/a + 1/b) = 0: weights as a/b to one, opposite in sign
    a, b = found.best["a"], found.best["b"]
    expected = np.array([a, -b, 0.0]) / np.hypot(a, b)
    got = np.array([free["a"], free["b"], free["m"]])
    assert abs(got @ expected) == pytest.approx(1.0, abs=1e-6)
    errors = found.identified.standard_errors
    assert np.isinf(errors[:2]).all()
    assert errors[2] == pytest.approx(0.01, rel=1e-3)
    content = found.to_dict()
    assert [p["standard_error"] is None for p in content["parameters"]] == [True, True, False]
    # every start ends elsewhere on the same valley
    ends = found.ends[:, 0]
    assert np.ptp(np.log(ends)) > 0.1
    np.testing.assert_allclose(found.costs, 0.0, atol=1e-6)
    # and what is taken is the end nearest to where the parameters were put
    own = np.log([p.start for p in chosen])
    far = np.linalg.norm(np.log(found.ends) - own, axis=1)
    np.testing.assert_array_equal(found.values, found.ends[far.argmin()])


def test_bounds_hold_and_are_named() -> None:
    chosen = (Parameter("k1", 1.2 * TRUTH["k1"], 1.1 * TRUTH["k1"], 5 * TRUTH["k1"]),)
    found = calibrate(with_known, chosen, targets("first"), starts=3, progress=silent)
    assert found.best["k1"] >= chosen[0].low
    assert found.best["k1"] == pytest.approx(chosen[0].low, rel=1e-3)
    assert found.on_bounds == ("k1",)
    assert not found.met()


def test_a_seed_reproduces() -> None:
    chosen, wanted = parameters("k1", "k2", "m1", "m2"), targets("first", "second", "static")
    runs = [
        calibrate(with_known, chosen, wanted, starts=3, seed=seed, progress=silent)
        for seed in (5, 5, 6)
    ]
    np.testing.assert_array_equal(runs[0].ends, runs[1].ends)
    assert not np.array_equal(runs[0].ends, runs[2].ends)


def test_several_starts_leave_a_local_minimum() -> None:
    def wavy(values: Mapping[str, float]) -> dict[str, float]:
        x = values["x"]
        return {"height": np.cos(3 * x) + 0.1 * (x - 4.0) ** 2}

    chosen = (Parameter("x", 1.2, 0.0, 6.0, scale="linear"),)
    wanted = (Target("height", -1.0, 0.1),)
    alone = calibrate(wavy, chosen, wanted, starts=1, progress=silent)
    several = calibrate(wavy, chosen, wanted, starts=8, progress=silent)
    assert several.cost < 0.2 * alone.cost


def test_a_model_that_fails_costs_its_start_alone() -> None:
    def touchy(values: Mapping[str, float]) -> dict[str, float]:
        if values["x"] > 3.0:
            raise NumericalError("model", "broke down.", "Stay below three.")
        return {"y": values["x"] ** 2}

    chosen, wanted = (Parameter("x", 1.0, 0.5, 20.0),), (Target("y", 4.0, 0.1),)
    found = calibrate(touchy, chosen, wanted, starts=5, progress=silent)
    assert found.best["x"] == pytest.approx(2.0, rel=1e-6)
    assert found.failures
    assert np.isinf(found.costs).sum() == len(found.failures)
    assert None in found.to_dict()["costs"]
    start = (Parameter("x", 10.0, 5.0, 20.0),)
    with pytest.raises(NumericalError, match="failed from each of 2 starts; the first: start 0"):
        calibrate(touchy, start, wanted, starts=2, progress=silent)


def test_an_assessment_searches_nothing() -> None:
    chosen, wanted = parameters("k1", "k2", start=1.0), targets("first", "second", "static")
    found = assess(with_known, chosen, wanted)
    assert found.best == pytest.approx({"k1": TRUTH["k1"], "k2": TRUTH["k2"]})
    assert found.cost == pytest.approx(0.0, abs=1e-12)
    # one run for the residuals, one for the result, two a parameter for the slopes
    assert found.evaluations == 6
    searched = calibrate(with_known, chosen, wanted, starts=1, progress=silent)
    np.testing.assert_allclose(
        found.identified.standard_errors, searched.identified.standard_errors, rtol=1e-4
    )


def test_progress_counts_starts() -> None:
    told: list[tuple[int, int]] = []
    calibrate(
        with_known,
        parameters("k1"),
        targets("first"),
        starts=3,
        progress=lambda done, total: told.append((done, total)),
    )
    assert told == [(0, 3), (1, 3), (2, 3), (3, 3)]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: Parameter("k", 1.0, 2.0, 3.0),
            "parameter k: starts at 1, and its range is 2 to 3",
        ),
        (lambda: Parameter("k", 1.0, -1.0, 3.0), 'Give a positive one, or scale="linear"'),
        (lambda: Parameter("k", 1.0, 0.5, np.inf), "not finite"),
        (lambda: Target("f", 1.0, 0.0), "positive uncertainty"),
        (lambda: calibrate(two_masses, (), targets("first")), "has no parameter"),
        (lambda: calibrate(two_masses, parameters("k1"), ()), "has no target"),
        (
            lambda: calibrate(two_masses, parameters("k1", "k1"), targets("first")),
            "parameter k1: is given twice",
        ),
        (
            lambda: calibrate(
                with_known, parameters("k1"), [Target("third", 1.0, 1.0)], progress=silent
            ),
            "target third: is not among the results of the model: first, second, static",
        ),
    ],
)
def test_what_cannot_be_calibrated_is_refused(make: object, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        make()  # type: ignore[operator]


def test_more_parameters_than_targets_leave_zero_singular_values() -> None:
    found = identifiability(np.array([[1.0, 1.0, 0.0]]), ("a", "b", "c"))
    np.testing.assert_allclose(found.singular_values, [np.sqrt(2.0), 0.0, 0.0])
    assert found.rank == 1
    assert found.determined == ()
