"""Gaps of meshes beside closed forms: cubes, spheres, bars, capsules, and what is inside what."""

from __future__ import annotations

import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.capsules import Capsule, Interference
from strutwork.kinematics.mesh_gaps import MeshGaps, PlacedPart
from strutwork.kinematics.mesh_overlap import crossing_depth, hull_depth, inside
from strutwork.kinematics.mesh_shapes import MOST_TRIANGLES, MeshShape
from strutwork.kinematics.segments import segment_distances
from tests.linkages import chain

Array = NDArray[Any]

#: Rounding of coordinates of some metres.
EXACT = 1e-12


def shape(made: Any, name: str = "part", node: str = "n") -> MeshShape:
    return MeshShape(name, node, np.zeros(3), np.asarray(made.vertices), np.asarray(made.faces))


def box(*sides: float) -> MeshShape:
    return shape(trimesh.creation.box(sides))


def placed(mesh: MeshShape, at: Any, turn: Any = None) -> PlacedPart:
    place = np.atleast_2d(np.asarray(at, dtype=float))
    rotation = np.broadcast_to(np.eye(3) if turn is None else turn, (len(place), 3, 3))
    ends, radius = mesh.around
    axis = place[:, None] + ends @ np.swapaxes(rotation, -1, -2)
    return PlacedPart(axis, radius, mesh, place, rotation)


def capsule(start: Any, end: Any, radius: float) -> PlacedPart:
    return PlacedPart(np.stack([np.atleast_2d(start), np.atleast_2d(end)], axis=1), radius)


def turns(count: int, seed: int = 5) -> Array:
    q = np.linalg.qr(np.random.default_rng(seed).normal(size=(count, 3, 3)))[0]
    return np.asarray(q * np.sign(np.linalg.det(q))[:, None, None])


@pytest.fixture(scope="module")
def gaps() -> MeshGaps:
    return MeshGaps()


CUBES = [
    # apart by a face, an edge, a corner
    ((1.5, 0.2, 0.3), 0.5),
    ((1.3, 1.4, 0.2), 0.5),
    ((2.0, 2.0, 2.0), np.sqrt(3.0)),
    ((1.0 + 1e-6, 0.3, 0.1), 1e-6),
    # overlapping, the least side of what is common
    ((0.9, 0.1, 0.2), -0.1),
    ((1.0 - 1e-6, 0.1, 0.2), -1e-6),
    # with faces in one plane; touching; one on the other
    ((0.7, 0.0, 0.0), -0.3),
    ((1.0, 0.3, 0.0), 0.0),
    ((0.0, 0.0, 0.0), -1.0),
]


@pytest.mark.parametrize("turn", [np.eye(3), turns(1)[0]], ids=["upright", "turned"])
@pytest.mark.parametrize(("at", "gap"), CUBES)
def test_two_cubes(gaps: MeshGaps, at: Any, gap: float, turn: Array) -> None:
    cube = box(1, 1, 1)
    first, second = placed(cube, np.zeros(3), turn), placed(cube, turn @ np.array(at), turn)
    # FCL's root of a squared distance near zero: 1e-12 of the size
    assert gaps.gaps(first, second, np.inf)[0] == pytest.approx(gap, abs=1e-11)
    assert gaps.gaps(second, first, np.inf)[0] == pytest.approx(gap, abs=1e-11)


def test_bars_that_cross_without_a_corner_inside(gaps: MeshGaps) -> None:
    height = np.array([0.2, 0.1 - 1e-4, 0.09, 0.06])
    at = np.stack([np.full(4, 0.02), np.full(4, 0.03), height], axis=-1)
    first, second = placed(box(1, 0.1, 0.1), np.zeros((4, 3))), placed(box(0.1, 1, 0.1), at)
    np.testing.assert_allclose(gaps.gaps(first, second, np.inf), height - 0.1, atol=EXACT)


def test_a_part_inside_another_overlaps_by_its_way_out_at_least(gaps: MeshGaps) -> None:
    at = np.array([[0.0, 0, 0], [0.3, 0.1, 0], [0.549, 0.01, 0], [0.551, 0.01, 0]])
    large, small = placed(box(1, 1, 1), np.zeros((4, 3))), placed(box(0.1, 0.1, 0.1), at)
    wanted = [-0.45 - 0.1, -0.15 - 0.1, -1e-3, 1e-3]
    for pair in ((large, small), (small, large)):
        np.testing.assert_allclose(gaps.gaps(*pair, np.inf), wanted, atol=EXACT)


def test_a_part_in_the_cavity_of_another_is_free_until_it_touches(gaps: MeshGaps) -> None:
    outer, hollow = trimesh.creation.box((1, 1, 1)), trimesh.creation.box((0.8, 0.8, 0.8))
    hollow.invert()
    at = np.array([[0.0, 0, 0], [0.349, 0.01, 0], [0.36, 0.01, 0.02], [0.9, 0.0, 0.0]])
    large = placed(shape(trimesh.util.concatenate([outer, hollow])), np.zeros((4, 3)))
    small = placed(box(0.1, 0.1, 0.1), at)
    for pair in ((large, small), (small, large)):
        np.testing.assert_allclose(gaps.gaps(*pair, np.inf), [0.35, 0.001, -0.01, 0.35], atol=EXACT)
    rod = capsule(at, at + np.array([0.0, 0.0, 0.1]), 0.05)
    assert np.all(gaps.gaps(large, rod, np.inf)[[0, 3]] > 0.0)


