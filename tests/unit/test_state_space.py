"""State spaces of structures beside the responses of the same model, and beside python-control."""

from __future__ import annotations

import numpy as np
import pytest

import strutwork as sw
from strutwork.errors import ModelError
from strutwork.fea import LossFactor, ModalRatio, Port, Rayleigh, frequency_response
from strutwork.fea.motor_shapes import Motor
from strutwork.fea.port_states import Observed, state_space
from strutwork.fea.ports import tool_ports
from strutwork.studies.model_damping import model_damping
from tests.drives import MASS, MOTOR, SPRING, looped, servo, slide
from tests.tool_against import column_and_table

GANTRY = "examples/machines/gantry.toml"
FREQUENCIES = np.linspace(1.0, 900.0, 120)


@pytest.fixture(scope="module")
def gantry():
    return sw.load(GANTRY)


def ports(model):
    return [Port(model.tool, axis) for axis in "xyz"]


@pytest.mark.parametrize("damping", [ModalRatio(0.015), Rayleigh(3.0, 2e-5)])
def test_all_modes_give_the_response_of_the_model(gantry, damping):
    at = ports(gantry)
    expected = frequency_response(
        gantry.vibrating, at, at, FREQUENCIES, damping, "all_modes"
    ).receptance
    system = state_space(gantry.vibrating, at, at, damping)
    assert system.truncation(900.0) == 0.0
    found = system.response(FREQUENCIES)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * np.abs(expected).max())
    omega = 2.0 * np.pi * FREQUENCIES[:, None, None]
    for quantity, factor in (("velocity", 1j * omega), ("acceleration", -(omega**2))):
        moved = state_space(gantry.vibrating, at, [Observed(p, quantity) for p in at], damping)
        size = np.abs(factor * expected).max()
        np.testing.assert_allclose(
            moved.response(FREQUENCIES), factor * expected, rtol=0, atol=1e-9 * size
        )


def test_a_tool_relative_to_a_workpiece_gives_the_response_of_the_model():
    model = column_and_table("table", "tip")
    at, damping = tool_ports(model.structure.linkage), ModalRatio(0.015)
    assert at[0].carried
    expected = frequency_response(
        model.placed, at, at, FREQUENCIES, damping, "all_modes"
    ).receptance
    found = state_space(model.placed, at, at, damping).response(FREQUENCIES)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9 * np.abs(expected).max())


def test_few_modes_err_by_less_than_they_state(gantry):
    at, damping = ports(gantry), ModalRatio(0.015)
    expected = frequency_response(
        gantry.vibrating, at, at, FREQUENCIES, damping, "all_modes"
    ).receptance
    system = state_space(gantry.vibrating, at, at, damping, modes=20)
    assert len(system.a) == 40
    assert "20 of 144 modes" in system.kept
    static = np.abs(system.static())
    for highest in (100.0, 400.0):
        within = highest >= FREQUENCIES
        error = (np.abs(system.response(FREQUENCIES) - expected)[within] / static).max()
        assert 0.5 * error < system.truncation(highest)
        assert np.diagonal(np.abs(system.response(FREQUENCIES) - expected)[within], 0, 1, 2).max(
            axis=0
        ) / np.diag(static) == pytest.approx(0.0, abs=1.05 * system.truncation(highest))
    assert system.truncation(900.0) == np.inf


def test_dashpots_couple_modes_and_stay_in_the_equations():
    model = sw.load("examples/08_column_on_mounts.toml")
    damping = model_damping(model)
    at = ports(model)
    # below half of the cutoff of its solid
    lines = FREQUENCIES[FREQUENCIES < 400.0]
    expected = frequency_response(model.vibrating, at, at, lines, damping).receptance
    found = state_space(model.vibrating, at, at, damping).response(lines)
    # both divide by squares that reach from the lines to the highest mode, some 1e8 times: what
    # rounding leaves differs from processor to processor, up to 3e-9 seen
    np.testing.assert_allclose(found, expected, rtol=0, atol=3e-8 * np.abs(expected).max())


