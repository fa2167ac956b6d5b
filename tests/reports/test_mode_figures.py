"""Pictures of modes: outline, rods, colours, and the charts beside them."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np
import pytest

from strutwork.meshes.block import block
from strutwork.meshes.boundary import boundary
from strutwork.papers.son_2002.chapters.modes import nearly
from strutwork.papers.son_2002.figures.mode_surface import (
    LINE_RADIUS,
    mode_surface,
    modes_view,
    outline,
)
from strutwork.papers.son_2002.mode_files import mode_fields, mode_scene
from strutwork.papers.son_2002.modes import ModePicture
from strutwork.reports.figures.modes import energy_bars, frequency_dots, singular_values


@pytest.fixture
def picture() -> ModePicture:
    """A block of eight cells that moves along x with its height, and one rod above it."""
    mesh = block((1.0, 1.0, 1.0), (2, 2, 2))
    outer = np.concatenate([f.nodes for f in boundary(mesh).faces])
    used, faces = np.unique(outer, return_inverse=True)
    points = mesh.points[used]
    return ModePicture(
        points,
        faces.reshape(outer.shape),
        points[:, 2:] * [0.5, 0.0, 0.0],
        np.array([[0.5, 0.5, 1.0], [0.5, 0.5, 2.0]]),
        np.array([[0.5, 0.0, 0.0], [1.0, 0.0, 0.0]]),
        np.array([[0, 1]]),
    )


def test_outline_of_a_block_has_its_twelve_edges(picture: ModePicture) -> None:
    # each of the twelve edges is two cells long
    found = outline(picture)
    assert len(found) == 24
    assert sum(float(np.linalg.norm(b - a)) for a, b in found) == pytest.approx(12.0)


def test_surface_joins_granite_and_rods(picture: ModePicture) -> None:
    surface = mode_surface(picture)
    solid = len(picture.points)
    assert len(surface.triangles) > 2 * len(picture.faces)
    np.testing.assert_array_equal(surface.points[:solid], picture.points)
    rod = surface.points[solid:]
    assert np.abs(rod[:, :2] - 0.5).max() == pytest.approx(LINE_RADIUS)
    # the rod goes on where the block ends: displacement along x is half the height
    np.testing.assert_allclose(surface.displacement[:, 0], 0.5 * surface.points[:, 2])
    np.testing.assert_allclose(surface.values, surface.displacement[:, 0])


def test_view_swings_about_the_shape_at_rest(picture: ModePicture) -> None:
    other = ModePicture(
        picture.points,
        picture.faces,
        picture.displacement[:, [1, 0, 2]],
        picture.nodes,
        picture.node_displacement[:, [1, 0, 2]],
        picture.lines,
    )
    figure = modes_view({"along x": picture, "along y": other})
    motion, moving = figure["motion"], figure["data"][0]
    assert moving["type"] == "mesh3d"
    assert motion["colour"] == "intensity"
    assert moving["intensity"] == motion["modes"][0]["size"]
    first, second = motion["modes"]
    assert (first["label"], second["label"]) == ("along x", "along y")
    assert max(first["x"]) > 0 == max(map(abs, first["y"]))
    assert second["y"] == first["x"]
    shown = np.add(motion["rest"]["x"], first["x"])
    np.testing.assert_allclose(moving["x"], shown, rtol=1e-3, atol=1e-2)
    # the axes hold both extremes of both modes
    ranges = [figure["layout"]["scene"][f"{a}axis"]["range"] for a in "xy"]
    for (low, high), side in zip(ranges, "xy", strict=True):
        for mode in motion["modes"]:
            for sign in (-1, 1):
                at = np.add(motion["rest"][side], sign * np.array(mode[side]))
                assert low < at.min() < at.max() < high


def test_files_hold_the_shapes(picture: ModePicture, tmp_path: Path) -> None:
    file = mode_fields("shapes.vtu", "shapes", {"first": picture})
    file.write(tmp_path / file.name)
    read = meshio.read(tmp_path / file.name)
    assert {c.type: len(c.data) for c in read.cells} == {"quad": 24, "line": 1}
    np.testing.assert_allclose(read.point_data["first"][-1], [1.0, 0.0, 0.0])
    np.testing.assert_allclose(
        read.points[read.cells_dict["line"][0]], picture.nodes, rtol=0, atol=1e-15
    )
    scene = mode_scene("first.glb", "swings", picture)
    scene.write(tmp_path / scene.name)
    content = (tmp_path / scene.name).read_bytes()
    assert content[:4] == b"glTF"
    assert b"animations" in content


def test_dots_leave_out_what_is_not_published() -> None:
    figure = frequency_dots(["high", "low"], {"thesis": [200.0, None], "ours": [201.0, 20.0]})
    thesis, ours = figure["data"]
    assert (thesis["x"], thesis["y"]) == ([200.0], ["high"])
    assert ours["x"] == [201.0, 20.0]
    assert figure["layout"]["yaxis"]["categoryarray"] == ["low", "high"]
    assert figure["layout"]["xaxis"]["title"]["text"] == "frequency (Hz)"


def test_bars_stack_to_what_they_are_given() -> None:
    figure = energy_bars(["a", "b"], {"granite": [60, 10], "mounts": [40, 90]}, "share (%)")
    assert figure["layout"]["barmode"] == "stack"
    totals = np.sum([trace["x"] for trace in figure["data"]], axis=0)
    np.testing.assert_allclose(totals, 100.0)
    assert figure["layout"]["xaxis"]["title"]["text"] == "share (%)"


def test_zero_singular_values_stand_at_the_foot() -> None:
    figure = singular_values({"some": [50.0, 5.0, 0.0]}, 1e-3)
    (line,) = figure["data"]
    assert line["y"] == [1.0, 0.1, 1e-4]
    assert line["customdata"] == [50.0, 5.0, 0.0]
    (threshold,) = figure["layout"]["shapes"]
    assert threshold["y0"] == 1e-3


def test_rounded_zero_has_no_sign() -> None:
    assert (nearly(-0.04), nearly(0.05), nearly(-7.3)) == (0.0, 0.05, -7.3)
