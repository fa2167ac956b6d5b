"""Shapes of a model file's bodies: how they bound its workspace, and what is wrong with them."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from strutwork.errors import ModelError
from strutwork.kinematics.capsules import Interference
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.machines.model_poses import at_pose
from strutwork.reports.chapters import workspace_size
from strutwork.reports.subject import Subject
from strutwork.studies.workspace import Workspace, workspace
from strutwork.studies.workspace_margin import MachineMargin, interference_of
from tests.shaped_arm import MESH, RODS, SHAPE, TEXT, WHOLE, written


def space(model: Model, points: tuple[int, int] = (61, 41)) -> Workspace:
    axes = {"x": np.linspace(-0.1, 0.2, points[0]), "y": np.linspace(-0.1, 0.1, points[1])}
    step = np.array([v[1] - v[0] for v in axes.values()])
    safe = interference_of(model, None)
    return workspace(MachineMargin(model, ("x", "y"), step, interference=safe), axes)


@pytest.mark.slow
def test_a_mesh_takes_more_of_the_workspace_than_its_capsule(tmp_path: Path) -> None:
    """Both as closed forms say, to the chords of a grid of 5 mm."""
    rods = space(load(str(written(tmp_path, TEXT))))
    mesh = space(load(str(written(tmp_path))))
    assert rods.measure == pytest.approx(WHOLE - RODS, abs=1e-4)
    assert mesh.measure == pytest.approx(WHOLE - MESH, abs=1e-4)
    assert mesh.measure < rods.measure - 0.002
    assert mesh.nearest is not None
    assert mesh.nearest.reason == "interference of arm and post"
    # the face of the mesh is 70 mm away, the arm 10 mm thick to that side
    assert mesh.nearest.distance == pytest.approx(0.06, abs=1e-6)
    assert mesh.regions.holes == 1


def test_a_shape_moves_with_its_body(tmp_path: Path) -> None:
    """The mesh on the arm, as on the post: the same poses are free by symmetry."""
    text = TEXT + SHAPE.replace('"post"', '"arm"').replace('["100 mm", 0', "[0, 0")
    assert space(load(str(written(tmp_path, text)))).measure == pytest.approx(
        WHOLE - MESH, abs=1e-4
    )


def test_axes_of_a_shape_turn_it(tmp_path: Path) -> None:
    turned = TEXT + SHAPE + "axis = [0, 0, 1]\nsecond_axis = [0, 1, 0]\n"
    found = space(load(str(written(tmp_path, turned))))
    # 60 mm across now: 20 mm from the middle to the face, and the arm
    assert found.nearest is not None
    assert found.nearest.distance == pytest.approx(0.1 - 0.02 - 0.01, abs=1e-6)


def test_a_shape_of_the_ground_and_one_put_elsewhere_first(tmp_path: Path) -> None:
    text = TEXT + SHAPE.replace('"post"\n', '"ground"\nname = "table"\n')
    model = load(str(written(tmp_path, text)))
    safe = interference_of(model, None)
    words = {safe.words(q) for q in range(len(safe.pairs))}
    assert "arm and table" in words
    moved = at_pose(model, {"x": 0.02})
    q = [safe.words(q) for q in range(len(safe.pairs))].index("arm and table")
    gaps = [safe.gaps(m.placement, np.inf)[q] for m in (model, moved)]
    np.testing.assert_allclose(gaps, [0.06, 0.04], atol=1e-9)


def test_a_shape_is_held_by_a_node_that_does_not_slide(tmp_path: Path) -> None:
    """The slide's second node is the first of a joint that slides; the first one is not."""
    text = TEXT + SHAPE.replace('"post"\n', '"slide"\n').replace('["100 mm", 0', '["-50 mm", 0')
    model = load(str(written(tmp_path, text)))
    assert model.shapes[0].node == "X0"
    with pytest.raises(ModelError, match='held by the node "X1", which slides along'):
        Interference(model.structure.linkage, (), (replace(model.shapes[0], node="X1"),))
    with pytest.raises(ModelError, match=r"shapes\[0\].body: has no node that stays"):
        load(
            str(
                written(
                    tmp_path,
                    text.replace('["X0", "X1"]', '["X1", "X2"]')
                    .replace("X0 = [0, 0, 0]", "X2 = [0, 0, 0]")
                    .replace('"G", "X0"', '"X2", "G"')
                    .replace('node = "G"', 'node = "G"'),
                )
            )
        )


