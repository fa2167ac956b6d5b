"""A milling cut as a cause of displacement: its mean by statics, its harmonics by responses."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.cutting.described import described_frame, described_milling
from strutwork.cutting.forces import cutting_force
from strutwork.errors import ModelError
from strutwork.fea import ModalRatio, frequency_response
from strutwork.fea.ports import Port
from strutwork.machines.load import load
from strutwork.machines.model_file import parse_model
from strutwork.machines.process_file import known_errors
from strutwork.msa import tool_compliance
from strutwork.studies.error_causes import error_sheet
from strutwork.studies.error_file import parse_errors, read_errors
from strutwork.studies.error_milling import MillingCut, milling_forces
from tests.tool_against import column_and_table, column_text

PROCESS = """
[process]
diameter = "20 mm"
teeth = 4
helix = "30 deg"
material = "aluminium-7075-t6"
immersion = 0.5
feed_per_tooth = "0.1 mm"
axis = [0, 0, 1]
feed = [0, 1, 0]
speeds = { from = "1500 rpm", to = "9000 rpm", points = 31 }
"""

MILLING = '[milling]\ndepth = "0.2 mm"\nspeed = "3000 rpm"\nharmonics = 2\n'


def test_the_forces_are_those_of_the_cut_by_the_angle() -> None:
    model = parse_model(column_text(None) + PROCESS, "column.toml")
    assert model.process is not None
    found = milling_forces(model, MillingCut(2e-4, 100 * np.pi, harmonics=300), model.placement)
    angles = np.linspace(0, np.pi / 2, 720, endpoint=False)
    axes = described_frame(model.process, model.rotation).matrix
    force = cutting_force(described_milling(model.process), 2e-4, 1e-4, angles) @ axes
    np.testing.assert_allclose(found.frequencies[:2], [200.0, 400.0])
    phase = np.exp(1j * np.outer(4 * angles, np.arange(1, 301)))
    again = found.mean + (phase @ found.amplitudes).real
    assert np.abs(again - force).max() < 0.02 * np.abs(force).max()


@pytest.mark.parametrize("against", [None, "table"])
def test_the_rows_are_static_and_harmonic_responses(against: str | None) -> None:
    model = parse_model(column_text(against) + PROCESS, "column.toml")
    sheet = error_sheet(model, parse_errors(MILLING, "errors.toml", model)).of("cutting")
    forces = milling_forces(model, MillingCut(2e-4, 100 * np.pi, harmonics=2), model.placement)
    rows = {row.part: row for row in sheet.rows}
    assert list(rows) == ["milling, mean", "milling, 200 Hz", "milling, 400 Hz"]
    static = tool_compliance(model.placed)[:, :3] @ forces.mean
    np.testing.assert_allclose(rows["milling, mean"].mean, static, rtol=1e-8, atol=1e-15)
    ports = [Port("tip", d, against, carried=against is not None) for d in "xyz"]
    response = frequency_response(
        model.placed, ports, ports, [200.0], ModalRatio(0.02), "all_modes"
    ).receptance[0]
    expected = np.abs(response @ forces.amplitudes[0])
    np.testing.assert_allclose(rows["milling, 200 Hz"].worst[:3], expected, rtol=1e-6)


def test_a_machine_without_a_process_is_refused() -> None:
    model = column_and_table(None)
    with pytest.raises(ModelError, match=r"milling.*no process"):
        parse_errors(MILLING, "errors.toml", model)


@pytest.mark.parametrize("name", ["mit-ss1", "eclipse-3pprs", "eclipse-prototype"])
def test_assumed_causes_of_catalogue_machines(name: str) -> None:
    model = load(name)
    entry = {"mit-ss1": "errors-mit-ss1"}.get(name, "errors-eclipse")
    inputs = read_errors(known_errors(entry), model)
    assert inputs.source.startswith("Assumed, because")
    sheet = error_sheet(model, inputs)
    assert sheet.causes == ("geometry", "gravity", "thermal", "cutting", "drives", "ground")
    # of the order of machine tools: more than a micrometre, less than a millimetre
    assert 1e-6 < np.linalg.norm(sheet.largest()) < 1e-3


def test_a_tolerance_of_both_files_is_refused() -> None:
    model = load("examples/machines/3-rps.toml")
    text = '[[tolerances]]\nname = "place of ball 1"\nkind = "point_position"\njoint = "ball1"\n'
    with pytest.raises(ModelError, match=r"place of ball 1.*defined twice"):
        parse_errors(text + 'size = "1 um"\n', "errors.toml", model)
