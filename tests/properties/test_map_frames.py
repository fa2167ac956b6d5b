"""A machine that stands askew is as stiff, as near to singularities and as locked as upright.

Through the survey of poses that `map` runs: filters, Jacobians, compiled kernel, what is locked.
Tolerance: compliances of these machines keep nine digits (condition up to 1e6), and turning a pose
by a matrix good to 1e-16 changes a condition number by as much as itself times rounding.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.kinematics import Linkage, Placement, Poses
from strutwork.machines import HexelHexapod, Limit, MitSS1, Proposed3PPRS
from strutwork.msa import Structure
from strutwork.studies import Filters, sweep

Array = NDArray[Any]

MACHINES: dict[str, Any] = {
    "three legs": Proposed3PPRS(),
    "hexapod": HexelHexapod(),
    # five axes: two directions of the tool are locked but for its struts
    "planar": MitSS1(),
}
turns = st.lists(st.floats(-3, 3), min_size=3, max_size=3).map(
    lambda v: Rotation.from_rotvec(v).as_matrix()
)


@dataclass(frozen=True)
class Askew:
    """A machine turned about the origin as a whole."""

    base: Any
    turn: tuple[tuple[float, ...], ...]

    @property
    def matrix(self) -> Array:
        return np.array(self.turn)

    @property
    def linkage(self) -> Linkage:
        return self.base.linkage

    @property
    def structure(self) -> Structure:
        beams = [
            b
            if b.orientation is None or isinstance(b.orientation, str)
            else replace(b, orientation=tuple(self.matrix @ b.orientation))
            for b in self.base.structure.beams
        ]
        return replace(self.base.structure, beams=tuple(beams))

    @property
    def limits(self) -> tuple[Limit, ...]:
        return self.base.limits

    def home(self) -> Poses:
        return self.there(self.base.home())

    def skeleton(self) -> Sequence[tuple[str, str]]:
        return self.base.skeleton()

    def there(self, poses: Poses) -> Poses:
        return Poses(poses.position @ self.matrix.T, self.matrix @ poses.rotation)

    def place(self, poses: Poses) -> Placement:
        q = self.matrix
        here = self.base.place(Poses(poses.position @ q, q.T @ poses.rotation))
        return replace(here, positions=here.positions @ q.T, frames=q @ here.frames)


@settings(max_examples=12, deadline=None)
@given(turns)
@pytest.mark.parametrize("name", MACHINES)
def test_a_survey_of_a_machine_askew(name: str, turn: Array) -> None:
    base = MACHINES[name]
    askew = Askew(base, tuple(map(tuple, turn.tolist())))
    home = base.home()
    away = np.array([[0, 0, 0], [0.004, 0, 0], [0, 0, 0.003], [5.0, 0, 0]])
    positions = home.position + away
    filters = Filters(length=0.1)
    upright = sweep(base, positions, filters=filters, workers=1)
    found = sweep(askew, positions @ turn.T, filters=filters, workers=1)
    assert found["status"].to_numpy().tolist() == upright["status"].to_numpy().tolist()
    condition = upright["condition_number"].to_numpy()
    np.testing.assert_allclose(found["condition_number"].to_numpy(), condition, rtol=1e-7)
    both = np.kron(np.eye(2), turn)
    expected = both @ upright["compliance"].to_numpy() @ both.T
    largest = np.nanmax(np.abs(expected[:3]))
    gap = np.abs(found["compliance"].to_numpy() - expected)
    assert np.nanmax(gap) < 1e-8 * largest
    assert np.isfinite(gap[:3]).all()