def test_a_capsule_beside_a_cube(gaps: MeshGaps) -> None:
    x = np.array([0.6, 0.56, 0.54, 0.501, 0.45, 0.2, -0.45])
    start = np.stack([x, np.full(7, 0.1), np.full(7, -0.2)], axis=-1)
    rod = capsule(start, start + np.array([0.0, 0.0, 0.4]), 0.05)
    cube = placed(box(1, 1, 1), np.zeros((7, 3)))
    # its distance from the face, inside its way out, less the radius
    outside = np.array([0.1, 0.06, 0.04, 0.001, -0.05, -0.3, -0.05])
    for pair in ((cube, rod), (rod, cube)):
        np.testing.assert_allclose(gaps.gaps(*pair, np.inf), outside - 0.05, atol=EXACT)
    across = capsule([[-1.0, 0.1, 0.2]], [[1.0, 0.1, 0.2]], 0.05)
    assert gaps.gaps(cube[:1], across, np.inf)[0] == -0.05
    point = capsule([[0.7, 0.1, 0.2]], [[0.7, 0.1, 0.2]], 0.05)
    assert gaps.gaps(cube[:1], point, np.inf)[0] == pytest.approx(0.15, abs=EXACT)


def test_a_sphere_is_its_capsule_to_the_sag_of_its_triangles(gaps: MeshGaps) -> None:
    """Every point of the surface is within this of the sphere: edge² / (6 r), with a margin."""
    made = trimesh.creation.icosphere(3, 0.5)
    sag = made.edges_unique_length.max() ** 2 / (6.0 * 0.5)
    ball = shape(made)
    random = np.random.default_rng(2)
    at, turn = random.uniform(-1.2, 1.2, (60, 3)), turns(60)
    start, along = random.uniform(-0.8, 0.8, (60, 3)), random.uniform(-1, 1, (60, 3))
    rod = capsule(start, start + along, 0.1)
    found = gaps.gaps(placed(ball, at, turn), rod, np.inf)
    exact = segment_distances(np.stack([at, at], axis=1), rod.ends) - 0.6
    clear = exact > 0.0
    assert 10 < clear.sum() < 55
    assert np.all(found[clear] >= exact[clear] - EXACT)
    assert np.all(found[clear] <= exact[clear] + sag)
    assert np.all(found[exact < -sag] < 0.0)


def test_gaps_do_not_depend_on_axes_or_order(gaps: MeshGaps) -> None:
    random = np.random.default_rng(8)
    mine, other = box(0.4, 0.1, 0.2), shape(trimesh.creation.cylinder(0.1, 0.6, sections=12))
    at, turn = random.uniform(-0.4, 0.4, (40, 3)), turns(40, 9)
    found = gaps.gaps(placed(mine, np.zeros((40, 3))), placed(other, at, turn), np.inf)
    assert 5 < (found < 0).sum() < 35
    q, shift = turns(1, 11)[0], np.array([0.3, -2.0, 1.0])
    moved = (
        placed(mine, np.tile(shift, (40, 1)), np.tile(q, (40, 1, 1))),
        placed(other, at @ q.T + shift, q @ turn),
    )
    np.testing.assert_allclose(gaps.gaps(*moved, np.inf), found, atol=1e-9)
    np.testing.assert_allclose(gaps.gaps(*moved[::-1], np.inf), found, atol=1e-9)


def test_far_gaps_are_told_as_a_least(gaps: MeshGaps) -> None:
    cube = box(1, 1, 1)
    at = np.stack([np.linspace(1.01, 6.0, 30), np.zeros(30), np.zeros(30)], axis=-1)
    parts = placed(cube, np.zeros((30, 3))), placed(cube, at)
    exact, quick = gaps.gaps(*parts, np.inf), gaps.gaps(*parts, 1.0)
    assert np.all(quick <= exact + EXACT)
    np.testing.assert_array_equal(np.minimum(quick, 1.0)[quick < 1.0], exact[quick < 1.0])
    assert np.all(exact[quick >= 1.0] >= 1.0)
    assert (quick < exact).any()


def test_the_capsule_about_a_shape_holds_it() -> None:
    random = np.random.default_rng(4)
    for sides in ((1, 0.1, 0.1), (0.3, 0.3, 0.3), (0.5, 0.4, 0.01)):
        turned = box(*sides).points @ turns(1, 3)[0].T + random.normal(size=3)
        mesh = MeshShape("part", "n", np.zeros(3), turned, box(*sides).triangles)
        (a, b), radius = mesh.around
        share = np.clip((turned - a) @ (b - a) / max((b - a) @ (b - a), 1e-30), 0.0, 1.0)
        off = np.linalg.norm(turned - a - share[:, None] * (b - a), axis=1)
        assert off.max() <= radius * (1 + 1e-12)
        assert radius < 1.1 * np.linalg.norm(sides) / 2
        assert mesh.half == pytest.approx(min(sides) / 2, rel=1e-9)


