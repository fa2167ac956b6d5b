"""Robot files that are wrong or hostile: a clear error, and nothing is opened or expanded."""

from __future__ import annotations

from pathlib import Path

import pytest

from strutwork.errors import ModelError
from strutwork.machines.load import load
from strutwork.machines.model_file import read_tables
from strutwork.machines.robots import read_robot
from strutwork.machines.robots.models import model_of

INERTIAL = '<inertial><mass value="{m}"/><inertia ixx="{i}" iyy="1" izz="1"/></inertial>'


def urdf(inside: str = "", m: str = "1", i: str = "1") -> str:
    return (
        f'<robot name="r"><link name="base"/><link name="arm">{INERTIAL.format(m=m, i=i)}</link>'
        '<joint name="j" type="continuous"><parent link="base"/><child link="arm"/></joint>'
        f"{inside}</robot>"
    )


JOINT = '<joint name="k" type="{t}"><parent link="{p}"/><child link="{c}"/></joint>'
SDF = '<sdf version="1.9"><model name="m">{}</model></sdf>'
BOMB = (
    '<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">'
    '<!ENTITY c "&b;&b;&b;&b;&b;&b;&b;&b;&b;&b;">]><robot name="&c;"/>'
)
HOSTILE: dict[str, tuple[str, str]] = {
    "entity bomb": (BOMB, "declares a document type or entities"),
    "external entity": (
        '<!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]><robot name="&x;"/>',
        "declares a document type or entities",
    ),
    "external document type": (
        '<!DOCTYPE r SYSTEM "http://example.org/r.dtd"><robot name="r"/>',
        "declares a document type or entities",
    ),
    "no XML": ("<robot", "is not XML"),
    "undefined entity": ('<robot name="&x;"/>', "is not XML"),
    "another format": ("<html/>", "no URDF, SDF or MJCF"),
    "too deep": ("<robot>" + "<a>" * 300 + "</a>" * 300 + "</robot>", "nested more than"),
    "too many": ("<robot>" + "<a/>" * 400_001 + "</robot>", "has more than 200000 elements"),
    "xacro": ('<robot xmlns:xacro="http://x"><xacro:include filename="a"/></robot>', "xacro"),
    "no links": ('<robot name="r"/>', "has no <link>"),
    "missing link": (urdf(JOINT.format(t="fixed", p="arm", c="hand")), 'unknown link "hand"'),
    "two parents": (urdf(JOINT.format(t="fixed", p="base", c="arm")), "child of two joints"),
    "loop": (urdf(JOINT.format(t="fixed", p="arm", c="base")), "no root link"),
    "two roots": (urdf('<link name="other"/>'), "2 root links"),
    "mass not a number": (urdf(m="nan"), "has the mass 'nan'"),
    "mass infinite": (urdf(m="1e999"), "has the mass"),
    "negative mass": (urdf(m="-1"), "has the mass -1 kg"),
    "negative inertia": (urdf(i="-1"), "negative principal moment"),
    "no type": (
        urdf('<link name="hand"/>' + JOINT.format(t="bend", p="arm", c="hand")),
        'unknown type "bend"',
    ),
    "axis of zero": (
        urdf().replace("<child", '<axis xyz="0 0 0"/><child'),
        "axis of length zero",
    ),
    "two numbers": (urdf().replace("<child", '<axis xyz="0 1"/><child'), "has 2 numbers in xyz"),
    "mimics nothing": (
        urdf().replace("<child", '<mimic joint="q"/><child'),
        'mimics the unknown joint "q"',
    ),
    "mimics itself": (
        urdf().replace("<child", '<mimic joint="j"/><child'),
        "follows itself|couples|itself",
    ),
    "loop of an unknown link": (
        urdf(
            '<constraint name="c" type="fixed"><parent link="x"/>'
            '<child link="arm"/></constraint>'
        ),
        'unknown link "x"',
    ),
    "loop that cannot close": (
        urdf(
            '<constraint name="c" type="spherical"><parent link="base"/>'
            '<parent_origin xyz="0 0 9"/><child link="arm"/></constraint>'
        ),
        "stays open by 9000 mm",
    ),
    "a link twice": (urdf('<link name="arm"/>'), "link arm: is defined twice"),
    "no name": (urdf("<link/>"), "has no name"),
    "a long name": (urdf(f'<link name="{"x" * 101}"/>'), "has a name of 101 characters"),
    "a hidden character": (urdf('<link name="&#x202e;x"/>' + JOINT.format(
        t="continuous", p="arm", c="&#x202e;x")), "character that is not shown|no name"),
    "include in SDF": (
        '<sdf version="1.9"><include><uri>https://x.org/m</uri></include></sdf>',
        "includes are not opened",
    ),
    "no model": ('<sdf version="1.9"/>', "has 0 models"),
    "SDF without version": ("<sdf><model/></sdf>", "version"),
    "static": (SDF.format("<static>true</static>"), "is static"),
    "frame of itself": (
        SDF.format('<link name="a"><pose relative_to="a">0 0 0 0 0 0</pose></link>'),
        "placed relative to itself",
    ),
    "gearbox": (
        SDF.format(
            '<link name="a"/><joint name="j" type="gearbox"><parent>world</parent>'
            "<child>a</child></joint>"
        ),
        'has the type "gearbox"',
    ),
    "unknown frame": (
        SDF.format(
            '<link name="a"/><joint name="j" type="fixed"><parent>b</parent>'
            "<child>a</child></joint>"
        ),
        "is used and not defined",
    ),
    "include in MJCF": (
        '<mujoco><include file="other.xml"/><worldbody/></mujoco>',
        "is not opened or expanded",
    ),
    "a mesh with mass": (
        ('<mujoco><worldbody><body name="a"><joint/><geom type="mesh" mesh="m"/></body></worldbody>'
        "</mujoco>"),
        "Give the body an <inertial>",
    ),
    "unknown class": (
        '<mujoco><worldbody><body name="a"><joint class="q"/></body></worldbody></mujoco>',
        'unknown class "q"',
    ),
    "connect without a body": (
        ('<mujoco><worldbody><body name="a"><joint/><geom size="1"/></body></worldbody>'
        '<equality><connect body1="b" anchor="0 0 0"/></equality></mujoco>'),
        'unknown body "b"',
    ),
    "a ratio that varies": (
        ('<mujoco><worldbody><body name="a"><joint name="j"/><geom size="1"/><body name="b">'
        '<joint name="k"/><geom size="1"/></body></body></worldbody><equality>'
        '<joint joint1="j" joint2="k" polycoef="0 1 2 0 0"/></equality></mujoco>'),
        "varies with the coordinate",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", HOSTILE)
def test_wrong_and_hostile_files_are_refused(case: str, tmp_path: Path) -> None:
    text, words = HOSTILE[case]
    file = tmp_path / "robot.xml"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ModelError, match=words):
        model_of(read_robot(file))


def test_a_huge_file_is_refused_before_it_is_read(tmp_path: Path) -> None:
    file = tmp_path / "robot.urdf"
    with file.open("wb") as stream:
        stream.truncate(20_000_000)
    with pytest.raises(ModelError, match="20 MB"):
        read_robot(file)
    with pytest.raises(ModelError, match="does not exist"):
        load(tmp_path / "other.sdf")


def test_a_robot_file_that_is_to_be_varied_is_converted_first() -> None:
    with pytest.raises(ModelError, match="strutwork convert"):
        read_tables("examples/robots/arm.urdf")
