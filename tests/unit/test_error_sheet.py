"""The error sheet against solves, frequency responses and plain sampling."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea import ModalRatio, Port, frequency_response
from strutwork.fea.ground_vibration import GroundSpectrum, ground_vibration
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model
from strutwork.msa import LoadCase, solve
from strutwork.studies.accuracy_answer import VolumetricAccuracy, drive_errors
from strutwork.studies.error_answer import ErrorSheets, axis_errors
from strutwork.studies.error_causes import error_sheet
from strutwork.studies.error_file import parse_errors, read_errors
from strutwork.studies.error_inputs import CuttingForce, DriveError, ErrorInputs
from strutwork.studies.error_servos import with_servos
from strutwork.studies.error_sheet import ErrorRow, ErrorSheet

EXAMPLES = Path(__file__).parents[2] / "examples"

ALONE = ErrorInputs(geometry=False, gravity=False)


@cache
def machine(name: str) -> Model:
    return load(str(EXAMPLES / "machines" / f"{name}.toml"))


@cache
def gantry_sheet() -> ErrorSheet:
    model = machine("gantry")
    return error_sheet(model, read_errors(EXAMPLES / "errors" / "gantry.toml", model))


def test_gravity_by_parts_adds_to_the_ordinary_solve() -> None:
    model = machine("gantry")
    sheet = error_sheet(model, ErrorInputs(geometry=False)).of("gravity")
    found = solve(model.placed, [model.case("gravity")])
    expected = found.displacement(model.tool or "", "gravity")
    np.testing.assert_allclose(sheet.mean, expected, atol=1e-12 * np.abs(expected).max())
    assert {row.part for row in sheet.rows} >= {"ram", "bed", "carriage", "spindle"}


def test_drives_carry_the_weight_below_them() -> None:
    forces = dict(gantry_sheet().drive_forces)
    beam = 7850 * 0.2 * (0.09**2 - 0.066**2)
    # ram and spindle hang on the drive z, with the carriage before it
    np.testing.assert_allclose(abs(forces["z:z"]), (beam + 10) * 9.80665, rtol=1e-6)


def test_servos_in_series_do_what_a_softer_machine_does() -> None:
    model = machine("gantry")
    inputs = read_errors(EXAMPLES / "errors" / "gantry.toml", model)
    softer = replace(model, structure=with_servos(model.structure, inputs.drives))
    other = error_sheet(softer, replace(inputs, drives=()))
    np.testing.assert_allclose(gantry_sheet().mean, other.mean, rtol=1e-9, atol=1e-15)
    parts = [row.part for row in gantry_sheet().of("drives").rows]
    assert "servo of x:z" in parts


def test_a_servo_behind_a_rigid_drive_is_a_spring() -> None:
    text = """
[nodes]
A = [0, 0, 0]
B = [0, 0, 0]
C = [0.3, 0, 0]
[[joints]]
name = "slide"
type = "prismatic"
between = ["A", "B"]
axis = [1, 0, 0]
driven = ["z"]
[[bodies]]
name = "table"
nodes = ["B", "C"]
[[supports]]
node = "A"
fixed = "all"
[tool]
tcp = "C"
"""
    model = parse_model(text)
    inputs = ErrorInputs(
        cutting=(CuttingForce("cut", (120.0, 0, 0, 0, 0, 0)),),
        drives=(DriveError("slide", "z", 1e-6, 4e-6, 2e7),),
    )
    sheet = error_sheet(model, inputs)
    np.testing.assert_allclose(sheet.mean[0], 120.0 / 2e7, rtol=1e-12)
    np.testing.assert_allclose(sheet.half_range[0], 0.5e-6 + 2e-6, rtol=1e-12)
    # uniform within the resolution, at either stop of the backlash
    np.testing.assert_allclose(sheet.deviation[0] ** 2, (0.5e-6) ** 2 / 3 + 4e-12, rtol=1e-12)


def test_a_periodic_force_is_the_frequency_response() -> None:
    model = machine("gantry")
    wrench = (30.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    sheet = error_sheet(model, replace(ALONE, cutting=(CuttingForce("teeth", wrench, 180.0),)))
    tool = model.tool or ""
    ports = [Port(tool, d) for d in ("x", "y", "z")]
    response = frequency_response(
        model.placed, ports[:1], ports, [180.0], ModalRatio(0.015), method="all_modes"
    )
    expected = 30.0 * np.abs(response.receptance[0, :, 0])
    found = sheet.of("cutting")
    np.testing.assert_allclose(found.half_range[:3], expected, rtol=1e-9, atol=1e-15)
    np.testing.assert_allclose(found.deviation[:3], expected / np.sqrt(2), rtol=1e-9, atol=1e-15)


def _oscillator(frequency: float) -> Model:
    mass = 5.0
    k = mass * (2 * np.pi * frequency) ** 2
    return parse_model(f"""
