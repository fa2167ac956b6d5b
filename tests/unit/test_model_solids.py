from __future__ import annotations

import importlib.util
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.errors import ModelError
from strutwork.fea import modes
from strutwork.fea.interface import Interface
from strutwork.fea.mode_damping import damping_ratios
from strutwork.fea.reduce_solid import reduce_solid
from strutwork.fea.solid import Solid
from strutwork.kinematics import GROUND, Body
from strutwork.machines.model import ModelWarning
from strutwork.machines.model_file import parse_model, read_model
from strutwork.machines.model_solid_element import SolidElement
from strutwork.meshes import (
    block,
    grid,
    joined,
    lines_through,
    moved,
    patch,
    quadratic,
    surface_of,
    write_mesh,
)
from strutwork.meshes.boundary import boundary
from strutwork.meshes.surfaces import write_surface
from strutwork.msa import Material, tool_compliance
from strutwork.msa.mass import mass_properties
from strutwork.reports.model_check import check_model
from strutwork.studies.model_damping import model_damping
from strutwork.units import LENGTH, quantity
from tests.model_files import Content, drop, put, toml
from tests.solid_models import brick, column, from_file, model_of

INSTALLED = importlib.util.find_spec("gmsh") is not None
GRANITE = Material.isotropic(60e9, 0.25, density=2900.0, name="granite")


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Superelements of these tests stay with them; equal solids are reduced once."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv("XDG_CACHE_HOME", str(tmp_path_factory.getbasetemp() / "superelements"))
        yield


def test_a_solid_beams_and_joints_are_one_structure() -> None:
    model = model_of()
    (solid,) = model.solids
    assert isinstance(solid, SolidElement)
    assert model.structure.elements == (solid,)
    assert solid.tied == ("foot", "head")
    assert solid.monitors[0] == "column/1"
    assert repr(solid).startswith("<SolidElement column: 2 interfaces, <Superelement column:")
    # nodes inside a solid are none of the file
    assert model.nodes == ("ground", "foot", "head", "tip")
    linkage = model.structure.linkage
    assert linkage.nodes == (*model.nodes, *solid.monitors, "ground (ground)")
    assert linkage.bodies == (
        Body("arm and 1 more", ("foot", "head", "tip", *solid.monitors)),
        Body(GROUND, ("ground (ground)",)),
    )
    np.testing.assert_allclose(solid.positions[:2], [[0.1, 0.075, 0.0], [0.1, 0.075, 0.6]])


def test_it_is_what_python_makes_of_it() -> None:
    model = model_of()
    # mesh lines fall on the edges of the box
    x, y = lines_through((0, 0.2, 0.05, 0.15), 0.2), lines_through((0, 0.15, 0.05, 0.1), 0.2)
    mesh = grid(x, y, lines_through((0, 0.6), 0.2))
    mesh = patch(mesh, "head", (0.05, 0.05, 0.6), (0.15, 0.1, 0.6))
    expected = reduce_solid(
        Solid(mesh, {"solid": GRANITE}, name="column"),
        [
            Interface("foot", "-z", (0.1, 0.075, 0.0)),
            Interface("head", "head", (0.1, 0.075, 0.6), "rigid"),
        ],
        modes=18,
    )
    found = model.solids[0]
    assert found.nodes == expected.nodes
    for name in ("positions", "local_stiffness", "local_mass", "fixed_frequencies", "shapes"):
        assert np.array_equal(getattr(found.reduced, name), getattr(expected, name))


def test_it_weighs_what_it_is() -> None:
    model = model_of()
    solid = 0.2 * 0.15 * 0.6 * 2900.0
    assert model.solids[0].weighed[0] == pytest.approx(solid, rel=1e-10)
    assert model.solids[0].weighed[1] == pytest.approx([0.1, 0.075, 0.3], rel=1e-9)
    found, expected = check_model(model).mass, mass_properties(model.placed)
    assert found is not None
    assert found.center is not None
    assert found.total == pytest.approx(solid + 0.06 * 0.04 * 0.2 * 7850 + 5.0, rel=1e-10)
    assert found.total == pytest.approx(float(expected.total), rel=1e-10)
    assert found.center == pytest.approx(expected.centre.tolist(), rel=1e-9)


