"""Robot files: what is read of them, round trips, and files that are wrong or hostile."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError, ModelWarning
from strutwork.kinematics import mobility
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model
from strutwork.machines.robots import model_text, read_robot, robot_of, robot_text
from strutwork.machines.robots.choices import Choices
from strutwork.machines.robots.models import model_of, robot_model
from tests.robots import EXAMPLES

MACHINES = (
    "examples/04_four_bar.toml",
    "examples/10_screws_and_belt.toml",
    "examples/machines/3-rps.toml",
    "examples/machines/6-ups.toml",
    "examples/machines/tricept.toml",
)


def counts(model: Model) -> tuple[int, int, int]:
    found = mobility(model.structure.linkage, model.placement)
    return found.mobility, found.mobility_locked, found.redundant


@pytest.mark.parametrize("ending", [".urdf", ".sdf", ".xml"])
@pytest.mark.parametrize("machine", MACHINES)
def test_a_machine_comes_back_from_every_format(machine: str, ending: str, tmp_path: Path) -> None:
    given = load(machine)
    robot = robot_of(given)
    file = tmp_path / f"robot{ending}"
    file.write_text(robot_text(robot, file), encoding="utf-8")
    back = read_robot(file)
    assert back.mass == pytest.approx(robot.mass, rel=1e-14)
    np.testing.assert_allclose(back.centre, robot.centre, rtol=0, atol=1e-14)
    if robot.tool is not None:
        assert back.tool is not None
        np.testing.assert_allclose(back.tool[1], robot.tool[1], rtol=0, atol=1e-14)
    assert counts(parse_model(model_text(back))) == counts(given)
    driven = sum(f.driven for joint in back.joints for f in joint.freedoms)
    assert driven == len(given.structure.linkage.driven)
    if machine != "examples/10_screws_and_belt.toml":
        # there a link is cut where a screw closes a loop
        assert len(back.links) == len(robot.links)
        kinds = sorted(joint.kind for joint in robot.joints)
        assert sorted(joint.kind for joint in back.joints) == kinds


@pytest.mark.parametrize("ending", [".urdf", ".sdf"])
def test_inertia_and_damping_and_limits_come_back(ending: str, tmp_path: Path) -> None:
    robot = read_robot(EXAMPLES / "arm.urdf")
    file = tmp_path / f"robot{ending}"
    file.write_text(robot_text(robot, file), encoding="utf-8")
    back = {link.name: link for link in read_robot(file).links}
    for link in robot.links:
        np.testing.assert_allclose(back[link.name].inertia, link.inertia, rtol=0, atol=1e-14)
        np.testing.assert_allclose(back[link.name].centre, link.centre, rtol=0, atol=1e-14)
    joints = {joint.name: joint for joint in read_robot(file).joints}
    for joint in robot.joints:
        for one, other in zip(joint.freedoms, joints[joint.name].freedoms, strict=True):
            assert other == one


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("arm.urdf", (6, 0, 0)),
        ("biglide.urdf", (2, 0, 3)),
        ("four_bar.sdf", (1, 0, 3)),
        ("hexapod.xml", (6, 0, 0)),
    ],
)
def test_examples_move_as_they_should(name: str, found: tuple[int, int, int]) -> None:
    robot = read_robot(EXAMPLES / name)
    assert counts(model_of(robot)) == found
    assert robot.tool is not None


def test_an_arm_stands_as_its_file_says() -> None:
    robot = read_robot(EXAMPLES / "arm.urdf")
    assert robot.notes == ()
    assert robot.tool is not None
    assert robot.tool[0] == "spindle"
    second = next(joint for joint in robot.joints if joint.name == "A2")
    # turned by −90° about x: the axis z of the file points along y
    np.testing.assert_allclose(second.axis, [0, 1, 0], atol=1e-15)
    np.testing.assert_allclose(second.place, [0.15, 0, 0.45], atol=1e-15)
    model = robot_model(EXAMPLES / "arm.urdf")
    assert counts(model) == (6, 0, 0)
    drives = {(d.joint, d.speed, d.force) for d in model.drives}
    assert ("A1", 2.5, 900.0) in drives


def test_poses_of_sdf_are_relative_to_what_they_say(tmp_path: Path) -> None:
    file = tmp_path / "robot.sdf"
    file.write_text(
        """<sdf version="1.9"><model name="m"><pose>1 0 0 0 0 0</pose>
        <link name="a"><pose degrees="true">0 2 0 0 0 90</pose>
        <inertial><mass>1</mass></inertial></link>
        <frame name="f" attached_to="a"><pose>0.5 0 0 0 0 0</pose></frame>
        <link name="b"><pose relative_to="f">0 0 3 0 0 0</pose>
        <inertial><pose>0.1 0 0 0 0 0</pose><mass>2</mass>
        <inertia><ixx>1</ixx><iyy>2</iyy><izz>2.5</izz></inertia></inertial></link>
        <joint name="w" type="fixed"><parent>world</parent><child>a</child></joint>
        <joint name="j" type="universal"><pose>0 0 -1 0 0 0</pose><parent>f</parent><child>b</child>
        <axis><xyz expressed_in="__model__">0 0 1</xyz></axis>
        <axis2><xyz>1 0 0</xyz></axis2></joint>
        <joint name="s" type="screw"><parent>a</parent><child>c</child><axis><xyz>0 0 1</xyz></axis>
        <screw_thread_pitch>0.01</screw_thread_pitch></joint>
        <link name="c"><pose rotation_format="quat_xyzw">0 0 0 1 0 0 0</pose></link>
        </model></sdf>""",
        encoding="utf-8",
    )
    robot = read_robot(file)
    links = {link.name: link for link in robot.links}
    joints = {joint.name: joint for joint in robot.joints}
    np.testing.assert_allclose(links["b"].origin, [1, 2.5, 3], atol=1e-15)
    np.testing.assert_allclose(links["b"].centre, [1, 2.6, 3], atol=1e-15)
    # its x axis is y of the world
    np.testing.assert_allclose(links["b"].inertia, np.diag([2, 1, 2.5]), atol=1e-15)
    np.testing.assert_allclose(joints["j"].place, [1, 2.5, 2], atol=1e-15)
    np.testing.assert_allclose(joints["j"].axis, [0, 0, 1], atol=1e-15)
    np.testing.assert_allclose(joints["j"].second, [0, 1, 0], atol=1e-15)
    assert joints["j"].parent == "a"
    assert joints["s"].pitch == 0.01
    # turned by 180° about x
    np.testing.assert_allclose(joints["s"].axis, [0, 0, -1], atol=1e-15)
    assert any("link c has no <inertial>" in note for note in robot.notes)


FEATURES = """<mujoco model="features">
  <compiler angle="degree" eulerseq="ZYx"/>
  <default>
    <joint damping="0.5"/>
    <geom density="2700"/>
    <default class="slider"><joint type="slide" axis="1 0 0" range="-0.1 0.2"/></default>
    <default class="steel"><geom density="7850"/></default>
  </default>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body name="a" pos="0.1 0 0.5" euler="20 -30 40">
      <joint name="j1" axis="0 1 0" pos="0.02 0 0" ref="15"/>
      <geom type="box" size="0.1 0.2 0.05" pos="0.05 0 0" euler="0 10 0"/>
      <geom type="capsule" size="0.03" fromto="0 0 0 0.1 0.2 0.3" class="steel"/>
      <frame pos="0.3 0 0" axisangle="0 0 1 35">
        <body name="b" childclass="slider" xyaxes="0 1 0 -1 0 0">
          <joint name="j2" ref="0.02"/>
          <joint name="j3" type="hinge" axis="0 0 1"/>
          <geom type="cylinder" size="0.05 0.2" zaxis="1 1 0"/>
          <geom type="ellipsoid" size="0.05 0.1 0.07" mass="1.5"/>
          <body name="c" pos="0 0 0.4" quat="0.5 0.5 -0.5 0.5">
            <joint name="j4" class="main" type="ball" pos="0 0 0.01"/>
            <geom type="sphere" size="0.06" pos="0.2 0 0.1" class="steel"/>
            <geom type="box" size="0.02" fromto="0 0 0 0 0.1 0.3"/>
            <site name="tcp" pos="0.3 0.1 0"/>
          </body>
        </body>
      </frame>
    </body>
  </worldbody>
  <actuator><motor joint="j1"/><motor joint="j2"/><motor joint="j3"/></actuator>
