"""The 9-dof prototype: redundant drives, its inverse kinematics, what it is made of."""

from __future__ import annotations

from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.kinematics import (
    GROUND,
    Poses,
    check_coincidence,
    drive_values,
    forward_kinematics,
    jacobians,
    mobility,
    tangent_rotation,
)
from strutwork.machines import Prototype3PPPRS, check_limits, hemisphere_poses
from strutwork.machines.legs import full, seat
from strutwork.msa.mass import mass_properties
from strutwork.studies.filters import moving_machine

MOVED = Prototype3PPPRS(stage_angles=(0.15, -0.20, 0.05))

both = pytest.mark.parametrize("machine", [Prototype3PPPRS(), MOVED], ids=["middle", "moved"])


@pytest.fixture(params=["home", "tilted"])
def poses(request: pytest.FixtureRequest) -> Poses:
    machine = Prototype3PPPRS()
    if request.param == "home":
        return machine.home()
    normal = np.array([0.2, -0.1, 1.0])
    rotation = tangent_rotation(normal / np.linalg.norm(normal), 0.2)
    return Poses(machine.home().position + np.array([3e-3, -2e-3, -5e-3]), rotation)


@both
def test_nine_drives_move_nine_freedoms_and_hold_them_all(
    machine: Prototype3PPPRS, poses: Poses
) -> None:
    # six freedoms of the platform and one internal freedom in each of the three chains
    found = mobility(machine.linkage, machine.place(poses))
    assert len(machine.linkage.driven) == 9
    assert (found.mobility, found.mobility_locked, found.redundant) == (9, 0, 0)
    # Grübler: 3 x (3 bodies + link) + platform = 13 bodies; 3 x (5 + 5 + 5 + 5 + 3) = 69 rows
    assert found.gruebler == 6 * 13 - 69 == 9


@both
def test_with_its_stages_locked_it_is_a_machine_of_six_drives(
    machine: Prototype3PPPRS, poses: Poses
) -> None:
    locked = machine.locked()
    placement = locked.place(poses)
    found = mobility(locked.linkage, placement)
    assert (found.mobility, found.mobility_locked, found.redundant) == (6, 0, 0)
    assert jacobians(locked.linkage, placement).inverse.shape == (6, 6)
    # what the drives do is the only difference: the places are the same
    np.testing.assert_array_equal(placement.positions, machine.place(poses).positions)
    assert moving_machine(machine) == locked


@both
def test_joints_close_and_links_keep_their_length(machine: Prototype3PPPRS) -> None:
    many = hemisphere_poses(machine.pole_height, lattice=4, rolls=5)
    placement = machine.place(many)
    assert placement.reachable.mean() > 0.5
    check_coincidence(machine.linkage, placement)
    gram = np.swapaxes(placement.frames, -1, -2) @ placement.frames
    # rounding of products of unit vectors
    np.testing.assert_allclose(gram, np.broadcast_to(np.eye(3), gram.shape), atol=1e-13)
    np.testing.assert_allclose(np.linalg.det(placement.frames), 1.0, atol=1e-13)
    index = machine.linkage.node_index
    for i in (1, 2, 3):
        span = (
            placement.positions[..., index[seat(i)], :]
            - placement.positions[..., index[full(i, "root")], :]
        )
        size = np.linalg.norm(span, axis=-1)[placement.reachable]
        np.testing.assert_allclose(size, machine.link_length, rtol=1e-12)