def test_the_surface_follows_the_nodes() -> None:
    turn = Rotation.from_rotvec([0.3, -0.8, 1.1]).as_matrix()
    model = parse_model(toml(turned(turn, np.array([0.4, -0.2, 1.0]))))
    (solid,) = model.solids
    # a rigid motion of the nodes is one of the surface
    spin, shift = np.array([0.2, -0.1, 0.4]), np.array([0.01, 0.02, -0.03])
    moves = np.concatenate(
        [shift + np.cross(spin, solid.positions), np.tile(spin, (len(solid.nodes), 1))], axis=1
    )
    expected = shift + np.cross(spin, solid.points)
    np.testing.assert_allclose(solid.motion(moves, model.placed), expected, atol=1e-8)
    np.testing.assert_allclose(
        solid.motion(np.stack([moves, 2 * moves]), model.placed)[1], 2 * expected, atol=1e-8
    )
    # a closed surface, outwards: its volume is that of the block
    corners = solid.points[solid.triangles]
    volume = np.linalg.det(corners - solid.points.mean(axis=0)).sum() / 6.0
    assert volume == pytest.approx(0.2 * 0.15 * 0.6, rel=1e-9)
    # twelve edges: 3 pieces along each x, 3 along y, 3 along z
    assert len(solid.outline) == 4 * (3 + 3 + 3)


def turned(turn: np.ndarray, shift: np.ndarray) -> Content:
    """The column in another frame."""
    content = column()
    for name, place in content["nodes"].items():
        at = turn @ np.array([quantity(v, LENGTH, name) for v in place]) + shift
        content["nodes"][name] = at.tolist()
    content["beams"][0]["orientation"] = turn[:, 2].tolist()
    for part in (content["joints"][0], content["solids"][0]):
        part["axis"], part["second_axis"] = turn[:, 2].tolist(), turn[:, 0].tolist()
    content["solids"][0]["position"] = shift.tolist()
    content["gravity"] = (turn @ [0, 0, -9.81]).tolist()
    return content


@pytest.mark.parametrize("rotation", [[0.0, 0.0, 0.0], [0.3, -0.8, 1.1], [0.0, np.pi / 2, 0.0]])
def test_another_frame_changes_nothing(rotation: list[float]) -> None:
    turn = Rotation.from_rotvec(rotation).as_matrix()
    first = model_of()
    second = parse_model(toml(turned(turn, np.array([0.4, -0.2, 1.0]))))
    # round-off beside the softest motion; stiffnesses differ by ten orders within the solid
    np.testing.assert_allclose(
        modes(second.placed, 10).frequencies, modes(first.placed, 10).frequencies, rtol=1e-6
    )
    blocks = np.kron(np.eye(2), turn)
    expected = blocks @ tool_compliance(first.placed) @ blocks.T
    np.testing.assert_allclose(
        tool_compliance(second.placed), expected, atol=1e-7 * np.abs(expected).max()
    )


def test_one_interface_and_few_modes_still_know_how_they_are_turned() -> None:
    turn = Rotation.from_rotvec([0.3, -0.8, 1.1]).as_matrix()
    single = [drop("solids.0.interfaces.1"), drop("beams"), drop("masses"), drop("loads"),
              drop("nodes.head"), drop("nodes.tip"), put("tool.tcp", "foot"),
              put("solids.0.modes", 1)]  # fmt: skip
    contents = [column(), turned(turn, np.zeros(3))]
    found = []
    for content in contents:
        for edit in single:
            edit(content)
        found.append(modes(parse_model(toml(content)).placed, 6).frequencies)
    np.testing.assert_allclose(found[1], found[0], rtol=1e-7)


@pytest.mark.parametrize("suffix", [".msh", ".vtu", ".inp", ".bdf"])
def test_a_mesh_file_is_read_beside_the_model_file(suffix: str, tmp_path: Path) -> None:
    write_mesh(brick(), tmp_path / f"part{suffix}", "mm")
    path = tmp_path / "model.toml"
    box = [[0, 0, "600 mm"], ["200 mm", "150 mm", "600 mm"]]
    named = from_file(f"part{suffix}", unit="mm")
    path.write_text(toml(column(named, put("solids.0.interfaces.1.box", box))), encoding="utf-8")
    model = read_model(path)
    assert model.solids[0].weighed[0] == pytest.approx(0.2 * 0.15 * 0.6 * 2900.0, rel=1e-6)


