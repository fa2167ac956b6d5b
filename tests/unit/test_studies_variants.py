"""Variants that share a program have the numbers that each has alone."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea.lowest import natural_frequencies
from strutwork.machines.model_poses import moved
from strutwork.msa import axis_stiffness_blocked, axis_stiffness_free, compliance_and_outcome
from strutwork.msa.mass import total_mass
from strutwork.msa.variant_of import origin_of
from strutwork.studies.parametric import Parametric
from strutwork.studies.variants import Variants, why

HEXAPOD = "examples/machines/6-ups.toml"
PATHS = [
    "sections.ram.diameter",
    "sections.cylinder.outer_diameter",
    "materials.steel.youngs_modulus",
    "joints.ball*.stiffness.*",
    "joints.drive*.stiffness.z",
]
#: With home, six machines at these are enough poses for the compiled kernel.
X = np.linspace(-0.1, 0.12, 45)


def _samples(count: int) -> np.ndarray:
    stated = [0.05, 0.09, 210e9, 4e8, 2e8]
    return stated * np.random.default_rng(5).uniform(0.8, 1.25, (count, 5))


def test_shared_program_gives_what_each_variant_has_alone() -> None:
    variants = Variants.of(
        HEXAPOD,
        PATHS,
        "stiffness",
        "frequency",
        "mass",
        workspace={"x": X},
        reductions=["poses"],
    )
    samples = _samples(6)
    found = variants.values(samples)
    machine = Parametric.of(HEXAPOD)
    for row in (0, 5):
        model = machine.model(dict(zip(PATHS, samples[row].tolist(), strict=True)))
        _, placement = moved(model, {"x": X})
        assert origin_of(model.structure) is not None
        # the dense solver, that a machine alone is solved by
        compliance, outcome = compliance_and_outcome(model.structure.at(placement), "saddle_point")
        assert outcome.solved.all()
        for name, of in (
            ("stiffness_free", axis_stiffness_free),
            ("stiffness_blocked", axis_stiffness_blocked),
        ):
            np.testing.assert_allclose(found[name][row], of(compliance), rtol=1e-9)
        # that at home: the legs of a hexapod are as long as the pose makes them
        np.testing.assert_allclose(found["mass"][row], total_mass(model.placed), rtol=1e-12)
        first = natural_frequencies(model.vibrating, 1)[0]
        np.testing.assert_allclose(found["first_frequency"][row], first, rtol=1e-9)
    # what is varied does act
    assert np.ptp(found["stiffness_free"][:, 0, 2]) > 0.01 * found["stiffness_free"][0, 0, 2]


def test_results_do_not_depend_on_threads() -> None:
    variants = Variants.of(HEXAPOD, PATHS, "stiffness", workspace={"x": X})
    samples = _samples(40)
    one, two = variants.values(samples, workers=1), variants.values(samples, workers=2)
    for name, values in one.items():
        np.testing.assert_array_equal(values, two[name])


def test_a_variant_that_cannot_be_keeps_its_reason() -> None:
    paths = ["sections.cylinder.outer_diameter", "sections.cylinder.inner_diameter"]
    variants = Variants.of(HEXAPOD, paths, "stiffness", workspace={"x": X})
    found = variants.values([[0.09, 0.066], [0.05, 0.066]])
    assert found["status"].tolist() == [0, 1]
    assert why(found, 0) == ""
    assert "cylinder" in why(found, 1)
    assert np.isnan(found["stiffness_free_worst"][1]).all()
    assert np.isfinite(found["stiffness_free_worst"][0]).all()


def test_samples_of_another_width_are_refused() -> None:
    variants = Variants.of(HEXAPOD, PATHS, "mass", workspace={})
    with pytest.raises(ModelError, match="row of 5"):
        variants.values(np.ones((2, 4)))
