"""Stiffness maps: what is counted, what is chosen, what is missing."""

from __future__ import annotations

import importlib
import json
from dataclasses import replace
from math import pi
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from strutwork.errors import ModelError, StudyWarning
from strutwork.kinematics import rotation_z
from strutwork.machines import Alizade3PRPS, Eclipse3PPRS, Glozman3PRRS, Proposed3PPRS
from strutwork.msa import axis_stiffness_blocked, tool_compliance
from strutwork.papers.azulay_2014.filters import AS_IN_AZULAY
from strutwork.papers.azulay_2014.link_lengths import link_lengths
from strutwork.studies import (
    CheckPoints,
    Filters,
    PoseStatus,
    area_weights,
    hemisphere,
    stiffness_map,
    summary,
    sweep,
)
from strutwork.studies.description import study_key
from strutwork.studies.evaluation import Evaluated
from strutwork.studies.filters import moving_machine, tool_radius
from strutwork.studies.stiffness_map import stiffest_roll

ROLLS = np.arange(6) * pi / 9


@pytest.fixture(scope="module")
def small() -> xr.Dataset:
    machine = Glozman3PRRS()
    return stiffness_map(machine, hemisphere(machine, lattice=4), ROLLS, workers=1)


def test_every_candidate_is_kept_or_counted(small: xr.Dataset) -> None:
    candidates = small.attrs["candidates"]
    assert candidates == small.sizes["point"] * len(ROLLS)
    dropped = small["dropped"].sum("reason")
    assert int(dropped.max()) <= len(ROLLS)
    assert int(dropped.sum()) + small.attrs["candidates_kept"] == candidates
    words = json.loads(small.attrs["dropped_by_reason"])
    assert sum(words.values()) == int(dropped.sum())
    assert all(
        small["dropped"].sum("point").sel(reason=r) > 0 for r in ("unreachable", "near_singular")
    )


def test_a_point_counts_when_a_candidate_is_left(small: xr.Dataset) -> None:
    left = len(ROLLS) - small["dropped"].sum("reason")
    good = small["status"] == PoseStatus.GOOD
    assert bool(((left > 0) == good).all())
    assert 0 < int(good.sum()) == small.attrs["points_kept"]
    numbers = ("roll", "condition_number", "stiffness_blocked", "stiffness_free", "compliance")
    for name in numbers:
        missing = np.isnan(small[name].to_numpy()).reshape(len(good), -1)
        assert missing.all(axis=1).tolist() == (~good).to_numpy().tolist(), name
        assert missing.any(axis=1).tolist() == (~good).to_numpy().tolist(), name


def test_status_carries_its_meanings(small: xr.Dataset) -> None:
    attributes = small["status"].attrs
    words = attributes["flag_meanings"].split()
    assert dict(zip(words, attributes["flag_values"].tolist(), strict=True)) == {
        s.word: int(s) for s in PoseStatus
    }
    assert all(
        {"units", "component_units"} & set(v.attrs)
        for n, v in small.data_vars.items()
        if n != "status"
    )


def test_the_chosen_roll_is_the_stiffest_along_x(small: xr.Dataset) -> None:
    machine = Glozman3PRRS()
    points = hemisphere(machine, lattice=4)
    each = [
        stiffness_map(machine, points, [roll], workers=1)["stiffness_blocked"].sel(direction="x")
        for roll in ROLLS
    ]
    stacked = np.stack([e.to_numpy() for e in each])
    found = small["stiffness_blocked"].sel(direction="x").to_numpy()
    kept = np.isfinite(found)
    # the same poses by the same method: rounding of a stack's order only
    assert found[kept] == pytest.approx(np.nanmax(stacked[:, kept], axis=0), rel=1e-9)


