"""Inverse kinematics and Jacobians of two machines beside Pinocchio.

@inproceedings{carpentier2019,
  author    = {Carpentier, Justin and Saurel, Guilhem and Buondonno, Gabriele and Mirabel, Joseph
               and Lamiraux, Florent and Stasse, Olivier and Mansard, Nicolas},
  title     = {The {Pinocchio} {C++} library},
  booktitle = {IEEE/SICE International Symposium on System Integration (SII)},
  year      = {2019},
  pages     = {614--619},
}

The legs are branches of one tree in Pinocchio and closed by Newton's method to 1e-12 m; its
Jacobians give the rates of the drives. Both are exact up to rounding, so drives agree to 1e-9 m
or rad, rates to 1e-9 of the largest of each pose.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from benchmarks.kinematics_speed import poses_around
from benchmarks.pinocchio_peer import PinocchioLegs, branches
from strutwork.kinematics import jacobians
from strutwork.kinematics.inverse_survey import inverse_survey
from strutwork.machines import Glozman3PRRS, HexelHexapod, Machine, MitSS1, Proposed3PPRS
from strutwork.machines.load import machine_model

TOLERANCE = 1e-9
POSES = 200

each = pytest.mark.parametrize("machine", [HexelHexapod(), Proposed3PPRS(), Glozman3PRRS()])


@pytest.fixture(scope="module", autouse=True)
def pinocchio() -> Any:
    try:
        import pinocchio  # noqa: PLC0415 - an extra that may be missing
    except ImportError as error:
        pytest.fail(
            f"Pinocchio cannot be imported ({error}). These tests need the extra `bench`: "
            "pip install -e '.[bench]'."
        )
    return pinocchio


@each
def test_drives_ranges_and_margins_are_those_of_pinocchio(machine: Machine) -> None:
    motion = machine_model(machine, "machine").motion
    poses = poses_around(machine, POSES)
    ours = inverse_survey(motion, poses)
    theirs = PinocchioLegs(motion).survey(poses, ours.length)
    home = dict(zip(motion.joints.names, motion.home_values, strict=True))
    zero = np.array([home[name] for name in motion.linkage.driven])
    # both find the poses good, and there are some to compare
    assert np.array_equal(ours.reachable, theirs.good)
    good = theirs.good
    assert good.sum() > POSES // 2
    assert np.abs(ours.values - zero).max() > 1e-3
    assert np.abs(ours.values - zero - theirs.drives)[good].max() < TOLERANCE
    assert np.abs(ours.margin - theirs.margin)[good].max() < TOLERANCE


@each
@pytest.mark.parametrize("method", ["legs", "rows"])
def test_jacobians_are_those_of_pinocchio(machine: Machine, method: Any) -> None:
    motion = machine_model(machine, "machine").motion
    poses = poses_around(machine, POSES)
    placement = machine.place(poses)
    ours = jacobians(machine.linkage, placement, method).inverse
    theirs = PinocchioLegs(motion).survey(poses, motion.length).rates
    largest = np.abs(ours).max(axis=(-2, -1), keepdims=True)
    assert (np.abs(ours - theirs) / largest).max() < TOLERANCE


@each
def test_closed_forms_are_those_of_pinocchio(machine: Machine) -> None:
    motion = machine_model(machine, "machine").motion
    poses = poses_around(machine, POSES)
    names = list(machine.place(poses).names)
    drives = [names.index(name) for name in motion.linkage.driven]
    own = machine.place(poses).values[:, drives] - machine.place(machine.home()).values[drives]
    theirs = PinocchioLegs(motion).survey(poses, motion.length).drives
    assert np.abs(own - theirs).max() < TOLERANCE


def test_poses_out_of_a_range_are_told_alike() -> None:
    """Farther from home, joints of the machine with ranges leave them."""
    machine = Proposed3PPRS()
    motion = machine_model(machine, "machine").motion
    step = np.zeros((61, 6))
    step[:, 2] = np.linspace(-0.06, 0.06, 61)
    poses = machine.home().moved(step)
    ours = inverse_survey(motion, poses)
    theirs = PinocchioLegs(motion).survey(poses, ours.length)
    taken = ours.taken
    assert np.array_equal(ours.reachable[taken], theirs.good[taken])
    assert 5 < ours.reachable.sum() < taken.sum()


def test_other_legs_are_refused() -> None:
    with pytest.raises(ValueError, match="three joints and a ball"):
        branches(machine_model(MitSS1(), "machine").motion)
