"""Mobility and redundancy from the rank of the constraint rows, against known linkages."""

from __future__ import annotations

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.kinematics import (
    GROUND,
    Body,
    Joint,
    Linkage,
    Placement,
    Poses,
    axes_frame,
    constraint_rows,
    mobility,
    rotation_z,
)
from tests.linkages import chain, gough

FOUR_BAR = [[0, 0, 0], [0.2, 0.5, 0], [1.1, 0.7, 0], [1.0, 0, 0]]
CUBE_EDGES = [[0, 0, 0], [1, 0, 0], [1, -1, 0], [1, -1, 1], [0, -1, 1], [0, 0, 1]]


def perpendicular_to_both_bars(points: np.ndarray) -> np.ndarray:
    return np.cross(points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points)


def bricard(odd: float) -> tuple[np.ndarray, np.ndarray]:
    """Points and axes of the trihedral Bricard linkage whose odd joints are turned by `odd`.

    Six bars of 1 m with right angles of twist, alternately right and left. Closure gives the
    even joints: cos(odd) + cos(even) + cos(odd) cos(even) = 0.
    """
    step = np.eye(4)
    step[0, 3] = 1.0

    def frames(even: float) -> list[np.ndarray]:
        result = [np.eye(4)]
        for i in range(6):
            turn, twist = np.eye(4), np.eye(4)
            turn[:3, :3] = rotation_z(even if i % 2 else odd)
            sign = 1.0 if i % 2 else -1.0
            twist[:3, :3] = [[1, 0, 0], [0, 0, -sign], [0, sign, 0]]
            result.append(result[-1] @ turn @ step @ twist)
        return result

    even = float(np.arccos(-np.cos(odd) / (1.0 + np.cos(odd))))
    *closed, back = frames(even)
    np.testing.assert_allclose(back, np.eye(4), atol=1e-12, err_msg="the loop does not close")
    return np.array([f[:3, 3] for f in closed]), np.array([f[:3, 2] for f in closed])


def test_planar_four_bar_in_space() -> None:
    # verification case: Gruebler's count gives -2, the linkage moves with one freedom
    linkage, placement = chain(FOUR_BAR, [[0, 0, 1]] * 4)
    found = mobility(linkage, placement)
    assert found.gruebler == -2
    assert (found.mobility, found.mobility_locked, found.redundant) == (1, 1, 3)
    (motion,) = found.motions
    assert {joint for joint, _ in motion.joints} == {"R1", "R2", "R3", "R4"}
    assert {direction for _, direction in motion.joints} == {"rz"}
    assert len(found.self_stress) == 3


def test_a_drive_holds_the_four_bar_and_adds_no_redundancy() -> None:
    linkage, placement = chain(FOUR_BAR, [[0, 0, 1]] * 4, driven=0)
    found = mobility(linkage, placement)
    assert (found.mobility, found.mobility_locked, found.redundant) == (1, 0, 3)
    assert found.motions == ()
    assert len(found.driven_motions) == 1


def test_a_four_bar_turned_in_space_is_the_same_linkage() -> None:
    axis = np.array([0.3, -0.5, 0.8])
    turn = axes_frame(axis)
    linkage, placement = chain(np.array(FOUR_BAR) @ turn.T + [5, -3, 2], [axis] * 4)
    found = mobility(linkage, placement)
    assert (found.mobility, found.redundant) == (1, 3)


def test_bricard_linkage_along_the_edges_of_a_cube() -> None:
    # IFToMM multibody benchmark A04: five rods of 1 m, six revolutes
    points = np.array(CUBE_EDGES, dtype=float)
    linkage, placement = chain(points, perpendicular_to_both_bars(points))
    found = mobility(linkage, placement)
    assert found.gruebler == 0
    assert (found.mobility, found.redundant) == (1, 1)
    (stress,) = found.self_stress
    assert stress.joints == tuple(f"R{i}" for i in range(1, 7))


