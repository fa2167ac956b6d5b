"""Surfaces from CAD: mass properties of closed ones, refusal of the others, glTF."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from strutwork.errors import ModelError
from strutwork.meshes import (
    GltfPart,
    Surface,
    block,
    boundary,
    check_closed,
    flipped,
    l_frame,
    mass_properties,
    moved,
    patch_area,
    quadratic,
    read_surface,
    surface_of,
    surface_properties,
    to_glb,
    tube,
    welded,
    write_gltf,
    write_surface,
)


def cube(size: float = 1.0, at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Surface:
    mesh = moved(block((size, size, size), (1, 1, 1), name="cube"), translation=at)
    return surface_of(mesh, boundary(mesh))


def together(*parts: Surface) -> Surface:
    offsets = np.cumsum([0, *(len(p.points) for p in parts)])
    return Surface(
        np.concatenate([p.points for p in parts]),
        np.concatenate([p.triangles + o for p, o in zip(parts, offsets[:-1], strict=True)]),
        "parts",
    )


def test_the_body_of_a_surface_weighs_what_its_mesh_weighs() -> None:
    mesh = l_frame((0.9, 0.6, 1.5), 0.184, 0.228, size=0.17)
    found = surface_properties(surface_of(mesh, boundary(mesh)), 3000.0)
    wanted = mass_properties(mesh, 3000.0)
    # two exact integrals of the same body
    assert found.volume == pytest.approx(wanted.volume, rel=1e-12)
    assert found.mass == pytest.approx(wanted.mass, rel=1e-12)
    assert found.centre == pytest.approx(wanted.centre, rel=1e-12)
    assert found.inertia == pytest.approx(wanted.inertia, rel=1e-11, abs=1e-9)


def test_the_body_of_a_cube_far_away_keeps_its_digits() -> None:
    found = surface_properties(cube(0.5, (1000.0, 0.0, 0.0)), 8000.0)
    assert found.mass == pytest.approx(1000.0, rel=1e-9)
    assert found.centre == pytest.approx([1000.25, 0.25, 0.25], rel=1e-12)
    assert found.inertia == pytest.approx(np.eye(3) * 1000.0 * 0.25 / 6.0, rel=1e-9, abs=1e-7)
    assert found.principal_inertias() == pytest.approx(np.full(3, 1000.0 / 24.0), rel=1e-9)


@pytest.mark.parametrize("suffix", [".stl", ".obj", ".glb"])
@pytest.mark.parametrize("unit", ["m", "mm"])
def test_a_surface_comes_back_from_its_file(suffix: str, unit: str, tmp_path: Path) -> None:
    mesh = tube(0.05, 0.08, 0.3, (1, 12, 2))
    surface = surface_of(mesh, boundary(mesh))
    path = tmp_path / f"part{suffix}"
    if suffix == ".glb":
        unit = "m"
        write_gltf([GltfPart(surface)], path)
    else:
        write_surface(surface, path, unit)
    found = read_surface(path, unit)
    assert len(found.triangles) == len(surface.triangles)
    wanted = surface_properties(surface, 1.0)
    # STL and glTF hold single precision, 6e-8
    assert surface_properties(found, 1.0).centre == pytest.approx(wanted.centre, abs=1e-7)
    assert surface_properties(found, 1.0).volume == pytest.approx(wanted.volume, rel=1e-6)


def test_quadratic_faces_become_triangles_between_all_their_nodes() -> None:
    for serendipity, count in ((True, 6), (False, 8)):
        mesh = quadratic(block((1.0, 2.0, 3.0), (1, 1, 1)), serendipity=serendipity)
        surface = surface_of(mesh, boundary(mesh))
        assert len(surface.triangles) == 6 * count
        assert surface_properties(surface, 1.0).volume == pytest.approx(6.0)
        top = surface_of(mesh, mesh.patch("+z"))
        assert top.points.tolist() == mesh.points[mesh.patch("+z").nodes].tolist()


def test_an_open_surface_is_refused_with_its_gaps() -> None:
    closed = cube()
    opened = replace(closed, triangles=closed.triangles[2:])
    with pytest.raises(
        ModelError, match=r"cube: is not watertight: 4 open edges, the first at \("
    ) as caught:
        surface_properties(opened, 1.0)
    assert "Close the gaps" in str(caught.value)


def test_a_gap_is_welded_with_a_tolerance() -> None:
    closed = cube()
    # every triangle with corners of its own, pulled apart by a micrometre
    corners = closed.points[closed.triangles].reshape(-1, 3)
    loose = corners + np.random.default_rng(3).uniform(-5e-7, 5e-7, corners.shape)
    soup = Surface(loose, np.arange(len(loose)).reshape(-1, 3))
    with pytest.raises(ModelError, match="not watertight: 36 open edges"):
        check_closed(soup)
    assert surface_properties(welded(soup, 1e-5), 1.0).volume == pytest.approx(1.0, abs=1e-5)


def test_triangles_that_disagree_are_refused() -> None:
    triangles = np.array(cube().triangles)
    triangles[0] = triangles[0][::-1]
    with pytest.raises(ModelError, match="disagree about the outside at 3 edges"):
        check_closed(replace(cube(), triangles=triangles))


def test_a_body_inside_out_is_refused_and_turned() -> None:
    inside_out = flipped(cube())
    with pytest.raises(ModelError, match=r"-1 m³: it is inside out.*\n.*flipped"):
        surface_properties(inside_out, 1.0)
    assert surface_properties(flipped(inside_out), 1.0).volume == pytest.approx(1.0)


def test_a_cavity_is_no_body_inside_out_and_one_beside_is() -> None:
    hollow = together(cube(2.0), flipped(cube(1.0, (0.5, 0.5, 0.5))))
    assert surface_properties(hollow, 1.0).volume == pytest.approx(7.0)
    with pytest.raises(ModelError, match="inside out"):
        check_closed(together(cube(2.0), flipped(cube(1.0, (5.0, 0.0, 0.0)))))


@pytest.mark.parametrize("suffix", [".stl", ".obj", ".glb"])
@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9])
def test_a_file_cut_short_is_refused_and_named(
    suffix: str, share: float, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / f"part{suffix}"
    if suffix == ".glb":
        write_gltf([GltfPart(cube())], path)
    else:
        write_surface(cube(), path)
    content = path.read_bytes()
    path.write_bytes(content[: int(len(content) * share)])
    with pytest.raises(ModelError, match="part"):
        # an OBJ that ends between two lines lacks faces, which its gaps show
        check_closed(read_surface(path))
    assert capfd.readouterr() == ("", "")


def test_a_text_stl_cut_short_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "part.stl"
    made = trimesh.Trimesh(cube().points, cube().triangles, process=False)
    text = made.export(file_type="stl_ascii")
    path.write_text(text)
    assert len(read_surface(path, "mm").triangles) == 12
    path.write_text(text[: len(text) // 2])
    with pytest.raises(ModelError, match="its last line is not `endsolid`"):
        read_surface(path)


@pytest.mark.parametrize(
    ("name", "unit", "words"),
    [
        ("none.stl", "m", "no such file"),
        ("part.step", "m", "not that of a surface"),
        ("part.stl", "inch", "unit is given as 'inch'"),
        ("part.glb", "mm", "glTF is in m"),
    ],
)
def test_what_cannot_be_read_is_refused(name: str, unit: str, words: str, tmp_path: Path) -> None:
    with pytest.raises(ModelError, match=words):
        read_surface(tmp_path / name, unit)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Surface(np.zeros((3, 3)), np.zeros((0, 3), int)), "no triangles"),
        (lambda: Surface(np.full((3, 3), np.nan), [[0, 1, 2]]), "not finite"),
        (lambda: Surface(np.zeros((3, 3)), [[0, 1, 3]]), "does not exist; there are 3"),
        (lambda: surface_properties(cube(), 0.0), "its density is 0"),
        (lambda: write_surface(cube(), "part.glb"), "not written as '.glb'"),
        (lambda: write_gltf([GltfPart(cube())], "part.obj"), "not written as '.obj'"),
        (lambda: to_glb([]), "holds nothing"),
        (lambda: to_glb([GltfPart(cube(), np.ones(4))]), r"colours of shape \(4,\)"),
        (lambda: to_glb([GltfPart(cube(), np.full(3, 1.5))]), "beyond 0 to 1"),
        (lambda: to_glb([GltfPart(cube(), None, np.ones((2, 3)))]), r"shape \(2, 3\)"),
        (lambda: to_glb([GltfPart(cube(), None, np.full((8, 3), np.inf))]), "not finite"),
    ],
)
def test_a_surface_that_cannot_be_is_refused(make: object, words: str) -> None:
    assert callable(make)
    with pytest.raises(ModelError, match=words):
        make()


def document(content: bytes) -> tuple[dict[str, object], bytes]:
    magic, version, length = struct.unpack_from("<4sII", content)
    assert (magic, version, length) == (b"glTF", 2, len(content))
    size, kind = struct.unpack_from("<I4s", content, 12)
    assert kind == b"JSON"
    rest, kind = struct.unpack_from("<I4s", content, 20 + size)
    assert (kind, rest) == (b"BIN\0", len(content) - 28 - size)
    return json.loads(content[20 : 20 + size]), content[28 + size :]


def test_a_scene_holds_colours_displacement_and_a_swing(tmp_path: Path) -> None:
    surface = cube()
    shape = np.random.default_rng(4).uniform(-1, 1, surface.points.shape)
    colours = np.random.default_rng(5).uniform(0, 1, surface.points.shape)
    path = write_gltf([GltfPart(surface, colours, shape), GltfPart(cube(0.5))], tmp_path / "a.glb")
    text, binary = document(path.read_bytes())
    views, accessors = text["bufferViews"], text["accessors"]
    primitive = text["meshes"][0]["primitives"][0]  # type: ignore[index]

    def values(accessor: int) -> np.ndarray:
        view = views[accessors[accessor]["bufferView"]]  # type: ignore[index]
        raw = binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
        return np.frombuffer(raw, "<f4").reshape(accessors[accessor]["count"], -1)  # type: ignore[index]

    assert values(primitive["attributes"]["POSITION"]) == pytest.approx(surface.points)
    assert values(primitive["targets"][0]["POSITION"]) == pytest.approx(shape, rel=1e-6)
    normals = values(primitive["attributes"]["NORMAL"])
    outwards = (surface.points - 0.5) * normals
    assert np.linalg.norm(normals, axis=1) == pytest.approx(np.ones(8))
    assert (outwards.sum(axis=1) > 0).all()
    # middle grey of a screen is 0.214 of its light
    grey = document(to_glb([GltfPart(surface, np.full(3, 0.5))]))[1]
    assert np.float32(0.21404114) in np.frombuffer(grey, "<f4")
    (animation,) = text["animations"]  # type: ignore[misc]
    sampler = animation["samplers"][0]
    assert values(sampler["input"])[[0, -1], 0].tolist() == [0.0, 2.0]
    assert values(sampler["output"])[[0, 4, 12], 0] == pytest.approx([0.0, 1.0, -1.0])
    assert "animations" not in document(to_glb([GltfPart(surface, None, shape)], swings=False))[0]


def test_z_points_up_in_a_viewer(tmp_path: Path) -> None:
    path = write_gltf([GltfPart(cube(1.0, (0.0, 0.0, 4.0)))], tmp_path / "a.glb")
    scene = trimesh.load_scene(path)
    assert scene.bounds == pytest.approx(np.array([[0.0, 4.0, -1.0], [1.0, 5.0, 0.0]]))


def test_area_of_a_patch_is_that_of_its_triangles() -> None:
    mesh = block((1.0, 2.0, 3.0), (2, 2, 2))
    surface = surface_of(mesh, mesh.patch("-x"))
    made = trimesh.Trimesh(surface.points, surface.triangles, process=False)
    assert made.area == pytest.approx(patch_area(mesh, mesh.patch("-x")))
