"""Stiffness from a compliance of deficient rank: the same in every frame, never negative.

Whole models are turned and moved: rigid guides on an elastic drive, arms whose ends cannot turn,
serial chains of slides and turntables.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.errors import SingularPoseError
from strutwork.msa import (
    axis_stiffness_blocked,
    axis_stiffness_free,
    movable_rank,
    stiffness_ellipsoid,
    tool_compliance,
    tool_stiffness,
)
from tests.structures import Model

Array = NDArray[Any]


def number(low: float, high: float) -> Any:
    """As a file has it: no lengths of 1e-78 m."""
    return st.floats(low, high).map(lambda v: round(v, 4))


turns = st.tuples(*[number(-1.0, 1.0)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1)
place = st.tuples(*[number(-3.0, 3.0)] * 3)
axis = st.tuples(*[number(-1.0, 1.0)] * 3).filter(lambda v: np.linalg.norm(v) > 0.2)
link = st.tuples(
    st.sampled_from(["prismatic", "revolute"]),
    axis,
    st.floats(5.0, 8.0),
    st.tuples(*[number(-0.4, 0.4)] * 3),
)
chains = st.lists(link, min_size=1, max_size=4)

#: Shares that remain of stiffnesses of 1e5 to 1e8, whose squares meet in one product.
CLOSE = 1e-6


def serial(links: list[Any]) -> Model:
    """Rigid links on elastic drives, one after another; the tool on the last."""
    model = Model("tool")
    model.ground(base=(0, 0, 0))
    last, at = "base", np.zeros(3)
    for i, (kind, along, power, step) in enumerate(links):
        drive = "z" if kind == "prismatic" else "rz"
        model.joint(
            f"joint{i}", kind, (last, f"on{i}"), along, driven=(drive,),
            stiffness={drive: 10.0**power},
        )  # fmt: skip
        at = at + np.asarray(step)
        last = "tool" if i == len(links) - 1 else f"top{i}"
        model.nodes(**{last: at})
        model.rigid(f"link{i}", f"on{i}", last)
    return model


def check(here: Array, there: Array, turn: Array) -> None:
    """What is made from two compliances, one in a frame turned against the other."""
    six = np.kron(np.eye(2), turn)
    assert movable_rank(there) == movable_rank(here)
    back = six.T @ there @ six
    for stiffness in (axis_stiffness_free, axis_stiffness_blocked):
        found = stiffness(there)
        assert np.all(found > 0)
        assert not np.any(np.isnan(found))
        wanted = stiffness(here)
        # a direction that moves by a share below the rank's tolerance may be either
        sure = np.isfinite(wanted) & (wanted < 1e12)
        np.testing.assert_allclose(stiffness(back)[sure], wanted[sure], rtol=CLOSE)
        assert np.all(stiffness(back)[~np.isfinite(wanted)] > 1e12)
    for rotation in ("free", "blocked"):
        found, wanted = (stiffness_ellipsoid(c, rotation).values for c in (there, here))
        assert np.all(found > 0)
        sure = np.isfinite(wanted) & (wanted < 1e12)
        np.testing.assert_allclose(found[sure], wanted[sure], rtol=CLOSE)
        assert np.all(found[~np.isfinite(wanted)] > 1e12)
    if movable_rank(here) == 6:
        np.testing.assert_allclose(
            six.T @ tool_stiffness(there) @ six,
            tool_stiffness(here),
            atol=CLOSE * np.abs(tool_stiffness(here)).max(),
        )
    else:
        for compliance in (here, there):
            with pytest.raises(SingularPoseError, match="does not move at all"):
                tool_stiffness(compliance)


@settings(max_examples=60)
@given(chains, turns, place)
# all nodes at one place, whose mean is off by rounding: that is no length
@example(
    [("revolute", (0.0, 0.75, 1.0), 5.0, (0.0, 0.0, 0.0))], (0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.6172)
)
def test_serial_chains_in_any_frame(
    links: list[Any], quaternion: tuple[float, ...], shift: tuple[float, ...]
) -> None:
    turn = Rotation.from_quat(quaternion).as_matrix()
    model = serial(links)
    here = tool_compliance(model.place())
    check(here, tool_compliance(model.turned(turn, np.array(shift)).place()), turn)


@settings(max_examples=60)
@given(axis, st.floats(4.0, 9.0), turns, place)
def test_a_guide_in_any_direction_yields_only_along_itself(
    along: tuple[float, ...], power: float, quaternion: tuple[float, ...], shift: tuple[float, ...]
) -> None:
    stiffness = 10.0**power
    turn = Rotation.from_quat(quaternion).as_matrix()
    model = serial([("prismatic", along, power, (0.0, 0.0, 0.1))])
    there = tool_compliance(model.turned(turn, np.array(shift)).place())
    check(tool_compliance(model.place()), there, turn)
    direction = turn @ np.asarray(along) / np.linalg.norm(along)
    np.testing.assert_allclose(
        there[:3, :3], np.outer(direction, direction) / stiffness, atol=1e-12 / stiffness
    )
    found = stiffness_ellipsoid(there, "blocked")
    assert found.values[0] == pytest.approx(stiffness, rel=1e-9)
    assert np.all(np.isposinf(found.values[1:]))
    blocked = axis_stiffness_blocked(there)
    # oblique to every axis, nothing else moves and no axis yields alone
    if np.abs(direction).max() < 0.999:
        assert np.all(np.isposinf(blocked))
    free = axis_stiffness_free(there)[:3]
    seen = np.abs(direction) > 1e-3
    np.testing.assert_allclose(free[seen], stiffness / direction[seen] ** 2, rtol=1e-8)


@settings(max_examples=25)
@given(turns, place, place)
def test_an_arm_whose_end_cannot_turn_in_any_frame(
    quaternion: tuple[float, ...], shift: tuple[float, ...], end: tuple[float, ...]
) -> None:
    turn = Rotation.from_quat(quaternion).as_matrix()
    model = Model("tip")
    model.nodes(root=(0, 0, 0), tip=np.array([0.5, 0.0, 0.0]) + 0.05 * np.asarray(end))
    model.beam("arm", "root", "tip")
    model.support("root")
    model.support("tip", "rx", "ry", "rz")
    here = tool_compliance(model.place())
    there = tool_compliance(model.turned(turn, np.array(shift)).place())
    assert movable_rank(there) == 3
    assert not np.any(np.abs(there[3:]) > 1e-15)
    check(here, there, turn)
    # with no rotation left both ellipsoids are one
    found = [stiffness_ellipsoid(there, kind).values for kind in ("free", "blocked")]
    np.testing.assert_allclose(*found, rtol=1e-9)
