"""Generated meshes: volumes, sides, mesh lines, and what is refused."""

from __future__ import annotations

from math import pi, sin

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.meshes import (
    Mesh,
    block,
    boundary,
    check_connectivity,
    hexahedral_block,
    l_frame,
    lines,
    lines_through,
    mass_properties,
    patch_area,
    plate_with_patches,
    quality,
    tube,
)

#: Of sums of a few thousand terms of order one.
ROUNDING = 1e-12


def volume(mesh: Mesh) -> float:
    return float(quality(mesh).volume.sum())


def test_block_has_its_volume_sides_and_sizes() -> None:
    mesh = block((1.0, 2.0, 3.0), (2, 3, 4), (1.0, 2.0, 0.5))
    assert volume(mesh) == pytest.approx(6.0, rel=ROUNDING)
    assert mesh.cell_count == 24
    areas = {side: patch_area(mesh, patch) for side, patch in mesh.patches.items()}
    wanted = {"-x": 6.0, "+x": 6.0, "-y": 3.0, "+y": 3.0, "-z": 2.0, "+z": 2.0}
    assert areas == pytest.approx(wanted, rel=ROUNDING)
    assert repr(mesh) == (
        "Mesh(block: 60 points, 24 hexahedron, 1 regions, 6 patches, 1 × 2 × 3 m)"
    )


def test_grading_is_last_over_first_cell() -> None:
    steps = np.diff(lines(2.0, 7, 5.0))
    assert steps[-1] / steps[0] == pytest.approx(5.0)
    assert steps[1:] / steps[:-1] == pytest.approx(np.full(6, 5.0 ** (1 / 6)))
    both = np.diff(lines(2.0, 7, 5.0, both=True))
    assert both == pytest.approx(both[::-1])
    assert both[3] / both[0] == pytest.approx(5.0)
    assert lines(2.0, 7, 5.0)[-1] == 2.0


def test_lines_fall_on_every_stop_and_are_no_farther_apart_than_asked() -> None:
    found = lines_through((0.0, 0.3, 1.0, 1.0 + 1e-12), 0.1)
    assert len(found) == 11
    assert 0.3 in found
    graded = lines_through((0.0, 0.3, 1.0), 0.1, towards=(0.3,), ratio=4.0)
    steps = np.diff(graded)
    assert steps.max() <= 0.1 * (1 + 1e-9)
    at = int(np.flatnonzero(graded == 0.3)[0])
    assert steps[at:].max() / steps[at] == pytest.approx(4.0)
    assert steps[:at].max() / steps[at - 1] == pytest.approx(4.0)


def test_hexahedral_block_has_the_volume_of_its_corners() -> None:
    # a frustum of a pyramid: h/3 (A + B + sqrt(A B))
    below = np.array([(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)], dtype=float)
    above = np.array([(0.5, 0.5, 3), (1.5, 0.5, 3), (1.5, 1.5, 3), (0.5, 1.5, 3)])
    mesh = hexahedral_block(np.concatenate([below, above]), (3, 2, 4))
    assert volume(mesh) == pytest.approx(3.0 / 3.0 * (4.0 + 1.0 + 2.0), rel=ROUNDING)
    assert patch_area(mesh, mesh.patch("+z")) == pytest.approx(1.0, rel=ROUNDING)


@pytest.mark.parametrize("corner_ratio", [1.0, 3.0])
def test_l_frame_is_a_plate_on_a_base(corner_ratio: float) -> None:
    mesh = l_frame(
        *((0.9, 0.6, 1.5), 0.184, 0.228),
        size=0.17,
        corner_ratio=corner_ratio,
        stops={"x": (0.1, 0.8)},
    )
    wanted = 0.9 * (0.6 * 0.228 + 0.184 * (1.5 - 0.228))
    assert volume(mesh) == pytest.approx(wanted, rel=ROUNDING)
    total = sum(patch_area(mesh, patch) for patch in mesh.patches.values())
    assert total == pytest.approx(patch_area(mesh, boundary(mesh)), rel=ROUNDING)
    front = patch_area(mesh, mesh.patch("plate front"))
    assert front == pytest.approx(0.9 * (1.5 - 0.228), rel=ROUNDING)
    assert {0.1, 0.8} <= set(mesh.points[:, 0])
    corner = mesh.points[mesh.node_set("bottom right front")]
    assert corner.tolist() == [[0.9, 0.6, 0.0]]
    check_connectivity(mesh)


def test_tube_of_straight_edges_is_a_prism_over_a_polygon() -> None:
    mesh = tube(0.05, 0.08, 0.3, (2, 16, 3))
    polygon = 16 / 2 * sin(2 * pi / 16) * (0.08**2 - 0.05**2)
    assert volume(mesh) == pytest.approx(polygon * 0.3, rel=ROUNDING)
    assert patch_area(mesh, mesh.patch("+z")) == pytest.approx(polygon, rel=ROUNDING)
    # closed around: nothing is left of the seam
    total = sum(patch_area(mesh, patch) for patch in mesh.patches.values())
    assert total == pytest.approx(patch_area(mesh, boundary(mesh)), rel=ROUNDING)
    check_connectivity(mesh)


