"""Loads of parts that expand, against closed forms and whole machines."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model
from strutwork.msa import system_of
from strutwork.msa.nodal_response import nodal_displacements
from strutwork.msa.thermal_loads import Expansion, expandable, thermal_loads
from strutwork.studies.error_causes import error_sheet
from strutwork.studies.error_inputs import ErrorInputs
from strutwork.studies.error_temperatures import temperature_of

MACHINES = Path(__file__).parents[2] / "examples" / "machines"

E, ALPHA, CHANGE = 200e9, 12e-6, 10.0

PARTS = f"""
[materials.steel]
youngs_modulus = {E}
poissons_ratio = 0.3
density = 7800
[sections.bar]
shape = "rectangle"
width_y = 0.02
height_z = 0.03
"""

BAR = f"""{PARTS}
[nodes]
A = [0, 0, 0]
B = [0.8, 0, 0]
[[beams]]
name = "bar"
from = "A"
to = "B"
material = "steel"
section = "bar"
elements = 3
[[supports]]
node = "A"
fixed = "all"
[tool]
tcp = "B"
"""


def heated(model: Model, *parts: str, **given: object) -> np.ndarray:
    inputs = ErrorInputs(
        (temperature_of(model, parts, ALPHA, {}, name="test", **({"change": CHANGE} | given)),)
    )
    return error_sheet(model, inputs).mean


def test_a_free_bar_grows_by_its_strain() -> None:
    expected = [ALPHA * CHANGE * 0.8, 0, 0, 0, 0, 0]
    np.testing.assert_allclose(heated(parse_model(BAR), "bar"), expected, atol=1e-15)


def test_a_bar_with_a_gradient_becomes_an_arc() -> None:
    """κ = α g: a hotter top bends the bar down, as in v = −κ L² / 2 (Przemieniecki 1968)."""
    model = parse_model(BAR)
    k, length = ALPHA * 50.0, 0.8
    # local z is global z, and so is local y
    expected = [0, 0, -k * length**2 / 2, 0, k * length, 0]
    np.testing.assert_allclose(
        heated(model, "bar", change=0.0, gradient=(0.0, 50.0)), expected, atol=1e-14
    )
    expected = [0, -k * length**2 / 2, 0, 0, 0, -k * length]
    np.testing.assert_allclose(
        heated(model, "bar", change=0.0, gradient=(50.0, 0.0)), expected, atol=1e-14
    )


def test_a_bar_between_walls_moves_its_middle_by_the_cold_half() -> None:
    """One of two equal bars in line is heated: the middle moves by half of its growth."""
    text = BAR.replace("B = [0.8, 0, 0]", "B = [0.8, 0, 0]\nC = [1.6, 0, 0]")
    text += """
[[beams]]
name = "cold"
from = "B"
to = "C"
material = "steel"
section = "bar"
[[supports]]
node = "C"
fixed = "all"
"""
    moved = heated(parse_model(text), "bar")
    np.testing.assert_allclose(moved[0], ALPHA * CHANGE * 0.8 / 2, rtol=1e-12)
    np.testing.assert_allclose(moved[1:], 0.0, atol=1e-15)


def test_a_bimetal_strip_bends_as_timoshenko_has_it() -> None:
    """κ = h Δε / (h² + (EI₁ + EI₂)(1/EA₁ + 1/EA₂)) (Timoshenko 1925), two bars joined at ends."""
    h, length = 0.05, 0.6
    text = f"""{PARTS}
[nodes]
base = [0, 0, 0]
low1 = [0, 0, 0]
high1 = [0, 0, {h}]
low2 = [{length}, 0, 0]
high2 = [{length}, 0, {h}]
[[beams]]
name = "low"
from = "low1"
to = "low2"
material = "steel"
section = "bar"
[[beams]]
name = "high"
from = "high1"
to = "high2"
material = "steel"
section = "bar"
elements = 2
[[bodies]]
name = "root"
nodes = ["base", "low1", "high1"]
[[bodies]]
name = "tip"
nodes = ["low2", "high2"]
[[supports]]
node = "base"
fixed = "all"
[tool]
tcp = "low2"
"""
    area, second = 0.02 * 0.03, 0.02 * 0.03**3 / 12
    curvature = h * ALPHA * CHANGE / (h**2 + 2 * E * second * 2 / (E * area))
    moved = heated(parse_model(text), "high")
    # the hot bar lies above: the strip bends down, and its tip turns about +y
    np.testing.assert_allclose(moved[4], curvature * length, rtol=1e-10)
    np.testing.assert_allclose(moved[2], -curvature * length**2 / 2, rtol=1e-10)


def test_a_portal_with_one_heated_leg_tilts_and_sways() -> None:
    """θ = E A w δ / (E A w² + 4 E I), heave δ / 2, sway H θ / 2: legs clamped to a rigid girder."""
    w, height = 0.5, 0.7
    text = f"""{PARTS}
