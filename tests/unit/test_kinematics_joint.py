"""Joints and linkages: what their directions do, and what they refuse."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, GROUND, JOINT_TYPES, Body, Joint, Linkage, State

AB = ("a", "b")
FREE = {
    "fixed": set(),
    "revolute": {"rz"},
    "prismatic": {"z"},
    "cylindrical": {"z", "rz"},
    "helical": {"rz"},
    "universal": {"rx", "rz"},
    "spherical": {"rx", "ry", "rz"},
    "planar": {"x", "y", "rz"},
}


@pytest.mark.parametrize(("type_", "free"), FREE.items())
def test_free_directions_of_each_type(type_: str, free: set[str]) -> None:
    states = Joint("J", type_, AB, pitch=0.01 if type_ == "helical" else None).states
    assert {d for d, s in zip(DIRECTIONS, states, strict=True) if s == State.FREE} == free
    assert State.ELASTIC not in states


def test_every_type_is_covered_above() -> None:
    assert set(JOINT_TYPES) == {*FREE, "bushing", "support"}


def test_a_named_stiffness_makes_a_direction_elastic_whether_it_was_locked_or_free() -> None:
    joint = Joint("J", "revolute", AB, stiffness={"z": 3e6, "rz": 12.0})
    states = dict(zip(DIRECTIONS, joint.states, strict=True))
    assert states["z"] == states["rz"] == State.ELASTIC
    assert states["x"] == State.LOCKED
    np.testing.assert_array_equal(joint.stiffness_matrix, np.diag([0, 0, 3e6, 0, 0, 12.0]))


def test_a_driven_direction_is_held_in_statics_and_elastic_with_a_drive_stiffness() -> None:
    assert Joint("J", "prismatic", AB, driven=("z",)).states[2] == State.LOCKED
    soft = Joint("J", "prismatic", AB, driven=("z",), stiffness={"z": 3e6})
    assert soft.states[2] == State.ELASTIC


@pytest.mark.parametrize("kind", [k for k in JOINT_TYPES if k not in ("bushing", "helical")])
@pytest.mark.parametrize("direction", DIRECTIONS)
def test_only_a_direction_that_can_move_is_driven(kind: str, direction: str) -> None:
    if direction in JOINT_TYPES[kind]:
        with pytest.raises(ModelError, match=rf"joint J: drives {direction}, which a {kind}"):
            Joint("J", kind, AB, driven=(direction,))
    else:
        assert Joint("J", kind, AB, driven=(direction,)).driven == (direction,)
    # made elastic by name it is locked no longer
    soft = Joint("J", kind, AB, {direction: 1e6}, driven=(direction,))
    assert soft.states[DIRECTIONS.index(direction)] == State.ELASTIC


def test_the_error_of_a_locked_drive_says_what_may_be_driven() -> None:
    with pytest.raises(ModelError, match="Of this joint z, rz can be driven"):
        Joint("J", "cylindrical", AB, driven=("x", "z"))
    with pytest.raises(ModelError, match="its locks hold"):
        Joint("J", "revolute", AB, driven=("rz",), locks=("rz",))
    bushing = Joint("J", "bushing", AB, {"x": 1e6}, driven=("x", "y"))
    assert bushing.states[:2] == (State.ELASTIC, State.LOCKED)


def test_a_support_locks_what_it_names() -> None:
    states = Joint("J", "support", AB, locks=("x", "ry")).states
    assert states == (State.LOCKED, 0, 0, 0, State.LOCKED, 0)


def test_a_bushing_is_elastic_in_every_direction_of_its_matrix() -> None:
    matrix = tuple(tuple(row) for row in (np.eye(6) * 1e6 + 1e3).tolist())
    joint = Joint("J", "bushing", AB, matrix=matrix)
    assert set(joint.states) == {State.ELASTIC}
    np.testing.assert_array_equal(joint.stiffness_matrix, np.eye(6) * 1e6 + 1e3)


def lopsided() -> tuple[tuple[float, ...], ...]:
    matrix = np.eye(6)
    matrix[0, 4] = 0.5
    return tuple(tuple(row) for row in matrix.tolist())


def indefinite() -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(row) for row in np.diag([1.0, 1, -1, 1, 1, 1]).tolist())


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        ({"type": "hinge"}, 'unknown type "hinge"'),
        ({"between": ("a", "a")}, 'joins node "a" to itself'),
        ({"stiffness": {"w": 1.0}}, 'stiffness names the unknown direction "w"'),
        ({"driven": ("w",)}, 'driven names the unknown direction "w"'),
        ({"limits": {"w": (0.0, 1.0)}}, 'limits names the unknown direction "w"'),
        ({"stiffness": {"x": -1.0}}, "stiffness in x is -1.0"),
        ({"stiffness": {"x": 0.0}}, "stiffness in x is 0.0"),
        ({"stiffness": {"x": float("nan")}}, "stiffness in x is nan"),
        ({"damping": {"rz": -2.0}}, "damping in rz is -2.0"),
        ({"damping": {"rz": float("inf")}}, "damping in rz is inf"),
        ({"type": "bushing"}, "a bushing without matrix or stiffness"),
        ({"matrix": lopsided()}, "matrix is not symmetric: entry (x, ry)"),
        ({"type": "bushing", "matrix": indefinite()}, "negative eigenvalue"),
        ({"type": "bushing", "matrix": ((1.0, 0.0),)}, "not 6 x 6 finite numbers"),
        ({"matrix": tuple(map(tuple, np.eye(6).tolist()))}, "revolute joint cannot have a matrix"),
        (
            {
                "type": "bushing",
                "matrix": tuple(map(tuple, np.eye(6).tolist())),
                "stiffness": {"x": 1.0},
            },
            "has both matrix and stiffness",
        ),
    ],
)
def test_a_wrong_joint_is_refused_by_name(arguments: dict[str, Any], problem: str) -> None:
    with pytest.raises(ModelError, match=re.escape(problem)) as caught:
        Joint(**{"name": "R1", "type": "revolute", "between": AB, **arguments})
    assert caught.value.part == "joint R1"
    assert caught.value.remedy


@pytest.mark.parametrize(
    ("arguments", "part", "problem"),
    [
        ({"nodes": ("a", "b", "a")}, "node a", "defined twice"),
        ({"bodies": (Body("p", ("a",)), Body("p", ("b",)))}, "body p", "defined twice"),
        ({"joints": (Joint("J", "fixed", AB),) * 2}, "joint J", "defined twice"),
        ({"bodies": (Body("p", ("c",)),)}, "body p", 'unknown node "c"'),
        ({"joints": (Joint("J", "fixed", ("a", "c")),)}, "joint J", 'unknown node "c"'),
        ({"tool": "c"}, "tool", 'unknown node "c"'),
        (
            {"bodies": (Body("p", ("a",)), Body("q", ("a", "b")))},
            "node a",
            'belongs to bodies "p" and "q"',
        ),
    ],
)
def test_a_wrong_linkage_is_refused_by_name(
    arguments: dict[str, Any], part: str, problem: str
) -> None:
    with pytest.raises(ModelError, match=re.escape(problem)) as caught:
        Linkage(**{"nodes": AB, "bodies": (), "joints": (), **arguments})
    assert caught.value.part == part
    assert caught.value.remedy


def test_bodies_ground_and_lone_nodes_of_a_linkage() -> None:
    linkage = Linkage(
        ("g", "p1", "lone", "p2"),
        (Body(GROUND, ("g",)), Body("plate", ("p1", "p2"))),
        (
            Joint("P", "prismatic", ("g", "p1"), driven=("z",)),
            Joint("C", "cylindrical", ("lone", "p2"), driven=("rz", "z")),
        ),
    )
    assert linkage.body_names == ("plate", "lone")
    assert linkage.body_of_node.tolist() == [-1, 0, 1, 0]
    assert linkage.driven == (("P", "z"), ("C", "z"), ("C", "rz"))
    assert linkage.driven_mask().sum() == 3
    assert repr(linkage) == "<Linkage: 4 nodes, 2 bodies, 2 joints, 3 driven directions>"