def test_map_agrees_with_the_structure_at_its_poses(small: xr.Dataset) -> None:
    machine = Glozman3PRRS()
    kept = np.flatnonzero(small["status"].to_numpy() == PoseStatus.GOOD)[:5]
    normal, roll = small["normal"].to_numpy()[kept], small["roll"].to_numpy()[kept]
    points = CheckPoints(small["position"].to_numpy()[kept], normal)
    for i, point in enumerate(kept):
        poses = points.poses(slice(i, i + 1), roll[i : i + 1])
        compliance = tool_compliance(machine.structure.at(machine.place(poses)), "saddle_point")[0]
        # two solvers of one system
        found = small["compliance"].to_numpy()[point]
        assert found == pytest.approx(compliance, rel=1e-7, abs=1e-9 * np.abs(compliance).max())
        assert small["stiffness_blocked"].to_numpy()[point] == pytest.approx(
            axis_stiffness_blocked(compliance), rel=1e-6
        )


def test_a_third_of_a_turn_changes_nothing() -> None:
    # twelve normals in a ring at 40° repeat after 120°, as the machine does
    turn = np.arange(12) * pi / 6
    normal = np.stack(
        [np.sin(0.7) * np.cos(turn), np.sin(0.7) * np.sin(turn), np.full(12, np.cos(0.7))], axis=-1
    )
    machine = Eclipse3PPRS()
    points = CheckPoints([0.0, 0.0, machine.pole_height] + 4e-3 * (normal - [0, 0, 1]), normal)
    found = stiffness_map(machine, points, [0.3], AS_IN_AZULAY, workers=1)
    assert found.attrs["points_kept"] == 12
    # symmetry to the rounding of a stack of well-conditioned systems
    near = {"rel": 1e-9}
    principal = found["principal_stiffness"].to_numpy()
    assert np.roll(principal, 4, axis=0) == pytest.approx(principal, **near)
    stiffness = np.linalg.inv(found["compliance"].to_numpy())[:, :3, :3]
    mean = stiffness.mean(axis=0)
    third = rotation_z(2 * pi / 3)
    assert third @ mean @ third.T == pytest.approx(mean, rel=1e-9, abs=1e-9 * np.abs(mean).max())
    assert mean[0, 0] == pytest.approx(mean[1, 1], **near)


def test_an_interrupted_map_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    module = importlib.import_module("strutwork.studies.stiffness_map")
    monkeypatch.setattr(module, "CHUNK", 60)
    machine = Proposed3PPRS()
    points = hemisphere(machine, lattice=3)

    def stop(done: int, total: int, /) -> None:
        if 0 < done < total:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt), pytest.warns(StudyWarning, match="of 3 chunks"):
        stiffness_map(machine, points, ROLLS, workers=1, progress=stop, folder=tmp_path)
    kept = {p: p.stat().st_mtime_ns for p in tmp_path.rglob("chunk-*.npz")}
    assert 0 < len(kept) < 3
    resumed = stiffness_map(machine, points, ROLLS, workers=1, folder=tmp_path)
    assert {p: p.stat().st_mtime_ns for p in kept} == kept
    assert len(list(tmp_path.rglob("chunk-*.npz"))) == 3
    xr.testing.assert_identical(resumed, stiffness_map(machine, points, ROLLS, workers=2))


def test_the_key_sees_every_input() -> None:
    machine, points = Proposed3PPRS(), np.zeros((2, 3))
    keys = {
        study_key("map", machine, {"filters": Filters()}, points),
        study_key("sweep", machine, {"filters": Filters()}, points),
        study_key("map", replace(machine, link_length=0.217), {"filters": Filters()}, points),
        study_key("map", machine, {"filters": AS_IN_AZULAY}, points),
        study_key("map", machine, {"filters": Filters()}, points + 1e-12),
    }
    assert len(keys) == 5
    again = study_key("map", Proposed3PPRS(), {"filters": Filters()}, points.copy())
    assert again in keys


