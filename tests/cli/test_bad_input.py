"""Bad input gives one message that names the part, exit status 1 and nothing on stdout."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, nan
from pathlib import Path

import pytest

from strutwork.machines import model_file
from tests.cli.conftest import Program
from tests.model_files import SAMPLE, Content, Edit, add, drop, put, sample, toml

MATRIX = [[1e7 * (i == j) for j in range(6)] for i in range(6)]
ASKEW = [
    [2e6 if (i, j) == (0, 1) else v for j, v in enumerate(row)] for i, row in enumerate(MATRIX)
]

#: What is changed in the sample, and what the message must hold.
WRONG: dict[str, tuple[list[Edit], list[str]]] = {
    "unknown node of a beam": ([put("beams.0.to", "Q")], ["beam arm", '"Q"', "A, B, C"]),
    "unknown node of a body": ([put("bodies.0.nodes", ["C", "Q"])], ["body plate", '"Q"']),
    "unknown node of a joint": ([put("joints.0.between", ["B", "Q"])], ["joint hinge", '"Q"']),
    "unknown node of a spring": ([put("springs.0.node", "Q")], ["springs[0]", '"Q"']),
    "unknown node of a support": ([put("supports.1.node", "Q")], ["support", '"Q"']),
    "unknown node of a load": ([put("loads.0.node", "Q")], ["loads[0]", '"Q"']),
    "unknown node of a mass": ([put("masses.0.node", "Q")], ["masses[0]", '"Q"']),
    "unknown node of a settlement": ([put("settlements.0.node", "Q")], ["settlements[0]", '"Q"']),
    "unknown node of the tool": ([put("tool.tcp", "Q")], ["tool", '"Q"']),
    "unknown section": ([put("beams.0.section", "tub")], ["beam arm", '"tub"', "tube, bar"]),
    "unknown material": ([put("beams.0.material", "tin")], ["beam arm", '"tin"', "steel"]),
    "unknown beam of a line load": ([put("line_loads.0.beam", "q")], ["line_loads[0]", '"q"']),
    "unknown joint of a misfit": ([put("misfits.0.joint", "q")], ["misfits[0]", '"q"', "hinge"]),
    "unknown joint type": ([put("joints.0.type", "hinge")], ["joints.hinge.type", "revolute"]),
    "support is no type of the file": ([put("joints.0.type", "support")], ["joints.hinge.type"]),
    "unknown direction": ([put("joints.0.driven", ["rw"])], ["joints.hinge.driven[0]", '"rw"']),
    "unknown direction of a stiffness": (
        [put("joints.1.stiffness", {"w": 1.0})],
        ["joints.mount.stiffness.w", "not a known key"],
    ),
    "unknown shape": ([put("sections.bar.shape", "I")], ["sections.bar.shape", '"I"', "'tube'"]),
    "section without shape": ([drop("sections.bar.shape")], ["sections.bar.shape", "missing"]),
    "size of another shape": (
        [put("sections.bar.diameter", 0.1)],
        ["sections.bar.diameter", "not a known key"],
    ),
    "zero-length beam": ([put("nodes.G", SAMPLE["nodes"]["F"])], ["beam strut", "zero length"]),
    "beam from a node to itself": ([put("beams.0.to", "A")], ["beam arm", "itself"]),
    "orientation along the beam": (
        [put("beams.0.orientation", [2, 0, 0])],
        ["beam arm", "orientation", "along the beam"],
    ),
    "orientation of zero length": ([put("beams.0.orientation", [0, 0, 0])], ["beam arm"]),
    "negative modulus": (
        [put("materials.steel.youngs_modulus", "-210 GPa")],
        ["materials.steel.youngs_modulus", '"-210 GPa"', "above 0"],
    ),
    "negative density": ([put("materials.steel.density", -1)], ["materials.steel.density", "-1"]),
    "Poisson's ratio above one half": (
        [put("materials.steel.poissons_ratio", 0.6)],
        ["materials.steel.poissons_ratio", "0.6", "0.5"],
    ),
    "no Poisson's ratio and no shear modulus": (
        [drop("materials.steel.poissons_ratio")],
        ["material steel", "poissons_ratio", "shear_modulus"],
    ),
    "negative loss factor": (
        [put("materials.steel.loss_factor", -0.1)],
        ["materials.steel.loss_factor"],
    ),
    "negative diameter": (
        [put("sections.tube.outer_diameter", "-40 mm")],
        ["sections.tube.outer_diameter", '"-40 mm"'],
    ),
    "hole wider than the tube": (
        [put("sections.tube.inner_diameter", "41 mm")],
        ["section tube", "inner_diameter"],
    ),
    "negative mass": ([put("masses.0.mass", "-2 kg")], ["masses[0].mass", '"-2 kg"']),
    "negative stiffness": (
        [put("joints.1.stiffness.x", "-3 N/um")],
        ["joints.mount.stiffness.x", '"-3 N/um"'],
    ),
    "negative damping": (
        [put("joints.0.damping.rz", -1.0)],
        ["joints.hinge.damping.rz", "-1"],
    ),
    "negative modal ratio": ([put("damping.modal_ratio", -0.1)], ["damping.modal_ratio"]),
    "negative inertia": ([put("masses.0.inertia", [1, -1, 1])], ["mass at node B", "inertia"]),
    "infinite coordinate": ([put("nodes.B", [inf, 0, 0])], ["nodes.B[0]", "inf", "finite"]),
    "coordinate that is no number": ([put("nodes.B", [0, nan, 0])], ["nodes.B[1]", "nan"]),
    "number beyond all bounds": ([put("nodes.B", [0, "1e400 m", 0])], ["nodes.B[1]", "finite"]),
    "infinite force": ([put("loads.0.force", [0, -inf, 0])], ["loads[0].force[1]", "finite"]),
    "unit of another dimension": (
        [put("sections.tube.outer_diameter", "40 kg")],
        ["sections.tube.outer_diameter", '"40 kg"', "a mass", "a length"],
    ),
    "translational unit for a rotation": (
        [put("joints.0.stiffness.rz", "3 N/um")],
        ["joints.hinge.stiffness.rz", "N*m/rad"],
    ),
    "string without a unit": ([put("nodes.B", ["300", 0, 0])], ["nodes.B[0]", '"300"', "length"]),
    "unknown unit": ([put("nodes.B", ["300 foo", 0, 0])], ["nodes.B[0]", '"foo"']),
    "true for a number": ([put("nodes.B", [True, 0, 0])], ["nodes.B[0]", "true"]),
    "two coordinates": ([put("nodes.B", [0, 0])], ["nodes.B[2]", "missing"]),
    "four coordinates": ([put("nodes.B", [0, 0, 0, 0])], ["nodes.B", "at most 3"]),
    "direction fixed by two supports": (
        [add("supports", {"node": "G", "fixed": ["z"]})],
        ["support of node G", "z", "conflict"],
    ),
    "direction fixed twice by one support": (
        [put("supports.1.fixed", ["x", "x"])],
        ["support of node G", "x"],
    ),
    "support that fixes nothing": ([put("supports.1.fixed", [])], ["support of node G"]),
    "two settlements of one direction": (
        [add("settlements", {"case": "settle", "node": "A", "displacement": {"z": 0.0}})],
        ["settlements[1]", "support A", '"settle"'],
    ),
    "settlement of a free direction": (
        [put("settlements.0", {"node": "G", "displacement": {"rz": 0.1}})],
        ["settlements[0]", "support G", "rz"],
    ),
    "settlement without support": (
        [put("settlements.0.node", "B")],
        ["settlements[0]", '"B"', "no support"],
    ),
    "misfit in a free direction": (
        [put("misfits.0", {"joint": "mount", "gap": {"rx": 0.1}})],
        ["misfits[0]", "mount", "rx"],
    ),
    "disconnected node": ([put("nodes.Q", [1, 1, 1])], ["node Q", "disconnected"]),
    "load on a disconnected node": (
        [put("nodes.Q", [1, 1, 1]), put("loads.0.node", "Q")],
        ["node Q", "disconnected"],
    ),
    "body with one node": ([put("bodies.0.nodes", ["C"])], ["body plate", "1 node"]),
    "body without nodes": ([put("bodies.0.nodes", [])], ["body plate", "0 nodes"]),
    "body that names a node twice": (
        [put("bodies.0.nodes", ["C", "D", "TCP", "C"])],
        ["body plate", '"C"', "twice"],
    ),
    "node in two bodies": (
        [add("bodies", {"name": "lid", "nodes": ["D", "TCP"]})],
        ["node D", '"plate"', '"lid"'],
    ),
    "centre of mass without mass": (
        [drop("bodies.0.mass"), put("bodies.0.center_of_mass", [0, 0, 0])],
        ["body plate", "mass"],
    ),
    "asymmetric bushing matrix": (
        [drop("joints.1.stiffness"), put("joints.1.matrix", ASKEW)],
        ["joint mount", "not symmetric", "(x, y)"],
    ),
    "matrix of a revolute": (
        [drop("joints.0.stiffness"), put("joints.0.matrix", MATRIX)],
        ["joint hinge", "matrix"],
    ),
    "bushing without stiffness": ([drop("joints.1.stiffness")], ["joint mount", "without"]),
    "axis of zero length": ([put("joints.0.axis", [0, 0, 0])], ["joint hinge", "zero length"]),
    "second axis along the first": (
        [put("joints.0.second_axis", [0, 2, 0])],
        ["joint hinge", "second axis"],
    ),
    "joint nodes apart": (
        [put("nodes.C", ["301 mm", 0, 0])],
        ["joint hinge", '"B"', '"C"', "0.001 m apart"],
    ),
    "spring with two ends and a node": (
        [put("springs.0.between", ["B", "C"])],
        ["springs[0]", "both"],
    ),
    "spring without nodes": ([drop("springs.0.node")], ["springs[0]", "neither"]),
    "spring without stiffness": ([put("springs.0.stiffness", {})], ["spring B", "no stiffness"]),
    "load without force": ([drop("loads.0.force")], ["loads[0]", "neither"]),
    "two kinds of damping": ([put("damping.loss_factor", 0.1)], ["damping", "modal_ratio"]),
    "no kind of damping": ([put("damping", {})], ["damping", "exactly one"]),
    "one shear area": (
        [
            put(
                "sections.bar",
                {"shape": "properties", "area": 1, "Iy": 1, "Iz": 1, "J": 1, "shear_area_y": 1},
            )
        ],
        ["section bar", "shear area"],
    ),
    "beam divided too finely": ([put("beams.0.elements", 1001)], ["beams.arm.elements", "1000"]),
    "half an element": ([put("beams.0.elements", 1.5)], ["beams.arm.elements", "1.5"]),
    "word for true": ([put("beams.0.shear", "no")], ["beams.arm.shear", '"no"']),
    "unknown key": ([put("beams.0.sectoin", "bar")], ["beams.arm.sectoin", '"section"']),
    "unknown table": ([put("beam", [])], ["beam", "not a known key", '"beams"']),
    "list where a table is expected": ([put("tool", [])], ["tool", "[tool]"]),
    "table where a list is expected": ([put("beams", {})], ["beams", "[[beams]]"]),
    "number where a table is expected": ([put("materials", 3)], ["materials", "table"]),
    "no nodes": ([drop("nodes")], ["nodes", "missing"]),
    "two beams of one name": ([put("beams.1.name", "arm")], ["beam arm", "twice"]),
    "two bodies of one name": (
        [add("bodies", {"name": "plate", "nodes": ["A", "B"]})],
        ["body plate", "twice"],
    ),
    "two joints of one name": ([put("joints.1.name", "hinge")], ["joint hinge", "twice"]),
    "joint called as a support": ([put("joints.1.name", "support A")], ["joint support A"]),
    "empty name": ([put("beams.0.name", "")], ["beams[0].name"]),
    "several problems": (
        [put("beams.0.x", 1), put("nodes.B", ["1 kg", 0, 0])],
        ["2 problems", "beams.arm.x", "nodes.B[0]"],
    ),
}


@pytest.mark.parametrize("name", WRONG)
def test_message_names_the_part(
    name: str, strutwork: Program, write: Callable[[Content], Path]
) -> None:
    edits, expected = WRONG[name]
    for command in ("check", "solve"):
        run = strutwork(command, write(sample(*edits)), "--json")
        assert (run.status, run.out) == (1, "")
        assert run.err.startswith("Error: ")
        assert run.err.count("Error: ") == 1
        assert "Traceback" not in run.err
        assert "pydantic" not in run.err
        assert [part for part in expected if part not in run.err] == [], run.err


def test_the_sample_itself_is_right(strutwork: Program, write: Callable[[Content], Path]) -> None:
    for command in ("check", "solve"):
        assert strutwork(command, write(SAMPLE), "--json").result


def test_mechanism_under_load_names_joint_and_direction(
    strutwork: Program, write: Callable[[Content], Path]
) -> None:
    edits = [put("joints.0.driven", []), drop("joints.0.stiffness"), drop("joints.1.stiffness")]
    loose = put("joints.1.stiffness", {"y": "30 N/um"})
    run = strutwork("solve", write(sample(*edits, loose)), "--json")
    assert (run.status, run.out) == (1, "")
    assert "hinge in rz" in run.err
    assert "mechanism under its load" in run.err


def test_solve_without_load_and_tool(strutwork: Program, write: Callable[[Content], Path]) -> None:
    tables = ("gravity", "loads", "line_loads", "settlements", "misfits", "tool")
    run = strutwork("solve", write(sample(*map(drop, tables))), "--json")
    assert (run.status, run.out) == (1, "")
    assert "neither a load nor a tool" in run.err


def test_gravity_without_density(strutwork: Program, write: Callable[[Content], Path]) -> None:
    run = strutwork("solve", write(sample(drop("materials.steel.density"))), "--json")
    assert (run.status, run.out) == (1, "")
    assert "material steel" in run.err
    assert "density" in run.err


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"nodes = [", "not TOML"),
        (b"[nodes]\nA = [0, 0, 0]\nA = [0, 0, 0]\n", "not TOML"),
        (b'title = "caf\xe9"\n', "not UTF-8: byte 12 is 0xe9"),
        (toml(SAMPLE).encode("utf-16"), "not UTF-8"),
        (b"\x00\x01\x02", "not TOML"),
        (b"x = " + b"[" * 5000 + b"]" * 5000, "nested too deeply"),
        (b"x = " + b"9" * 5000, "not TOML"),
        (b"", "nodes: is missing"),
        (b"[nodes]", "nodes: are none"),
        (b"[1, 2, 3]", "not TOML"),
        (b'{"nodes": {}}', "not TOML"),
    ],
)
def test_file_of_another_shape(
    content: bytes, expected: str, strutwork: Program, tmp_path: Path
) -> None:
    path = tmp_path / "model.toml"
    path.write_bytes(content)
    run = strutwork("check", path)
    assert (run.status, run.out) == (1, "")
    assert expected in run.err
    assert "Traceback" not in run.err


def test_byte_order_mark_is_no_fault(strutwork: Program, tmp_path: Path) -> None:
    path = tmp_path / "model.toml"
    path.write_bytes(b"\xef\xbb\xbf" + toml(SAMPLE).encode())
    assert strutwork("check", path).status == 0


def test_missing_file_and_directory(strutwork: Program, tmp_path: Path) -> None:
    for path, problem in (
        (tmp_path / "none.toml", "does not exist"),
        (tmp_path, "is a directory"),
        (tmp_path / "none.toml" / "deeper", "does not exist"),
        (Path("/dev/zero"), "not an ordinary file"),
        (tmp_path / ("n" * 300), "cannot be read"),
    ):
        run = strutwork("check", path)
        assert (run.status, run.out) == (1, "")
        assert run.err.startswith(f"Error: {path}")
        assert problem in run.err


def test_file_of_100_megabytes_is_not_read(
    strutwork: Program, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "model.toml"
    with path.open("wb") as file:
        file.truncate(100_000_000)
    monkeypatch.setattr(Path, "read_bytes", lambda _: pytest.fail("the file was read"))
    run = strutwork("check", path)
    assert (run.status, run.out) == (1, "")
    assert "has 100 MB, more than the 10 MB" in run.err


def test_number_of_nodes_is_bounded(
    strutwork: Program, write: Callable[[Content], Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("strutwork.machines.model_checks.MAX_MESH_NODES", 100)
    run = strutwork("check", write(sample(put("beams.0.elements", 101))))
    assert run.status == 1
    assert "has 107 nodes" in run.err
    assert model_file.MAX_BYTES == 10_000_000
