"""Gradients against closed forms and finite differences, and what has none."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea import LossFactor, ModalRatio, PartDamping, Port, Rayleigh
from strutwork.fea.preload import preloaded
from strutwork.fea.sensitivity import dynamic_sensitivity, frequency_sensitivity
from strutwork.kinematics.task_grid import TaskGrid
from strutwork.machines.model import Model
from strutwork.msa.changes import Change
from strutwork.msa.sensitivity import StaticQuantity, compliance_sensitivity
from strutwork.studies.dimension import Dimension, dimensions
from strutwork.studies.gradient import gradient, worst_pose
from strutwork.studies.gradient_quantities import Vibrating
from strutwork.studies.parametric import Parametric
from strutwork.studies.tangents import Tangents
from tests.gradients import CANTILEVER, CHAIN, gap
from tests.solid_models import COLUMN

GRAVITY = "gravity = [0, 0, -9.81]\n"


def of(text: str, *names: str) -> tuple[Parametric, list[Dimension]]:
    machine = Parametric.of(text)
    return machine, [Dimension.of(machine, name) for name in names]


def test_the_closed_forms_of_a_cantilever() -> None:
    """k = 3EI/L³: dk/dE = k/E, dk/dd = 4k/d, dk/dL = −3k/L; ω² = k/m: dω/dp follows."""
    machine, parameters = of(
        CANTILEVER,
        "materials.steel.youngs_modulus",
        "sections.bar.diameter",
        "nodes.tip.x",
        "masses[0].mass",
    )
    found = gradient(
        machine.model,
        parameters,
        ["stiffness_z", "stiffness_x", "frequency_1", "displacement:tip:z@pull"],
    ).isel(pose=0)
    inertia = np.pi * 0.03**4 / 64
    k = 3 * 210e9 * inertia / 0.6**3
    assert float(found["value"][0]) == pytest.approx(k, rel=1e-10)
    powers = [[1, 4, -3, 0], [1, 2, -1, 0], [0.5, 2, -1.5, -0.5], [-1, -4, 3, 0]]
    assert found["elasticity"].to_numpy() == pytest.approx(np.array(powers), abs=2e-7)
    expected = np.array([k / 210e9, 4 * k / 0.03, -3 * k / 0.6, 0.0])
    assert found["gradient"][0].to_numpy() == pytest.approx(expected, rel=1e-8, abs=1e-6)
    assert found["gradient_unit"][0].to_numpy().tolist() == [
        "N/m per Pa",
        "N/m per m",
        "N/m per m",
        "N/m per kg",
    ]


@pytest.mark.parametrize("text", [CHAIN, GRAVITY + CHAIN])
def test_a_chain_with_elastic_joints(text: str) -> None:
    """Every number of it, by every quantity, against differences."""
    machine, parameters = of(
        text,
        "sections.bar.outer_diameter",
        "materials.steel.youngs_modulus",
        "materials.steel.density",
        "joints.shoulder.stiffness.ry",
        "joints.elbow.stiffness.rz",
        "springs.balance.stiffness.z",
        "masses[0].mass",
        "nodes.tip.x",
        "nodes.end.z+nodes.begin.z",
    )
    static = ["displacement:tip:z@cut", "joint_force:elbow:z@cut", "joint_force:shoulder:ry@cut"]
    quantities = ["stiffness_x", "stiffness_ry", "blocked_stiffness_z", *static]
    assert gap(machine.model, parameters, [*quantities, "frequency_1", "frequency_4"]).max() < 1e-6


@pytest.mark.parametrize(
    "damping",
    [
        ModalRatio(0.02),
        LossFactor(0.03),
        Rayleigh(2.0, 1e-5),
        PartDamping(),
        PartDamping(ModalRatio(0.01), joints={"shoulder": 0.05}),
    ],
    ids=str,
)
def test_the_least_dynamic_stiffness(damping: ModalRatio) -> None:
    """With damping of every kind; loss factors and dashpots are parameters too."""
    machine, parameters = of(
        CHAIN,
        "sections.bar.outer_diameter",
        "materials.steel.density",
        "materials.steel.loss_factor",
        "joints.elbow.stiffness.rz",
        "joints.elbow.damping.rz",
        "nodes.tip.x",
    )
    vibrating = Vibrating(damping, (1.0, 2000.0))
    quantities = ["least_dynamic_stiffness_x", "least_dynamic_stiffness_z"]
    assert gap(machine.model, parameters, quantities, None, vibrating).max() < 2e-6


@pytest.mark.parametrize(
    ("source", "task", "names"),
    [
        (
            "examples/machines/3-rps.toml",
            {"z": 0.69, "rx": 0.1, "ry": 0.05},
            (
                "sections.cylinder.outer_diameter",
                "joints.hinge*.stiffness.x",
                "joints.drive1.stiffness.z",
                "nodes.base1.y+nodes.foot1.y",
                "nodes.TCP.z",
                "bodies.platform.mass",
            ),
        ),
        (
            "eclipse-3pprs",
            {"x": 0.02, "rx": 0.1},
            (
                "section.outer_diameter",
                "drive_stiffness",
                "base_radius",
                "platform_radius",
                "link_length",
            ),
        ),
        ("mit-ss1", {}, ("radial_stiffness", "strut_lengths[0]", "guide_distances[1]")),
    ],
)
def test_machines_at_a_pose(source: str, task: Mapping[str, float], names: tuple[str, ...]) -> None:
    """Sections, joints and geometry, the tool held where it is."""
    machine, parameters = of(source, *names)
    quantities = ["stiffness_x", "stiffness_z", "blocked_stiffness_ry", "frequency_1"]
    vibrating = Vibrating(ModalRatio(0.02), (1.0, 1000.0))
    if source == "mit-ss1":
        assert gap(machine.model, parameters, quantities[:3], task, vibrating).max() < 1e-6
        return
    assert gap(machine.model, parameters, quantities, task, vibrating, 1e-3).max() < 1e-6


def test_a_frequency_that_occurs_twice_is_split() -> None:
    """A round bar bends alike in both planes; a thicker other axis would part them."""
    machine, parameters = of(CANTILEVER, "sections.bar.diameter", "nodes.tip.x")
    found = gradient(machine.model, parameters, ["frequency_1", "frequency_2"]).isel(pose=0)
    assert any("occurs several times" in remark for remark in found.attrs["remarks"])
    # both branches stay together here
    assert found["elasticity"][:, 0].to_numpy() == pytest.approx(np.array([2.0, 2.0]), abs=1e-6)
    box = CANTILEVER.replace(
        'shape = "rod"\ndiameter = "30 mm"',
        'shape = "rectangle"\nwidth_y = "30 mm"\nheight_z = "30 mm"',
    )
    machine, parameters = of(box, "sections.bar.height_z")
    found = gradient(machine.model, parameters, ["frequency_1", "frequency_2"]).isel(pose=0)
    # ω grows with h^1.5 where h bends, and with h^0.5 across
    assert found["elasticity"][:, 0].to_numpy() == pytest.approx(np.array([0.5, 1.5]), abs=1e-6)


def test_an_infinite_stiffness_has_no_gradient() -> None:
    """A bar that is one rigid body with a slide: along the slide it moves, across not."""
    text = """