[nodes]
A = [0, 0, 0]
B = [{w}, 0, 0]
C = [0, 0, {height}]
D = [{w}, 0, {height}]
M = [{w / 2}, 0, {height}]
[[beams]]
name = "cold"
from = "A"
to = "C"
material = "steel"
section = "bar"
orientation = [1, 0, 0]
[[beams]]
name = "hot"
from = "B"
to = "D"
material = "steel"
section = "bar"
orientation = [1, 0, 0]
[[bodies]]
name = "girder"
nodes = ["C", "M", "D"]
[[supports]]
node = "A"
fixed = "all"
[[supports]]
node = "B"
fixed = "all"
[tool]
tcp = "M"
"""
    area, second = 0.02 * 0.03, 0.02 * 0.03**3 / 12
    growth = ALPHA * CHANGE * height
    tilt = area * w * growth / (area * w**2 + 4 * second)
    moved = heated(parse_model(text), "hot")
    # the leg at +x grows: the girder turns about −y and sways to −x
    expected = [-height * tilt / 2, 0, growth / 2, 0, -tilt, 0]
    np.testing.assert_allclose(moved, expected, rtol=1e-9, atol=1e-15)


def test_a_machine_that_expands_everywhere_is_its_own_image() -> None:
    """Beams, a solid and rigid bodies of one strain: all moves away from the foot that is held."""
    model = load(str(MACHINES / "gantry.toml"))
    system = system_of(model.placed)
    strain = 1e-4
    parts = [Expansion(part, strain) for part in expandable(system)]
    found = thermal_loads(system, parts)
    u = (nodal_displacements(system.placed, found.loads, found.gaps) + found.moved).sum(axis=-1)[0]
    linkage = model.structure.linkage
    places = model.placed.placement.positions
    arms = places - places[linkage.node_index["foot1"]]
    nodes = [linkage.node_index[n] for n in model.nodes]
    np.testing.assert_allclose(u[nodes, :3], strain * arms[nodes], atol=1e-11)
    np.testing.assert_allclose(u[nodes, 3:], 0.0, atol=1e-11)


def test_drift_is_exponential_in_time() -> None:
    model = parse_model(BAR)
    t = temperature_of(model, ["bar"], ALPHA, {}, name="bar", change=CHANGE, time_constant=600.0)
    inputs = ErrorInputs((t,), time=300.0, moments=(600.0,))
    sheet = error_sheet(model, inputs)
    grown = ALPHA * CHANGE * 0.8
    np.testing.assert_allclose(sheet.mean[0], grown * (1 - np.exp(-0.5)), rtol=1e-12)
    ((moment, moved),) = sheet.drift
    assert moment == 600.0
    np.testing.assert_allclose(moved[0], grown * (1 - np.exp(-1.0)), rtol=1e-12)


def test_a_spread_is_an_interval() -> None:
    model = parse_model(BAR)
    t = temperature_of(model, ["bar"], ALPHA, {}, name="bar", change=CHANGE, spread=2.0)
    sheet = error_sheet(model, ErrorInputs((t,)))
    half = ALPHA * 2.0 * 0.8
    np.testing.assert_allclose(sheet.half_range[0], half, rtol=1e-12)
    np.testing.assert_allclose(sheet.deviation[0], half / np.sqrt(3), rtol=1e-12)
    np.testing.assert_allclose(sheet.worst[0], ALPHA * 12.0 * 0.8, rtol=1e-12)


def test_what_does_not_fit_is_named() -> None:
    model = parse_model(BAR)
    with pytest.raises(ModelError, match=r'unknown part "baar".\nDid you mean "bar"'):
        temperature_of(model, ["baar"], ALPHA, {}, name="t")
    with pytest.raises(ModelError, match="steel has no coefficient of expansion"):
        temperature_of(model, ["bar"], None, {"granite": 7e-6}, name="t")
    with pytest.raises(ModelError, match="spread"):
        replace(temperature_of(model, ["bar"], ALPHA, {}, name="t"), spread=-1.0)
    body = load(str(MACHINES / "gantry.toml"))
    with pytest.raises(ModelError, match="gradient across a beam, and it is no beam"):
        heated(body, "spindle", change=0.0, gradient=(1.0, 0.0))
