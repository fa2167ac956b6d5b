"""Springs and point masses: what they do and what they refuse."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.msa import LoadCase, PointMass, Spring, solve
from tests.structures import Model, every_direction, wrench


def test_a_spring_to_ground_resists_by_direction() -> None:
    model = Model("n")
    model.nodes(n=(1, 2, 3))
    stiffness = dict(
        zip(("x", "y", "z", "rx", "ry", "rz"), (1e5, 2e5, 4e5, 10, 20, 50), strict=True)
    )
    model.springs.append(Spring("s", ("n",), stiffness))
    found = solve(model.place(), [wrench("push", "n", 10, 10, 10, 1, 1, 1)])
    expected = [1e-4, 5e-5, 2.5e-5, 0.1, 0.05, 0.02]
    np.testing.assert_allclose(found.displacement("n", "push"), expected, rtol=1e-13)
    assert found.strain_energy[0] == pytest.approx(
        0.5 * (10 * sum(expected[:3]) + sum(expected[3:])), rel=1e-13
    )


def between(direction: str, place: tuple[float, float, float]) -> Model:
    model = Model("b")
    model.nodes(a=(0, 0, 0), b=place)
    model.springs += [
        Spring("root", ("a",), every_direction(1e6)),
        Spring("link", ("a", "b"), {direction: 5e5}),
        Spring("hold", ("b",), every_direction(1e3)),
    ]
    return model


def test_a_spring_between_two_nodes_resists_their_relative_motion() -> None:
    found = solve(between("z", (0, 0, 0)).place(), [wrench("push", "b", 0, 0, 100.0)])
    series = 1e6 * 5e5 / 1.5e6
    expected = 100 / (series + 1e3)
    assert found.displacement("b", "push")[2] == pytest.approx(expected, rel=1e-12)
    assert found.displacement("a", "push")[2] == pytest.approx(expected * series / 1e6, rel=1e-12)


def test_a_spring_along_its_span_is_taken_and_one_across_is_not() -> None:
    between("z", (0, 0, 0.5)).place()
    with pytest.raises(
        ModelError, match=r"spring link: its nodes are 0\.5 m apart across"
    ) as caught:
        between("x", (0, 0, 0.5)).place()
    assert "joint" in caught.value.remedy


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        ({"stiffness": {}}, "has no stiffness"),
        ({"stiffness": {"w": 1.0}}, 'unknown direction "w"'),
        ({"stiffness": {"x": 0.0}}, "stiffness in x is 0.0"),
        ({"stiffness": {"x": -5.0}}, "stiffness in x is -5.0"),
        ({"stiffness": {"x": float("nan")}}, "stiffness in x is nan"),
        ({"nodes": ("a", "a")}, 'joins node "a" to itself'),
    ],
)
def test_a_wrong_spring_is_refused_by_name(arguments: dict[str, Any], problem: str) -> None:
    with pytest.raises(ModelError, match=re.escape(problem)) as caught:
        Spring(**{"name": "s", "nodes": ("a",), "stiffness": {"x": 1.0}, **arguments})
    assert caught.value.part == "spring s"
    assert caught.value.remedy


def test_an_offset_mass_pulls_with_a_moment() -> None:
    model = Model("n")
    model.nodes(n=(0, 0, 0))
    model.support("n")
    model.masses.append(PointMass("n", 2.0, offset=(0.3, 0.0, 0.1)))
    found = solve(model.place(), [LoadCase("g", gravity=(1.0, 0.0, -10.0))])
    # r × m g = (0.3, 0, 0.1) × (2, 0, −20)
    np.testing.assert_allclose(
        found.joint_force("support n", "g"), [-2, 0, 20, 0, -6.2, 0], atol=1e-12
    )


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        ({"mass": -1.0}, "mass is -1.0"),
        ({"mass": float("inf")}, "mass is inf"),
        ({"inertia": ((1.0, 0.0), (0.0, 1.0))}, "inertia is not 3 x 3"),
        ({"inertia": ((1.0, 0.5, 0), (0, 1.0, 0), (0, 0, 1.0))}, "inertia is not symmetric"),
        ({"inertia": ((1.0, 2.0, 0), (2.0, 1.0, 0), (0, 0, 1.0))}, "negative principal moment"),
    ],
)
def test_a_wrong_mass_is_refused_by_node(arguments: dict[str, Any], problem: str) -> None:
    with pytest.raises(ModelError, match=re.escape(problem)) as caught:
        PointMass(**{"node": "n", "mass": 1.0, **arguments})
    assert caught.value.part == "mass at node n"
