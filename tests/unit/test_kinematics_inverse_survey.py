"""A survey of poses beside its parts: inverse kinematics, joint ranges, margin."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.kinematics import jacobians
from strutwork.kinematics.inverse_survey import PIECE, inverse_survey
from strutwork.machines import Proposed3PPRS, check_limits, joint_limits
from strutwork.machines.load import load
from tests.legs import around


def test_newton_and_closed_form_say_the_same_as_their_parts() -> None:
    found, machine = load("proposed-3pprs"), Proposed3PPRS()
    poses = around(found.motion, PIECE + 100, 0.03, 0.4, 1)
    limits = joint_limits(machine.linkage)
    newton = inverse_survey(found.motion, poses, limits)
    closed = inverse_survey(machine, poses, limits)
    placement = check_limits(limits, machine.place(poses))
    margin = jacobians(machine.linkage, placement).margin(newton.length)
    for survey in (newton, closed):
        np.testing.assert_array_equal(survey.reachable, placement.reachable)
        # rounding of two inverse kinematics, at rates of some hundreds
        np.testing.assert_allclose(survey.margin[survey.taken], margin[survey.taken], atol=1e-9)
    assert 0.1 < newton.reachable.mean() < 0.95
    bad = int(np.flatnonzero(~newton.reachable)[0])
    assert newton.reason(bad) == placement.reason(bad)


def test_a_length_and_a_coordinate_that_make_no_sense() -> None:
    motion = load("hexel-hexapod").motion
    with pytest.raises(ModelError, match=r"has the length 0 m"):
        inverse_survey(motion, motion.home_pose, length=0.0)
    with pytest.raises(ModelError, match='no coordinate "y"'):
        inverse_survey(motion, motion.home_pose, coordinates=[("leg1/ram", "y")])


MILLION = """
import numpy as np
from strutwork.kinematics import Poses
from strutwork.kinematics.inverse_survey import inverse_survey
from strutwork.kinematics.turns import rotation_matrix
from strutwork.machines.load import load
model = load("hexel-hexapod")
home = model.motion.home_pose
random = np.random.default_rng(0)
place = home.position + random.uniform(-0.1, 0.1, (1_000_000, 3))
turn = rotation_matrix(random.uniform(-0.1, 0.1, (1_000_000, 3)))
found = inverse_survey(model.motion, Poses(place, turn))
# its own peak: getrusage still counts what the process was forked from
(peak,) = [line for line in open("/proc/self/status") if line.startswith("VmHWM")]
print(int(found.reachable.sum()), peak.split()[1])
"""


@pytest.mark.slow
def test_a_million_poses_take_less_than_a_gigabyte() -> None:
    done = subprocess.run(
        [sys.executable, "-c", MILLION],
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(__file__).parents[2],
    )
    good, kilobytes = map(int, done.stdout.split())
    assert good > 900_000
    assert kilobytes < 1_000_000
