"""Kinematics of the planar machine over its workspace."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.kinematics import drive_values
from strutwork.machines import MitSS1
from strutwork.papers.son_2002.planar_kinematics import (
    SINGULAR_X,
    parallel_determinant,
    planar_kinematics,
    singular_tilt,
)
from strutwork.papers.son_2002.published import MACHINE, MANIPULABILITY


def test_condition_number_of_the_workspace() -> None:
    condition = planar_kinematics()["condition"]
    for found, end in ((condition.min(), "least"), (condition.max(), "most")):
        published = MANIPULABILITY.value(MACHINE, f"position condition number, {end}")
        # printed to two decimals; nothing fitted
        assert float(found) == pytest.approx(published, abs=0.005)


def test_drives_are_the_inverse_kinematics() -> None:
    machine = MitSS1()
    found = planar_kinematics(machine, [0.0, 0.02], [0.1])
    expected = drive_values(machine, machine.place(machine.poses(0.02, 0.0, 0.1)))
    np.testing.assert_array_equal(found["drive"].to_numpy()[1, 0], expected)


def test_singular_tilts_are_where_the_determinant_vanishes() -> None:
    machine = MitSS1()
    for x in SINGULAR_X:
        tilt = singular_tilt(machine, x)
        assert tilt is not None
        # the rows have entries of order one tenth
        assert abs(float(parallel_determinant(machine, x, tilt))) < 1e-13
        assert abs(tilt) > np.radians(30.0)


def test_out_of_reach() -> None:
    machine = MitSS1()
    found = planar_kinematics(machine, [0.0, 2.0], [0.0])
    assert np.isnan(found["condition"].to_numpy()[1, 0])
    assert np.all(np.isnan(found["drive"].to_numpy()[1, 0]))
    assert singular_tilt(machine, 2.0) is None
    with pytest.raises(ModelError, match="no pose"):
        planar_kinematics(machine, [2.0], [0.0])
