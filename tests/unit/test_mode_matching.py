"""Shares of patterns in modes, on the MIT-SS-1 without its granite."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea.modes import Modes, modes
from strutwork.kinematics import GROUND
from strutwork.machines import MitSS1
from strutwork.msa.mass import mass_properties
from strutwork.studies.mode_matching import matched, pattern_shares

MACHINE = MitSS1(drive_stiffness=1e8)


def found(count: int, tilts: list[float] | float = 0.0) -> Modes:
    placement = MACHINE.place(MACHINE.poses(0.0, 0.0, tilts))
    return modes(MACHINE.structure.at(placement), count)


def translations(at: Modes) -> np.ndarray:
    """Everything that moves, along x, y and z."""
    linkage = MACHINE.linkage
    patterns = np.zeros((3, len(at.placed.structure.mesh_nodes), 6))
    for body in linkage.bodies:
        if body.name != GROUND:
            for name in body.nodes:
                patterns[range(3), linkage.node_index[name], range(3)] = 1.0
    return patterns


def test_a_mode_holds_itself_and_no_other() -> None:
    at = found(6)
    np.testing.assert_allclose(pattern_shares(at, at.shapes), np.eye(6), atol=1e-8)


def test_translations_give_effective_masses() -> None:
    at = found(12)
    total = mass_properties(at.placed).total
    expected = at.effective_mass[:, :3].T / total
    np.testing.assert_allclose(pattern_shares(at, translations(at)), expected, atol=1e-9)


def test_shares_do_not_depend_on_the_pattern_s_size_and_stay_below_one() -> None:
    at = found(12)
    shares = pattern_shares(at, translations(at))
    np.testing.assert_allclose(pattern_shares(at, -7.0 * translations(at)), shares, atol=1e-12)
    assert np.all(shares.sum(axis=-1) <= 1 + 1e-9)


def test_a_batch_is_its_poses() -> None:
    tilts = [-0.3, 0.0, 0.4]
    batch = found(5, tilts)
    together = pattern_shares(batch, translations(batch))
    assert together.shape == (3, 3, 5)
    for i, tilt in enumerate(tilts):
        alone = found(5, tilt)
        np.testing.assert_allclose(
            together[i], pattern_shares(alone, translations(alone)), atol=1e-9
        )


def test_every_pattern_has_a_mode_of_its_own() -> None:
    # the first column is the best of both rows, and the second row loses least elsewhere
    assert matched(np.array([[0.9, 0.1, 0.0], [0.8, 0.0, 0.7]])).tolist() == [0, 2]


def test_a_pattern_that_moves_nothing_is_refused() -> None:
    at = found(3)
    with pytest.raises(ModelError, match="pattern 1: moves no mass"):
        pattern_shares(at, np.stack([at.shapes[0], np.zeros_like(at.shapes[0])]))