[materials.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
[nodes]
rail = [0, 0, 0]
car = [0, 0, 0]
tool = [0, 0, "100 mm"]
[[bodies]]
name = "carriage"
nodes = ["car", "tool"]
[[joints]]
name = "guide"
type = "prismatic"
between = ["rail", "car"]
axis = [1, 0, 0]
driven = ["z"]
stiffness = { z = "50 N/um" }
[[supports]]
node = "rail"
fixed = "all"
[tool]
tcp = "tool"
"""
    machine, parameters = of(text, "joints.guide.stiffness.z")
    quantities = ["stiffness_x", "stiffness_y", "blocked_stiffness_x"]
    found = gradient(machine.model, parameters, quantities).isel(pose=0)
    assert found["gradient"].to_numpy()[[0, 2], 0] == pytest.approx([1.0, 1.0], rel=1e-9)
    assert np.isnan(found["gradient"].to_numpy()[1, 0])
    assert any("stiffness_y is infinite" in remark for remark in found.attrs["remarks"])


def test_a_parameter_without_influence_is_named() -> None:
    machine, parameters = of(CANTILEVER, "materials.other.youngs_modulus", "sections.bar.diameter")
    found = gradient(machine.model, parameters, ["stiffness_z"])
    assert found.attrs["no_influence"] == ["materials.other.youngs_modulus"]
    assert float(found["gradient"][0, 0, 0]) == 0.0


def test_a_parameter_that_cannot_move_alone_is_refused() -> None:
    """One node of a joint would leave the other behind."""
    machine, parameters = of(CHAIN, "nodes.end.z", "sections.bar.outer_diameter")
    found = gradient(machine.model, parameters, ["stiffness_z"])
    (refused,) = found.attrs["refused"]
    assert refused.startswith("nodes.end.z: ")
    assert found["parameter"].to_numpy().tolist() == ["sections.bar.outer_diameter"]
    with pytest.raises(ModelError, match="has no parameter"):
        gradient(machine.model, parameters[:1], ["stiffness_z"])


def test_the_worst_pose_of_a_grid() -> None:
    machine, parameters = of("examples/machines/3-rps.toml", "sections.ram.diameter")
    model = machine.model()
    grid = TaskGrid({"z": np.array([0.66, 0.7]), "rx": np.array([-0.1, 0.0, 0.1])})
    worst = worst_pose(model, "stiffness_z", grid)
    tangents = Tangents.of(machine.model, parameters)
    poses = {d: np.array(v) for d, v in grid.task().items()}
    every = gradient(tangents, parameters, ["stiffness_z"], poses)
    least = int(np.argmin(every["value"].to_numpy()[0]))
    assert worst == {d: float(v[least]) for d, v in poses.items()}
    one = gradient(tangents, parameters, ["stiffness_z"], {d: [v] for d, v in worst.items()})
    assert float(one["gradient"][0, 0, 0]) == pytest.approx(
        float(every["gradient"][0, 0, least]), rel=1e-7
    )


def test_a_pose_that_a_changed_machine_cannot_take_is_missing() -> None:
    """Its gradient is missing there, and there at other poses."""
    machine, parameters = of("examples/machines/3-rps.toml", "sections.ram.diameter")
    tangents = Tangents.of(machine.model, parameters)
    found = tangents.at({"z": [0.66, 0.7]})
    lost = replace(found, missing=np.array([[True, False]]))
    from strutwork.studies.gradient_quantities import read_quantity, sensitivities  # noqa: PLC0415

    asked = [read_quantity(tangents.model, "stiffness_z")]
    _, rates, _ = sensitivities(tangents.model, lost, asked, Vibrating())
    assert np.isnan(rates[0, 0]).tolist() == [True, False]


def test_what_cannot_be_asked() -> None:
    machine, parameters = of(CANTILEVER, "sections.bar.diameter")
    for name, words in (
        ("stifness_z", "no quantity"),
        ("stiffness_q", "unknown direction"),
        ("displacement:tip:z@none", "unknown load case"),
        ("displacement:nowhere:z@pull", "is not in the structure"),
        ("joint_force:nowhere:z@pull", "is not in the structure"),
    ):
        with pytest.raises(ModelError, match=words):
            gradient(machine.model, parameters, [name])
    with pytest.raises(ModelError, match="of no quantity"):
        gradient(machine.model, parameters, [])
    with pytest.raises(ModelError, match="damping: is missing"):
        gradient(machine.model, parameters, ["least_dynamic_stiffness_z"])
    with pytest.raises(ModelError, match="Did you mean"):
        Dimension.of(machine, "sections.bar.diametr")
    with pytest.raises(ModelError, match="different units"):
        Dimension.of(machine, "sections.bar.diameter+masses[0].mass")
    with pytest.raises(ModelError, match="Say displacement"):
        StaticQuantity("force", "tip", "z", machine.model().cases[0])


def test_a_free_joint_direction_carries_no_force() -> None:
    machine, parameters = of("examples/machines/3-rps.toml", "sections.ram.diameter")
    with pytest.raises(ModelError, match="is free in rz"):
        gradient(machine.model, parameters, ["joint_force:hinge1:rz@cutting"])


def test_other_parts_are_no_derivative() -> None:
    one = Parametric.of(CANTILEVER).model().structure
    other = Parametric.of(CANTILEVER.replace("elements = 2", "elements = 3")).model().structure
    with pytest.raises(ModelError, match="changes which parts"):
        Change("arm.elements", one, other, 1.0)


def test_a_preload_is_refused() -> None:
    model: Model = Parametric.of(CANTILEVER).model()
    loaded = preloaded(model.placed, model.case("pull"))
    with pytest.raises(ModelError, match="preload"):
        frequency_sensitivity(loaded, [])
    with pytest.raises(ModelError, match="is not that of the tool"):
        dynamic_sensitivity(model.placed, [], Port("root", "x"), ModalRatio(0.1), (1.0, 2.0))


def test_dimensions_leave_out_what_is_no_part_of_the_body() -> None:
    names = {p.name for p in dimensions(Parametric.of("examples/machines/3-rps.toml"))}
    assert {"sections.ram.diameter", "joints.drive1.stiffness.z", "bodies.platform.mass"} <= names
    assert not any(
        n.startswith(("nodes.", "loads", "gravity", "drives", "workspace")) for n in names
    )
    assert not any(".limits." in n or ".axis." in n for n in names)


def test_no_parameter_gives_the_value_alone() -> None:
    model = Parametric.of(CANTILEVER).model()
    found = compliance_sensitivity(model.placed, [])
    assert found.rates.shape == (0, 1, 6, 6)
    assert found.free.shape == (0, 1, 6)
    assert "0 parameters" in repr(found)


def test_beside_a_solid_joints_have_gradients_and_its_material_is_refused() -> None:
    """The solid's matrices take part; what would mesh and reduce it anew has no small step."""
    names = ["materials.granite.youngs_modulus", "joints.mount.stiffness.z", "masses[0].mass"]
    machine = Parametric.of(dict(COLUMN))
    parameters = [Dimension.of(machine, name) for name in names]
    quantities = ["displacement:tip:z@gravity", "frequency_1"]
    found = gradient(machine.model, parameters, quantities)
    (refused,) = found.attrs["refused"]
    assert "meshed and reduced anew" in refused
    assert gap(machine.model, parameters[1:], quantities[:1], step=1e-2).max() < 1e-6
    # the frequency is known to nine digits only beside so stiff a solid, and differences to five
    assert gap(machine.model, parameters[1:], quantities[1:], step=1e-2).max() < 1e-4
