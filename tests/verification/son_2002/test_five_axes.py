"""Five axes of the MIT-SS-1 as one map of a surface, eqs 38 to 47.

@phdthesis{son2002,
  author = {Son, Seung-Kil},
  title  = {A Hybrid Type Small 5-Axis {CNC} Milling Machine},
  school = {Massachusetts Institute of Technology},
  year   = {2002}
}

The thesis prints formulas and no numbers here. What is asserted is geometry that the formulas do
not use: matrices that turn the workpiece, and distances between pins. 1e-15 is a few units in the
last place of a unit vector, 1e-14 m the same of lengths and heights of up to 1 m; points lie within
the travel of the struts.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.machines import MitSS1, WorkTable
from strutwork.papers.son_2002.five_axes import DRIVES, five_axes, five_axes_field, tilts

Array = NDArray[Any]


@pytest.fixture(scope="module")
def asked() -> tuple[Array, Array]:
    """Points of the workpiece within ±40 mm and unit normals up to 60° about x, 30° about y."""
    draw = np.random.default_rng(5)
    work = draw.uniform(-0.04, 0.04, (500, 3))
    lean = draw.uniform(-1.0, 1.0, (500, 2)) * np.radians([60.0, 30.0])
    normal = Rotation.from_euler("yx", lean[:, ::-1]).apply([0.0, 0.0, 1.0])
    return work, normal


def turned(drives: Array, vectors: Array) -> Array:
    """Vectors of the workpiece in the machine's axes: the table turns by θ₅ = −a about x."""
    return np.asarray(Rotation.from_rotvec(drives[:, 4:] * [1.0, 0.0, 0.0]).apply(vectors))


def test_tool_axis_is_the_turned_normal(asked: tuple[Array, Array]) -> None:
    work, normal = asked
    drives = five_axes(work, normal)
    _, b = tilts(normal)
    axis = np.stack([np.sin(b), 0 * b, np.cos(b)], axis=-1)
    np.testing.assert_allclose(axis, turned(drives, normal), rtol=0.0, atol=1e-15)
    # the same directions at any length
    np.testing.assert_allclose(five_axes(work, 7.3 * normal), drives, rtol=0.0, atol=1e-14)


def test_tool_tip_comes_back_to_the_point(asked: tuple[Array, Array]) -> None:
    """Eqs 38 and 39 by a matrix: the table's point stands where the struts' tool stands."""
    work, normal = asked
    drives, table = five_axes(work, normal), WorkTable()
    on_carriage = turned(drives, work + np.array([0.0, 0.0, table.table_height]))
    tip = on_carriage + np.array([0.0, 0.0, table.axis_height])
    tip[:, 1] += drives[:, 3]
    assert np.abs(tip[:, 1]).max() <= 1e-14
    a, _ = tilts(normal)
    np.testing.assert_allclose(tip, table.tool_position(work, a), rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(table.work_position(tip, drives[:, 3:]), work, rtol=0.0, atol=1e-14)


def test_struts_keep_their_lengths(asked: tuple[Array, Array]) -> None:
    """Eqs 43 to 45: from the blocks to the pins on the housing, 1e-14 m over lengths of 0.4 m."""
    work, normal = asked
    machine = MitSS1()
    drives = five_axes(work, normal)
    a, b = tilts(normal)
    seats = Rotation.from_rotvec(b[:, None] * [0.0, 1.0, 0.0]).as_matrix() @ machine.seats.T
    pins = WorkTable().tool_position(work, a)[:, None] + np.swapaxes(seats, 1, 2)
    blocks = np.stack(
        [np.broadcast_to(machine.rails, (500, 3)), np.zeros((500, 3)), drives[:, :3]], axis=-1
    )
    lengths = np.linalg.norm(blocks - pins, axis=-1)
    np.testing.assert_allclose(lengths - machine.strut_lengths, 0.0, rtol=0.0, atol=1e-14)


def test_out_of_reach_is_no_number() -> None:
    drives = five_axes([[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]], [0.0, 0.0, 1.0])
    assert np.isfinite(drives[0]).all()
    assert np.isnan(drives[1]).all()


def test_gradients_over_a_surface() -> None:
    """Central differences: 1e-8 is their own error at steps of 1e-5 m and rounding over that."""

    def surface(points: Array) -> tuple[Array, Array]:
        u, v = points[:, 0], points[:, 1]
        normal = np.stack([-2.0 * u, -1.0 * v, 1.0 + 0 * u], axis=-1)
        return np.stack([u, v, u * u + 0.5 * v * v], axis=-1), normal

    points = np.array([[0.01, 0.02], [-0.02, 0.005], [0.03, -0.03], [0.6, 0.0]])
    field = five_axes_field(surface)
    assert field.drives == DRIVES
    found = field.gradient(points)
    assert np.isnan(found[3]).all()
    step = 1e-5
    for k, way in enumerate(step * np.eye(2)):
        high, low = (five_axes(*surface(points[:3] + s * way)) for s in (1, -1))
        np.testing.assert_allclose(found[:3, :, k], (high - low) / (2 * step), atol=1e-8)