def test_shapes_that_collide_at_home_name_both(tmp_path: Path) -> None:
    model = load(str(written(tmp_path, sides=(200.0, 40.0, 300.0))))
    with pytest.raises(ModelError, match="arm and post: interfere at home"):
        interference_of(model, None)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('"post.stl"', '"missing.stl"', r'shapes\[0\].surface: there is no file "missing.stl"'),
        ('"post.stl"', '"../post.stl"', "leads out of the folder"),
        ('"post.stl"', '"post.toml"', r"there is no file"),
        ('"post.stl"', '"arm.toml"', r"suffix '.toml' is not that of a surface"),
        ('"post.stl"', '"open.stl"', "is not watertight"),
        ('"post.stl"', '"two.stl"', "holds 2 separate bodies"),
        ('"post.stl"', '"broken.stl"', "is cut short or not an STL file"),
        ('"post.stl"', '"fine.stl"', r"triangles; 200000 is the limit"),
        ('body = "post"\nsurface', 'body = "pole"\nsurface', 'unknown body, beam or solid "pole"'),
        ("[[shapes]]", SHAPE + "[[shapes]]", 'has the name "post" of another shape'),
        ('unit = "mm"', 'unit = "inch"', "unit"),
    ],
)
def test_errors_name_the_field(tmp_path: Path, old: str, new: str, words: str) -> None:
    cube = trimesh.creation.box((20.0, 20.0, 20.0))
    trimesh.Trimesh(cube.vertices, cube.faces[:-1]).export(tmp_path / "open.stl")
    apart = cube.copy()
    apart.apply_translation([100, 0, 0])
    trimesh.util.concatenate([cube, apart]).export(tmp_path / "two.stl")
    (tmp_path / "broken.stl").write_bytes(cube.export(file_type="stl")[:-20])
    if "fine" in new:
        trimesh.creation.icosphere(7, 10.0).export(tmp_path / "fine.stl")
    text = TEXT + SHAPE
    assert old in text
    with pytest.raises(ModelError, match=words):
        load(str(written(tmp_path, text.replace(old, new, 1))))


def test_too_many_shapes(tmp_path: Path) -> None:
    with pytest.raises(ModelError, match="are 201; at most 200"):
        load(str(written(tmp_path, TEXT + 201 * SHAPE)))


def test_without_the_library_the_remedy_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    model = load(str(written(tmp_path)))
    monkeypatch.setitem(sys.modules, "fcl", None)
    with pytest.raises(ModelError, match=r"pip install strutwork\[interference\]"):
        interference_of(model, None)
    # the chapter says why it is not there
    assert "pip install strutwork[interference]" in workspace_size.missing(
        Subject(model, "arm", "arm")
    )


def test_the_chapter_says_what_was_looked_at(tmp_path: Path) -> None:
    subject = Subject(load(str(written(tmp_path))), "arm", "arm")
    assert workspace_size.missing(subject) == ""
    blocks = " ".join(str(block) for block in workspace_size.write(subject).blocks)
    assert "without a collision of beams and shapes (1 mesh)" in blocks
    assert "interference of arm and post" in blocks


def test_formulas_that_tell_no_turns_are_refused(tmp_path: Path) -> None:
    model = load(str(written(tmp_path)))
    formula = replace(model, closed_form=lambda _: model.placement)
    with pytest.raises(ModelError, match="needs the rotations of the bodies"):
        interference_of(formula, None)
