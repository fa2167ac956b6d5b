"""Straight and curved edges of quadratic cells."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from strutwork.meshes import block, is_straight, linear, moved, quadratic, straightened, unbent
from strutwork.meshes.cells import CELL_TYPES
from strutwork.meshes.quality import quality
from tests.solid_cases import bent, cells_of

SIZE = (0.3, 0.2, 0.4)


def test_middle_nodes_in_the_middle_are_straight_up_to_the_rounding_of_a_file() -> None:
    mesh = moved(quadratic(block(SIZE, (2, 1, 1))), translation=(1.0, 2.0, 3.0))
    assert is_straight(mesh)
    assert is_straight(replace(mesh, points=mesh.points.astype(np.float32)))
    off = mesh.points.copy()
    off[-1] += 1e-5
    assert not is_straight(replace(mesh, points=off))
    assert is_straight(linear(bent(block(SIZE, (1, 1, 1)))))


def test_straightened_cells_alone_lose_their_bends() -> None:
    mesh = bent(cells_of("tetra", SIZE, (2, 1, 1)))
    made = straightened(mesh, np.array([3]))
    own = mesh.blocks[0].nodes[3]
    moved_ = np.flatnonzero((made.points != mesh.points).any(axis=1))
    assert set(moved_) == set(own[4:])
    ends = [list(p) for p in CELL_TYPES["tetra10"].parents[4:]]
    for node, (a, b) in zip(own[4:], ends, strict=True):
        np.testing.assert_allclose(
            made.points[node], (made.points[own[a]] + made.points[own[b]]) / 2, atol=1e-15
        )


def test_what_curves_turn_inside_out_is_made_straight_and_the_rest_stays() -> None:
    mesh = bent(cells_of("tetra", SIZE, (3, 3, 3)), share=0.2)
    before = quality(mesh).inverted
    made, cells = unbent(mesh)
    assert 0 < len(before) <= len(cells) < mesh.cell_count
    assert set(before) <= set(cells)
    assert len(quality(made).inverted) == 0
    # nodes of no such cell stay where they are
    touched = np.unique(mesh.blocks[0].nodes[cells])
    others = np.setdiff1d(np.arange(len(mesh.points)), touched)
    assert len(others) > 0
    np.testing.assert_array_equal(made.points[others], mesh.points[others])
    # of a sound mesh nothing changes
    sound = bent(cells_of("tetra", SIZE, (2, 1, 1)))
    same, none = unbent(sound)
    assert same is sound
    assert len(none) == 0
