"""Exponents over sizes, against a beam and a joint in series."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from strutwork.errors import ModelError, NumericalError
from strutwork.msa import tool_compliance
from strutwork.studies.removal_rate import removal_exponents
from strutwork.studies.scale import FACTORS, joint_share, power_law, scale_study
from strutwork.studies.similarity import ROLLERS, SIMILAR, UNSCALED, JointScaling
from tests.structures import Model, cantilever

SIZES = (0.5, 1.0, 2.0)


def on_a_joint(share: float) -> Model:
    """A cantilever whose elastic root takes a share of the deflection across it."""
    rigid = cantilever(elements=2)
    bending = float(tool_compliance(rigid.place())[1, 1])
    model = cantilever(elements=2)
    # a turn of the root moves the tip, 0.6 m off, by 0.36 m² per moment's compliance
    turning = 0.36 / (bending * share / (1 - share))
    model.joints[0] = replace(model.joints[0], stiffness={"rz": turning})
    return model


@pytest.mark.parametrize("power", [-2.0, 0.0, 0.8])
def test_a_power_is_found_exactly(power: float) -> None:
    values = np.array([3.0, 0.2]) * np.array(FACTORS)[:, None] ** power
    found = power_law(FACTORS, values)
    assert found.exponent == pytest.approx([power, power], abs=1e-13)
    assert found.local == pytest.approx(np.full((len(FACTORS), 2), power), abs=1e-12)
    assert found.error.max() < 1e-13


def test_what_is_no_power_says_how_far_off() -> None:
    # log values 0, 0, 1 (natural) over log sizes −1, 0, 1: slope 1/2, middle 1/3 too low
    found = power_law(np.exp([-1.0, 0.0, 1.0]), np.exp([0.0, 0.0, 1.0]))
    assert found.exponent == pytest.approx(0.5)
    assert found.error == pytest.approx(1 - np.exp(-1 / 3))
    # of the parabola through the three points
    assert found.local == pytest.approx([-0.5, 0.5, 1.5])


@pytest.mark.parametrize("share", [0.2, 0.53, 0.9])
def test_a_joint_in_series_with_a_beam(share: float) -> None:
    placed = on_a_joint(share).place()
    assert joint_share(placed)[1] == pytest.approx(share, rel=1e-9)
    study = scale_study(placed, laws=(SIMILAR, ROLLERS, UNSCALED), count=2)
    sizes, middle = np.array(FACTORS), FACTORS.index(1.0)
    for i, rotational in enumerate((3.0, 2.8, 0.0)):
        # compliance of the beam ~ 1/L, of the joint ~ L²/L^r
        expected = 1 / ((1 - share) / sizes + share * sizes ** (2 - rotational))
        stiffness = study.stiffness[i, :, 1]
        assert stiffness / stiffness[middle] == pytest.approx(expected, rel=1e-9)
        slope = (1 - share) + share * (rotational - 2)
        # a spline over steps of √2
        assert study.stiffness_law(i).local[middle, 1] == pytest.approx(slope, abs=2e-3)
    # what the joint does not touch stays similar
    assert study.stiffness_law(2).exponent[0] == pytest.approx(1.0, abs=1e-9)


def test_a_batch_of_poses_is_each_pose() -> None:
    model = on_a_joint(0.4)
    model.positions["tip"] = np.array([[0.6, 0.0, 0.0], [0.5, 0.2, 0.1]])
    placed = model.place()
    both = scale_study(placed, SIZES, count=3)
    assert both.stiffness.shape == (3, 3, 2, 6)
    assert both.frequencies.shape == (3, 3, 2, 3)
    for pose in range(2):
        alone = scale_study(placed[pose], SIZES, count=3)
        assert both.stiffness[:, :, pose] == pytest.approx(alone.stiffness, rel=1e-9)
        assert both.frequencies[:, :, pose] == pytest.approx(alone.frequencies, rel=1e-9)
        assert both.joint_share[pose] == pytest.approx(alone.joint_share, abs=1e-9)
    assert both.to_dict()["laws"][0]["removal_rate"] == {}
    with pytest.raises(ModelError, match="several poses"):
        both.removal(0)


def test_rigid_body_modes_are_left_out() -> None:
    model = on_a_joint(0.4)
    model.nodes(loose=(1.0, 1.0, 0.0), end=(1.5, 1.0, 0.0))
    model.beam("loose", "loose", "end")
    study = scale_study(model.place(), SIZES, (SIMILAR,), 3)
    assert study.frequency_law(0).exponent == pytest.approx([-1.0] * 3, abs=1e-9)


def test_as_tables() -> None:
    study = scale_study(on_a_joint(0.4).place(), SIZES, (ROLLERS, JointScaling(0.5)), 2)
    data = study.to_dataset()
    assert dict(data.sizes) == {"law": 2, "factor": 3, "direction": 6, "mode": 2}
    assert (
        data["stiffness"].sel(law="roller bearings", factor=2.0, direction="y")
        == (study.stiffness[0, 2, 1])
    )
    assert data["stiffness_exponent"].values[0] == pytest.approx(study.stiffness_law(0).local)
    told = json.loads(json.dumps(study.to_dict(), allow_nan=False))
    first = told["laws"][0]
    assert first["frequency_exponents"] == study.frequency_law(0).exponent.tolist()
    exponent = first["stiffness_exponents"][1]
    assert first["removal_rate"]["y"][1] == vars(removal_exponents(3.0, exponent))
    assert "3 sizes from 0.5 to 2, 2 laws" in repr(study)


@pytest.mark.parametrize(
    "sizes", [(), (1.0,), (2.0, 1.0), (0.0, 1.0), (1.0, np.nan), ((1.0, 2.0),)]
)
def test_sizes_must_ascend(sizes: tuple[float, ...]) -> None:
    with pytest.raises(ModelError, match="sizes of the machine"):
        scale_study(cantilever().place(), sizes)


def test_what_has_no_exponent_is_refused() -> None:
    with pytest.raises(NumericalError, match="not positive"):
        power_law(SIZES, [1.0, 0.0, 2.0])
    with pytest.raises(ModelError, match="no law"):
        scale_study(cantilever().place(), SIZES, ())
    with pytest.raises(ModelError, match="fewer than 40 modes"):
        scale_study(cantilever().place(), SIZES, count=40)