def test_a_patch_of_the_mesh_file_is_an_interface(tmp_path: Path) -> None:
    write_mesh(brick(), tmp_path / "part.msh")
    by_name = [from_file("part.msh"), drop("solids.0.interfaces.1.box")]
    named = model_of(*by_name, put("solids.0.interfaces.1.patch", "head"), folder=tmp_path)
    whole = [[0, 0, "600 mm"], ["200 mm", "150 mm", "600 mm"]]
    boxed = model_of(
        from_file("part.msh"), put("solids.0.interfaces.1.box", whole), folder=tmp_path
    )
    assert np.array_equal(named.solids[0].reduced.positions, boxed.solids[0].reduced.positions)
    np.testing.assert_allclose(
        tool_compliance(named.placed), tool_compliance(boxed.placed), rtol=1e-9
    )


def test_quadratic_cells_keep_their_corners(tmp_path: Path) -> None:
    write_mesh(quadratic(brick((2, 2, 6))), tmp_path / "part.vtu")
    whole = [[0, 0, "600 mm"], ["200 mm", "150 mm", "600 mm"]]
    model = model_of(
        from_file("part.vtu"), put("solids.0.interfaces.1.box", whole), folder=tmp_path
    )
    # quadratic displacements on straight cells: the nodes that the file has too
    assert model.solids[0].reduced.shapes.shape[0] == 3 * (5 * 5 * 13)


def test_each_region_has_its_material(tmp_path: Path) -> None:
    low = block((0.2, 0.15, 0.3), (3, 3, 4), region="stone", name="low")
    high = moved(block((0.2, 0.15, 0.3), (3, 3, 4), region="cap", name="high"), None, (0, 0, 0.3))
    write_mesh(joined(low, high), tmp_path / "part.msh")
    whole = [[0, 0, "600 mm"], ["200 mm", "150 mm", "600 mm"]]
    edits = [from_file("part.msh"), put("solids.0.interfaces.1.box", whole),
             put("solids.0.interfaces.0", {"node": "foot", "box": [[0, 0, 0], [0.2, 0.15, 0]]}),
             drop("solids.0.material")]  # fmt: skip
    both = put("solids.0.materials", {"stone": "granite", "cap": "steel"})
    model = model_of(*edits, both, folder=tmp_path)
    assert model.solids[0].materials == ("granite", "steel")
    expected = 0.2 * 0.15 * 0.3 * (2900.0 + 7850.0)
    assert model.solids[0].weighed[0] == pytest.approx(expected, rel=1e-9)
    with pytest.raises(ModelError, match=r"(?s)solids\.column.*'cap' has no material"):
        model_of(*edits, put("solids.0.materials", {"stone": "granite"}), folder=tmp_path)
    # a group around several regions stands for those that have no material of their own
    whole_mesh = joined(low, high)
    groups = {"everything": np.arange(whole_mesh.cell_count)}
    write_mesh(replace(whole_mesh, cell_sets=groups), tmp_path / "part.msh")
    by_group = {"everything": "granite", "cap": "steel"}
    model = model_of(*edits, put("solids.0.materials", by_group), folder=tmp_path)
    assert model.solids[0].weighed[0] == pytest.approx(expected, rel=1e-9)
    lossy = put("materials.steel.loss_factor", 0.02)
    with pytest.warns(ModelWarning, match="the least of them, 0"):
        model_of(*edits, both, lossy, folder=tmp_path)


def test_the_loss_factor_of_its_material_damps() -> None:
    plain = model_of(drop("damping"), drop("joints.0.damping"))
    assert model_damping(plain) is None
    lossy = model_of(
        drop("damping"), drop("joints.0.damping"), put("materials.granite.loss_factor", 0.01)
    )
    damping = model_damping(lossy)
    assert str(damping) == "materials' loss factors"
    found = modes(lossy.placed, 8)
    ratios = damping_ratios(found, damping)
    share = found.energy_shares[:, found.energy_parts.index("element column")]
    # 2 ζ is the loss factor times the share of the energy in the solid, to second order
    np.testing.assert_allclose(2 * ratios, 0.01 * share, rtol=1e-3, atol=1e-9)


@pytest.mark.parametrize("order", [1, 2])
def test_a_tube_weighs_what_the_ring_does(order: int) -> None:
    def edit(content: Content) -> None:
        solid = content["solids"][0]
        solid["order"] = order
        solid.pop("size")
        solid |= {"shape": "tube", "outer_diameter": 0.2, "inner_diameter": 0.12, "length": 0.6}
        solid |= {"cell": 0.1, "modes": 6, "position": [0.1, 0.075, 0]}
        solid["interfaces"] = [{"node": "foot", "patch": "-z"}, {"node": "head", "patch": "+z"}]

    found = model_of(edit).solids[0].weighed[0]
    ring = np.pi / 4 * (0.2**2 - 0.12**2) * 0.6 * 2900.0
    # straight cells make a polygon; parabolas over an arc θ lack θ⁴/480
    turn = 2 * np.pi / (28 if order == 1 else 24)
    share = np.sin(turn) / turn if order == 1 else 1.0 - turn**4 / 480
    assert found == pytest.approx(ring * share, rel=1e-9 if order == 1 else 1e-6)