def test_a_loss_factor_becomes_viscous_damping_with_its_loss_at_resonance(gantry):
    at = ports(gantry)
    lossy = state_space(gantry.vibrating, at, at, LossFactor(0.03))
    viscous = state_space(gantry.vibrating, at, at, ModalRatio(0.015))
    assert lossy.modes.equivalent
    np.testing.assert_allclose(lossy.a, viscous.a, rtol=1e-12)


def test_a_motor_pushes_the_mass_that_it_is_free_to_move():
    motor = Motor("slide", "z", MOTOR)
    found = state_space(slide().placed, [motor], [motor, Port("carriage", "x")], ModalRatio(0.0))
    s = 2j * np.pi * np.array([1.0, 50.0])
    expected = 1.0 / ((MASS + MOTOR) * s**2)
    np.testing.assert_allclose(found.response([1.0, 50.0])[:, 0, 0], expected, rtol=1e-12)
    elastic = state_space(slide(elastic=True).placed, [motor], [motor], ModalRatio(0.0))
    poles = np.sort(np.abs(elastic.poles))
    assert poles[:2] == pytest.approx([0.0, 0.0], abs=1e-3)
    assert poles[2] == pytest.approx(np.sqrt(SPRING * (1.0 / MASS + 1.0 / MOTOR)), rel=1e-12)


def test_what_cannot_be_asked(gantry):
    at, damping = ports(gantry), ModalRatio(0.01)
    with pytest.raises(ModelError, match="ports"):
        state_space(gantry.vibrating, [], at, damping)
    with pytest.raises(ModelError, match="unknown quantity"):
        Observed(at[0], "jerk")
    with pytest.raises(ModelError, match="at least one"):
        state_space(gantry.vibrating, at, at, damping, modes=0)
    motor = Motor("slide", "z", MOTOR)
    drifting = state_space(slide().placed, [motor], [motor], ModalRatio(0.0))
    with pytest.raises(ModelError, match="pole at zero"):
        drifting.static()


def test_python_control_computes_the_same(gantry):
    control = pytest.importorskip("control")
    at = ports(gantry)
    system = state_space(gantry.vibrating, at, at, ModalRatio(0.015), modes=12)
    theirs = system.to_control()
    assert theirs.nstates == 24
    response = theirs(2j * np.pi * FREQUENCIES)
    np.testing.assert_allclose(
        np.moveaxis(response, -1, 0), system.response(FREQUENCIES), rtol=1e-7, atol=1e-18
    )
    for pole in control.poles(theirs):
        assert np.abs(system.poles - pole).min() < 1e-9 * abs(pole)


@pytest.mark.filterwarnings("ignore:invalid value:RuntimeWarning:control")
def test_python_control_closes_the_same_loop():
    control = pytest.importorskip("control")
    drive = servo(delay=4e-4, order=2)
    found = looped(slide(elastic=True), drive, 0.01)
    s = control.tf("s")
    motor = Motor("slide", "z", MOTOR)
    plant = state_space(slide(elastic=True).placed, [motor], [motor], ModalRatio(0.01)).to_control()
    gains = drive.velocity_gain * (1 + 1 / (drive.integral_time * s))
    delay = control.tf(*control.pade(drive.delay, drive.order))
    forward = control.ss(gains * delay) * plant
    # velocity and position from the same output of the plant
    loop = control.tf(forward) * (s + drive.position_gain)
    theirs = control.feedback(loop, 1).poles()
    ours = np.array([p.value for p in found.poles])
    for pole in ours:
        assert np.abs(theirs - pole).min() < 1e-5 * abs(pole) + 1e-6
    (margins,) = found.margins
    for opened, mine in (
        (found.connected.velocity_loop(0), margins.velocity),
        (found.connected.position_loop(0), margins.position),
    ):
        gain, phase, _, gain_at, phase_at, _ = control.stability_margins(opened.to_control())
        assert mine.gain == pytest.approx(gain, rel=1e-5)
        assert mine.gain_frequency == pytest.approx(gain_at / (2 * np.pi), rel=1e-5)
        assert np.degrees(mine.phase) == pytest.approx(phase, rel=1e-5)
        assert mine.phase_frequency == pytest.approx(phase_at / (2 * np.pi), rel=1e-5)