@both
def test_the_stages_stand_where_their_coordinates_say(
    machine: Prototype3PPPRS, poses: Poses
) -> None:
    placement = machine.place(poses)
    values = dict(zip(placement.names, placement.values, strict=True))
    index = machine.linkage.node_index
    for i in (1, 2, 3):
        turn = (i - 1) * 2.0 * pi / 3.0 + machine.stage_angles[i - 1]
        outward = np.array([np.cos(turn), np.sin(turn), 0.0])
        tangent = np.array([-np.sin(turn), np.cos(turn), 0.0])
        assert values[full(i, "guide"), "rz"] == machine.stage_angles[i - 1]
        hinge = placement.positions[index[full(i, "root")]]
        across, along = values[full(i, "tangential"), "z"], values[full(i, "radial"), "z"]
        expected = along * outward + across * tangent + [0.0, 0.0, 2 * machine.stage_height]
        np.testing.assert_allclose(hinge, expected, atol=1e-15)
        # the hinge turns about the tangent: the link has no part along it
        link = placement.positions[index[seat(i)]] - hinge
        assert abs(link @ tangent) < 1e-15
        carriage = placement.positions[index[full(i, "carriage")]]
        np.testing.assert_allclose(carriage, machine.base_radius * outward, atol=1e-15)


def test_the_jacobian_agrees_with_finite_differences(poses: Poses) -> None:
    machine = MOVED.locked()
    step = 1e-6
    numeric = np.stack(
        [
            (
                drive_values(machine, machine.place(poses.moved(step * e)))
                - drive_values(machine, machine.place(poses.moved(-step * e)))
            )
            / (2 * step)
            for e in np.eye(6)
        ],
        axis=-1,
    )
    exact = jacobians(machine.linkage, machine.place(poses)).inverse
    # central differences: step² and rounding over the step
    np.testing.assert_allclose(exact, numeric, atol=1e-8)


def test_forward_kinematics_finds_the_pose_again(poses: Poses) -> None:
    machine = MOVED.locked()
    target = drive_values(machine, machine.place(poses))
    found = forward_kinematics(machine, target, machine.home())
    np.testing.assert_allclose(found.position, poses.position, atol=1e-10)
    np.testing.assert_allclose(found.rotation, poses.rotation, atol=1e-9)


def test_the_home_pose_is_within_every_range() -> None:
    machine = Prototype3PPPRS()
    placement = machine.place(machine.home())
    assert bool(check_limits(machine.limits, placement).reachable)
    kinds = [limit.kind for limit in machine.limits]
    # three linear guides and two rotary ones in each chain
    assert (kinds.count("prismatic"), kinds.count("revolute"), kinds.count("spherical")) == (
        6,
        6,
        3,
    )


def test_a_stage_beyond_its_guide_is_named() -> None:
    machine = Prototype3PPPRS(stage_angles=(radians(31.0), 0.0, 0.0))
    placement = check_limits(machine.limits, machine.place(machine.home()))
    # at 31° the platform's joint stands 21 mm abreast of the stage: only the guide's 30° are left
    assert placement.reason(()).startswith("leg1/guide: rz")


def test_a_platform_too_high_is_out_of_reach() -> None:
    machine = Prototype3PPPRS()
    high = Poses.of([0.0, 0.0, machine.hinge_height + machine.link_length + 1e-3])
    assert "farther from the hinges' height" in machine.place(high).reason(())


def test_its_mass_is_the_sum_of_its_parts() -> None:
    machine = Prototype3PPPRS()
    found = mass_properties(machine.structure.at(machine.place(machine.home())))
    density = 7870.0
    link = density * pi / 4 * (0.019**2 - 0.014**2) * 0.216
    disc = density * pi * 0.060**2 * 0.015
    # the carriages are held by their guides: a part of the structure that does not move but counts
    chain = link + (0.5 + 0.5) + (0.3 + 0.5) + 0.3
    assert GROUND not in machine.linkage.body_names
    assert found.total == pytest.approx(3 * chain + disc + 0.5, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"guides": "free"}, "guides"),
        ({"stage_angles": (0.0, 0.0)}, "stage_angles"),
        ({"stage_angles": (0.0, np.nan, 0.0)}, "stage_angles"),
        ({"stage_height": 0.0}, "stage_height"),
        ({"pole_height": 0.4}, "cannot stand at home"),
    ],
)
def test_wrong_parameters_are_named(change: dict[str, object], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        replace(Prototype3PPPRS(), **change)  # type: ignore[arg-type]
