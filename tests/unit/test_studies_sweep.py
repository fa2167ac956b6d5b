"""Sweeps of poses: the good ones, and a mask with reasons for the others."""

from __future__ import annotations

import importlib
import json
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
import pytest

from strutwork.errors import NumericalError
from strutwork.kinematics import tangent_rotation
from strutwork.machines import Proposed3PPRS
from strutwork.msa import PlacedStructure, Structure, tool_compliance
from strutwork.outcome import Outcome, reason_of
from strutwork.studies import (
    CheckPoints,
    Filters,
    PoseStatus,
    hemisphere,
    stiffness_map,
    sweep,
)
from strutwork.studies.evaluation import compliance_where_possible


@dataclass(frozen=True, kw_only=True)
class Loose(Proposed3PPRS):
    """A machine whose structure has no hinge where it should: nothing holds its links."""

    @cached_property
    def structure(self) -> Structure:
        linkage = self.linkage
        joints = tuple(
            replace(j, type="spherical", limits={}) if j.name.endswith("hinge") else j
            for j in linkage.joints
        )
        beams = super().structure.beams
        return Structure(
            replace(linkage, joints=joints), beams=beams, rigid=super().structure.rigid
        )


def test_a_sweep_gives_the_good_poses_and_a_mask_with_reasons() -> None:
    machine = Proposed3PPRS()
    home = machine.home().position
    far, out_of_range = home + np.array([[0, 0, 0.2], [0, 0, -0.12]])
    found = sweep(machine, [home, far, out_of_range], workers=1)
    assert found["good"].to_numpy().tolist() == [True, False, False]
    assert found["status"].to_numpy().tolist() == [
        PoseStatus.GOOD,
        PoseStatus.UNREACHABLE,
        PoseStatus.JOINT_RANGE,
    ]
    reasons = found["reason_text"].to_numpy()[found["reason"].to_numpy()]
    assert reasons[0] == ""
    assert "higher above the guide than the link is long" in reasons[1]
    assert "is exceeded" in reasons[2]
    words = json.loads(found.attrs["dropped_by_reason"])
    assert words == {reasons[1]: 1, reasons[2]: 1}
    stiffness = found["stiffness_blocked"].to_numpy()
    assert np.isfinite(stiffness).all(axis=1).tolist() == [True, False, False]
    assert np.isnan(stiffness[1:]).all()


def test_a_sweep_crosses_positions_with_rotations() -> None:
    machine = Proposed3PPRS()
    positions = machine.home().position + np.array([[0, 0, 0], [1e-3, 0, 0]])
    normals = np.array([[0, 0, 1.0], [0, 0.6, 0.8]])
    rotations = tangent_rotation(normals, 0.1)
    found = sweep(machine, positions, rotations, Filters(joint_kinds=()), workers=1)
    assert found["position"].to_numpy()[:, 0].tolist() == [0, 0, 1e-3, 1e-3]
    assert np.array_equal(found["rotation"].to_numpy()[[0, 1]], rotations)
    assert np.array_equal(found["rotation"].to_numpy()[[2, 3]], rotations)
    assert found.attrs["poses_kept"] == 4


def test_a_singular_pose_is_counted_and_never_raises() -> None:
    machine = Proposed3PPRS()
    found = sweep(machine, [machine.home().position], None, Filters(condition_limit=1.5), workers=1)
    assert found["status"].to_numpy().tolist() == [PoseStatus.NEAR_SINGULAR]
    assert "condition number" in str(found["reason_text"].to_numpy()[-1])


def test_mechanisms_are_counted_and_never_raise() -> None:
    machine = Loose()
    points = hemisphere(machine, lattice=1)
    found = stiffness_map(machine, points, [0.0, 0.4], Filters(joint_kinds=()), workers=1)
    assert set(found["status"].to_numpy().tolist()) == {int(PoseStatus.MECHANISM)}
    assert found["dropped"].sel(reason="mechanism").to_numpy().tolist() == [2] * 5
    assert np.isnan(found["compliance"].to_numpy()).all()
    reason = "the structure moves freely under its load"
    assert json.loads(found.attrs["dropped_by_reason"]) == {reason: 10}
    # what moves is named for the first pose
    assert "hinge" in json.loads(found.attrs["first_of_reason"])[reason]


def test_what_a_solver_says_of_a_pose_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    module = importlib.import_module("strutwork.studies.evaluation")
    failed = NumericalError("static solution", "is off by 3.2e-07 there.", "Try again.")

    def one_fails(placed: PlacedStructure) -> tuple[Any, Outcome]:
        compliance = tool_compliance(placed)
        status = np.zeros(len(compliance), dtype=np.int16)
        status[1] = 1
        return compliance, Outcome(status, (reason_of(failed),), (failed,))

    monkeypatch.setattr(module, "compliance_and_outcome", one_fails)
    machine = Proposed3PPRS()
    home = machine.home().position
    found = sweep(machine, home + np.array([[0, 0, 0], [1e-3, 0, 0], [0, 0, 0.2]]), workers=1)
    assert found["status"].to_numpy().tolist() == [
        PoseStatus.GOOD,
        PoseStatus.UNSOLVED,
        PoseStatus.UNREACHABLE,
    ]
    reasons = found["reason_text"].to_numpy()[found["reason"].to_numpy()]
    # numbers of one pose do not make a reason of its own
    assert reasons[1] == "static solution: is off by … there"
    assert json.loads(found.attrs["first_of_reason"]) == {
        reasons[1]: "static solution: is off by 3.2e-07 there."
    }


def test_one_mechanism_in_a_stack_spoils_no_other_pose() -> None:
    machine = Proposed3PPRS()
    home = machine.home().position
    placement = machine.place(
        CheckPoints(
            home + np.linspace(-1e-3, 1e-3, 5)[:, None] * [1.0, 0.5, 0.2],
            np.tile([0.0, 0.0, 1.0], (5, 1)),
        ).poses(slice(None), np.array([0.2]))
    )
    frames = placement.frames.copy()
    assert not compliance_where_possible(machine.structure, placement)[1].any()
    # links on vertical hinges turn with the platform, which nothing holds about its vertical
    for leg in (1, 2, 3):
        hinge = machine.linkage.joint_index[f"leg{leg}/hinge"]
        frames[2, hinge] = np.eye(3)
    spoiled = replace(placement, frames=frames)
    compliance, status, outcome = compliance_where_possible(machine.structure, spoiled)
    alone = compliance_where_possible(machine.structure, spoiled[2:3])[1]
    assert alone.tolist() == [PoseStatus.MECHANISM]
    assert outcome.reason(2) == "the structure moves freely under its load"
    assert status.tolist() == [0, 0, PoseStatus.MECHANISM, 0, 0]
    good = [0, 1, 3, 4]
    expected = tool_compliance(machine.structure.at(placement[good]))
    # the same solver on the same systems
    assert compliance[good] == pytest.approx(expected, rel=1e-9, abs=1e-15)
    assert np.isnan(compliance[2]).all()
