"""Level sets of margins: measures within their errors, components, holes, exact borders."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics.margin_grid import margin_grid
from strutwork.kinematics.margins import Margins, of_slacks
from strutwork.kinematics.regions import regions
from strutwork.studies.level_set import apart, level_set

Array = NDArray[Any]


def shape(function: Callable[[Array], Array]) -> Callable[[Array], Margins]:
    return lambda points: of_slacks({"shape": function(points)})


def axes(dimensions: int, count: int, half: float = 1.5) -> list[Array]:
    return [np.linspace(-half, half, count)] * dimensions


BALLS = {1: 2.0, 2: np.pi, 3: 4 / 3 * np.pi}


@pytest.mark.parametrize("dimensions", BALLS)
def test_a_ball_within_its_error_which_falls_fourfold(dimensions: int) -> None:
    ball = shape(lambda p: 1.0 - np.linalg.norm(p, axis=1))
    errors = []
    for count in (21, 41):
        grid = margin_grid("xyz"[:dimensions], axes(dimensions, count), ball)
        measure, coarse = level_set(grid).measure, level_set(grid.coarse()).measure
        errors.append(abs(measure - BALLS[dimensions]))
        # the place of a crossing is known to half of 1/4096 of a cell
        rounding = 2 * dimensions * BALLS[dimensions] * grid.step[0] / 8192
        assert errors[-1] <= abs(measure - coarse) + rounding
    if dimensions > 1:
        # chords of a smooth border: second order
        assert errors[1] < 0.35 * errors[0]


def test_a_ring_has_a_hole_and_two_discs_are_two_components() -> None:
    ring = shape(lambda p: 0.4 - np.abs(np.linalg.norm(p, axis=1) - 0.9))
    grid = margin_grid("xy", axes(2, 61), ring)
    found = regions(grid.good)
    assert (len(found.sizes), found.holes) == (1, 1)
    assert level_set(grid).measure == pytest.approx(np.pi * (1.3**2 - 0.5**2), rel=2e-3)
    # home in the hole belongs to nothing
    assert found.of(np.array([30.0, 30.0])) == 0
    discs = shape(lambda p: 0.4 - np.linalg.norm(np.abs(p) - [0.8, 0.0], axis=1))
    grid = margin_grid("xy", axes(2, 61), discs)
    found = regions(grid.good)
    assert (len(found.sizes), found.holes) == (2, 0)
    left, right = found.of(np.array([14.2, 30.0])), found.of(np.array([46.0, 30.4]))
    assert {left, right} == {1, 2}


def test_a_hollow_ball_in_space() -> None:
    shell = shape(lambda p: 0.35 - np.abs(np.linalg.norm(p, axis=1) - 0.9))
    grid = margin_grid("xyz", axes(3, 41), shell)
    found = regions(grid.good)
    assert (len(found.sizes), found.holes) == (1, 1)
    measure = level_set(grid).measure
    assert measure == pytest.approx(4 / 3 * np.pi * (1.25**3 - 0.55**3), rel=1e-2)


def test_errors_of_an_outer_and_an_inner_border_do_not_cancel() -> None:
    # chords lose outside what they gain inside: the measures of two grids nearly agree
    ring = shape(lambda p: 0.4 - np.abs(np.linalg.norm(p, axis=1) - 0.9))
    grid = margin_grid("xy", axes(2, 25), ring)
    fine, coarse = level_set(grid), level_set(grid.coarse())
    error = abs(fine.measure - np.pi * (1.3**2 - 0.5**2))
    between = apart(fine, coarse, 2 * grid.step)
    assert error < between < 0.02 * fine.measure
    assert between > 2 * abs(fine.measure - coarse.measure)
    ball = margin_grid("xyz", axes(3, 21), shape(lambda p: 1.0 - np.linalg.norm(p, axis=1)))
    fine, coarse = level_set(ball), level_set(ball.coarse())
    assert apart(fine, coarse, 2 * ball.step) >= abs(fine.measure - coarse.measure)


@pytest.mark.parametrize("dimensions", [1, 2, 3])
def test_the_border_is_closed_where_the_grid_ends(dimensions: int) -> None:
    everything = shape(lambda p: np.ones(len(p)))
    grid = margin_grid("xyz"[:dimensions], axes(dimensions, 5), everything)
    found = level_set(grid)
    assert (found.crossing == -1).all()
    # the corners are cut by cells outside the grid, whose size is nothing
    assert found.measure == pytest.approx(3.0**dimensions, rel=1e-12)
    nothing = margin_grid(
        "xyz"[:dimensions], axes(dimensions, 5), shape(lambda p: -np.ones(len(p)))
    )
    assert level_set(nothing).measure == 0.0


def test_the_border_names_what_it_is_made_of() -> None:
    def half(points: Array) -> Margins:
        return of_slacks({"left": points[:, 0] + 1.0, "right": 0.5 - points[:, 0]})

    grid = margin_grid("xy", axes(2, 21), half)
    found = level_set(grid)
    sizes = found.facet_sizes(np.ones(2))
    assert sizes.sum() == pytest.approx(2 * (1.5 + 3.0), rel=1e-3)
    on = found.crossing[found.facets]
    inner = (on >= 0).all(axis=1)
    words = np.array(grid.crossings.reasons)[grid.crossings.reason[on[inner, 0]]]
    place = found.points[found.facets[inner, 0], 0]
    np.testing.assert_allclose(place, np.where(words == "left", -1.0, 0.5), atol=1e-4)
    assert set(words) == {"left", "right"}


def test_wrong_grids() -> None:
    good = shape(lambda p: np.ones(len(p)))
    with pytest.raises(ModelError, match="odd number"):
        margin_grid("x", [np.linspace(0, 1, 6)], good)
    with pytest.raises(ModelError, match="one, two or three"):
        margin_grid("", [], good)
    with pytest.raises(ModelError, match="evenly spaced"):
        margin_grid("x", [np.array([0.0, 1.0, 2.0, 4.0, 5.0])], good)
    with pytest.raises(ModelError, match="not a number"):
        margin_grid("x", axes(1, 5), shape(lambda p: np.full(len(p), np.nan)))
