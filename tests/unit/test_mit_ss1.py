"""The MIT-SS-1: its pins and bearings, its reach, its stiffness in the plane."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from strutwork.errors import ModelError, UnreachableError
from strutwork.kinematics import Poses, check_coincidence, mobility, rotation_y, rotation_z
from strutwork.machines import MitSS1, check_limits
from strutwork.machines import mit_ss1_parts as parts
from strutwork.machines.mit_ss1 import NOMINAL_TILT, NOMINAL_X
from strutwork.msa import tool_compliance
from strutwork.msa.mass import mass_properties
from strutwork.papers.son_2002.published import DIMENSIONS, MACHINE

IN_PLANE = np.ix_([0, 2, 4], [0, 2, 4])


def workspace(machine: MitSS1, count: int = 5) -> Poses:
    x, b = np.meshgrid(
        np.linspace(*NOMINAL_X, count), np.linspace(-NOMINAL_TILT, NOMINAL_TILT, count)
    )
    return machine.poses(x, 0.02, b)


def test_the_dimensions_are_those_of_the_thesis() -> None:
    machine = MitSS1()
    named = {
        "w1": machine.guide_distances[0],
        "w2": machine.guide_distances[1],
        "w3": machine.guide_distances[2],
        "l1": machine.strut_lengths[0],
        "l2": machine.strut_lengths[1],
        "l3": machine.strut_lengths[2],
        "t": machine.joint_height,
        "r": machine.joint_radius,
        "p": machine.joint_rise,
    }
    for name, value in named.items():
        assert value == DIMENSIONS.value(MACHINE, name)


@pytest.mark.parametrize(
    ("machine", "redundant", "gruebler"),
    [
        # 7 bodies. Ideal pins: 3 guides x 5 + 6 pins x 5 = 45 rows, drives free.
        (MitSS1(pins="revolute"), 6, 42 - 45),
        # Two bearings a pin: 6 x 6 rows instead of 6 x 5, the sixth being redundant.
        (MitSS1(), 12, 42 - 51),
        (MitSS1(radial_stiffness=None, axial_stiffness=None), 12, 42 - 51),
    ],
    ids=["ideal pins", "bearings", "rigid bearings"],
)
@pytest.mark.parametrize("tilt", [0.0, 0.4])
def test_three_drives_move_three_freedoms_of_an_overconstrained_linkage(
    machine: MitSS1, redundant: int, gruebler: int, tilt: float
) -> None:
    found = mobility(machine.linkage, machine.place(machine.poses(0.01, -0.03, tilt)))
    assert (found.mobility, found.mobility_locked) == (3, 0)
    assert (found.redundant, found.gruebler) == (redundant, gruebler)
    assert len(found.self_stress) == redundant


def test_every_bearing_is_a_joint_of_its_own() -> None:
    machine = MitSS1()
    names = [joint.name for joint in machine.linkage.joints]
    assert names[:3] == ["block1/guide", "block2/guide", "block3/guide"]
    assert tuple(names[3:]) == parts.bearings()
    assert names[3:7] == [
        "strut1/block near",
        "strut1/block far",
        "strut1/housing near",
        "strut1/housing far",
    ]
    placement = machine.place(machine.home())
    near, far = machine.bearing_planes
    assert far - near == machine.pin_width
    for joint in machine.linkage.joints[3:]:
        at = placement.positions[machine.linkage.node_index[joint.between[0]]]
        assert at[1] == (near if joint.name.endswith("near") else far)


@pytest.mark.parametrize("kind", ["bearings", "revolute"])
def test_joints_close_and_struts_keep_their_length(kind: Any) -> None:
    machine = MitSS1(pins=kind)
    placement = machine.place(workspace(machine))
    assert placement.reachable.all()
    check_coincidence(machine.linkage, placement)
    frames = placement.frames
    gram = np.swapaxes(frames, -1, -2) @ frames
    # rounding of products of unit vectors
    np.testing.assert_allclose(gram, np.broadcast_to(np.eye(3), gram.shape), atol=1e-14)
    np.testing.assert_allclose(np.linalg.det(frames), 1.0, atol=1e-13)
    pins = frames[..., 3:, :, 2]
    np.testing.assert_array_equal(pins, np.broadcast_to([0.0, 1.0, 0.0], pins.shape))
    index = machine.linkage.node_index
    for i, length in zip(parts.STRUTS, machine.strut_lengths, strict=True):
        ends = [placement.positions[..., index[parts.strut(i, e, "end")], :] for e in parts.ENDS]
        np.testing.assert_allclose(np.linalg.norm(ends[1] - ends[0], axis=-1), length, rtol=1e-14)
        # blocks above the housing, and the pins' x axis down the strut
        assert (ends[0][..., 2] > ends[1][..., 2]).all()
        name = parts.strut(i, "block", "near") if kind == "bearings" else parts.pin(i, "block")
        axis = frames[..., machine.linkage.joint_index[name], :, 0]
        np.testing.assert_allclose(axis * length, ends[1] - ends[0], atol=1e-15)


def test_pins_turn_by_what_their_values_say() -> None:
    machine = MitSS1()
    x, z, b = 0.02, -0.01, 0.35
    placement = machine.place(machine.poses(x, z, b))
    values = dict(zip(placement.names, placement.values, strict=True))
    index = machine.linkage.node_index
    for i in parts.STRUTS:
        strut, housing = (values[parts.strut(i, end, "near"), "rz"] for end in parts.ENDS)
        # a strut that hangs straight down, turned about y
        down = rotation_y(strut) @ np.array([0.0, 0.0, -machine.strut_lengths[i - 1]])
        ends = [placement.positions[index[parts.strut(i, e, "near")]] for e in parts.ENDS]
        np.testing.assert_allclose(ends[1] - ends[0], down, atol=1e-15)
        assert strut + housing == pytest.approx(b, abs=1e-15)


@pytest.mark.parametrize(
    ("poses", "words"),
    [
        (Poses.of([0.0, 1e-3, 0.0]), "outside the plane y = 0"),
        (Poses.of([0.0, 0.0, 0.0], rotation_z(0.01)), "an axis other than y"),
        (Poses.of([0.0, 0.0, 0.0], np.diag([1.0, -1.0, -1.0])), "an axis other than y"),
        (Poses.of([0.3, 0.0, 0.0]), "strut 1: its joint on the housing is farther"),
        (Poses.of([-0.25, 0.0, 0.0]), "strut 2: its joint on the housing is farther"),
        (Poses.of([-0.06, 0.0, 0.0]), "strut 3: its joint on the housing is farther"),
    ],
    ids=["off plane", "turned", "upside down", "left", "right", "third"],
)
def test_a_pose_it_cannot_take_is_marked_and_leaves_the_others(poses: Poses, words: str) -> None:
    # a third strut so short that it fails first somewhere
    machine = MitSS1(strut_lengths=(0.4, 0.4, 0.2))
    both = Poses(np.stack([np.zeros(3), poses.position]), np.stack([np.eye(3), poses.rotation]))
    placement = machine.place(both)
    assert placement.reachable.tolist() == [True, False]
    assert words in placement.reason(1)
    for array in (placement.positions, placement.frames, placement.values):
        assert np.isfinite(array).all()
    with pytest.raises(UnreachableError, match="pose 1"):
        machine.structure.at(placement)
    machine.structure.at(placement[placement.reachable])


def test_it_knows_no_joint_range() -> None:
    machine = MitSS1()
    assert machine.limits == ()
    assert check_limits(machine.limits, machine.place(workspace(machine))).reachable.all()


def test_a_drawing_names_nodes_of_the_machine() -> None:
    machine = MitSS1()
    drawn = {node for line in machine.skeleton() for node in line}
    assert drawn <= set(machine.linkage.nodes)
    assert parts.TOOL in drawn


@pytest.mark.parametrize("struts", ["rigid", "beams"])
@pytest.mark.parametrize("guide", [None, 180e6])
@pytest.mark.parametrize("drive", [None, 120e6])
def test_stiffness_in_the_plane_is_that_of_its_struts(
    struts: Any, guide: float | None, drive: float | None
) -> None:
    """Eqs 51 to 53 with every strut's force along the strut: K = Σ a aᵀ / c.

    c = 1/k_se + 1/k_sm + 1/k_st + u_x²/k_tr + u_z²/k_drive; a pair of bearings has twice the
    stiffness of one. Two exact computations: 1e-9 is left for the conditioning of K.
    """
    machine = MitSS1(struts=struts, guide_stiffness=guide, drive_stiffness=drive)
    placement = machine.place(workspace(machine, 3))
    found = np.linalg.inv(tool_compliance(machine.structure.at(placement))[(..., *IN_PLANE)])
    index, radial = machine.linkage.node_index, machine.radial_stiffness
    assert radial is not None
    tool = placement.positions[..., index[parts.TOOL], :]
    expected = np.zeros((3, 3, 3, 3))
    for i, length in zip(parts.STRUTS, machine.strut_lengths, strict=True):
        upper, lower = (
            placement.positions[..., index[parts.strut(i, e, "end")], :] for e in parts.ENDS
        )
        u, q = (upper - lower) / length, lower - tool
        ux, uz = u[..., 0], u[..., 2]
        row = np.stack([ux, uz, ux * q[..., 2] - uz * q[..., 0]], axis=-1)
        # the moment about +y is z F_x − x F_z
        c = np.full(ux.shape, 2.0 / (2.0 * radial))
        if struts == "beams":
            c += length / (machine.material.youngs_modulus * machine.section.area)
        if guide is not None:
            c += ux**2 / guide
        if drive is not None:
            c += uz**2 / drive
        expected += row[..., :, None] * row[..., None, :] / c[..., None, None]
    scale = np.abs(expected).max(axis=(-1, -2), keepdims=True)
    np.testing.assert_allclose(found / scale, expected / scale, rtol=0.0, atol=1e-9)


def test_motion_in_the_plane_and_out_of_it_are_separate() -> None:
    """The tool and the struts stand in the middle between the bearings."""
    machine = MitSS1()
    compliance = tool_compliance(machine.structure.at(machine.place(machine.poses(0.01, 0.0, 0.2))))
    mixed = compliance[np.ix_([0, 2, 4], [1, 3, 5])]
    assert np.abs(mixed).max() < 1e-12 * np.abs(compliance).max()
    assert (np.linalg.eigvalsh(compliance) > 0).all()


@pytest.mark.parametrize("struts", ["rigid", "beams"])
@pytest.mark.parametrize("tilt", [0.0, 0.4])
def test_struts_and_housing_weigh_what_was_measured(struts: Any, tilt: float) -> None:
    """Section 9.1: a spindle of 7.1 kg is "about 6 %" of the strut and end-effector."""
    machine = MitSS1(struts=struts)
    placement = machine.place(machine.poses(0.01, 0.0, tilt))
    found = mass_properties(machine.structure.at(placement))
    assert found.total == pytest.approx(30.0 + 3 * 29.4, rel=1e-14)
    assert 7.1 / found.total == pytest.approx(0.06, abs=5e-4)
    # every part is alike at both ends and both sides: the centre follows from the pins
    index = machine.linkage.node_index
    ends = [parts.strut(i, end, "end") for i in parts.STRUTS for end in parts.ENDS]
    struts_at = placement.positions[[index[n] for n in ends]].mean(axis=0)
    housing_at = placement.positions[[index[n] for n in ends[1::2]]].mean(axis=0)
    expected = (30.0 * housing_at + 3 * 29.4 * struts_at) / found.total
    np.testing.assert_allclose(found.centre, expected, atol=1e-14)


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"strut_lengths": (0.4, 0.4, 0.0)}, "strut_lengths"),
        ({"guide_distances": (0.4, 0.4)}, "guide_distances"),
        ({"pin_width": -0.1}, "pin_width"),
        ({"joint_rise": float("nan")}, "joint_rise"),
        ({"radial_stiffness": 0.0}, "radial_stiffness"),
        ({"guide_stiffness": float("inf")}, "guide_stiffness"),
        ({"housing_mass": -1.0}, "housing_mass"),
        ({"struts": "solid"}, 'Choose "beams" or "rigid"'),
        ({"pins": "ball"}, 'Choose "bearings" or "revolute"'),
        ({"strut_lengths": (0.2, 0.4, 0.475)}, "cannot stand at home: strut 1"),
    ],
)
def test_wrong_dimensions_are_named(fields: dict[str, Any], words: str) -> None:
    with pytest.raises(ModelError, match=words):
        MitSS1(**fields)


def test_a_strut_lighter_than_its_beam_is_refused() -> None:
    with pytest.raises(ModelError, match=r"strut_mass: is 12 kg, less than the 17\.9 kg"):
        _ = MitSS1(strut_mass=12.0).structure
