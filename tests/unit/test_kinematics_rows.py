"""Constraint rows and placements."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.errors import ModelError, UnreachableError
from strutwork.kinematics import (
    GROUND,
    Body,
    Joint,
    Linkage,
    Placement,
    Poses,
    axes_frame,
    body_references,
    characteristic_length,
    check_coincidence,
    constraint_rows,
)
from tests.linkages import chain, gough

RNG = np.random.default_rng(7)


def test_rows_read_the_relative_twist_of_the_two_sides_in_joint_axes() -> None:
    machine = gough()
    linkage = machine.linkage
    placement = machine.place(Poses.of([0.02, -0.01, 0.5]))
    rows = constraint_rows(linkage, placement)
    bodies = len(linkage.body_names)
    twists = RNG.normal(size=(bodies, 6))
    read = rows.on_bodies() @ twists.ravel()

    moved = np.vstack([twists, np.zeros(6)])[linkage.body_of_node]
    references = np.vstack([body_references(linkage, placement), np.zeros(3)])
    arms = placement.positions - references[linkage.body_of_node]
    velocity = moved[:, :3] + np.cross(moved[:, 3:], arms)
    expected = []
    for joint, direction in zip(rows.joint, rows.direction, strict=True):
        a, b = (linkage.node_index[n] for n in linkage.joints[joint].between)
        frame = placement.frames[joint]
        gap = velocity[b] - velocity[a] if direction < 3 else moved[b, 3:] - moved[a, 3:]
        expected.append(frame[:, direction % 3] @ gap)
    # both sides are sums of products of order one
    np.testing.assert_allclose(read, expected, atol=1e-13)


def test_rows_are_named_by_joint_and_direction() -> None:
    linkage, placement = chain([[0, 0, 0], [1, 0, 0]], [[0, 0, 1]] * 2, driven=0, closed=False)
    rows = constraint_rows(linkage, placement)
    assert rows.labels == tuple(f"R1:{d}" for d in ("x", "y", "z", "rx", "ry", "rz"))
    assert rows.nodes.tolist() == [[0, 1]] * 6
    free = constraint_rows(linkage, placement, linkage.elastic_or_locked() & ~linkage.driven_mask())
    assert free.labels == rows.labels[:-1]


def test_one_batch_of_poses_gives_the_rows_of_each() -> None:
    machine = gough()
    poses = Poses.of(RNG.normal(size=(2, 3, 3)) * 0.02 + [0, 0, 0.5])
    together = constraint_rows(machine.linkage, machine.place(poses)).on_bodies()
    alone = constraint_rows(machine.linkage, machine.place(poses[1, 2])).on_bodies()
    assert together.shape == (2, 3, 78, 78)
    np.testing.assert_array_equal(together[1, 2], alone)


def test_a_rigid_motion_of_everything_moves_only_what_holds_the_ground() -> None:
    linkage = Linkage(
        ("g", "a", "b", "c"),
        (Body(GROUND, ("g",)), Body("p", ("a", "b")), Body("q", ("c",))),
        (Joint("G", "fixed", ("g", "a")), Joint("J", "fixed", ("b", "c"))),
    )
    positions = np.array([[0, 0, 0], [0, 0, 0], [1, 2, 3], [1, 2, 3]], dtype=float)
    frames = axes_frame(RNG.normal(size=(2, 3)))
    rows = constraint_rows(linkage, Placement(positions, frames, np.zeros(0)))
    turn = np.array([0.3, -0.2, 0.5])
    twist_p = np.concatenate([np.zeros(3), turn])
    twist_q = np.concatenate([np.cross(turn, positions[3]), turn])
    read = rows.on_bodies() @ np.concatenate([twist_p, twist_q])
    np.testing.assert_allclose(read[6:], 0.0, atol=1e-15)
    np.testing.assert_allclose(read[3:6], frames[0].T @ turn, atol=1e-15)


def test_characteristic_length_is_the_reach_from_the_centre_and_no_turn_changes_it() -> None:
    points = np.array([[0, 0, 0], [4.0, 1, 1]])
    turned = points @ Rotation.from_rotvec([0.3, -0.8, 1.1]).as_matrix().T + 5.0
    for positions in (points, turned):
        placement = Placement(positions, np.zeros((0, 3, 3)), np.zeros(0))
        assert characteristic_length(placement) == pytest.approx(np.sqrt(18) / 2, rel=1e-14)


def test_nodes_of_a_joint_that_do_not_meet_are_named_with_their_distance_and_pose() -> None:
    linkage, placement = chain([[0, 0, 0], [1, 0, 0]], [[0, 0, 1]] * 2, closed=False)
    check_coincidence(linkage, placement)
    positions = np.repeat(placement.positions[None], 3, axis=0)
    frames = np.repeat(placement.frames[None], 3, axis=0)
    positions[2, 1, 1] = 3.2e-3
    apart = Placement(positions, frames, np.zeros((3, 0)))
    with pytest.raises(ModelError, match=r'"a0" and "b0".* 0.0032 m apart at pose 2') as caught:
        check_coincidence(linkage, apart)
    assert caught.value.part == "joint R1"


def test_unreachable_poses_are_masked_with_their_reason() -> None:
    _, placement = chain([[0, 0, 0], [1, 0, 0]], [[0, 0, 1]] * 2, closed=False)
    several = Placement(
        np.repeat(placement.positions[None], 3, axis=0),
        np.repeat(placement.frames[None], 3, axis=0),
        np.zeros((3, 0)),
        status=np.array([0, 2, 0], dtype=np.int8),
        reasons=("too far", "R1 beyond its range"),
    )
    assert several.reachable.tolist() == [True, False, True]
    assert several.reason(1) == "R1 beyond its range"
    assert several.reason(0) == ""
    assert several[several.reachable].batch == (2,)
    assert several[2].require_reachable().batch == ()
    with pytest.raises(UnreachableError, match=r"R1 beyond its range \(1 of 3 poses"):
        several.require_reachable()


@pytest.mark.parametrize(
    ("position", "rotation", "problem"),
    [
        (np.zeros(2), np.eye(3), "shapes"),
        (np.zeros(3), 2 * np.eye(3), "not a rotation"),
        (np.zeros(3), np.diag([1.0, 1, -1]), "not a rotation"),
        (np.array([0, np.nan, 0]), np.eye(3), "not finite"),
    ],
)
def test_wrong_poses_are_refused(position: np.ndarray, rotation: np.ndarray, problem: str) -> None:
    with pytest.raises(ModelError, match=problem):
        Poses(position, rotation)


def test_replacing_positions_keeps_the_status() -> None:
    machine = gough()
    placement = machine.place(Poses.of(np.tile([0, 0, 0.5], (2, 1))))
    assert replace(placement, positions=placement.positions + 1.0).reachable.all()
