"""What holds for every mesh: rotation, refinement, order and files change no body."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from strutwork.meshes import (
    Mesh,
    block,
    boundary,
    cell_volumes,
    hexahedral_block,
    mass_properties,
    merged,
    moved,
    nodal_area_vectors,
    patch_area,
    quadratic,
    quality,
    refined,
    surface_of,
    surface_properties,
)
from strutwork.meshes.cells import CUBE
from tests.mesh_cases import every_kind

#: Corners moved by less than this share of the edge leave every cell in order.
SHAKE = 0.15
KINDS = st.sampled_from(sorted(every_kind()))


@st.composite
def shaken_blocks(draw: st.DrawFn) -> Mesh:
    """Blocks of any proportion whose corners are anywhere near those of a brick."""
    size = np.array([draw(st.floats(0.1, 10.0)) for _ in range(3)])
    shake = np.random.default_rng(draw(st.integers(0, 2**32 - 1))).uniform(-SHAKE, SHAKE, (8, 3))
    divisions = [draw(st.integers(1, 3)) for _ in range(3)]
    return hexahedral_block((np.array(CUBE) + shake) * size, divisions)


@st.composite
def rotations(draw: st.DrawFn) -> np.ndarray:
    return Rotation.random(rng=np.random.default_rng(draw(st.integers(0, 2**32 - 1)))).as_matrix()


@given(KINDS, rotations(), st.floats(-5.0, 5.0))
@settings(max_examples=40)
def test_a_mesh_turned_and_shifted_is_the_same_body(
    kind: str, rotation: np.ndarray, shift: float
) -> None:
    mesh = every_kind()[kind]
    turned = moved(mesh, rotation, (shift, -shift, 2.0 * shift))
    before, after = quality(mesh), quality(turned)
    assert after.volume == pytest.approx(before.volume, rel=1e-11)
    assert after.scaled_jacobian == pytest.approx(before.scaled_jacobian, rel=1e-10)
    assert after.aspect_ratio == pytest.approx(before.aspect_ratio, rel=1e-10)
    first, second = mass_properties(mesh, 1.0), mass_properties(turned, 1.0)
    wanted = rotation @ first.centre + [shift, -shift, 2.0 * shift]
    assert second.centre == pytest.approx(wanted, rel=1e-11, abs=1e-11)
    inertia = rotation @ first.inertia @ rotation.T
    assert second.inertia == pytest.approx(inertia, rel=1e-9, abs=1e-9)


@given(shaken_blocks())
@settings(max_examples=30)
def test_refinement_and_order_keep_the_volume_of_trilinear_blocks(mesh: Mesh) -> None:
    volume = cell_volumes(mesh).sum()
    # the middle nodes of a trilinear cell lie on it
    assert cell_volumes(quadratic(mesh)).sum() == pytest.approx(volume, rel=1e-12)
    assert cell_volumes(quadratic(mesh, serendipity=True)).sum() == pytest.approx(volume, rel=1e-12)
    assert cell_volumes(refined(mesh)).sum() == pytest.approx(volume, rel=1e-12)


@given(shaken_blocks())
@settings(max_examples=30)
def test_the_divergence_theorem_holds_on_every_block(mesh: Mesh) -> None:
    nodes, vectors = nodal_area_vectors(mesh, boundary(mesh))
    scale = patch_area(mesh, boundary(mesh))
    assert np.abs(vectors.sum(axis=0)).max() < 1e-13 * scale
    # the field x is linear on each face, and so exact at its nodes
    flux = np.sum(mesh.points[nodes] * vectors) / 3.0
    assert flux == pytest.approx(cell_volumes(mesh).sum(), rel=1e-10)


@given(rotations(), st.tuples(*[st.integers(1, 3)] * 3))
@settings(max_examples=30)
def test_the_triangles_around_a_brick_bound_what_its_cells_fill(
    rotation: np.ndarray, divisions: tuple[int, int, int]
) -> None:
    mesh = moved(block((1.0, 2.0, 0.5), divisions), rotation)
    found = surface_properties(surface_of(mesh, boundary(mesh)), 7.0)
    wanted = mass_properties(mesh, 7.0)
    assert found.volume == pytest.approx(wanted.volume, rel=1e-12)
    assert found.centre == pytest.approx(wanted.centre, rel=1e-11, abs=1e-11)
    assert found.inertia == pytest.approx(wanted.inertia, rel=1e-9, abs=1e-9)


@given(shaken_blocks(), st.integers(0, 2**32 - 1))
@settings(max_examples=30)
def test_nodes_torn_apart_are_merged_again(mesh: Mesh, seed: int) -> None:
    cells = mesh.blocks[0].nodes
    order = np.random.default_rng(seed).permutation(cells.size)
    number = np.argsort(order)
    torn = replace(
        mesh,
        points=mesh.points[cells.ravel()][order],
        blocks=(replace(mesh.blocks[0], nodes=number.reshape(cells.shape)),),
        patches={},
    )
    found = merged(torn)
    assert len(found.points) == len(mesh.points)
    assert cell_volumes(found).sum() == pytest.approx(cell_volumes(mesh).sum(), rel=1e-12)
    assert len(boundary(found)) == len(boundary(mesh))
