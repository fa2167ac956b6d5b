"""Ports: where a structure is excited and observed."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea import Port
from strutwork.fea.eigen import solve_eigen
from strutwork.fea.ports import port_motions
from strutwork.fea.reduction import reduce_system
from strutwork.msa import system_of
from tests.structures import cantilever
from tests.unit.test_fea_reduction import swinging_door
from tests.vibration import heavy


def test_a_port_reads_from_text() -> None:
    assert Port.parse("TCP:x") == Port("TCP", "x")
    assert Port.parse("leg:1:rz") == Port("leg:1", "rz")
    assert Port.parse("table-TCP:y") == Port("TCP", "y", against="table")


def test_known_nodes_tell_a_hyphen_in_a_name() -> None:
    nodes = ("tool-tip", "tool", "tip", "table")
    assert Port.parse("tool-tip:x", nodes) == Port("tool-tip", "x")
    assert Port.parse("table-tool-tip:x", nodes) == Port("tool-tip", "x", against="table")
    assert Port.parse("tool-tip-table:x", nodes) == Port("table", "x", against="tool-tip")
    with pytest.raises(ModelError, match="which node moves relative to which"):
        Port.parse("a-b-c:x")
    with pytest.raises(ModelError, match="which node moves relative to which"):
        Port.parse("nowhere-tip:x", nodes)


@pytest.mark.parametrize("text", ["TCP", ":x", "TCP:", ""])
def test_text_without_node_or_direction(text: str) -> None:
    with pytest.raises(ModelError, match="is not a node with a direction"):
        Port.parse(text)


def test_directions() -> None:
    np.testing.assert_array_equal(Port("a", "ry").vector, [0, 0, 0, 0, 1, 0])
    oblique = (0.6, 0.8, 0.0, 0.0, 0.0, 0.0)
    np.testing.assert_array_equal(Port("a", oblique).vector, oblique)
    with pytest.raises(ModelError, match="unknown direction"):
        Port("a", "w")
    for bad in ((0.0,) * 6, (1.0, 0.0, 0.0)):
        with pytest.raises(ModelError, match="has no direction"):
            Port("a", bad)


def test_text_of_a_port() -> None:
    assert str(Port("a", "x")) == "a:x"
    assert str(Port("a", "x", against="b")) == "a against b:x"
    assert str(Port("a", (1.0, 0.0, 0.0, 0.0, 0.0, 0.0))) == "a:[1.0, 0.0, 0.0, 0.0, 0.0, 0.0]"


def test_a_relative_port_is_the_difference() -> None:
    reduced = reduce_system(system_of(heavy("three-legged frame").place()))
    one, other = (Port(n, "y").on(reduced) for n in ("tool", "knee1"))
    relative = Port("tool", "y", against="knee1").on(reduced)
    np.testing.assert_allclose(relative, one - other)


def test_a_held_direction_is_an_error() -> None:
    reduced = reduce_system(system_of(cantilever().place()))
    with pytest.raises(ModelError, match="port root:x: does not move"):
        Port("root", "x").on(reduced)
    with pytest.raises(ModelError, match="not in the structure"):
        Port("nowhere", "x").on(reduced)
    with pytest.raises(ModelError, match="port tip against tip:x: does not move"):
        Port("tip", "x", against="tip").on(reduced)


@pytest.mark.parametrize(
    ("name", "port"), [("four-bar, rigid", "tool:y"), ("Bricard, rigid", "a3:x")]
)
def test_rounding_of_a_closed_loop_is_no_motion(name: str, port: str) -> None:
    reduced = reduce_system(system_of(heavy(name).place()))
    with pytest.raises(ModelError, match=f"port {port}: does not move"):
        Port.parse(port).on(reduced)


def test_a_direction_held_at_one_pose_of_many_names_the_pose() -> None:
    reduced = reduce_system(system_of(swinging_door().place()))
    with pytest.raises(ModelError, match="does not move at pose 1"):
        Port("handle", "y").on(reduced)


def test_struts_that_spin_do_not_make_the_tool_float() -> None:
    reduced = reduce_system(system_of(heavy("hexapod, spinning struts").place()))
    eigen = solve_eigen(reduced)
    _, rigid = port_motions(reduced, [Port("tool", "x"), Port("tool", "rz")], eigen.rigid)
    assert rigid.shape == (7, 2, 6)
    assert not np.any(rigid)
    _, spin = port_motions(reduced, [Port("foot0", "rz")], eigen.rigid)
    assert np.all(np.abs(spin).max(axis=(1, 2)) > 0)