[nodes]
A = [0, 0, 0]
[[springs]]
node = "A"
stiffness = {{ x = {k}, y = {k}, z = {k}, rx = 1e5, ry = 1e5, rz = 1e5 }}
[[masses]]
node = "A"
mass = {mass}
inertia = [0.01, 0.01, 0.01]
[damping]
modal_ratio = 0.01
[tool]
tcp = "A"
""")


@pytest.mark.parametrize("ratio", [0.001, 0.01, 0.1])
def test_white_noise_shakes_an_oscillator_as_the_closed_form_has_it(ratio: float) -> None:
    """σ² = S / (8 ζ ω³) relative to the ground, S one-sided per Hz (Crandall and Mark 1963)."""
    model = _oscillator(40.0)
    density = 3e-6
    spectrum = GroundSpectrum("x", (1e-3, 1e5), (density, density))
    found = ground_vibration(model.placed, [spectrum], ModalRatio(ratio))
    omega = 2 * np.pi * 40.0
    expected = density / (8 * ratio * omega**3)
    # the band leaves out a share of ζ · 1e-4 or so
    np.testing.assert_allclose(found.covariance[0, 0, 0], expected, rtol=1e-4)
    np.testing.assert_allclose(found.covariance[0, 1:, 1:], 0.0, atol=1e-6 * expected)
    np.testing.assert_allclose(found.cumulative[0, -1, 0] ** 2, expected, rtol=1e-4)
    assert np.all(np.diff(found.cumulative[0, :, 0]) >= 0)


def test_a_slow_ground_shakes_quasi_statically() -> None:
    """Far below the mode the relative motion is a / ω₀², for a spectrum that falls as f⁻²."""
    model = _oscillator(400.0)
    f = np.array([1.0, 4.0])
    spectrum = GroundSpectrum("z", tuple(f), tuple(1e-4 / f**2))
    found = ground_vibration(model.placed, [spectrum], ModalRatio(0.01))
    expected = 1e-4 * (1 - 1 / 4) / (2 * np.pi * 400.0) ** 4
    np.testing.assert_allclose(found.covariance[0, 2, 2], expected, rtol=3e-4)
    assert "ends at 4 Hz, below the first mode" in found.note


def test_a_six_ups_budget_against_plain_sampling() -> None:
    """The totals against draws of every error with the ordinary random numbers of a program."""
    model = machine("6-ups")
    drives = tuple(DriveError(j, d, 4e-6, 3e-6) for j, d in model.structure.linkage.driven)
    inputs = ErrorInputs(drives=drives, gravity=False)
    sheet = error_sheet(model, inputs)
    columns = model.structure.linkage.driven
    matrix = VolumetricAccuracy((), drive_errors(model, 1.0)).at(model.placed).transmission
    generator = np.random.default_rng(5)
    draws = 200_000
    misfit = generator.uniform(-2e-6, 2e-6, (draws, len(columns)))
    misfit += generator.choice([-1.5e-6, 1.5e-6], (draws, len(columns)))
    moved = misfit @ matrix.T
    only = sheet.of("drives")
    np.testing.assert_allclose(only.deviation, moved.std(axis=0), rtol=0.01)
    np.testing.assert_allclose(only.within(), np.quantile(np.abs(moved), 0.95, axis=0), rtol=0.02)
    assert np.all(np.abs(moved).max(axis=0) <= only.worst * (1 + 1e-12))
    np.testing.assert_allclose(only.worst, 3.5e-6 * np.abs(matrix).sum(axis=1), rtol=1e-9)


def test_totals_are_those_of_the_rows() -> None:
    sheet = gantry_sheet()
    rows = sheet.rows
    np.testing.assert_allclose(sheet.mean, sum(r.mean for r in rows), rtol=1e-12)
    np.testing.assert_allclose(sheet.half_range, sum(r.half_range for r in rows), rtol=1e-12)
    np.testing.assert_allclose(sheet.deviation**2, sum(r.deviation**2 for r in rows), rtol=1e-12)
    assert np.all(sheet.within() <= sheet.worst)
    assert np.linalg.norm(sheet.largest()) >= sheet.worst[:3].max()
    assert sheet.causes == ("geometry", "gravity", "thermal", "cutting", "drives", "ground")


def test_the_workpiece_takes_its_own_motion_away() -> None:
    """Relative to the tool's own node nothing moves; to another, the difference of both."""
    model = machine("gantry")
    inputs = read_errors(EXAMPLES / "errors" / "gantry.toml", model)
    still = error_sheet(model, replace(inputs, against=model.tool))
    np.testing.assert_allclose(still.worst, 0.0, atol=1e-14)
    case = LoadCase("gravity", gravity=(0.0, 0.0, -9.80665))
    found = solve(model.placed, [case])
    places = model.placed.placement.positions
    index = model.structure.linkage.node_index
    bed, tool = found.displacement("rail1", "gravity"), found.displacement("TCP", "gravity")
    arm = places[index["TCP"]] - places[index["rail1"]]
    expected = tool - bed
    expected[:3] -= np.cross(bed[3:], arm)
    relative = error_sheet(model, replace(inputs, against="rail1")).of("gravity").mean
    np.testing.assert_allclose(relative, expected, rtol=1e-9, atol=1e-15)


