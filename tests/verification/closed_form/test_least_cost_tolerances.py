"""Tolerances of least cost in closed form, for a reciprocal cost and one limit.

@article{chase1988,
  author = {Chase, Kenneth W. and Greenwood, William H.},
  title = {Design Issues in Mechanical Tolerance Analysis},
  journal = {Manufacturing Review}, volume = {1}, number = {1}, pages = {50--59}, year = {1988}
}

By Lagrange's multiplier, Σ cₛ/tₛ under Σ aₛ tₛ = L is least at tₛ = L √(cₛ/aₛ) / Σ √(cᵣ aᵣ), and
is (Σ √(cₛ aₛ))² / L there.
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.overconstraint import allocate, sensitivity, worst_case
from tests.three_struts import TILT, case


@pytest.mark.parametrize("costs", [(1.0, 1.0, 1.0), (5.0, 1.0, 0.2)])
def test_one_axial_limit(costs: tuple[float, float, float]) -> None:
    responses = case()
    limit, key = 1e3, ("joint1", "axial force")
    found = allocate(
        responses, {key: limit}, "cost", dict(zip(("axis1", "axis2", "axis3"), costs, strict=True))
    )
    a = sensitivity(worst_case(responses)).slopes[responses.index(*key)] * TILT
    c = np.array(costs)
    # the certificate of the cost is 2e-9; a size is known to its root
    assert found.cost == pytest.approx(np.sqrt(c * a).sum() ** 2 / limit, rel=1e-8)
    assert np.allclose(found.scale, limit * np.sqrt(c / a) / np.sqrt(c * a).sum(), rtol=1e-4)
    assert found.gap is not None
    assert found.gap < 1e-8
