"""Sobol indices of functions whose variance is known by parts.

@inproceedings{ishigami1990,
  title     = {An importance quantification technique in uncertainty analysis for computer models},
  author    = {Ishigami, T. and Homma, T.},
  booktitle = {First International Symposium on Uncertainty Modeling and Analysis},
  year      = {1990},
  note      = {pp. 398--403}
}
@book{saltelli2004,
  title     = {Sensitivity Analysis in Practice},
  author    = {Saltelli, Andrea and Tarantola, Stefano and Campolongo, Francesca and Ratto, Marco},
  publisher = {Wiley},
  year      = {2004},
  note      = {p. 196: variances of the function by parts}
}
"""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.studies.parameter import Parameter
from strutwork.studies.sample import Sample
from strutwork.studies.sobol_blocks import block_shares
from strutwork.studies.sobol_indices import indices
from strutwork.studies.study import Study
from tests.gradients import CANTILEVER
from tests.ishigami import closed_form, ishigami

pytest.importorskip("SALib")


def test_ishigamis_function() -> None:
    wanted = closed_form()
    shares = block_shares(2048, 3, 5, second_order=True)
    found = indices(ishigami((2 * shares - 1) * np.pi), 3, second_order=True)
    assert found.dropped == ()
    # the 95 % interval at 2048 blocks is 0.03 at most
    np.testing.assert_allclose(found.first, wanted["first"], atol=0.02)
    np.testing.assert_allclose(found.total, wanted["total"], atol=0.02)
    pairs = found.second[np.triu_indices(3, 1)]
    # a pair is the difference of three estimates
    np.testing.assert_allclose(pairs, wanted["second"], atol=0.03)
    # the variance shares of a function sum to one
    assert found.first.sum() + pairs.sum() == pytest.approx(1.0, abs=0.03)


def test_intervals_hold_the_closed_form() -> None:
    """Of six intervals of 95 % one in four times one would miss: three standard deviations."""
    wanted = closed_form()
    shares = block_shares(2048, 3, 5, second_order=False)
    found = indices(ishigami((2 * shares - 1) * np.pi), 3, second_order=False)
    assert np.all(np.abs(found.first - wanted["first"]) < 1.53 * found.first_confidence)
    assert np.all(np.abs(found.total - wanted["total"]) < 1.53 * found.total_confidence)


def test_the_stiffness_of_a_cantilever_of_scattering_size() -> None:
    """k = 3EI/L³ is a product: with e = Var(x)/E(x)² of each factor, S_i = e_i / (Π(1 + e) − 1)."""
    modulus, diameter = ("180 GPa", "240 GPa"), ("29 mm", "31 mm")
    study = Study.of(
        CANTILEVER,
        [
            Parameter("materials.steel.youngs_modulus", low=modulus[0], high=modulus[1]),
            Parameter("sections.bar.diameter", low=diameter[0], high=diameter[1]),
        ],
        sample=Sample("saltelli", 32, 1),
        workspace={},
    )
    found = study.run(workers=1).sel(answer="stiffness_free_home z")
    a, b = 180e9, 240e9
    first = ((b - a) ** 2 / 12) / ((a + b) / 2) ** 2
    low, high = 0.029, 0.031

    def moment(power: int) -> float:
        return (high ** (power + 1) - low ** (power + 1)) / ((power + 1) * (high - low))

    second = moment(8) / moment(4) ** 2 - 1.0
    variance = (1 + first) * (1 + second) - 1
    # the intervals of 32 blocks are 0.2; Sobol's points of a smooth function are far nearer
    np.testing.assert_allclose(
        found["sobol_first"], np.array([first, second]) / variance, atol=0.02
    )
    np.testing.assert_allclose(
        found["sobol_total"],
        np.array([first * (1 + second), second * (1 + first)]) / variance,
        atol=0.02,
    )
