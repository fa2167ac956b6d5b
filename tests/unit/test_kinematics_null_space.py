"""Null spaces of stacks, also where LAPACK's faster method gives up."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from strutwork.kinematics.motion_spaces import null_space


def test_a_matrix_that_does_not_converge_is_done_by_the_older_method(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    random = np.random.default_rng(5)
    # ranks 3 and 4 of six columns
    rows = np.stack([random.normal(size=(5, r)) @ random.normal(size=(r, 6)) for r in (3, 4)])
    expected = null_space(rows, share=1e-10)
    plain = np.linalg.svd

    def gives_up(matrices: Any) -> Any:
        if any(np.array_equal(m, rows[1]) for m in matrices):
            raise np.linalg.LinAlgError("SVD did not converge")
        return plain(matrices)

    monkeypatch.setattr(np.linalg, "svd", gives_up)
    found = null_space(rows, share=1e-10)
    for one, other, rank, of in zip(found, expected, (3, 4), rows, strict=True):
        kept = one[:, np.abs(one).max(axis=0) > 0]
        assert kept.shape[1] == 6 - rank
        np.testing.assert_allclose(of @ kept, 0.0, atol=1e-12)
        np.testing.assert_allclose(one @ one.T, other @ other.T, atol=1e-12)
