"""All roots of polynomials, beside those of NumPy's companion matrices."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.kinematics.polynomial_roots import all_roots


@pytest.mark.parametrize("spread", [0.0, 3.0, 8.0])
def test_roots_of_many_sizes(spread: float) -> None:
    random = np.random.default_rng(3)
    for _ in range(50):
        sizes = 10.0 ** random.uniform(-spread / 2, spread / 2, 16)
        wanted = sizes * np.exp(2j * np.pi * random.uniform(size=16))
        poly = np.poly(wanted)[::-1].astype(complex)
        found = np.empty(16, dtype=complex)
        assert all_roots(np.ascontiguousarray(poly), found)
        gaps = np.abs(found[:, None] / wanted - 1.0)
        # every root has one that is it, as well as the coefficients tell
        assert gaps.min(axis=0).max() < 1e-6
        assert gaps.min(axis=1).max() < 1e-6


def test_a_double_root_is_found_twice() -> None:
    wanted = np.array([1.0, 1.0, -2.0, 3j])
    found = np.empty(4, dtype=complex)
    all_roots(np.ascontiguousarray(np.poly(wanted)[::-1].astype(complex)), found)
    assert np.sum(np.abs(found - 1.0) < 1e-6) == 2
