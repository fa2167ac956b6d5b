"""The camera of a 3-D view: all of a machine is seen, and it fills its box."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from strutwork.reports.figures.camera import ASPECT, BOTTOM, SIDES, TANGENT, TOP, camera_of

SHAPES = [(1, 1, 1), (0.3, 0.3, 1.5), (1.5, 0.3, 0.3), (0.3, 1.5, 0.4), (1.2, 1.2, 0.24)]


@pytest.mark.parametrize("ratio", SHAPES)
def test_a_box_of_any_proportions_fills_the_view_and_is_not_cut(
    ratio: tuple[float, float, float],
) -> None:
    camera = camera_of(np.array(ratio))
    eye, centre = (np.array(list(camera[key].values())) for key in ("eye", "center"))
    away = eye - centre
    distance = float(np.linalg.norm(away))
    way = away / distance
    right = np.cross([0, 0, 1], way)
    right /= np.linalg.norm(right)
    up = np.cross(way, right)
    corners = np.array(list(itertools.product((-0.5, 0.5), repeat=3))) * ratio - centre
    reach = TANGENT * (distance - corners @ way)
    high, wide = corners @ up / reach, corners @ right / (ASPECT * reach)
    assert high.max() <= TOP + 1e-6
    assert high.min() >= -BOTTOM - 1e-6
    assert np.abs(wide).max() <= SIDES + 1e-6
    # one of the margins is reached: nearer it would be cut
    full = [high.max() / TOP + high.min() / -BOTTOM, 2 * np.abs(wide).max() / SIDES]
    assert max(full) == pytest.approx(2.0, abs=1e-3)
