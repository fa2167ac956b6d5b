"""Numbers beside their scale: rounding is shown as 0, everything else stays."""

from __future__ import annotations

import numpy as np

from strutwork.reports.numbers import (
    clean,
    matrix_without_rounding,
    six_without_rounding,
    without_rounding,
)


def test_numbers_of_one_kind_are_compared_with_their_largest() -> None:
    np.testing.assert_array_equal(without_rounding([2.6e7, -0.0065, 0.3]), [2.6e7, 0.0, 0.3])
    # alone they are what they are, until it is known what they were made from
    np.testing.assert_array_equal(without_rounding([1.9e-12]), [1.9e-12])
    np.testing.assert_array_equal(without_rounding([1.9e-12], scale=100.0), [0.0])
    # infinite values set no scale
    np.testing.assert_array_equal(without_rounding([np.inf, 5.0, 1e-12]), [np.inf, 5.0, 0.0])
    assert without_rounding([]).shape == (0,)
    assert clean([1.0, 3e-17, -2.0]) == "1.00, 0, −2.00"


def test_moments_are_compared_with_forces_times_the_length() -> None:
    table = [[1e5, 2.0, 1e-7, 3e-10, 0.0, -1e-9]]
    # moments that are all rounding of 1e5 N at 0.5 m
    np.testing.assert_array_equal(
        six_without_rounding(table, 0.5), [[1e5, 2.0, 0.0, 0.0, 0.0, 0.0]]
    )
    # a true moment beside them stays
    table[0][4] = 1e-3
    assert six_without_rounding(table, 0.5)[0, 4] == 1e-3
    # a table of rounding beside the loads of its case
    rounding = [[1e-10, 0.0, 0.0, 0.0, 2e-12, 0.0]]
    assert not six_without_rounding(rounding, 0.5, [[400.0, 0, 0, 0, 2.0, 0]]).any()
    assert six_without_rounding(np.zeros((0, 6)), 1.0).shape == (0, 6)


def test_a_matrix_is_compared_with_its_diagonal() -> None:
    matrix = np.diag([2.6e7, 2.6e7, 2.6e7, 1e2, 1e2, 1e2])
    matrix[0, 1] = matrix[1, 0] = -0.0065
    matrix[0, 4] = matrix[4, 0] = 0.5
    found = matrix_without_rounding(matrix)
    assert found[0, 1] == found[1, 0] == 0.0
    # small beside the largest, yet not beside its own row and column
    assert found[0, 4] == 0.5
