"""A pose of a batch gives what it gives alone, redundant joints included."""

from __future__ import annotations

import numpy as np

from strutwork.kinematics import Placement
from strutwork.msa import solve
from tests.structure_cases import LIBRARY


def test_forces_of_redundant_joints_do_not_see_the_other_poses() -> None:
    """The least forces in balance depend on a length: it must be the pose's own."""
    example = LIBRARY["door on two hinges"]()
    alone = example.model.place()
    here = alone.placement
    pair = Placement(
        np.stack([here.positions, 5.0 * here.positions]),
        np.stack([here.frames, here.frames]),
        np.zeros((2, 0)),
    )
    together = alone.structure.at(pair)
    for method in ("saddle_point", "null_space", "condensed"):
        one = solve(alone, example.cases, method)  # type: ignore[arg-type]
        both = solve(together, example.cases, method)  # type: ignore[arg-type]
        largest = np.abs(one.joint_forces).max()
        assert largest > 0
        # the same operations on the same numbers: rounding of another stacking at most
        assert np.abs(both.joint_forces[0] - one.joint_forces).max() <= 1e-12 * largest
