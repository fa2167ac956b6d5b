"""Compliance budgets of the best, the median and the worst pose of a map."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.machines import Proposed3PPRS
from strutwork.papers.azulay_2014.filters import AS_IN_AZULAY
from strutwork.studies import (
    budget_map,
    hemisphere,
    stiffness_map,
)

ROLLS = np.arange(6) * pi / 9


def test_budgets_of_best_median_and_worst_pose() -> None:
    machine = Proposed3PPRS()
    points = hemisphere(machine, lattice=3)
    found = stiffness_map(machine, points, ROLLS, AS_IN_AZULAY, workers=1)
    budget = budget_map(machine, found)
    # shares of one energy
    assert budget["share"].sum("part").to_numpy() == pytest.approx(np.ones((3, 3)), abs=1e-9)
    stiffness = budget["stiffness"].to_numpy()
    every = found["stiffness_blocked"].to_numpy()[:, :3]
    assert stiffness[:, 0].tolist() == every.max(axis=0).tolist()
    assert stiffness[:, 2].tolist() == every.min(axis=0).tolist()
    assert len(every) % 2 == 1
    assert stiffness[:, 1].tolist() == np.median(every, axis=0).tolist()
    free = found["stiffness_free"].to_numpy()
    point = budget["point"].to_numpy()
    for axis in range(3):
        # two solvers of one system
        expected = 1.0 / free[point[axis], axis]
        assert budget["deflection"].to_numpy()[axis] == pytest.approx(expected, rel=1e-7)


def test_a_budget_needs_the_machine_of_its_map() -> None:
    machine = Proposed3PPRS()
    found = stiffness_map(machine, hemisphere(machine, lattice=1), [0.0], workers=1)
    with pytest.raises(ModelError, match="not a stiffness map of this machine"):
        budget_map(replace(machine, link_length=0.22), found)
