from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from strutwork.errors import ModelError, UnitError
from strutwork.kinematics import GROUND, Body
from strutwork.machines.model import Damping, Model, ModelWarning
from strutwork.machines.model_file import parse_model, read_model
from strutwork.msa import solve
from tests.model_files import EXAMPLES, SAMPLE, Edit, add, drop, put, sample, toml


def model_of(*edits: Edit) -> Model:
    return parse_model(toml(sample(*edits)))


def test_nodes_joints_and_supports_keep_their_names() -> None:
    model = model_of()
    assert model.title == "One of everything"
    assert model.nodes == ("A", "B", "C", "D", "TCP", "F", "G")
    assert model.joints == ("hinge", "mount")
    assert model.supports == {"A": "support A", "G": "support G"}
    assert model.tool == "TCP"
    linkage = model.structure.linkage
    assert linkage.nodes == (*model.nodes, "A (ground)", "G (ground)")
    assert [j.name for j in linkage.joints] == ["hinge", "mount", "support A", "support G"]
    assert linkage.joints[2].between == ("A (ground)", "A")
    assert linkage.joints[3].locks == ("x", "y", "z", "rx")
    assert model.placement.batch == ()


def test_bodies_are_what_beams_and_rigid_bodies_hold_together() -> None:
    model = model_of()
    assert model.structure.linkage.bodies == (
        Body("plate", ("C", "D", "TCP")),
        Body("arm", ("A", "B")),
        Body("strut", ("F", "G")),
        Body(GROUND, ("A (ground)", "G (ground)")),
    )
    assert model.structure.rigid == ()


def test_rigid_body_on_a_beam_is_a_rigid_group() -> None:
    model = model_of(put("bodies.0.nodes", ["C", "D", "TCP", "F"]))
    assert model.structure.rigid == (Body("plate", ("C", "D", "TCP", "F")),)
    assert model.structure.linkage.bodies[0] == Body(
        "plate and 1 more", ("C", "D", "TCP", "F", "G")
    )


def test_body_called_ground_moves() -> None:
    model = model_of(put("bodies.0.name", "ground"))
    assert model.structure.linkage.body_names == ("ground'", "arm", "strut")


def test_support_split_over_two_tables() -> None:
    model = model_of(
        put("supports.1.fixed", ["rx", "z"]), add("supports", {"node": "G", "fixed": ["x", "y"]})
    )
    assert model.structure.linkage.joints[3].locks == ("x", "y", "z", "rx")


def test_cases_in_order_with_their_loads() -> None:
    model = model_of(
        add("loads", {"case": "wind", "node": "B", "moment": [0, "2 N*m", 0]}),
        add("loads", {"node": "B", "force": [0, 0, 1]}),
        put("line_loads.0.force_to", [0, 0, "-0.3 N/mm"]),
    )
    cases = {case.name: case for case in model.cases}
    assert list(cases) == ["gravity", "cutting", "wind", "load", "settle", "assembly"]
    assert cases["gravity"].gravity == (0.0, 0.0, -9.81)
    assert cases["cutting"].wrenches == (("TCP", (100.0, 0.0, 0.0, 0.0, 0.0, 0.0)),)
    assert cases["wind"].wrenches == (("B", (0.0, 0.0, 0.0, 0.0, 2.0, 0.0)),)
    (line,) = cases["wind"].line_loads
    assert (line.beam, line.first, line.second) == ("arm", (0.0, 0.0, -100.0), (0.0, 0.0, -300.0))
    assert cases["settle"].gaps == {("support A", "z"): -1e-3}
    assert cases["assembly"].gaps == {("hinge", "x"): 30e-6}


def test_loads_of_the_case_gravity_act_with_gravity() -> None:
    model = model_of(put("loads.0.case", "gravity"))
    first = model.cases[0]
    assert (first.name, first.gravity, len(first.wrenches)) == ("gravity", (0, 0, -9.81), 1)