</mujoco>"""


def test_defaults_shapes_and_frames_of_mjcf_are_those_of_mujoco(tmp_path: Path) -> None:
    mujoco = pytest.importorskip("mujoco")
    file = tmp_path / "features.xml"
    file.write_text(FEATURES, encoding="utf-8")
    robot = read_robot(file)
    m = mujoco.MjModel.from_xml_path(str(file))
    d = mujoco.MjData(m)
    mujoco.mj_forward(m, d)
    for link in robot.links:
        if link.mass == 0:
            # between the two joints of a body
            continue
        body = m.body(link.name).id
        np.testing.assert_allclose(link.mass, m.body_mass[body], rtol=1e-12)
        np.testing.assert_allclose(link.centre, d.xipos[body], rtol=0, atol=1e-12)
        turn = d.ximat[body].reshape(3, 3)
        inertia = turn @ np.diag(m.body_inertia[body]) @ turn.T
        np.testing.assert_allclose(link.inertia, inertia, rtol=0, atol=1e-10)
    for joint in robot.joints:
        k = m.joint(joint.name).id
        np.testing.assert_allclose(joint.place, d.xanchor[k], rtol=0, atol=1e-12)
        if joint.kind != "spherical":
            np.testing.assert_allclose(joint.axis, d.xaxis[k], rtol=0, atol=1e-12)
            (f,) = joint.freedoms
            assert f.home == pytest.approx(m.qpos0[m.jnt_qposadr[k]], abs=1e-15)
            assert f.damping == 0.5
            assert f.limits == (tuple(m.jnt_range[k]) if m.jnt_limited[k] else None)
    assert robot.tool is not None
    np.testing.assert_allclose(robot.tool[1], d.site_xpos[0], rtol=0, atol=1e-12)


def test_a_loop_that_is_open_at_zero_is_closed() -> None:
    robot = read_robot(EXAMPLES / "biglide.urdf")
    assert "moved" in robot.notes[0]
    places = {joint.name: joint.place for joint in robot.joints}
    for hinge in ("left_hinge", "right_hinge"):
        assert np.linalg.norm(places["pin"] - places[hinge]) == pytest.approx(0.5, abs=1e-9)
    with pytest.warns(ModelWarning, match="moved"):
        assert counts(load(EXAMPLES / "biglide.urdf"))[:2] == (2, 0)


LOOPS = {
    "loop": """<loop name="pin" type="revolute"><predecessor link="left_rod">
        <origin xyz="0 0 -0.5"/></predecessor><successor link="right_rod"><origin xyz="0 0 -0.5"/>
        </successor><axis xyz="0 1 0"/></loop>""",
    "loop_joint": """<loop_joint name="pin" type="spherical">
        <link1 link="left_rod" rpy="0 0 0" xyz="0 0 -0.5"/>
        <link2 link="right_rod" rpy="0 0 0" xyz="0 0 -0.5"/></loop_joint>""",
}


@pytest.mark.parametrize("kind", LOOPS)
def test_other_spellings_of_loops_are_read(kind: str, tmp_path: Path) -> None:
    text = (EXAMPLES / "biglide.urdf").read_text(encoding="utf-8")
    file = tmp_path / "robot.urdf"
    made = re.sub(r"<constraint.*</constraint>", LOOPS[kind], text, flags=re.DOTALL)
    file.write_text(made, encoding="utf-8")
    assert counts(model_of(read_robot(file)))[:2] == (2, 0)


def test_a_mimic_is_a_coupling_and_comes_back(tmp_path: Path) -> None:
    file = tmp_path / "robot.urdf"
    body = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'
    file.write_text(
        f"""<robot name="r"><link name="world"/><link name="a">{body}</link><link name="b">{body}
        </link><joint name="m" type="continuous"><parent link="world"/><child link="a"/></joint>
        <joint name="s" type="prismatic"><origin xyz="0 1 0"/><parent link="world"/>
        <child link="b"/><axis xyz="0 0 1"/><limit lower="-1" upper="1"/>
        <mimic joint="m" multiplier="0.02" offset="0.3"/></joint></robot>""",
        encoding="utf-8",
    )
    robot = read_robot(file)
    assert robot.joints[1].freedoms[0].home == pytest.approx(0.3)
    np.testing.assert_allclose(robot.joints[1].place, [0, 1, 0.3])
    assert counts(model_of(robot)) == (1, 0, 0)
    for ending in (".urdf", ".sdf", ".xml"):
        other = tmp_path / f"other{ending}"
        other.write_text(robot_text(robot, other), encoding="utf-8")
        (coupled,) = read_robot(other).couplings
        assert coupled.leader == ("m", "rz")
        assert coupled.ratio == 0.02


def test_drives_and_tool_can_be_chosen() -> None:
    robot = read_robot(EXAMPLES / "arm.urdf", Choices(tool="wrist_2", drives=("A1", "A3:rz")))
    assert [j.name for j in robot.joints if any(f.driven for f in j.freedoms)] == ["A1", "A3"]
    assert robot.tool is not None
    assert robot.tool[0] == "wrist_2"
    for choices, words in (
        (Choices(tool="hand"), "no link, frame or site"),
        (Choices(drives=("A9",)), "no joint of the robot"),
        (Choices(drives=("A1:z",)), "no direction in which"),
    ):
        with pytest.raises(ModelError, match=words):
            read_robot(EXAMPLES / "arm.urdf", choices)


def test_what_a_format_cannot_have_is_refused(tmp_path: Path) -> None:
    light = robot_of(load("hexel-hexapod"))
    with pytest.raises(ModelError, match="MJCF"):
        robot_text(light, tmp_path / "robot.xml")
    with pytest.raises(ModelError, match="no robot format"):
        robot_text(light, tmp_path / "robot.stl")


def test_names_with_marks_of_xml_come_back(tmp_path: Path) -> None:
    text = (EXAMPLES / "arm.urdf").read_text(encoding="utf-8")
    file = tmp_path / "robot.urdf"
    file.write_text(text.replace("spindle", "&lt;b&gt; &amp; &quot;q&quot; ö"), encoding="utf-8")
    robot = read_robot(file)
    for ending in (".urdf", ".sdf", ".xml"):
        other = tmp_path / f"other{ending}"
        other.write_text(robot_text(robot, other), encoding="utf-8")
        assert '<b> & "q" ö' in {link.name for link in read_robot(other).links}
