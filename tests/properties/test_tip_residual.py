"""Modes of a tip with those that stand for the others, against the receptance of all modes."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from strutwork.cutting import TipModes
from strutwork.fea.damping import ModalRatio
from strutwork.fea.modal import STATIC_SHARE, ModalModel
from strutwork.fea.pole_residue import PoleModel
from strutwork.fea.ports import Port

PORTS = tuple(Port("tip", d) for d in "xyz")

#: Largest error in the band as a share of the static compliance at the ports, as documented.
BY_MODES, BY_POLES = 1e-3, 5e-3


def tip(seed: int, modes: int, ratio: float) -> ModalModel:
    """The lowest mode at 100 Hz; the others carry less and less, the last has no mass."""
    random = np.random.default_rng(seed)
    above = np.sort(10.0 ** random.uniform(2.0, 5.0, modes))
    frequencies = np.concatenate([[100.0], above])
    residues = random.normal(size=(3, modes + 1)) * (100.0 / frequencies) ** 0.7
    residues[:, 0] = np.abs(residues[:, 0]) + 0.1
    square = 1.0 / (2 * np.pi * frequencies) ** 2
    return ModalModel(PORTS, residues[None], square[None], np.zeros((1, 3, 0)), ModalRatio(ratio))


def by_poles(model: ModalModel) -> PoleModel:
    omega = 1.0 / np.sqrt(model.square[0])
    ratio = 0.5 * model.viscous[0] * omega
    swing = omega * np.sqrt(1.0 - ratio**2)
    poles = -ratio * omega + 1j * swing
    left = model.residues[0] * omega
    right = left / (2j * swing)
    return PoleModel(
        PORTS,
        np.concatenate([poles, poles.conj()]),
        np.concatenate([left, left], axis=1),
        np.concatenate([right, right.conj()], axis=1),
        np.zeros((3, 3)),
        np.zeros((3, 3)),
    )


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 10**6),
    modes=st.integers(1, 40),
    ratio=st.floats(0.002, 0.03),
    highest=st.floats(110.0, 2000.0),
)
def test_statics_are_exact_and_the_band_is_within_the_tolerance(
    seed: int, modes: int, ratio: float, highest: float
) -> None:
    model = tip(seed, modes, ratio)
    lines = np.linspace(1e-6, highest, 60)
    expected = model.receptance(lines)[0]
    own = np.sqrt(np.diag(model.static_compliance[0]))
    size = own[:, None] * own
    for found, tolerance in (
        (TipModes.from_model(model, 0, None, highest), BY_MODES),
        (TipModes.from_poles(by_poles(model), None, highest), BY_POLES),
    ):
        assert found.residual_share <= 1.0 - STATIC_SHARE + 1e-9
        error = np.abs(found.receptance(lines).receptance - expected) / size
        # motions of less than 1e-6 have no mode
        assert error[0].max() < 1e-5
        assert error.max() < tolerance
