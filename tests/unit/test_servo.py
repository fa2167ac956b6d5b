"""Closed loops of drives: closed forms, limits, and what cannot be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigvals

import strutwork as sw
from strutwork.errors import ModelError, ValidityWarning
from strutwork.fea import ModalRatio, PartDamping, Port, minimum_dynamic_stiffness
from strutwork.machines.load import load
from strutwork.machines.model_file import parse_model
from strutwork.machines.servos import Servo
from strutwork.servo import UnstableLoopError, closed_loop
from strutwork.studies.servo_loop import machine_loop
from tests.drives import MASS, MOTOR, SLIDE, SPRING, cascade, looped, servo, slide

BAND = (1.0, 2000.0)


def poles_of(found):
    upper = np.array([pole.value for pole in found.poles])
    both = np.concatenate([upper, upper[upper.imag > 0].conj()])
    return both[np.lexsort((both.imag, np.abs(both)))]


def roots_of(polynomial):
    roots = np.roots(polynomial)
    return roots[np.lexsort((roots.imag, np.abs(roots)))]


def closed_form(control, *, elastic):
    """Characteristic polynomial of the carriage, of the motor's or the load's encoder."""
    above, below = cascade(control)
    speed = np.array([1.0, 0.0])
    if not elastic:
        return np.polyadd(
            np.polymul(below, [MASS + MOTOR, 0.0, 0.0]),
            np.polymul(above, [1.0, control.position_gain]),
        )
    load = np.array([MASS, 0.0, SPRING])
    own = np.polysub(np.polymul([MOTOR, 0.0, SPRING], load), [SPRING**2])
    if control.encoder == "motor":
        fed = np.polymul(load, [1.0, control.position_gain])
    else:
        fed = np.polyadd(np.polymul(speed, load), [SPRING * control.position_gain])
    return np.polyadd(np.polymul(below, own), np.polymul(above, fed))


@pytest.mark.parametrize("time", [0.02, None])
@pytest.mark.parametrize(
    ("elastic", "encoder"), [(False, "motor"), (True, "motor"), (True, "load")]
)
def test_poles_are_the_roots_of_the_characteristic_polynomial(elastic, encoder, time):
    control = servo(encoder=encoder, integral_time=time)
    found = poles_of(looped(slide(elastic=elastic), control))
    expected = roots_of(closed_form(control, elastic=elastic))
    np.testing.assert_allclose(found, expected, rtol=1e-9)


def test_dynamic_stiffness_of_one_mass_is_that_of_its_formula():
    control = servo()
    found = looped(slide(), control)
    frequencies = np.array([1.0, 10.0, 100.0])
    s = 2j * np.pi * frequencies
    kp, kv, time = control.velocity_gain, control.position_gain, control.integral_time
    formula = (MASS + MOTOR) * s**2 + kp * (1.0 + 1.0 / (time * s)) * (kv + s)
    np.testing.assert_allclose(1.0 / found.receptance(frequencies)[:, 0, 0], formula, rtol=1e-10)
    (least,) = found.least(BAND)
    fine = np.geomspace(*BAND, 200_001)
    s = 2j * np.pi * fine
    curve = np.abs((MASS + MOTOR) * s**2 + kp * (1.0 + 1.0 / (time * s)) * (kv + s))
    assert least.value == pytest.approx(curve.min(), rel=1e-7)
    assert least.certified
    # integral action lets nothing yield for ever
    assert least.static == np.inf


def test_static_stiffness_without_integral_action_is_the_product_of_the_gains_in_series():
    control = servo(integral_time=None)
    spring = control.position_gain * control.velocity_gain
    assert control.static_stiffness == spring
    assert looped(slide(), control).least(BAND)[0].static == pytest.approx(spring, rel=1e-9)
    motor = looped(slide(elastic=True), control).least(BAND)[0]
    assert motor.static == pytest.approx(1.0 / (1.0 / spring + 1.0 / SPRING), rel=1e-9)
    load = looped(slide(elastic=True), replace(control, encoder="load")).least(BAND)[0]
    # what is measured at the load leaves the transmission out of the position loop
    assert load.static == pytest.approx(spring, rel=1e-9)


def test_very_high_gains_give_the_machine_with_its_drives_locked():
    model = slide(elastic=True)
    stiff = servo(position_gain=1e4, velocity_gain=1e10, inertia=1.0, integral_time=None)
    found = looped(model, stiff, 0.02)
    frequencies = np.linspace(1.0, 400.0, 50)
    locked = found.locked.response(frequencies)
    np.testing.assert_allclose(found.receptance(frequencies), locked, rtol=1e-4)
    least = minimum_dynamic_stiffness(model.placed, [Port("carriage", "x")], ModalRatio(0.02), BAND)
    assert found.least_locked(BAND)[0].value == pytest.approx(float(least.value[0]), rel=1e-9)
    assert found.least(BAND)[0].value == pytest.approx(float(least.value[0]), rel=1e-3)


def test_a_dashpot_of_the_transmission_is_between_motor_and_carriage():
    control, dashpot = servo(), 3e3
    model = slide(elastic=True, dashpot=dashpot)
    found = closed_loop(model.placed, [control], [Port("carriage", "x")], PartDamping())
    above, below = cascade(control)
    across = np.array([dashpot, SPRING])
    load = np.polyadd([MASS, 0.0, 0.0], across)
    own = np.polysub(
        np.polymul(np.polyadd([MOTOR, 0.0, 0.0], across), load), np.polymul(across, across)
    )
    polynomial = np.polyadd(
        np.polymul(below, own), np.polymul(above, np.polymul(load, [1.0, control.position_gain]))
    )
    np.testing.assert_allclose(poles_of(found), roots_of(polynomial), rtol=1e-9)


def test_an_unstable_loop_is_named_and_has_no_dynamic_stiffness():
    found = looped(slide(elastic=True), servo(delay=5e-3, velocity_gain=2e4), 0.01)
    assert not found.stable
    assert any(pole.damping < 0 for pole in found.unstable)
    with pytest.raises(UnstableLoopError, match=r"unstable: .*Hz"):
        found.least(BAND)
    with pytest.raises(UnstableLoopError):
        found.receptance([10.0])


def test_the_gain_margin_is_where_the_loop_becomes_unstable():
    control = servo(delay=4e-4, order=3)
    found = looped(slide(elastic=True), control, 0.01)
    assert found.stable
    (margins,) = found.margins
    gain = margins.position.gain
    for factor, stable in ((0.999, True), (1.001, False)):
        at = replace(control, position_gain=factor * gain * control.position_gain)
        assert looped(slide(elastic=True), at, 0.01).stable is stable
    # the phase by which the velocity loop may lag is a delay at the crossing
    assert 0.0 < margins.velocity.phase < np.pi


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"position_gain": -1.0}, "position_gain"),
        ({"velocity_gain": 0.0}, "velocity_gain"),
        ({"integral_time": -0.1}, "integral_time"),
        ({"delay": -1e-3}, "delay"),
        ({"inertia": float("nan")}, "inertia"),
        ({"order": 0}, "pade_order"),
        ({"encoder": "table"}, "encoder"),
    ],
)
def test_wrong_numbers_of_a_controller(changed, words):
    with pytest.raises(ModelError, match=words):
        servo(**changed)


def test_a_drive_that_is_not_driven_or_unknown():
    model, port = slide(), [Port("carriage", "x")]
    for joint, direction, words in (("slide", "x", "not driven"), ("slid", "z", "unknown joint")):
        wrong = Servo(joint, direction, 50.0, 6e3)
        with pytest.raises(ModelError, match=words):
            closed_loop(model.placed, [wrong], port, ModalRatio(0.01))


def test_a_motor_without_inertia_beyond_its_transmission():
    with pytest.raises(ModelError, match="no inertia"):
        looped(slide(elastic=True), servo(inertia=0.0))
    # without a transmission the carriage's mass is the motor's too
    assert looped(slide(), servo(inertia=0.0)).stable


def test_nothing_to_control_and_nowhere_to_look():
    model = slide()
    with pytest.raises(ModelError, match="servos"):
        closed_loop(model.placed, [], [Port("carriage", "x")], ModalRatio(0.01))
    with pytest.raises(ModelError, match="ports"):
        closed_loop(model.placed, [servo()], [], ModalRatio(0.01))
    with pytest.raises(ModelError, match="does not move"):
        closed_loop(model.placed, [servo()], [Port("carriage", "y")], ModalRatio(0.01))


def test_no_frequency_reaches_a_level_below_the_least_dynamic_stiffness():
    """A level is reached at imaginary eigenvalues (Boyd and Balakrishnan 1990)."""
    found = looped(slide(elastic=True), servo(delay=4e-4), 0.01)
    (least,) = found.least((0.01, 1e5))
    tool = found.tool
    assert not np.any(tool.d)
    for factor, reached in ((1.0 + 1e-4, True), (1.0 - 1e-4, False)):
        level = 1.0 / (factor * least.value)
        # of inputs and outputs of one size
        b, c = tool.b / np.sqrt(level), tool.c / np.sqrt(level)
        pencil = np.block([[tool.a, b @ b.T], [-c.T @ c, -tool.a.T]])
        values = eigvals(pencil)
        on_axis = np.abs(values.real) < 1e-7 * np.abs(values)
        assert bool(on_axis.any()) is reached


@pytest.mark.parametrize("name", ["mit-ss1", "examples/machines/6-ups.toml"])
def test_parallel_machines_with_very_high_gains_are_those_with_locked_drives(name):
    """Drives without stiffness, and drives with a transmission each under a preload."""
    model = sw.load(name)
    driven = [(j.name, d) for j in model.structure.linkage.joints for d in j.driven]
    stiff = [Servo(joint, d, 1e4, 1e9, inertia=1.0) for joint, d in driven]
    ports = [Port(model.tool, axis) for axis in "xyz"]
    found = closed_loop(model.vibrating, stiff, ports, ModalRatio(0.01), highest=2000.0)
    assert found.stable
    frequencies = np.linspace(1.0, 300.0, 60)
    locked = found.locked.response(frequencies)
    off = np.abs(found.receptance(frequencies) - locked).max() / np.abs(locked).max()
    assert off < 1e-3


def test_rigid_drives_that_hold_one_another_are_named():
    text = SLIDE.format(elastic="", more="")
    second = text[text.index("[[joints]]") : text.index("[[supports]]")].replace("slide", "other")
    model = parse_model(text.replace("[[supports]]", second + "[[supports]]"))
    both = [servo(), replace(servo(), joint="other")]
    with pytest.raises(ModelError, match="hold one another"):
        closed_loop(model.placed, both, [Port("carriage", "x")], ModalRatio(0.01))


def test_a_band_beyond_what_a_solid_holds_to_is_said():
    model = load("examples/machines/gantry.toml")
    with pytest.warns(ValidityWarning, match="bed"):
        machine_loop(model, band=(1.0, 5000.0))