def test_inside_is_where_the_winding_number_is_one() -> None:
    ring = trimesh.creation.annulus(0.2, 0.5, 0.4)
    points = np.random.default_rng(6).uniform(-0.6, 0.6, (500, 3))
    across = np.hypot(points[:, 0], points[:, 1])
    # a ring of straight sides is off the round one by their sag
    clear = np.abs(across - 0.2) > 0.01
    clear &= np.abs(across - 0.5) > 0.01
    wanted = (across > 0.2) & (across < 0.5) & (np.abs(points[:, 2]) < 0.2)
    found = inside(points, np.asarray(ring.triangles))
    np.testing.assert_array_equal(found[clear], wanted[clear])
    assert 30 < found.sum() < 300


def test_depths_of_triangles_and_hulls() -> None:
    flat = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]])
    # a needle through its plane, by its shorter side
    needle = np.array([[[0.2, 0.2, -0.03], [0.2, 0.21, 0.5], [0.21, 0.2, 0.5]]])
    assert crossing_depth(flat, needle) == pytest.approx(0.03, abs=1e-3)
    assert crossing_depth(flat, needle + np.array([0, 0, 0.1])) == 0.0
    assert crossing_depth(flat[:0], needle[:0]) == 0.0
    cube = box(1, 1, 1).corners
    assert hull_depth(cube, cube + np.array([0.9, 0.2, 0.0])) == pytest.approx(0.1, abs=EXACT)
    assert hull_depth(cube, cube + np.array([1.2, 0.0, 0.0])) == 0.0


@pytest.mark.parametrize(
    ("points", "triangles", "words"),
    [
        (np.zeros((0, 3)), np.zeros((0, 3), int), "has no triangles"),
        (np.full((3, 3), np.nan), [[0, 1, 2]], "not finite"),
        (np.eye(3), [[0, 1, 3]], "does not exist"),
        (np.eye(3), np.zeros((MOST_TRIANGLES + 1, 3), int), "is the limit"),
    ],
)
def test_shapes_that_are_none(points: Any, triangles: Any, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        MeshShape("part", "n", np.zeros(3), points, triangles)


def four_bars() -> tuple[Any, Any, Capsule, MeshShape, MeshShape]:
    """A four-bar linkage: a thin capsule along bar 2, boxes about the first ends of 1 and 3."""
    linkage, home = chain([[0, 0, 0], [0, 1, 0], [3, 2, 0], [3, 0, 0]], [[0, 0, 1.0]] * 4)
    nodes = {b.name: b.nodes for b in linkage.bodies}
    cube = box(0.2, 0.5, 0.2)
    made = []
    for name in ("bar1", "bar3"):
        at = home.positions[linkage.node_index[nodes[name][0]]]
        made.append(MeshShape(name, nodes[name][0], at, at + cube.points, cube.triangles))
    # a body without a part would join its neighbours
    return linkage, home, Capsule("bar2", nodes["bar2"], 0.01), made[0], made[1]


@pytest.mark.usefixtures("gaps")
def test_pairs_of_meshes_and_capsules_of_a_linkage() -> None:
    linkage, home, between, first, third = four_bars()
    nodes = {b.name: b.nodes for b in linkage.bodies}
    rod = Capsule("rod3", nodes["bar3"], 0.1)
    both = Interference(linkage, (between,), (first, third))
    mixed = Interference(linkage, (between, rod), (first,))
    assert [both.words(q) for q in range(len(both.pairs))] == ["bar1 and bar3"]
    assert [mixed.words(q) for q in range(len(mixed.pairs))] == ["rod3 and bar1"]
    ends = [home.positions[linkage.node_index[s.node]] for s in (first, third)]
    apart = np.maximum(np.abs(ends[1] - ends[0]) - [0.2, 0.5, 0.2], 0.0)
    assert both.gaps(home, np.inf)[0] == pytest.approx(np.linalg.norm(apart), abs=EXACT)
    assert both.reach == pytest.approx([0.2])
    assert mixed.reach == pytest.approx([0.2])
    assert "2 meshes" in repr(both)
    assert both.check(home) is both
    with pytest.raises(ModelError, match="does not give the rotation of its body"):
        both.gaps(home[None])


@pytest.mark.usefixtures("gaps")
def test_meshes_that_collide_at_home_are_named() -> None:
    linkage, home, between, first, third = four_bars()
    wide = replace(first, points=first.place + first.local * [40.0, 8.0, 1.0])
    with pytest.raises(ModelError, match=r"bar1 and bar3: interfere at home: .* at least \d+"):
        Interference(linkage, (between,), (wide, third)).check(home)


def test_without_the_library_the_remedy_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    linkage, _, _, first, third = four_bars()
    monkeypatch.setitem(sys.modules, "fcl", None)
    with pytest.raises(ModelError, match=r"pip install strutwork\[interference\]"):
        Interference(linkage, (), (first, third))
