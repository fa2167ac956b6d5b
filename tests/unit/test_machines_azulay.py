"""The four machines of Azulay et al. 2014 as objects: joints, places, ranges, stiffness."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from strutwork.errors import ModelError, UnreachableError
from strutwork.kinematics import (
    Mechanism,
    Poses,
    check_coincidence,
    jacobians,
    mobility,
    rotation_z,
    tangent_rotation,
)
from strutwork.machines import (
    CATALOGUE,
    Alizade3PRPS,
    Eclipse3PPRS,
    Glozman3PRRS,
    Proposed3PPRS,
    ThreeLegs,
    check_limits,
    hemisphere_poses,
    roll_angles,
)
from strutwork.msa import Material, axis_stiffness_blocked, tool_compliance

MACHINES: tuple[type[Any], ...] = (Proposed3PPRS, Eclipse3PPRS, Alizade3PRPS, Glozman3PRRS)

NAMES = [name for name, entry in CATALOGUE.items() if entry.factory in MACHINES]

every_machine = pytest.mark.parametrize("machine", [m() for m in MACHINES], ids=NAMES)


@every_machine
def test_it_is_a_mechanism_with_six_drives_in_leg_order(machine: ThreeLegs) -> None:
    assert isinstance(machine, Mechanism)
    assert [joint.split("/")[0] for joint, _ in machine.linkage.driven] == [
        "leg1",
        "leg1",
        "leg2",
        "leg2",
        "leg3",
        "leg3",
    ]
    assert machine.linkage.tool == "tool"


@every_machine
def test_it_moves_in_six_ways_and_stands_without_redundancy(machine: ThreeLegs) -> None:
    found = mobility(machine.linkage, machine.place(machine.home()))
    assert (found.mobility, found.mobility_locked, found.redundant) == (6, 0, 0)


@every_machine
def test_clamping_the_links_at_the_platform_takes_the_freedom(machine: ThreeLegs) -> None:
    clamped = machine.apparent()
    found = mobility(clamped.linkage, clamped.place(clamped.home()))
    # nine rotations of three spherical joints are locked and six freedoms are there to be taken
    assert found.mobility_locked == 0
    assert found.redundant == 9


@every_machine
def test_the_nodes_of_every_joint_coincide_over_the_hemisphere(machine: ThreeLegs) -> None:
    placement = machine.place(hemisphere_poses(machine.pole_height))
    check_coincidence(machine.linkage, placement)
    frames = placement.frames
    gram = np.swapaxes(frames, -1, -2) @ frames
    # rounding of products of unit vectors
    np.testing.assert_allclose(gram, np.broadcast_to(np.eye(3), gram.shape), atol=1e-14)
    np.testing.assert_allclose(np.linalg.det(frames), 1.0, atol=1e-13)


@every_machine
def test_links_keep_their_length(machine: ThreeLegs) -> None:
    placement = machine.place(hemisphere_poses(machine.pole_height, lattice=4, rolls=6))
    index = machine.linkage.node_index
    name, length = {
        Proposed3PPRS: ("link", 0.216),
        Eclipse3PPRS: ("link", 0.216),
        Alizade3PRPS: ("strut", 0.281),
        Glozman3PRRS: ("link", 0.130),
    }[type(machine)]
    for beam in machine.structure.beams:
        if beam.name.endswith(f"/{name}"):
            first, second = (placement.positions[..., index[n], :] for n in beam.nodes)
            size = np.linalg.norm(second - first, axis=-1)[placement.reachable]
            np.testing.assert_allclose(size, length, rtol=1e-12)


@every_machine
def test_a_turn_of_120_degrees_changes_the_legs_only(machine: ThreeLegs) -> None:
    poses = hemisphere_poses(machine.pole_height, lattice=3, rolls=5)
    turn = rotation_z(2.0 * np.pi / 3.0)
    turned = Poses(poses.position @ turn.T, turn @ poses.rotation @ turn.T)
    first, second = machine.place(poses), machine.place(turned)

    def lengths(placement: Any, leg: int) -> Any:
        chosen = [
            i
            for i, (joint, _) in enumerate(placement.names)
            if joint.startswith(f"leg{leg}/") and not joint.endswith("guide")
        ]
        return placement.values[..., chosen]

    for leg, successor in ((1, 2), (2, 3), (3, 1)):
        # a pose on the limit of reach may fall to either side by rounding
        both = first.reachable & second.reachable
        assert both.mean() > 0.5
        np.testing.assert_allclose(
            lengths(first, leg)[both], lengths(second, successor)[both], atol=1e-7
        )


@every_machine
def test_a_pose_out_of_reach_is_marked_and_leaves_the_others(machine: ThreeLegs) -> None:
    home = machine.home().position
    poses = Poses.of(home + np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.5], [1.0, 0.0, 0.0]]))
    placement = machine.place(poses)
    assert np.isfinite(placement.positions).all()
    assert np.isfinite(placement.values).all()
    if isinstance(machine, Alizade3PRPS | Eclipse3PPRS):
        # one reaches any height with its slides, the other any point with its struts
        assert placement.reachable[1]
    else:
        assert not placement.reachable[1]
        assert placement.reason(1).startswith("leg 1: its joint centre is")
        with pytest.raises(UnreachableError, match="its joint centre"):
            machine.structure.at(placement)
    assert placement.reachable[0]
    machine.structure.at(placement[placement.reachable])


@every_machine
def test_a_seat_on_the_axis_of_the_guide_is_marked(machine: ThreeLegs) -> None:
    position = machine.home().position - machine.seats[0]
    placement = machine.place(Poses.of(position))
    assert placement.reason(()) == "leg 1: its joint centre lies on the axis of the guide"
    assert np.isfinite(placement.frames).all()


@pytest.mark.parametrize(
    ("machine", "kind", "position", "words"),
    [
        (Proposed3PPRS(), "prismatic", [0.0, 0.0, 0.17], "leg1/slide: z of the prismatic"),
        (Proposed3PPRS(), "revolute", [0.0, 0.0, 0.01], "leg1/hinge: rz of the revolute"),
        (Eclipse3PPRS(), "prismatic", [0.0, 0.0, 0.26], "leg1/slide: z of the prismatic"),
        (Alizade3PRPS(), "prismatic", [0.0, 0.0, 0.21], "leg1/slide: z of the prismatic"),
        (Glozman3PRRS(), "revolute", [0.0, 0.0, 0.12], "leg1/elbow: elevation of the revolute"),
    ],
)
def test_joint_ranges_are_a_question_of_their_own(
    machine: ThreeLegs, kind: str, position: list[float], words: str
) -> None:
    placement = machine.place(Poses.of(position))
    assert placement.reachable
    limits = [limit for limit in machine.limits if limit.kind == kind]
    checked = check_limits(limits, placement)
    assert not checked.reachable
    assert checked.reason(()).startswith(words)
    assert checked.reason(()).endswith("is exceeded")
    assert check_limits(limits, machine.place(machine.home())).reachable


@every_machine
def test_far_tilt_exceeds_the_spherical_joints_at_some_rolls(machine: ThreeLegs) -> None:
    balls = [limit for limit in machine.limits if limit.kind == "spherical"]
    assert check_limits(balls, machine.place(machine.home())).reachable
    placement = machine.place(
        Poses.of(machine.home().position, tangent_rotation([1.0, 0.0, 0.0], roll_angles()))
    )
    checked = check_limits(balls, placement)
    exceeded = placement.reachable & ~checked.reachable
    assert exceeded.any()
    first = int(exceeded.argmax())
    assert "swing of the spherical joint, 0 to 70 deg" in checked.reason(first)


def test_a_limit_without_a_coordinate_is_an_error() -> None:
    machine = Proposed3PPRS()
    stranger = replace(machine.limits[0], coordinate="ry")
    with pytest.raises(ModelError, match=r"leg1/slide.*\n.*inverse kinematics"):
        check_limits([stranger], machine.place(machine.home()))


def test_home_of_the_proposed_machine_by_hand() -> None:
    placement = Proposed3PPRS().place(Proposed3PPRS().home())
    values = dict(zip(placement.names, placement.values, strict=True))
    reach = np.sqrt(0.216**2 - 0.126**2)
    assert values["leg1/slide", "z"] == pytest.approx(0.018 + reach, rel=1e-14)
    assert values["leg1/hinge", "rz"] == pytest.approx(np.arcsin(0.126 / 0.216), rel=1e-14)
    assert values["leg2/guide", "rz"] == pytest.approx(2.0 * np.pi / 3.0, rel=1e-14)
    # the link leans 35.7 degrees below the platform, in which its neutral direction lies
    assert values["leg1/ball", "swing"] == pytest.approx(np.arcsin(0.126 / 0.216), rel=1e-12)


def test_home_of_the_glozman_machine_closes_by_hand() -> None:
    machine = Glozman3PRRS(pole_height=0.174)
    placement = machine.place(machine.home())
    values = dict(zip(placement.names, placement.values, strict=True))
    upper = values["leg1/shoulder", "rz"]
    lower = values["leg1/elbow", "elevation"]
    assert values["leg1/elbow", "rz"] == pytest.approx(lower - upper)
    assert 0.130 * (np.cos(upper) + np.cos(lower)) == pytest.approx(0.144, rel=1e-13)
    assert 0.130 * (np.sin(upper) + np.sin(lower)) == pytest.approx(0.174, rel=1e-13)
    assert upper > lower


def test_a_first_link_shorter_than_the_floor_keeps_a_length() -> None:
    machine = Proposed3PPRS()
    # the slider stands on the guide where the reach is 144 mm
    height = np.sqrt(0.216**2 - 0.144**2)
    placement = machine.place(Poses.of([0.0, 0.0, height]))
    index = machine.linkage.node_index
    first, second = (placement.positions[index[n]] for n in ("leg1/carriage", "leg1/overhang"))
    assert np.linalg.norm(second - first) == pytest.approx(1e-3)
    machine.structure.at(placement)


def test_the_least_first_link_costs_little_where_there_is_none() -> None:
    """The floor of 1 mm against 0.3 mm: the stiffness goes linearly with it."""
    height = np.sqrt(0.216**2 - 0.144**2)
    stiffness = []
    for shortest in (1e-3, 3e-4):
        machine = Proposed3PPRS(shortest_first_link=shortest)
        placed = machine.structure.at(machine.place(Poses.of([0.0, 0.0, height])))
        stiffness.append(axis_stiffness_blocked(tool_compliance(placed))[:3])
    # 0.7 of the 0.3 % that the docstring allows for the whole millimetre
    np.testing.assert_allclose(stiffness[0], stiffness[1], rtol=0.7 * 3e-3)


def test_rigid_beams_leave_the_eclipse_its_three_vertical_drives() -> None:
    """Kzz = 3 x 3 N/µm at every pose, since each leg carries along z with its slide only."""
    stiff = Material.isotropic(205e9 * 1e4, 0.29)
    machine = Eclipse3PPRS(material=stiff)
    poses = hemisphere_poses(machine.pole_height, lattice=3, rolls=4)
    placement = machine.place(poses)
    condition = jacobians(machine.linkage, placement).condition(machine.platform_radius)
    regular = placement[condition < 1e3]
    assert regular.reachable.sum() > 100
    stiffness = axis_stiffness_blocked(tool_compliance(machine.structure.at(regular)))
    # the steel's beams take 20 % of the stiffness: a ten-thousandth of that is left
    np.testing.assert_allclose(stiffness[..., 2], 9e6, rtol=1e-4)


@every_machine
@pytest.mark.parametrize("apparent", [False, True])
def test_three_equal_legs_are_alike_in_x_and_y_at_home(machine: ThreeLegs, apparent: bool) -> None:
    model = machine.apparent() if apparent else machine
    placed = model.structure.at(model.place(model.home()))
    stiffness = axis_stiffness_blocked(tool_compliance(placed))
    assert stiffness[0] == pytest.approx(stiffness[1], rel=1e-9)
    assert stiffness[3] == pytest.approx(stiffness[4], rel=1e-9)


@every_machine
def test_releasing_the_link_ends_makes_the_machine_softer(machine: ThreeLegs) -> None:
    """More freedom never stiffens: the difference of the compliances is positive."""
    clamped = replace(machine, platform_joint="clamped")
    soft, hard = (
        tool_compliance(m.structure.at(m.place(machine.home()))) for m in (machine, clamped)
    )
    scale = np.sqrt(np.diag(soft))
    assert np.linalg.eigvalsh((soft - hard) / np.outer(scale, scale)).min() > -1e-9


def test_rigid_drives_can_be_chosen() -> None:
    machine = Proposed3PPRS(guide_stiffness=None, drive_stiffness=None)
    assert all(not joint.stiffness for joint in machine.linkage.joints)
    elastic = Proposed3PPRS()
    rigid, soft = (
        axis_stiffness_blocked(tool_compliance(m.structure.at(m.place(m.home()))))
        for m in (machine, elastic)
    )
    assert (rigid[:3] > soft[:3]).all()


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: Proposed3PPRS(link_length=-0.2), "Proposed3PPRS.link_length"),
        (lambda: Alizade3PRPS(stroke=float("nan")), "Alizade3PRPS.stroke"),
        (lambda: Eclipse3PPRS(link_length=0.1), "Eclipse3PPRS: cannot stand at home: its joint"),
        (lambda: Glozman3PRRS(pole_height=0.3), "Glozman3PRRS: cannot stand at home: its joint"),
        (lambda: MACHINES[0](platform_joint="glued"), "Proposed3PPRS.platform_joint"),
        (lambda: MACHINES[0](guide_drive="slip"), "Proposed3PPRS.guide_drive"),
        (lambda: Proposed3PPRS(guide_stiffness=-3e6), "Proposed3PPRS.guide_stiffness"),
    ],
)
def test_dimensions_that_make_no_machine_are_named(make: Any, words: str) -> None:
    with pytest.raises(ModelError, match=words):
        make()


@every_machine
def test_the_skeleton_names_nodes(machine: ThreeLegs) -> None:
    lines = machine.skeleton()
    assert {node for line in lines for node in line} <= set(machine.linkage.nodes)
    assert {"platform/P1", "platform/P2", "platform/P3"} <= {n for line in lines for n in line}