def test_tube_of_curved_edges_tends_to_the_ring_with_the_fourth_power() -> None:
    exact = pi * (0.08**2 - 0.05**2) * 0.3
    errors = [
        abs(volume(tube(0.05, 0.08, 0.3, (1, around, 1), order=2)) / exact - 1.0)
        for around in (8, 16)
    ]
    assert errors[1] < 1e-4
    assert errors[0] / errors[1] == pytest.approx(16.0, rel=0.1)


def test_mass_properties_of_a_block_are_those_of_the_formula() -> None:
    a, b, c, density = 0.4, 0.7, 1.1, 7850.0
    mesh = block((a, b, c), (2, 3, 2))
    shifted = Mesh(mesh.points + np.array([100.0, -50.0, 3.0]), mesh.blocks)
    found = mass_properties(shifted, density)
    mass = density * a * b * c
    assert found.mass == pytest.approx(mass, rel=ROUNDING)
    assert found.centre == pytest.approx([100.0 + a / 2, -50.0 + b / 2, 3.0 + c / 2], rel=1e-12)
    inertia = mass / 12.0 * np.diag([b * b + c * c, a * a + c * c, a * a + b * b])
    # coordinates of order 100 keep 1e-14 of themselves
    assert found.inertia == pytest.approx(inertia, rel=1e-11, abs=1e-9)
    assert found.to_dict()["mass_kg"] == found.mass


def test_each_region_has_its_own_density() -> None:
    mesh = block((1.0, 1.0, 1.0), (1, 1, 1), region="granite")
    assert mass_properties(mesh, {"granite": 3000.0}).mass == pytest.approx(3000.0)
    with pytest.raises(ModelError, match="no density is given for region 'granite'"):
        mass_properties(mesh, {"steel": 7850.0})
    with pytest.raises(ModelError, match="its density is -1"):
        mass_properties(mesh, -1.0)


def test_plate_lines_fall_on_the_edges_of_its_patches() -> None:
    mesh = plate_with_patches(
        (1.0, 0.5, 0.05), {"rail": (0.1, 0.3, 0.0, 0.5), "pad": (0.2, 0.9, 0.11, 0.2)}, cell=0.1
    )
    assert volume(mesh) == pytest.approx(0.025, rel=ROUNDING)
    assert patch_area(mesh, mesh.patch("rail")) == pytest.approx(0.1, rel=ROUNDING)
    assert patch_area(mesh, mesh.patch("pad")) == pytest.approx(0.7 * 0.09, rel=ROUNDING)
    assert mesh.points[mesh.patch("pad").nodes, 2].tolist() == [0.05] * len(mesh.patch("pad").nodes)


TWISTED = [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0), (0, 0, 1), (0, 1, 1), (1, 1, 1), (1, 0, 1)]


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: block((1.0, 0.0, 1.0), (1, 1, 1)), "length is 0"),
        (lambda: block((1.0, 1.0, 1.0), (1, 0, 1)), "divisions is 0"),
        (lambda: block((1.0, 1.0, 1.0), (1, 2, 1), (1.0, -1.0, 1.0)), "ratio is -1"),
        (lambda: hexahedral_block(TWISTED, (2, 2, 2)), "8 of 8 cells are inverted or flat"),
        (lambda: hexahedral_block(TWISTED[:7], (2, 2, 2)), r"shape \(7, 3\)"),
        (lambda: lines_through((0.0,), 0.1), "the stops are"),
        (lambda: lines_through((0.0, 1.0), 0.0), "the cell size is 0"),
        (lambda: l_frame((1, 1, 1), 1.0, 0.2, size=0.2), "leave no L"),
        (lambda: l_frame((1, 1, 1), -0.1, 0.2, size=0.2), "plate is -0.1 m"),
        (lambda: l_frame((1, 1, 1), 0.1, 0.2, size=0.2, stops={"x": (2.0,)}), "outside 0 to 1"),
        (lambda: l_frame((1, 1, 1), 0.1, 0.2, size=0.2, stops={"r": (2.0,)}), "stops along"),
        (lambda: tube(0.0, 1.0, 1.0, (1, 8, 1)), "its radii are 0.0 and 1.0 m"),
        (lambda: tube(2.0, 1.0, 1.0, (1, 8, 1)), "its radii"),
        (lambda: tube(0.5, 1.0, 1.0, (1, 2, 1)), "2 cells around"),
        (lambda: plate_with_patches((1, 1, 0.1), {"a": (0.5, 1.5, 0, 1)}, cell=0.2), "leaves"),
        (lambda: plate_with_patches((1, 1, 0.1), {"a": (0.5, 0.5, 0, 1)}, cell=0.2), "empty"),
        (lambda: plate_with_patches((1, 1, 0.1), {"+z": (0, 0.5, 0, 1)}, cell=0.2), "of a side"),
    ],
)
def test_what_makes_no_mesh_is_refused(make: object, words: str) -> None:
    assert callable(make)
    with pytest.raises(ModelError, match=words):
        make()
