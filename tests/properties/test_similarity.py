"""Similar structures: stiffness grows with the size, frequencies with its inverse.

Random frames of beams and joints. Tolerance of the exponents 1e-9: a size between two and ten
divides the rounding of an answer, 1e-16 times a condition of 1e5 to 1e8, by its logarithm.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from strutwork.fea import modes
from strutwork.msa import axis_stiffness_free, tool_compliance
from strutwork.studies.similarity import ROLLERS, SIMILAR, JointScaling, scaled
from tests.random_frames import random_frame

seeds = st.integers(0, 2**32 - 1)
sizes = st.floats(2.0, 10.0) | st.floats(0.1, 0.5)


@settings(max_examples=15, deadline=None)
@given(seeds, sizes, st.booleans())
def test_exponents_of_random_frames(seed: int, size: float, joints: bool) -> None:
    here = random_frame(seed, joints=joints).place()
    there = scaled(here, size)
    ratio = axis_stiffness_free(tool_compliance(there)) / axis_stiffness_free(tool_compliance(here))
    assert np.log(ratio) / np.log(size) == pytest.approx([1, 1, 1, 3, 3, 3], abs=1e-9)
    first, second = modes(here, 6), modes(there, 6)
    assert np.array_equal(first.rigid_body_modes, second.rigid_body_modes)
    elastic = first.frequencies > 0
    assume(np.any(elastic))
    slope = np.log(second.frequencies[elastic] / first.frequencies[elastic]) / np.log(size)
    assert slope == pytest.approx(-np.ones_like(slope), abs=1e-9)


@settings(max_examples=15, deadline=None)
@given(seeds, sizes, sizes, st.sampled_from([SIMILAR, ROLLERS, JointScaling(0.3, 1.1)]))
def test_two_sizes_one_after_the_other_are_their_product(
    seed: int, one: float, other: float, law: JointScaling
) -> None:
    here = random_frame(seed, joints=True).place()
    twice, once = scaled(scaled(here, one, law), other, law), scaled(here, one * other, law)
    # powers of products are a few roundings apart; joints that lag behind a frame fifty times as
    # large make its compliance as much worse conditioned
    a, b = tool_compliance(twice), tool_compliance(once)
    scale = np.sqrt(np.einsum("ii->i", b))
    assert np.abs((a - b) / np.outer(scale, scale)).max() < 1e-7
    for left, right in zip(
        twice.structure.linkage.joints, once.structure.linkage.joints, strict=True
    ):
        assert dict(left.stiffness) == pytest.approx(dict(right.stiffness), rel=1e-12)
    for mine, yours in zip(twice.structure.beams, once.structure.beams, strict=True):
        assert mine.properties == pytest.approx(yours.properties, rel=1e-12)
