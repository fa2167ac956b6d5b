"""The tip of a tool: modes, receptances from a computation and from a measurement."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from strutwork.cutting import (
    Frame,
    TipModes,
    TipResponse,
    computed_response,
    measured_response,
    oriented,
)
from strutwork.errors import ModelError
from strutwork.fea import FrequencyResponse, LossFactor, ModalRatio, Port
from strutwork.fea.modal import STATIC_SHARE, ModalModel
from strutwork.fea.uff import FrfRecord, UniversalFile
from strutwork.fea.uff_read import read_universal
from strutwork.fea.uff_write import write_universal
from tests.cutting_cases import bull_nose, mill_tip

LINES = np.linspace(10.0, 2000.0, 200)
PORTS = tuple(Port("tip", d) for d in "xyz")


def model(damping: object = None) -> ModalModel:
    rng = np.random.default_rng(4)
    square = 1.0 / (2.0 * np.pi * np.array([[300.0, 700.0, 9000.0]])) ** 2
    residues = 1e-4 * rng.normal(size=(1, 3, 3)) * np.array([1.0, 1.0, 0.005])
    return ModalModel(
        PORTS,
        residues,
        square,
        np.zeros((1, 3, 0)),
        damping or ModalRatio(0.02),  # type: ignore[arg-type]
    )


def test_modes_of_a_structure_have_its_receptance() -> None:
    given = model()
    modes = TipModes.from_model(given, 0, None, 10_000.0)
    np.testing.assert_allclose(
        modes.receptance(LINES).receptance, given.receptance(LINES)[0], rtol=1e-9, atol=1e-18
    )
    turned = TipModes.from_model(given, 0, Frame.feed(0.3), 10_000.0)
    np.testing.assert_allclose(turned.shapes, modes.turned(0.3).shapes)


def test_a_mode_far_above_the_band_is_brought_nearer_with_its_compliance() -> None:
    given = model()
    modes = TipModes.from_model(given, 0, None, 1000.0)
    # the one at 9000 Hz would take steps that the band does not need
    np.testing.assert_allclose(np.abs(modes.poles) / (2 * np.pi), [300.0, 700.0, 4000.0])
    assert 0.0 < modes.residual_share < 1.0 - STATIC_SHARE
    assert modes.turned(0.3).residual_share == modes.residual_share
    assert TipModes.from_model(given, 0, None, 10_000.0).residual_share == 0.0
    still = modes.receptance([0.0, 1.0]).receptance[0]
    np.testing.assert_allclose(still.real, given.static_compliance[0], rtol=1e-9, atol=1e-16)


def test_motions_without_mass_keep_their_compliance() -> None:
    """A spring between the tool and a machine that has all the mass: half of the compliance."""
    given = model()
    square = np.append(given.square, [[0.0]], axis=1)
    residues = np.append(given.residues, np.array([[[1e-4], [0.0], [0.0]]]), axis=2)
    given = replace(given, square=square, residues=residues)
    modes = TipModes.from_model(given, 0, None, 1000.0)
    lines = np.array([0.0, 100.0, 290.0, 500.0])
    found, expected = modes.receptance(lines).receptance, given.receptance(lines)[0]
    np.testing.assert_allclose(found[0].real, expected[0].real, rtol=1e-9, atol=1e-16)
    # brought from infinity to four times the band: 1/(1 − 1/64) at half of it, and its damping
    assert np.abs(found - expected).max() < 0.02 * 1e-8
    assert modes.residual_share > 0.1


@pytest.mark.parametrize(
    ("given", "highest", "message"),
    [
        (model(), 100.0, "have none up to 100 Hz"),
        (model(LossFactor(0.02)), 1000.0, "loss factor"),
        (
            ModalModel(
                PORTS, np.ones((1, 3, 1)), np.ones((1, 1)), np.ones((1, 3, 1)), ModalRatio(0.1)
            ),
            1000.0,
            "rigid-body mode",
        ),
    ],
)
def test_a_structure_without_what_stability_needs(
    given: ModalModel, highest: float, message: str
) -> None:
    with pytest.raises(ModelError, match=message):
        TipModes.from_model(given, 0, None, highest)


def test_a_computed_response_takes_a_pose_and_a_frame() -> None:
    h = np.stack([bull_nose(real=False).receptance(LINES).receptance] * 2)
    response = FrequencyResponse(LINES, h, PORTS, PORTS, h[:, 0].real, "", "modal", 4, 1.0)
    frame = Frame.along((1.0, 0.0, 0.0), (0.2, 1.0, 0.0))
    found = computed_response(response, (1,), frame)
    # feed along y, across it z
    np.testing.assert_allclose(found.receptance[:, 0, 0], h[1, :, 1, 1])
    np.testing.assert_allclose(found.receptance[:, 2, 2], h[1, :, 0, 0])
    with pytest.raises(ModelError, match="several poses"):
        computed_response(response)


def test_turning_the_feed_turns_modes_and_response_alike() -> None:
    modes = bull_nose(real=False)
    np.testing.assert_allclose(
        modes.turned(0.7).receptance(LINES).receptance,
        modes.receptance(LINES).turned(0.7).receptance,
        atol=1e-18,
    )


def measured(tmp_path: Path, *pairs: str) -> UniversalFile:
    """Accelerances of pairs of directions, through a file."""
    h = mill_tip(2).turned(0.4).receptance(LINES).receptance
    records = [
        FrfRecord(
            ("tool", a),
            ("tool", b),
            LINES,
            -((2.0 * np.pi * LINES) ** 2) * h[:, "xyz".index(a), "xyz".index(b)],
            "acceleration",
        )
        for a, b in pairs
    ]
    file = tmp_path / "tip.uff"
    write_universal(file, UniversalFile(tuple(records), (), {"tool": (0.0, 0.0, 0.0)}))
    return read_universal(file)


def test_a_measured_response_is_read_from_a_universal_file(tmp_path: Path) -> None:
    found = measured_response(measured(tmp_path, "xx", "xy", "yy").functions, "tool")
    expected = mill_tip(2).turned(0.4).receptance(LINES).receptance
    scale = np.abs(expected).max()
    np.testing.assert_allclose(found.receptance, expected, atol=1e-6 * scale)
    assert found.source == "measured, without xz, yz, zz"


def test_a_measurement_that_does_not_do(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="no function of a direction"):
        measured_response(measured(tmp_path, "xy").functions, "tool")
    with pytest.raises(ModelError, match="functions are at: tool"):
        measured_response(measured(tmp_path, "xx").functions, "spindle")
    one = measured(tmp_path, "xx").functions[0]
    with pytest.raises(ModelError, match="twice"):
        measured_response([one, one], "tool")
    short = FrfRecord(("tool", "y"), ("tool", "y"), LINES[:9], one.values[:9], "acceleration")
    with pytest.raises(ModelError, match="other frequencies"):
        measured_response([one, short], "tool")


@pytest.mark.parametrize(
    "make",
    [
        lambda: TipModes.from_modes([], [], np.zeros((0, 3))),
        lambda: TipModes.from_modes([100.0], [0.0], [[1, 0, 0]]),
        lambda: TipModes.from_modes([100.0], [1.0], [[1, 0, 0]]),
        lambda: TipModes.from_modes([100.0], [0.1], [[1, 0]]),
        lambda: TipModes([1j], [[1, 0, 0]], [[1, 0, 0]]),
        lambda: TipModes([-1 + 1j], [[np.nan, 0, 0]], [[1, 0, 0]]),
        lambda: TipResponse([1.0], np.zeros((1, 3, 3))),
        lambda: TipResponse([2.0, 1.0], np.zeros((2, 3, 3))),
        lambda: TipResponse([1.0, 2.0], np.full((2, 3, 3), np.nan)),
        lambda: Frame(np.eye(3)[[1, 0, 2]]),
        lambda: Frame.along((0, 0, 1), (0, 0, 2)),
        lambda: Frame.along((0, 0, 0), (1, 0, 0)),
    ],
)
def test_faulty_tips_are_refused(make: object) -> None:
    with pytest.raises(ModelError):
        make()  # type: ignore[operator]


def test_an_oriented_response_keeps_its_source() -> None:
    assert oriented(mill_tip(1).receptance(LINES), Frame.feed(1.0)).source == "modes"
