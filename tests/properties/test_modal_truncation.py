"""A receptance from few modes against all of them, for any residues, damping and band."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from strutwork.fea.damping import Damping, LossFactor, ModalRatio, Rayleigh
from strutwork.fea.modal import ModalModel
from strutwork.fea.modal_truncation import TRUNCATED, truncated_receptance
from strutwork.fea.ports import Port
from strutwork.fea.rounding import uncoupled

PORTS = (Port("a", "x"), Port("a", "y"), Port("b", "x"))


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    modes=st.integers(1, 60),
    poses=st.integers(1, 2),
    highest=st.floats(1.0, 3000.0),
    apart=st.floats(-6.0, 0.0),
    damping=st.sampled_from([ModalRatio(0.02), LossFactor(0.1), Rayleigh(1.0, 1e-4)]),
)
def test_the_error_is_within_its_bound_and_the_bound_within_the_tolerance(
    seed: int, modes: int, poses: int, highest: float, apart: float, damping: Damping
) -> None:
    random = np.random.default_rng(seed)
    frequencies = np.sort(10.0 ** random.uniform(1.0, 4.0, (poses, modes)), axis=1)
    residues = random.normal(size=(poses, 3, modes)) * 10.0 ** random.uniform(-2, 0, modes)
    # a port that hardly answers the others, by modes of its own
    lonely = random.random(modes) < 0.3
    residues[:, 2] *= np.where(lonely, 1.0, 10.0**apart)
    residues[:, :2] *= np.where(lonely, 10.0**apart, 1.0)
    model = ModalModel(
        PORTS,
        residues,
        1.0 / (2 * np.pi * frequencies) ** 2,
        np.zeros((poses, 3, 0)),
        damping,
    )
    lines = np.linspace(0.0, highest, 40)
    expected = model.receptance(lines)
    found, bound, _, keep = truncated_receptance(model, lines)
    peak = np.abs(expected).max(axis=1, keepdims=True)
    size = np.sqrt(np.einsum("pfii->pfi", peak))
    rounding = 1e-12 * size[..., :, None] * size[..., None, :]
    assert np.all(np.abs(found - expected) <= bound * (1 + 1e-9) + rounding)
    together = ~uncoupled(expected)[:, None]
    assert np.all((bound <= 1.01 * TRUNCATED * peak) | ~together)
    # what is left out begins well above the band
    assert np.all(frequencies[:, ~keep] > 2.0 * highest)