def test_settlement_moves_the_supported_node() -> None:
    model = model_of()
    solution = solve(model.placed, model.cases)
    # a locked direction holds to round-off
    assert solution.displacement("A", "settle")[2] == pytest.approx(-1e-3, rel=1e-12)


def test_joint_axes() -> None:
    model = model_of(
        put("joints.1.axis", [0, 0, -2]),
        put("joints.1.second_axis", [1, 1, 5]),
    )
    half = np.sqrt(0.5)
    assert model.placement.frames[0] == pytest.approx(
        np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]]), abs=1e-15
    )
    assert model.placement.frames[1] == pytest.approx(
        np.array([[half, half, 0], [half, -half, 0], [0, 0, -1]]), abs=1e-15
    )
    assert model.placement.frames[2] == pytest.approx(np.eye(3))


def test_joint_stiffness_damping_and_drives() -> None:
    hinge, mount = model_of().structure.linkage.joints[:2]
    assert hinge.driven == ("rz",)
    assert hinge.stiffness == {"rz": 2e4}
    assert hinge.damping == {"rz": 3.0}
    assert mount.stiffness == {"x": 30e6, "y": 30e6, "z": 20e6}


def test_bushing_matrix_in_its_units() -> None:
    matrix: list[list[object]] = [[0.0] * 6 for _ in range(6)]
    for i in range(6):
        matrix[i][i] = "20 N/um" if i < 3 else "1 kN*m/rad"
    matrix[0][4] = matrix[4][0] = "-30 kN/rad"
    mount = model_of(drop("joints.1.stiffness"), put("joints.1.matrix", matrix)).structure
    expected = np.diag([20e6] * 3 + [1e3] * 3)
    expected[0, 4] = expected[4, 0] = -30e3
    assert mount.linkage.joints[1].stiffness_matrix == pytest.approx(expected)
    with pytest.raises(UnitError, match=r"joints\.mount\.matrix\[0\]\[4\]"):
        model_of(
            drop("joints.1.stiffness"),
            put("joints.1.matrix", matrix),
            put("joints.1.matrix.0.4", "-30 kN/m"),
        )


def test_empty_matrix_is_absent() -> None:
    assert model_of(put("joints.0.matrix", [])).structure.linkage == model_of().structure.linkage


def test_mass_of_a_body_sits_at_the_mean_of_its_nodes() -> None:
    at_b, plate = model_of().structure.masses
    assert (at_b.node, at_b.mass, at_b.offset) == ("B", 0.2, (0.0, 0.0, 0.0))
    assert (plate.node, plate.mass) == ("C", 2.0)
    assert plate.offset == pytest.approx((0.0, 0.1, 0.05))


def test_centre_of_mass_and_inertia() -> None:
    inertia = [[1e-4, 0, 0], [0, 1e-4, 0], [0, 0, "2 kg*cm^2"]]
    at_b, plate = model_of(
        put("bodies.0.center_of_mass", ["310 mm", 0, 0]),
        put("bodies.0.inertia", inertia),
        put("masses.0.inertia", [1e-4, 2e-4, 3e-4]),
    ).structure.masses
    assert plate.offset == pytest.approx((0.01, 0.0, 0.0))
    assert np.array(plate.inertia) == pytest.approx(np.diag([1e-4, 1e-4, 2e-4]))
    assert np.array(at_b.inertia) == pytest.approx(np.diag([1e-4, 2e-4, 3e-4]))


def test_beams() -> None:
    model = model_of(
        put("beams.0.elements", 3),
        put("beams.0.shear", False),
        put("beams.0.orientation", [0, 1, 1]),
        put("beams.0.offset_to", [0, 0, "5 mm"]),
    )
    arm, strut = model.structure.beams
    assert (arm.nodes, arm.elements, arm.shear) == (("A", "B"), 3, False)
    assert arm.orientation == (0.0, 1.0, 1.0)
    assert arm.offsets == ((0.0, 0.0, 0.0), (0.0, 0.0, 0.005))
    assert (strut.elements, strut.shear, strut.orientation) == (1, True, None)
    assert model.structure.mesh_nodes[-2:] == ("arm/1", "arm/2")