def test_an_axis_and_a_workspace_have_the_sheets_of_their_poses() -> None:
    model = machine("gantry")
    inputs = read_errors(EXAMPLES / "errors" / "gantry.toml", model)
    along = axis_errors(model, inputs, "x", np.array([-0.1, 0.0, 0.1]))
    assert along.names == ("EXX", "EYX", "EZX", "EAX", "EBX", "ECX")
    np.testing.assert_allclose(along.half_range[1], gantry_sheet().half_range, rtol=1e-9)
    np.testing.assert_allclose(along.errors[0, [0, 3, 4, 5]], 0.0)
    # straightness is what a straight line leaves
    np.testing.assert_allclose(along.errors[:, 1:3].sum(axis=0), 0.0, atol=1e-16)
    answer = ErrorSheets(model, inputs)
    placement = model.placed.placement
    batch = model.structure.at(placement[None])
    arrays, outcome = answer(batch)
    assert np.all(outcome.solved)
    np.testing.assert_allclose(arrays["worst_case"][0], gantry_sheet().worst, rtol=1e-9)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('[[temperatures]]\npart = "ram"\nchange = "2 K"', "steel has no coefficient of expansion"),
        ('[[temperatures]]\npart = "rom"\nchange = 2\nexpansion = 1e-5', 'unknown part "rom"'),
        ('[[temperatures]]\nmaterial = "steal"\nchange = 2', "of which no part is made"),
        ('[[temperatures]]\npart = "ram"\nchange = "2 mm"', "is not a difference of temperature"),
        ('[[temperatures]]\npart = "ram"\nchange = "2 degC"', "is not a difference"),
        ('[[temperatures]]\nchange = "2 K"', "neither part, parts nor material"),
        ('[[temperature]]\npart = "ram"', "temperatures"),
        ('[[drives]]\njoint = "x"\ndirection = "z"\nbacklash = "-2 um"', "out of range"),
        ('[[drives]]\njoint = "xx"\ndirection = "z"\nbacklash = "2 um"', 'unknown drive "xx:z"'),
        ('[[drives]]\njoint = "x"\ndirection = "z"', "states no error"),
        (
            '[[ground]]\ndirection = "x"\nfrequencies = [1, 2]\ndensity = [1e-6, -1e-6]',
            "out of range",
        ),
        ('[[ground]]\ndirection = "x"\nfrequencies = [1, 2]\ndensity = [1e-6]', "as many of both"),
        ('[[ground]]\ndirection = "x"\nfrequencies = [2, 1]\ndensity = [1, 1]', "do not rise"),
        ('[tool]\nagainst = "tabel"', 'unknown node "tabel"'),
        ("[nodes]\nA = [0, 0, 0]", "is a model file"),
    ],
)
def test_wrong_files_are_refused_by_name(text: str, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        parse_errors(text, "errors.toml", machine("gantry"))


def test_wrong_numbers_are_refused() -> None:
    with pytest.raises(ModelError, match="backlash -1e-06"):
        DriveError("x", "z", None, -1e-6)
    with pytest.raises(ModelError, match="a power is not negative"):
        GroundSpectrum("x", (1.0, 2.0), (1.0, -1.0))
    with pytest.raises(ModelError, match="no cause of error"):
        error_sheet(_oscillator(10.0))
    with pytest.raises(ModelError, match="unknown cause"):
        ErrorRow("weather", "rain", np.zeros(6), np.zeros((6, 0)))
    undamped = replace(machine("gantry"), damping=None)
    spectrum = GroundSpectrum("x", (1.0, 2.0), (1.0, 1.0))
    with pytest.raises(ModelError, match="vibrating ground needs it"):
        error_sheet(undamped, replace(ALONE, ground=(spectrum,)))
