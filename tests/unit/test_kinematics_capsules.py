"""Capsules: distances of segments, which parts may collide, and interference at home."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

from strutwork.errors import ModelError
from strutwork.kinematics.capsules import Capsule, Interference, outlines
from strutwork.kinematics.segments import segment_distances
from tests.linkages import chain, gough


def by_minimisation(first: np.ndarray, second: np.ndarray) -> float:
    def squared(x: np.ndarray) -> float:
        gap = first[0] + x[0] * (first[1] - first[0]) - second[0] - x[1] * (second[1] - second[0])
        return float(gap @ gap)

    starts = [(0.5, 0.5), (0.0, 1.0), (1.0, 0.0)]
    found = [minimize(squared, s, bounds=[(0, 1)] * 2, tol=1e-14).fun for s in starts]
    return float(np.sqrt(min(found)))


def test_distances_of_random_segments_as_a_minimiser_finds_them() -> None:
    random = np.random.default_rng(3)
    ends = random.uniform(-1, 1, (2, 60, 2, 3))
    found = segment_distances(ends[0], ends[1])
    wanted = [by_minimisation(a, b) for a, b in zip(ends[0], ends[1], strict=True)]
    # the minimiser's own tolerance, of a root of its function
    np.testing.assert_allclose(found, wanted, atol=1e-6)
    # all ways in which the nearest points lie occur: this is no test of one branch
    inside = np.asarray(wanted) < 0.9 * np.linalg.norm(
        ends[0][:, :, None] - ends[1][:, None], axis=-1
    ).min(axis=(1, 2))
    assert 10 < inside.sum() < 60


@pytest.mark.parametrize(
    ("first", "second", "distance"),
    [
        # crossing, parallel beside, parallel in line, a point beside, two points, touching
        ([[-1, 0, 0], [1, 0, 0]], [[0, -1, 0.3], [0, 1, 0.3]], 0.3),
        ([[0, 0, 0], [2, 0, 0]], [[1, 0.5, 0], [3, 0.5, 0]], 0.5),
        ([[0, 0, 0], [1, 0, 0]], [[3, 0, 0], [4, 0, 0]], 2.0),
        ([[0, 0, 0], [1, 0, 0]], [[0.5, 0.2, 0], [0.5, 0.2, 0]], 0.2),
        ([[0, 0, 0], [0, 0, 0]], [[0, 3, 4], [0, 3, 4]], 5.0),
        ([[0, 0, 0], [1, 1, 0]], [[1, 1, 0], [2, 0, 0]], 0.0),
    ],
)
def test_distances_of_known_segments(first: object, second: object, distance: float) -> None:
    a, b = np.array(first, dtype=float), np.array(second, dtype=float)
    assert segment_distances(a, b) == pytest.approx(distance, abs=1e-12)
    assert segment_distances(b, a[::-1]) == pytest.approx(distance, abs=1e-12)


def test_bodies_that_a_joint_joins_are_no_pair() -> None:
    # four bars and the ground: bar 1 and bar 3 alone may collide
    linkage, home = chain([[0, 0, 0], [0, 1, 0], [3, 2, 0], [3, 0, 0]], [[0, 0, 1.0]] * 4)
    found = Interference(linkage, tuple(outlines(linkage, 0.1)))
    assert [found.words(q) for q in range(len(found.pairs))] == ["bar1 and bar3"]
    np.testing.assert_allclose(found.gaps(home), [3.0 - 0.2])


def test_a_body_between_two_parts_joins_them_unless_it_is_a_part() -> None:
    linkage, _ = chain([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 2, 0]], [[0, 0, 1.0]] * 5)
    without = Interference(linkage, tuple(outlines(linkage, 0.01, ("bar1", "bar3"))))
    assert len(without.pairs) == 0
    whole = Interference(linkage, tuple(outlines(linkage, 0.01)))
    assert "bar1 and bar3" in [whole.words(q) for q in range(len(whole.pairs))]


def test_interference_at_home_names_the_parts_and_the_overlap() -> None:
    machine = gough()
    home = machine.place(machine.home())
    legs = [f"cylinder{i}" for i in range(1, 7)]
    # the feet of a pair of legs are this far apart, and the nearest points of two legs
    pair = 2 * 0.4 * np.sin(np.radians(10))
    thin = Interference(machine.linkage, tuple(outlines(machine.linkage, 0.4 * pair, legs)))
    assert thin.check(home) is thin
    assert thin.gaps(home).min() == pytest.approx(0.2 * pair, rel=1e-9)
    thick = Interference(machine.linkage, tuple(outlines(machine.linkage, 0.52 * pair, legs)))
    overlap = 1e3 * 0.04 * pair
    with pytest.raises(ModelError, match=rf"cylinder\d and cylinder\d: .*overlap by {overlap:.3g}"):
        thick.check(home)


def test_wrong_capsules() -> None:
    linkage, _ = chain([[0, 0, 0], [1, 0, 0], [1, 1, 0]], [[0, 0, 1.0]] * 3)
    with pytest.raises(ModelError, match="radius"):
        Capsule("bar", ("b0", "a1"), 0.0)
    with pytest.raises(ModelError, match="unknown node"):
        Interference(linkage, (Capsule("bar", ("b0", "nowhere"), 0.1),))
    with pytest.raises(ModelError, match="two bodies"):
        Interference(linkage, (Capsule("bar", ("b0", "b1"), 0.1),))