def test_springs_without_names_are_called_by_their_nodes() -> None:
    model = model_of(
        add("springs", {"node": "B", "stiffness": {"x": 1.0}}),
        add("springs", {"between": ["D", "F"], "stiffness": {"rx": 1.0}}),
        add("springs", {"name": "soft", "node": "B", "stiffness": {"y": 1.0}}),
    )
    assert [s.name for s in model.structure.springs] == ["B", "B 2", "D-F", "soft"]


def test_damping() -> None:
    assert model_of().damping == Damping(modal_ratio=0.01)
    assert model_of(put("damping", {"loss_factor": "2 %"})).damping == Damping(loss_factor=0.02)
    rayleigh = {"rayleigh": {"alpha": 5.36, "beta": "0.0746 ms"}}
    assert model_of(put("damping", rayleigh)).damping == Damping(rayleigh=(5.36, 7.46e-5))
    assert model_of(drop("damping")).damping is None


def test_shear_modulus_counts_before_poissons_ratio() -> None:
    close = put("materials.steel.shear_modulus", "80 GPa")  # implied: 80.77 GPa, 0.96 % away
    assert model_of(close).structure.beams[0].material.shear_modulus == 80e9
    with pytest.warns(ModelWarning, match=r"steel.*80\.77|steel.*8\.077e\+10"):
        model = model_of(put("materials.steel.shear_modulus", "79 GPa"))
    assert model.structure.beams[0].material.shear_modulus == 79e9


def test_sections() -> None:
    table = {"shape": "properties", "area": "36 cm^2", "Iy": 4.92e-6, "Iz": 5e-6, "J": 1e-5}
    plain = model_of(put("sections.bar", table)).structure.beams[1].section
    assert plain.area == pytest.approx(3.6e-3)
    assert plain.second_moment_y == 4.92e-6
    assert (plain.second_moment_z, plain.torsion_constant) == (5e-6, 1e-5)
    assert plain.shear_area(0.3) is None
    table |= {"shear_area_y": 2e-3, "shear_area_z": 1e-3}
    assert model_of(put("sections.bar", table)).structure.beams[1].section.shear_area(0.3) == (
        2e-3,
        1e-3,
    )
    box = {"shape": "box", "width_y": 0.02, "height_z": 0.03, "thickness": 0.002}
    assert model_of(put("sections.bar", box)).structure.beams[1].section.area == pytest.approx(
        0.02 * 0.03 - 0.016 * 0.026
    )
    rod = {"shape": "rod", "diameter": "20 mm"}
    assert model_of(put("sections.bar", rod)).structure.beams[1].section.area == pytest.approx(
        np.pi * 1e-4
    )


def test_a_node_of_a_divided_beam_may_not_be_redefined() -> None:
    edits = [put("beams.0.elements", 2), put("nodes.arm/1", [0, 0, 1])]
    with pytest.raises(ModelError, match="arm/1"):
        model_of(*edits, add("springs", {"node": "arm/1", "stiffness": {"x": 1.0}}))


def test_tool_is_asked_for_where_needed() -> None:
    assert model_of().require_tool() == "TCP"
    with pytest.raises(ModelError, match="tool: is missing"):
        model_of(drop("tool")).require_tool()


def test_repr_tells_title_and_size() -> None:
    assert repr(model_of()).startswith("<Model 'One of everything': <Structure: 9 nodes")


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_are_read(path: Path) -> None:
    model = read_model(path)
    assert model.title
    assert model.placed.batch == ()
    assert len(EXAMPLES) == 9


def test_order_of_tables_does_not_matter() -> None:
    turned = dict(reversed(list(SAMPLE.items())))
    found = parse_model(toml(turned))
    assert found.structure.linkage == model_of().structure.linkage
    assert [b.name for b in found.structure.beams] == ["arm", "strut"]