def test_joint_ranges_can_be_left_out() -> None:
    machine = Proposed3PPRS()
    points = hemisphere(machine, lattice=2)
    every = stiffness_map(machine, points, ROLLS, Filters(condition_limit=None), workers=1)
    none = stiffness_map(
        machine, points, ROLLS, Filters(joint_kinds=(), condition_limit=None), workers=1
    )
    assert int(none["dropped"].sum()) == 0
    assert int(every["dropped"].sel(reason="joint_range").sum()) > 0
    # what is outside is counted whether it is dropped or not
    xr.testing.assert_equal(every["outside_range"], none["outside_range"])
    assert bool((every["outside_range"].max("joint_kind") <= every["dropped"].sum("reason")).all())


def test_a_clamped_model_is_as_singular_as_its_machine() -> None:
    machine = Proposed3PPRS()
    points = hemisphere(machine, lattice=3)
    found = stiffness_map(machine.apparent(), points, ROLLS, workers=1)
    true = stiffness_map(machine, points, ROLLS, workers=1)
    xr.testing.assert_equal(found["dropped"], true["dropped"])
    assert moving_machine(machine) is machine
    assert found.attrs["joint_model"].startswith("apparent")
    assert true.attrs["joint_model"] == "true spherical joints"


def test_length_of_the_condition_number_is_the_platform_radius() -> None:
    machine = replace(Eclipse3PPRS(), platform_radius=0.02)
    assert tool_radius(machine) == pytest.approx(0.02, rel=1e-12)
    assert Filters(length=0.1).length_for(machine) == 0.1


@pytest.mark.parametrize(
    "make",
    [
        lambda: Filters(condition_limit=0.5),
        lambda: Filters(length=0.0),
        lambda: CheckPoints(np.zeros((2, 3)), np.zeros((2, 3))),
        lambda: CheckPoints(np.zeros((0, 3)), np.zeros((0, 3))),
        lambda: CheckPoints(np.zeros((2, 3)), np.zeros((1, 3))),
        lambda: hemisphere(Proposed3PPRS(), radius=-1.0),
        lambda: stiffness_map(Proposed3PPRS(), rolls=[]),
        lambda: sweep(Proposed3PPRS(), np.zeros((0, 3))),
        lambda: sweep(Proposed3PPRS(), [[0.0, 0.0]]),
        lambda: link_lengths(lengths=()),
        lambda: link_lengths(Alizade3PRPS()),
    ],
)
def test_bad_settings_are_refused(make: object) -> None:
    with pytest.raises(ModelError):
        make()  # type: ignore[operator]


def test_area_weights_give_the_rim_its_due() -> None:
    machine = Eclipse3PPRS()
    found = stiffness_map(machine, hemisphere(machine, lattice=3), ROLLS, AS_IN_AZULAY, workers=1)
    values = found["stiffness_blocked"].sel(direction="z").to_numpy()
    weights = area_weights(found["normal"].to_numpy())
    by_area = summary(found, weights="area").axis("z").statistics
    assert by_area.mean == pytest.approx(np.average(values, weights=weights), rel=1e-12)
    by_point = summary(found).axis("z").statistics
    assert by_point.mean == pytest.approx(values.mean(), rel=1e-12)
    assert by_area.mean != pytest.approx(by_point.mean, rel=1e-6)


def test_the_stiffest_roll_counts_and_may_be_infinitely_stiff() -> None:
    compliance = np.full((6, 6, 6), np.nan)
    status = np.full(6, PoseStatus.MECHANISM, dtype=np.int8)
    # at the first point the second and third of three rolls count, the third is locked along x
    compliance[1], compliance[2] = np.eye(6), np.diag([0.0, 1, 1, 1, 1, 1])
    # at the second only the last, and it is locked
    compliance[5] = np.diag([0.0, 1, 1, 1, 1, 1])
    status[[1, 2, 5]] = PoseStatus.GOOD
    none = np.zeros(6, dtype=np.int16)
    found = Evaluated(status, none, (), {}, np.zeros((6, 0), dtype=bool), none * np.nan, compliance)
    chosen, outcome = stiffest_roll(found, 3)
    assert chosen.tolist() == [2, 2]
    assert outcome.tolist() == [PoseStatus.GOOD] * 2