def test_an_l_frame_has_its_patches_and_edges() -> None:
    def edit(content: Content) -> None:
        solid = content["solids"][0]
        solid.pop("size")
        solid |= {"shape": "l_frame", "envelope": [0.2, 0.3, 0.6], "plate": 0.1, "base": 0.15}
        solid["interfaces"] = [
            {"node": "foot", "patch": "bottom"},
            {"node": "head", "box": [[0.05, 0, 0.6], [0.15, 0.1, 0.6]], "normal": [0, 0, 1]},
        ]
        content["nodes"]["head"] = content["nodes"]["tip"] = [0.1, 0.05, 0.6]
        content["nodes"]["tip"] = [0.1, 0.25, 0.6]

    found = model_of(edit).solids[0].weighed[0]
    assert found == pytest.approx(0.2 * (0.3 * 0.15 + 0.1 * 0.45) * 2900.0, rel=1e-9)


def test_two_solids_share_a_node() -> None:
    def edit(content: Content) -> None:
        second = {
            **{k: content["solids"][0][k] for k in ("shape", "material")},
            "cell": 0.04,
            "name": "block",
            "size": [0.1, 0.05, 0.1],
            "position": [0.05, 0.05, 0.6],
            "interfaces": [{"node": "head", "patch": "-z"}],
        }
        content["solids"].append(second)

    model = model_of(edit)
    assert [s.name for s in model.solids] == ["column", "block"]
    assert len(model.structure.linkage.bodies) == 2
    extra = modes(model.placed, 4).frequencies / modes(model_of().placed, 4).frequencies
    # a block more: lower, but not by much
    assert np.all(extra < 1.0)
    assert np.all(extra > 0.9)


def test_a_rigid_body_carries_a_node_off_the_patch() -> None:
    held = model_of(
        put("nodes.knob", [0.1, 0.075, 0.9]),
        put("bodies", [{"name": "neck", "nodes": ["head", "knob"]}]),
        put("tool.tcp", "knob"),
    )
    model = model_of(put("tool.tcp", "head"))
    arm = np.eye(6)
    arm[0, 4], arm[1, 3] = 0.3, -0.3
    expected = arm @ tool_compliance(model.placed) @ arm.T
    # zeros by symmetry are rounding, 4e-9 of the largest entry with SuperLU
    np.testing.assert_allclose(
        tool_compliance(held.placed), expected, atol=1e-7 * np.abs(expected).max()
    )


@pytest.mark.parametrize("source", ["surface", "step"])
def test_cad_is_filled_with_tetrahedra(source: str, tmp_path: Path) -> None:
    name = f"part.{'stl' if source == 'surface' else 'step'}"

    def edit(content: Content) -> None:
        solid = content["solids"][0]
        solid.pop("shape")
        solid.pop("size")
        solid |= {source: name, "cell": 0.15}
        box = {"box": [[0, 0, 0.6], [0.2, 0.15, 0.6]]}
        solid["interfaces"] = [
            {"node": "foot", "box": [[0, 0, 0], [0.2, 0.15, 0]]},
            {"node": "head", **box},
        ]

    if source == "surface":
        mesh = block((0.2, 0.15, 0.6), (1, 1, 1))
        write_surface(surface_of(mesh, boundary(mesh)), tmp_path / name)
    elif INSTALLED:
        import gmsh  # noqa: PLC0415 - an extra

        gmsh.initialize(interruptible=False)
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addBox(0, 0, 0, 200, 150, 600)
        gmsh.model.occ.synchronize()
        gmsh.write(str(tmp_path / name))
        gmsh.finalize()
    else:
        (tmp_path / name).write_text("ISO-10303-21; END-ISO-10303-21;", encoding="ascii")
    if not INSTALLED:
        with pytest.raises(ModelError, match=r"(?s)solids\.column.*not installed"):
            model_of(edit, folder=tmp_path)
        return
    model = model_of(edit, folder=tmp_path)
    # STL is in single precision
    assert model.solids[0].weighed[0] == pytest.approx(0.2 * 0.15 * 0.6 * 2900.0, rel=1e-5)
