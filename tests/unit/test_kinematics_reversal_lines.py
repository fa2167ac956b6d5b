"""Reversal lines, plates, and paths without a reversal."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.kinematics.clear_paths import path_reversals
from strutwork.kinematics.drive_fields import FormulaField, MotionField
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.reversals import reversals
from strutwork.kinematics.task_surfaces import Dome, sphere
from strutwork.kinematics.zero_lines import roots_between
from strutwork.machines import HexelHexapod

Array = NDArray[Any]


def hexapod(surface: Any) -> MotionField:
    machine = HexelHexapod()
    home = machine.home()
    motion = Motion(machine.linkage, machine.place(home), home.rotation)
    return MotionField(motion, surface, machine.place)


def circles() -> FormulaField:
    """Along u it turns back on a circle of radius 0.7; a second drive follows v."""
    return FormulaField(
        ("ring", "plain"),
        lambda p: np.stack(
            [
                np.stack([(p * p).sum(-1) - 0.49, 2 * p[:, 0] * p[:, 1]], axis=-1),
                np.stack([0 * p[:, 0], 1 + 0 * p[:, 0]], axis=-1),
            ],
            axis=1,
        ),
    )


def test_reversal_line_is_the_whole_circle() -> None:
    found = reversals(circles(), np.linspace(-1, 1, 22), np.linspace(-1, 1, 23))
    lines = found.lines([1, 0])
    # the feed does not move the second drive
    assert list(lines) == ["ring"]
    (line,) = lines["ring"]
    assert np.array_equal(line[0], line[-1])
    assert np.linalg.norm(line, axis=-1) == pytest.approx(np.full(len(line), 0.7), abs=1e-9)
    around = np.unwrap(np.arctan2(line[:, 1], line[:, 0]))
    assert abs(around[-1] - around[0]) == pytest.approx(2 * np.pi)


def test_two_lines_through_one_cell_stay_apart() -> None:
    """A hyperbola whose branches pass the cell in the middle: its centre says how."""
    for sign in (1.0, -1.0):
        field = FormulaField(
            ("one",),
            lambda p, s=sign: np.stack([p[:, 0] * p[:, 1] - s * 0.01, 0 * p[:, 0] + 1], -1)[
                :, None
            ],
        )
        found = reversals(field, *[np.linspace(-1.5, 1.5, 4)] * 2)
        lines = found.lines([1, 0])["one"]
        assert len(lines) == 2
        for line in lines:
            product = np.sign(line[:, 0]) * np.sign(line[:, 1])
            assert np.all(product == sign)


def test_plates_and_their_borders() -> None:
    """det(C₁, C₂) of (1, 0) and (u, v) is v: two plates, whose border is v = 0."""
    field = FormulaField(
        ("first", "second"),
        lambda p: np.stack([np.broadcast_to([1.0, 0.0], p.shape), p], axis=1),
    )
    found = reversals(field, np.linspace(-1, 1, 8), np.linspace(-1, 1, 10))
    assert found.plates.max() == 2
    assert (found.plates[:, 5:] == 2).all() ^ (found.plates[:, 5:] == 1).all()
    ((line,),) = found.plate_borders().values()
    assert np.abs(line[:, 1]).max() <= 1e-9


def test_reach_goes_round_no_extremum() -> None:
    """f = u² + v² beside u and v, from (a, 0): beyond the middle all of |v| < a is lost.

    A path there crosses u = 0, where f = v²; v keeps its way and has less than a to go, so that
    f has fallen, and has to grow again.
    """
    field = FormulaField(
        ("bowl", "along", "across"),
        lambda p: np.stack(
            [2 * p, np.broadcast_to([1.0, 0.0], p.shape), np.broadcast_to([0.0, 1.0], p.shape)],
            axis=1,
        ),
    )
    shares = []
    for half in (10, 20):
        axis = np.linspace(-1, 1, 2 * half + 1)
        seen = reversals(field, axis, axis).reach((3 * half // 2, half))
        u, v = np.meshgrid(axis, axis, indexing="ij")
        lost = (np.abs(v) < 0.5 - 1e-9) & (u < -1e-9)
        assert not seen[lost].any()
        shares.append(float(seen[~lost].mean()))
    # all the rest can be reached: where the way is narrow, along the circle, by a finer grid
    assert 0.7 < shares[0] < shares[1] - 0.02


def test_reversals_along_a_path_and_the_longest_clear_one() -> None:
    field = circles()
    path = path_reversals(field, [[-1, 0.3], [1, 0.3], [1, -0.3]])
    edge = np.sqrt(0.49 - 0.09)
    assert path.drives[:2] == ("ring", "ring")
    assert path.places[:2] == pytest.approx(np.array([[-edge, 0.3], [edge, 0.3]]), abs=1e-9)
    assert path.along[:2] == pytest.approx([(1 - edge) / 2, (1 + edge) / 2], abs=1e-9)
    # the second drive stands still on the first piece and moves on the second
    assert path.signs.tolist() == [[1, 0], [-1, -1]]
    # on the second piece the first drive goes back at v = 0, where it also stood at the corner
    assert path.along[2:] == pytest.approx([1.0, 1.5])
    found = reversals(field, np.linspace(-1, 1, 21), np.linspace(-1, 1, 21))
    longest = found.longest([[1, 0]])
    assert longest is not None
    # at v = ±0.7 and beyond it runs through
    assert longest.length == pytest.approx(2.0, abs=1e-12)
    assert abs(longest.start[1]) >= 0.7
    narrow = reversals(field, np.linspace(-1, 1, 21), np.linspace(-0.1, 0.1, 21)).longest([[1, 0]])
    assert narrow is not None
    assert narrow.length == pytest.approx(2 * 0.7, abs=1e-9)


def test_rounding_of_drives_that_stand_still_ends_no_path() -> None:
    """Slides along u and v and one that stands: what is left of their rates has any sign."""

    def gradient(p: Array) -> Array:
        rest = 1e-17 * np.sin(1e3 * (p[:, 0] + 2 * p[:, 1]))
        one = 1.0 + 0.0 * rest
        rows = [(one, rest), (rest, one), (rest, -rest)]
        return np.stack([np.stack(row, axis=-1) for row in rows], axis=1)

    field = FormulaField(("u", "v", "still"), gradient)
    found = reversals(field, np.linspace(-1, 1, 11), np.linspace(-1, 1, 11))
    for way, length in (([1, 0], 2.0), ([0, 1], 2.0), ([1, 1], np.sqrt(8.0))):
        path = found.longest([way])
        assert path is not None
        assert path.length == pytest.approx(length, rel=1e-12)
    assert path_reversals(field, [[-1, -1], [1, -1], [1, 1]]).signs.tolist() == [
        [1, 0, 0],
        [0, 1, 0],
    ]


def test_length_of_a_path_over_a_dome_is_its_arc() -> None:
    field = hexapod(Dome(sphere(0.3, [0.0, 0.0, 0.4])))
    axis = np.linspace(-0.1, 0.1, 5)
    longest = reversals(field, axis, axis).longest([[1.0, 0.0]], lines=1)
    assert longest is not None
    low, high = (np.arcsin(p[0] / 0.3) for p in (longest.start, longest.end))
    assert longest.length == pytest.approx(0.3 * (high - low), abs=1e-9)


def test_a_root_at_an_end_whose_sign_rounding_has_changed() -> None:
    """Signs of zeros differ from batch to batch; a way through a gap has no root."""
    low, high = np.array([[0.0, 0.0], [-1.0, 0.0]]), np.array([[1.0, 0.0], [0.0, 0.0]])
    found = roots_between(lambda p, _: np.where(p[:, 0] == 0.0, 1e-17, p[:, 0] ** 2), low, high)
    assert np.array_equal(found, np.zeros((2, 2)))

    def gap(points: Array, _: Any) -> Array:
        return np.where(np.abs(points[:, 0] - 0.5) < 0.2, np.nan, points[:, 0] - 0.5)

    assert np.isnan(roots_between(gap, low[:1], high[:1])).any()
