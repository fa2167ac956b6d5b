"""Static stiffness of servos in the error sheet, against their closed loops at rest."""

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea import ModalRatio, Port
from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model
from strutwork.servo import closed_loop
from strutwork.studies.error_causes import error_sheet
from strutwork.studies.error_file import parse_errors
from strutwork.studies.error_inputs import DriveError

#: Two slides, one on the other, with a beam to the tool; the second is driven through a screw.
MACHINE = """
[materials.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = 7850
[sections.ram]
shape = "tube"
outer_diameter = 0.05
inner_diameter = 0.03
[nodes]
bed = [0, 0, 0]
table = [0, 0, 0]
post = [0.1, 0, 0.2]
head = [0.1, 0, 0.2]
tip = [0.4, 0, 0.1]
[[bodies]]
name = "table"
nodes = ["table", "post"]
mass = 20
inertia = [[0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]]
[[beams]]
name = "ram"
from = "head"
to = "tip"
material = "steel"
section = "ram"
elements = 2
[[joints]]
name = "x"
type = "prismatic"
between = ["bed", "table"]
axis = [1, 0, 0]
driven = ["z"]
FIRST
[[joints]]
name = "y"
type = "prismatic"
between = ["post", "head"]
axis = [0, 1, 0]
driven = ["z"]
stiffness = { z = "80 N/um" }
[[supports]]
node = "bed"
fixed = "all"
[tool]
tcp = "tip"
[[servos]]
joint = "x"
direction = "z"
position_gain = 50
velocity_gain = 2e5
motor_mass = 30
INTEGRAL
[[servos]]
joint = "y"
direction = "z"
position_gain = 40
velocity_gain = 3e5
motor_mass = 30
encoder = "ENCODER"
"""
FORCE = (80.0, 120.0, -50.0)


def machine(first: str = "", integral: str = "", encoder: str = "motor") -> Model:
    text = MACHINE.replace("FIRST", first).replace("INTEGRAL", integral)
    return parse_model(text.replace("ENCODER", encoder))


def sheet_of(model: Model, more: str = ""):
    text = f'[[cutting]]\nname = "cut"\nforce = {list(FORCE)}\n{more}'
    return error_sheet(model, parse_errors(text, "test", model))


ELASTIC = 'stiffness = { z = "60 N/um" }'


@pytest.mark.parametrize("encoder", ["motor", "load"])
@pytest.mark.parametrize("integral", ["", 'integral_time = "20 ms"'], ids=["P", "PI"])
@pytest.mark.parametrize("first", ["", ELASTIC], ids=["rigid", "elastic"])
def test_the_sheet_is_the_closed_loop_at_rest(first: str, integral: str, encoder: str) -> None:
    """K_v K_p of every drive, infinite with integral action: the loop at zero frequency."""
    model = machine(first, integral, encoder)
    ports = [Port("tip", d) for d in ("x", "y", "z")]
    loop = closed_loop(model.placed, model.servos, ports, ModalRatio(0.02))
    expected = loop.receptance([0.0])[0].real @ FORCE
    found = sheet_of(model)
    np.testing.assert_allclose(found.mean[:3], expected, rtol=1e-6)
    assert bool(found.notes) is bool(integral)


def test_integral_action_at_the_joint_takes_back_what_the_screw_yields() -> None:
    model = machine(ELASTIC, 'integral_time = "20 ms"\nencoder = "load"')
    found = sheet_of(model)
    ports = [Port("tip", d) for d in ("x", "y", "z")]
    loop = closed_loop(model.placed, model.servos, ports, ModalRatio(0.02))
    np.testing.assert_allclose(
        found.mean[:3], loop.receptance([0.0])[0].real @ FORCE, rtol=1e-5, atol=1e-12
    )
    (row,) = [r for r in found.rows if r.part == "servo of x:z"]
    np.testing.assert_allclose(row.mean[0], -FORCE[0] / 60e6, rtol=1e-5)
    assert "x:z have integral action and measure the joint" in found.notes[0]


def test_what_the_errors_file_gives_goes_before_the_servos() -> None:
    model = machine()
    rows = {r.part: r.mean for r in sheet_of(model).rows}
    np.testing.assert_allclose(rows["servo of x:z"][0], FORCE[0] / (50 * 2e5), rtol=1e-9)
    entry = '[[drives]]\njoint = "x"\ndirection = "z"\n'
    rows = {r.part: r.mean for r in sheet_of(model, f'{entry}servo_stiffness = "4 N/um"').rows}
    np.testing.assert_allclose(rows["servo of x:z"][0], FORCE[0] / 4e6, rtol=1e-9)
    assert "servo of y:z" in rows
    assert [r.part for r in sheet_of(model, "[model]\nservos = false").rows] == ["cut"]
    only = sheet_of(model, f"{entry}servo = true\n[model]\nservos = false")
    assert [r.part for r in only.rows] == ["cut", "servo of x:z"]
    without = sheet_of(model, f"{entry}servo = false")
    assert [r.part for r in without.rows] == ["cut", "servo of y:z"]


def test_a_servo_that_is_not_there_is_named() -> None:
    text = MACHINE[: MACHINE.index("[[servos]]")].replace("FIRST", "")
    entry = '[[drives]]\njoint = "x"\ndirection = "z"\nservo = true'
    with pytest.raises(ModelError, match="servo of x:z, which the model does not have"):
        sheet_of(parse_model(text), entry)
    with pytest.raises(ModelError, match="gives servo_stiffness and servo"):
        sheet_of(machine(), f"{entry}\nservo_stiffness = 1e6")
    with pytest.raises(ModelError, match="servo stiffness -1"):
        DriveError("x", "z", servo_stiffness=-1.0)