@pytest.mark.parametrize("odd", [1.3, 1.7, 2.0])
def test_bricard_linkage_keeps_its_freedom_as_it_moves(odd: float) -> None:
    linkage, placement = chain(*bricard(odd))
    found = mobility(linkage, placement)
    assert (found.gruebler, found.mobility, found.redundant) == (0, 1, 1)


@pytest.mark.parametrize(("lower", "free", "spins"), [("universal", 6, 0), ("spherical", 12, 6)])
def test_gough_platform_has_no_redundant_constraint(lower: str, free: int, spins: int) -> None:
    machine = gough(lower)
    found = mobility(machine.linkage, machine.place(machine.home()))
    assert (found.mobility, found.gruebler) == (free, free)
    assert (found.mobility_locked, found.redundant) == (spins, 0)
    assert found.self_stress == ()
    legs = [{joint for joint, _ in motion.joints} for motion in found.motions]
    assert sorted(map(sorted, legs)) == [[f"S{i}", f"U{i}"] for i in range(1, spins + 1)]


def door(hinges: int) -> tuple[Linkage, Placement]:
    """A door on hinges one above the other."""
    frame = tuple(f"frame{i}" for i in range(hinges))
    leaf = tuple(f"leaf{i}" for i in range(hinges))
    joints = tuple(
        Joint(f"hinge{i}", "revolute", pair) for i, pair in enumerate(zip(frame, leaf, strict=True))
    )
    linkage = Linkage((*frame, *leaf), (Body(GROUND, frame), Body("door", leaf)), joints)
    heights = np.linspace(0, 2, hinges)[:, None] * [0.0, 0.0, 1.0]
    frames = axes_frame(np.array([[0.0, 0.0, 1.0]] * hinges))
    return linkage, Placement(np.tile(heights, (2, 1)), frames, np.zeros(0))


def test_each_hinge_of_a_door_after_the_first_is_five_times_redundant() -> None:
    for hinges in (1, 2, 3):
        found = mobility(*door(hinges))
        assert (found.mobility, found.redundant) == (1, 5 * (hinges - 1))
        assert found.gruebler == 6 - 5 * hinges


def test_states_of_self_stress_are_in_balance_and_name_their_joints() -> None:
    linkage, placement = door(3)
    rows = constraint_rows(linkage, placement)
    for stress in mobility(linkage, placement).self_stress:
        forces = [stress.forces.get(tuple(label.split(":")), 0.0) for label in rows.labels]
        assert np.abs(forces).max() > 0.5
        # forces of order one over arms of 2 m, from one singular value decomposition
        np.testing.assert_allclose(rows.on_bodies().T @ forces, 0.0, atol=1e-12)
        assert set(stress.joints) == {joint for joint, _ in stress.forces}
        assert len(stress.joints) >= 2


def test_an_elastic_direction_counts_as_held() -> None:
    linkage, placement = door(1)
    joint = Joint("hinge0", "revolute", ("frame0", "leaf0"), stiffness={"rz": 100.0})
    sprung = Linkage(linkage.nodes, linkage.bodies, (joint,))
    assert mobility(sprung, placement).mobility == 0


def test_a_body_that_nothing_holds_is_named() -> None:
    linkage = Linkage(("a",), (Body("stray", ("a",)),), ())
    found = mobility(linkage, Placement(np.zeros((1, 3)), np.zeros((0, 3, 3)), np.zeros(0)))
    assert found.mobility == 6
    assert all("stray" in motion.description for motion in found.motions)


def test_mobility_is_asked_one_pose_at_a_time() -> None:
    machine = gough()
    placement = machine.place(Poses.of(np.tile([0, 0, 0.5], (2, 1))))
    with pytest.raises(ModelError, match=r"got \(2,\) poses"):
        mobility(machine.linkage, placement)
    assert mobility(machine.linkage, placement[1]).mobility == 6


def test_what_is_reported_as_plain_numbers() -> None:
    plain = mobility(*door(2)).to_dict()
    assert (plain["mobility"], plain["redundant_constraints"]) == (1, 5)
    assert len(plain["mechanisms"]) == 1
