"""Parts of a model file follow their bodies: a moved file is the file written anew there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.errors import ModelError
from strutwork.fea import modes
from strutwork.kinematics.motion import Motion
from strutwork.machines.model_file import parse_model
from strutwork.msa import LoadCase, solve, tool_compliance
from strutwork.msa.mass import mass_properties
from strutwork.overconstraint.sources import misfit_sources

AXIS = np.array([1.0, 2.0, 2.0]) / 3.0


def written(turn: np.ndarray) -> str:
    """A turntable with everything on it that has axes, turned about its spindle."""

    def v(*vector: float) -> str:
        return str([float(x) for x in turn @ np.array(vector)])

    def up(*vector: float) -> str:
        # what a beam takes by default at home, said
        return "" if np.array_equal(turn, np.eye(3)) else f"orientation = {v(*vector)}"

    inertia = turn @ np.diag([1e-3, 2e-3, 2.5e-3]) @ turn.T
    return f"""
[materials.steel]
youngs_modulus = 2.1e11
poissons_ratio = 0.3
density = 7850
[sections.flat]
shape = "rectangle"
width_y = 0.02
height_z = 0.05
[nodes]
G = [0, 0, 0]
A = [0, 0, 0]
B = {v(0.0, 0.0, 0.4)}
C = {v(0.3, 0.1, 0.4)}
D = {v(0.3, 0.1, 0.4)}
E = {v(0.5, 0.0, 0.5)}
T = {v(0.6, 0.1, 0.5)}
[[beams]]
name = "column"
from = "A"
to = "B"
material = "steel"
section = "flat"
elements = 2
{up(0.0, 1.0, 0.0)}
[[beams]]
name = "arm"
from = "B"
to = "C"
material = "steel"
section = "flat"
orientation = {v(0.2, 0.3, 1.0)}
offset_from = {v(0.01, 0.02, 0.03)}
offset_to = {v(0.0, -0.02, 0.01)}
[[beams]]
name = "wrist"
from = "D"
to = "E"
material = "steel"
section = "flat"
{up(0.0, 0.0, 1.0)}
[[bodies]]
name = "head"
nodes = ["E", "T"]
mass = 3.0
center_of_mass = {v(0.55, 0.02, 0.48)}
inertia = {inertia.tolist()}
[[masses]]
node = "C"
mass = 0.5
inertia = {(2 * inertia).tolist()}
[[joints]]
name = "spindle"
type = "revolute"
between = ["G", "A"]
axis = {AXIS.tolist()}
driven = ["rz"]
[[joints]]
name = "guide"
type = "prismatic"
between = ["C", "D"]
axis = {v(0.0, 1.0, 0.0)}
second_axis = {v(1.0, 0.0, 0.0)}
stiffness = {{ rx = 2e4, x = 1e7 }}
[[springs]]
between = ["C", "D"]
stiffness = {{ y = 3e6 }}
[[supports]]
node = "G"
fixed = "all"
[tool]
tcp = "T"
[[tolerances]]
name = "seat"
kind = "location"
joint = "guide"
size = 1e-4
axis = {v(0.0, 1.0, 0.0)}
along = {v(1.0, 0.0, 1.0)}
length = 0.1
width = 0.05
"""


@pytest.fixture(scope="module")
def moved():
    # a spring between two bodies has axes that only the identity writes: along its own guide
    home = parse_model(written(np.eye(3)))
    motion = Motion(home.structure.linkage, home.placement)
    found = motion.move(joints={("spindle", "rz"): 0.7, ("guide", "z"): 0.0})
    assert found.reached
    return home, replace(home, placement=found.placement)


@pytest.fixture(scope="module")
def anew():
    turn = Rotation.from_rotvec(0.7 * AXIS).as_matrix()
    text = written(turn)
    # what a file cannot say turned: the spring, here a drive of the guide's own direction
    text = text.replace('[[springs]]\nbetween = ["C", "D"]\nstiffness = { y = 3e6 }\n', "")
    text = text.replace(
        "stiffness = { rx = 2e4, x = 1e7 }", "stiffness = { rx = 2e4, x = 1e7, z = 3e6 }"
    )
    return parse_model(text)


@pytest.mark.parametrize("method", ["compiled", "null_space", "saddle_point"])
def test_the_tool_is_as_compliant_as_in_the_file_written_there(moved, anew, method) -> None:
    """1e-9: rounding of the joint frames, times the condition of the beams."""
    there = tool_compliance(moved[1].placed, method=method)
    np.testing.assert_allclose(
        there, tool_compliance(anew.placed), rtol=0, atol=1e-9 * np.abs(there).max()
    )
    home = tool_compliance(moved[0].placed)
    assert np.abs(there - home).max() > 0.1 * np.abs(home).max()


def test_it_vibrates_as_the_file_written_there(moved, anew) -> None:
    here, there = (modes(m.placed, 6).frequencies for m in (moved[1], anew))
    np.testing.assert_allclose(here, there, rtol=1e-8)


def test_it_weighs_as_the_file_written_there(moved, anew) -> None:
    here, there = mass_properties(moved[1].placed), mass_properties(anew.placed)
    np.testing.assert_allclose(here.centre, there.centre, atol=1e-12)
    np.testing.assert_allclose(here.inertia, there.inertia, atol=1e-12)


def test_weight_bends_it_alike(moved, anew) -> None:
    case = LoadCase("gravity", gravity=(0.0, 0.0, -9.81))
    here, there = (solve(m.placed, [case]).displacements for m in (moved[1], anew))
    np.testing.assert_allclose(here, there, rtol=0, atol=1e-9 * np.abs(there).max())


def test_directions_of_tolerances_follow(moved, anew) -> None:
    here, there = (misfit_sources(m.placed, m.tolerances) for m in (moved[1], anew))
    rows = [there.columns.index(pair) for pair in here.columns]
    assert len(rows) == 2
    np.testing.assert_allclose(here.map, there.map[rows], atol=1e-12)


def test_a_turned_batch_has_one_answer_a_pose(moved) -> None:
    """The compiled kernel, pose for pose, against the poses one by one."""
    home = moved[0]
    motion = Motion(home.structure.linkage, home.placement)
    angles = np.linspace(-1.0, 1.0, 5)
    many = motion.move(joints={("spindle", "rz"): angles, ("guide", "z"): 0.0}).placement
    found = tool_compliance(home.structure.at(many))
    for k in range(5):
        one = tool_compliance(home.structure.at(many[k]), method="null_space")
        np.testing.assert_allclose(found[k], one, rtol=0, atol=1e-9 * np.abs(one).max())


SOLID = """
[materials.stone]
youngs_modulus = 5e10
poissons_ratio = 0.2
density = 2900
[nodes]
G = [0, 0, 0]
A = [0, 0, 0]
T = [0.4, 0.1, 0.05]
[[solids]]
name = "arm"
shape = "block"
size = [0.4, 0.2, 0.1]
position = [0, 0, 0]
material = "stone"
cell = 0.1
modes = 6
[[solids.interfaces]]
node = "A"
patch = "-x"
kind = "rigid"
[[solids.interfaces]]
node = "T"
patch = "+x"
[[joints]]
name = "spindle"
type = "revolute"
between = ["G", "A"]
axis = [0.333333333333333, 0.666666666666667, 0.666666666666667]
driven = ["rz"]
[[supports]]
node = "G"
fixed = "all"
[tool]
tcp = "T"
"""


def test_a_solid_turns_with_its_body() -> None:
    """What turns as a whole is the same compliance in axes that turn with it."""
    home = parse_model(SOLID)
    placement = home.motion.move(joints={("spindle", "rz"): 0.7}).placement
    there = replace(home, placement=placement)
    turn = Rotation.from_rotvec(0.7 * AXIS).as_matrix()
    whole = np.kron(np.eye(2), turn)
    here = tool_compliance(home.placed)
    np.testing.assert_allclose(
        tool_compliance(there.placed), whole @ here @ whole.T, atol=1e-9 * np.abs(here).max()
    )
    (solid,) = home.solids
    np.testing.assert_allclose(
        solid.points_at(there.placed), solid.points_at(home.placed) @ turn.T, atol=1e-12
    )
    frequencies = [modes(m.placed, 3).frequencies for m in (home, there)]
    np.testing.assert_allclose(*frequencies, rtol=1e-9)
    # a rigid motion of its nodes is one of its surface, in the axes of the pose
    index = there.structure.mesh_index
    arms = there.placed.positions[[index[n] for n in solid.nodes]]
    spin = np.array([0.1, -0.2, 0.3])
    nodes = np.concatenate([np.cross(spin, arms), np.broadcast_to(spin, arms.shape)], axis=1)
    moved_points = solid.motion(nodes, there.placed)
    np.testing.assert_allclose(
        moved_points, np.cross(spin, solid.points_at(there.placed)), atol=1e-9
    )


def test_a_joint_that_slides_on_a_solid_is_refused() -> None:
    text = SOLID.replace('type = "revolute"', 'type = "prismatic"').replace(
        'between = ["G", "A"]', 'between = ["A", "G"]'
    )
    text = text.replace('driven = ["rz"]', 'driven = ["z"]')
    with pytest.raises(ModelError, match=r"joint spindle: slides on node .A., which is tied"):
        _ = parse_model(text).motion
