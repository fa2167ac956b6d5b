"""Sobol indices: of incomplete blocks, and through a study."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from strutwork.errors import ModelError
from strutwork.studies.parameter import Parameter
from strutwork.studies.sample import Sample
from strutwork.studies.sobol_blocks import block_shares
from strutwork.studies.sobol_indices import dropped_words, indices
from strutwork.studies.study import Study
from strutwork.studies.study_analysis import analysed
from strutwork.studies.study_table import answer_columns
from tests.ishigami import closed_form, ishigami

pytest.importorskip("SALib")

RPS = Path(__file__).parents[2] / "examples/machines/3-rps.toml"


@pytest.fixture(scope="module")
def closed() -> dict[str, np.ndarray]:
    return closed_form()


def test_incomplete_blocks_are_left_out_and_named(closed: dict[str, np.ndarray]) -> None:
    shares = block_shares(1024, 3, 5, second_order=False)
    values = ishigami((2 * shares - 1) * np.pi)
    # rows of a block: 5
    values[[7, 5 * 100, 5 * 900 + 4]] = [np.nan, np.inf, np.nan]
    found = indices(values, 3, second_order=False)
    assert found.dropped == (1, 100, 900)
    assert found.total == pytest.approx(closed["total"], abs=0.05)
    assert np.isnan(found.second).all()
    words = dropped_words([found.dropped, (1, 2)], 1024)
    assert words == "4 of 1024 blocks are incomplete and left out: 1, 2, 100, 900"


def test_too_many_incomplete_blocks_give_no_indices() -> None:
    values = np.arange(16 * 4.0)
    values[::8] = np.nan
    assert indices(values, 2, second_order=False).refused == ""
    values[4::8] = np.nan
    found = indices(values, 2, second_order=False)
    assert "16 of 16 blocks hold a machine without this answer" in found.refused
    assert np.isnan(found.total).all()
    assert indices(np.full(64, 2.0), 2, second_order=False).refused == "it does not vary."


def test_two_springs_share_the_variance_as_their_ranges_do() -> None:
    """Springs one behind the other: compliance 1/k1 + 1/k2 has no interaction in closed form."""
    study = chain(Sample("saltelli", 32, 3, second_order=True))
    found = study.run(workers=1)
    ends = [(1e8, 3e8), (2e8, 3e8)]
    # variance of 1/k, k uniform between a and b
    variance = [1 / (a * b) - (np.log(b / a) / (b - a)) ** 2 for a, b in ends]
    share = np.array(variance) / sum(variance)
    column = next(c for c in answer_columns(found) if c.name == "stiffness_free_home z")
    k1, k2 = study.drawn.values.T
    assert column.values == pytest.approx(1 / (1 / k1 + 1 / k2), rel=1e-9)
    alone = indices(1.0 / column.values, 2, second_order=True, seed=3)
    assert np.all(np.abs(alone.first - share) < 1.53 * alone.first_confidence)
    assert np.all(np.abs(alone.total - share) < 1.53 * alone.total_confidence)
    assert abs(alone.second[0, 1]) < 1.53 * alone.second_confidence[0, 1]
    # of the stiffness itself what the dataset says, by the same road
    again = indices(column.values, 2, second_order=True, seed=3)
    one = found.sel(answer="stiffness_free_home z")
    assert np.array_equal(one["sobol_total"].to_numpy(), again.total)
    assert np.array_equal(one["sobol_second"].to_numpy(), again.second, equal_nan=True)
    assert found["sobol_first"].dims == ("answer", "parameter")
    assert found["sobol_first_confidence"].attrs["units"] == "1"
    # along x nothing varies
    assert json.loads(found.attrs["sobol_refused"])["stiffness_free_home x"] == "it does not vary."
    assert len(study) == 32 * 6


def chain(sample: Sample) -> Study:
    """Springs k1 and k2 along z, one behind the other, stiff otherwise."""
    text = """
title = "two springs in a row"
[tool]
tcp = "T"
[nodes]
A = [0, 0, 0]
M = [0, 0, 0]
T = [0, 0, 0]
[[supports]]
node = "A"
fixed = "all"
[[joints]]
name = "one"
type = "bushing"
between = ["A", "M"]
stiffness = { x = 1e9, y = 1e9, z = 2e8, rx = 1e8, ry = 1e8, rz = 1e8 }
[[joints]]
name = "two"
type = "bushing"
between = ["M", "T"]
stiffness = { x = 1e9, y = 1e9, z = 2e8, rx = 1e8, ry = 1e8, rz = 1e8 }
"""
    springs = {
        "joints.one.stiffness.z": (1e8, 3e8),
        "joints.two.stiffness.z": (2e8, 3e8),
    }
    return Study.of(text, springs, sample=sample, workspace={})


def test_the_dataset_of_a_study_holds_ishigamis_indices(
    closed: dict[str, np.ndarray],
) -> None:
    """The road of a study: its sample, its order of machines, its dataset."""
    parameters = [
        Parameter(f"joints.drive{i}.limits.z.high", low=0.8, high=0.9, name=f"p{i}")
        for i in (1, 2, 3)
    ]
    study = Study.of(RPS, parameters, "mass", sample=Sample("saltelli", 1024, 2), workspace={})
    few = Study.of(RPS, parameters, "mass", sample=Sample("saltelli", 8, 2), workspace={}).run()
    shares = (study.drawn.values - 0.8) / 0.1
    values = ishigami((2 * shares - 1) * np.pi)
    data = xr.Dataset(
        {"mass": ("sample", values, few["mass"].attrs), "status": ("sample", np.zeros(len(study)))}
    )
    found = analysed(study, data).sel(answer="mass")
    assert found["parameter"].to_numpy().tolist() == ["p1", "p2", "p3"]
    assert found["sobol_first"].to_numpy() == pytest.approx(closed["first"], abs=0.03)
    assert found["sobol_total"].to_numpy() == pytest.approx(closed["total"], abs=0.03)
    assert int(found["sobol_blocks"]) == 1024


@pytest.mark.parametrize(
    ("sample", "message"),
    [
        (Sample("saltelli", 100), "is 100; blocks for Sobol indices are a power of two"),
        (Sample("saltelli", 4), "8 or 16"),
        (Sample("saltelli"), "is missing"),
        (Sample("sobol", 16, second_order=True), "stands beside sobol points"),
        (Sample("saltelli", 2**24), "are the most"),
    ],
)
def test_a_sample_without_indices_is_refused(sample: Sample, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        chain(sample)


def test_one_parameter_has_no_shares() -> None:
    with pytest.raises(ModelError, match="there is one parameter, which decides everything"):
        Study.of(RPS, {"materials.*.youngs_modulus": (1e11, 2e11)}, sample=Sample("saltelli", 8))


def test_without_salib_the_message_says_how_to_install_it(monkeypatch: Any) -> None:
    monkeypatch.setitem(sys.modules, "SALib.sample.sobol", None)
    with pytest.raises(ModelError, match="SALib is not installed") as caught:
        chain(Sample("saltelli", 16))
    assert 'pip install "strutwork[design]"' in caught.value.remedy
