"""Displacement of the tool by errors of joints: beside finite motions, zones and the stiffness."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from strutwork.errors import MechanismError, ModelError
from strutwork.kinematics import DIRECTIONS, Joint, jacobians
from strutwork.kinematics.error_transmission import error_transmission
from strutwork.kinematics.joint import JOINT_TYPES
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.turns import rotation_vector
from strutwork.machines import HexelHexapod
from strutwork.machines.load import load
from strutwork.machines.model_poses import at_pose
from strutwork.overconstraint import Tolerance, draw
from strutwork.overconstraint.accuracy import accuracy
from strutwork.overconstraint.joint_errors import JointError
from strutwork.studies.accuracy_answer import drive_errors

FOLDER = "examples/machines"


def moved_by(model: Any, joint: str, direction: str, step: float) -> Any:
    """Rate of the tool's pose as one joint coordinate moves, the drives held, (6,).

    A locked direction is made a drive of its own: the error is then a motion of finite size.
    """
    linkage = model.structure.linkage
    number = linkage.joint_index[joint]
    old = linkage.joints[number]
    if direction not in old.driven:
        kept = {*JOINT_TYPES[old.type], *old.locks} | set(old.stiffness)
        locks = tuple(d for d in DIRECTIONS if d in kept - {direction, *old.driven})
        new = Joint(old.name, "support", old.between, driven=(*old.driven, direction), locks=locks)
        joints = (*linkage.joints[:number], new, *linkage.joints[number + 1 :])
        linkage = replace(linkage, joints=joints)
    motion = Motion(linkage, replace(model.placement, values=np.zeros(0), names=()), model.rotation)
    held = {(j, d): np.zeros(4) for j, d in linkage.driven}
    held[joint, direction] = step * np.array([-2.0, -1.0, 1.0, 2.0])
    found = motion.move(joints=held)
    found.placement.require_reachable()
    assert found.tool is not None
    turned = rotation_vector(found.tool.rotation @ model.rotation.T)
    pose = np.concatenate([found.tool.position, turned], axis=-1)
    return (8 * (pose[2] - pose[1]) - (pose[3] - pose[0])) / (12 * step)


@pytest.mark.parametrize(
    ("name", "columns"),
    [
        ("6-ups", 5),
        ("tricept", 5),
        ("3-rps", 5),
    ],
)
def test_matrix_is_the_differences_of_finite_motions(name: str, columns: int) -> None:
    """Away from home; drives, and locked directions that are let go one by one."""
    model = load(f"{FOLDER}/{name}.toml")
    first = model.task[0]
    value = model.motion.task_of(model.motion.home_pose)[DIRECTIONS.index(first)]
    model = at_pose(model, {first: value + 0.02})
    linkage = model.structure.linkage
    every = [
        c
        for c in error_transmission(linkage, model.placement).columns
        if linkage.joints[linkage.joint_index[c[0]]].matrix is None
        and c[0] not in model.supports.values()
        # a universal's crossed axes let go of one turn only by their own rule
        and (linkage.joints[linkage.joint_index[c[0]]].type != "universal" or c[1] in "xyz")
    ]
    random = np.random.default_rng(5)
    chosen = {*linkage.driven, *(every[k] for k in random.choice(len(every), columns, False))}
    columns_ = sorted(chosen)
    found = error_transmission(linkage, model.placement, columns_)
    assert bool(found.determined)
    for k, (joint, direction) in enumerate(columns_):
        rate = moved_by(model, joint, direction, 1e-3)
        # what does not move the tool: joints closed to 1e-12 or so, parted by 1e-3
        small = max(1e-6 * np.abs(rate).max(), 1e-9)
        assert found.matrix[:, k] == pytest.approx(rate, rel=1e-6, abs=small)
    locked = [k for k, c in enumerate(columns_) if c not in linkage.driven]
    assert np.abs(found.matrix[:, locked]).max() > 0.1


def test_drive_columns_are_the_forward_jacobian() -> None:
    machine = HexelHexapod()
    poses = machine.poses([-0.02, 0.0, 0.05], [0.1, 0.0, -0.2])
    placement = machine.place(poses)
    found = error_transmission(machine.linkage, placement, machine.linkage.driven)
    assert found.matrix == pytest.approx(jacobians(machine.linkage, placement).forward, abs=1e-9)


def test_rods_of_a_parallelogram_that_differ_turn_the_plate() -> None:
    """By δ/d about the axis across the rods and the seats: the reason for a large d."""
    model = load(f"{FOLDER}/linear-delta.toml")
    delta, d = 10e-6, 0.15
    one = next(t for t in model.tolerances if t.name == "length of rod 2a")
    found = accuracy(model.placed, [one])
    turn = found.gain[3:, 0]
    # seats along x, rods within the plane of y and z: the plate turns about the two
    assert found.contributions[..., 0] == pytest.approx(np.abs(found.gain[:, 0]), abs=1e-18)
    seats = np.array([1.0, 0.0, 0.0])
    rod = np.array([0.0, 0.6, 0.8])
    # the seats part along the rod by the difference: (θ × d seats)·rod = ± δ
    assert abs(np.cross(turn, d * seats) @ rod) == pytest.approx(delta, rel=1e-9)
    assert np.linalg.norm(turn) == pytest.approx(delta / d, rel=0.3)
    # rods longer by the same turn nothing
    both = accuracy(model.placed, [t for t in model.tolerances if "rod 2" in t.name])
    signs = both.sources.map[[c[0] for c in both.sources.columns].index("lower2a")]
    assert np.any(signs)
    assert both.gain[3:].sum(axis=-1) == pytest.approx(np.zeros(3), abs=1e-12)


@pytest.mark.parametrize("name", ["6-ups", "3-rps", "linear-delta"])
def test_rows_and_stiffness_agree_where_nothing_is_forced(name: str) -> None:
    model = load(f"{FOLDER}/{name}.toml")
    errors = drive_errors(model, 5e-6, 5e-6)
    rows = accuracy(model.placed, model.tolerances, errors, "rows")
    soft = accuracy(model.placed, model.tolerances, errors, "stiffness")
    assert (bool(rows.elastic), bool(soft.elastic)) == (False, True)
    assert rows.gain == pytest.approx(soft.gain, abs=1e-9 * np.abs(soft.gain).max())


def test_redundant_rows_ask_the_stiffness() -> None:
    model = load(f"{FOLDER}/gantry.toml")
    errors = drive_errors(model)
    assert bool(accuracy(model.placed, model.tolerances, errors).elastic)
    with pytest.raises(ModelError, match="are over-constrained"):
        accuracy(model.placed, model.tolerances, errors, "rows")


def hexapod_errors() -> tuple[Any, list[Tolerance], list[JointError]]:
    machine = HexelHexapod()
    placed = machine.structure.at(machine.place(machine.poses([0.0, 0.03], [0.0, 0.1])))
    tolerances = [
        Tolerance("seat", "point_position", ("leg1/ball",), size=20e-6),
        Tolerance("hole", "position", ("leg3/ball",), size=30e-6, axis=(0, 0, 1)),
    ]
    errors = [
        JointError("drive error", "leg2/ram", "z", 5e-6),
        JointError("play", "leg4/ball", "x", 4e-6),
    ]
    return placed, tolerances, errors


def test_worst_case_is_reached_and_not_exceeded() -> None:
    placed, tolerances, errors = hexapod_errors()
    found = accuracy(placed, tolerances, errors)
    assert found.names == (
        "seat", "hole", "drive error of leg2/ram:z", "play of leg4/ball:x",
    )  # fmt: skip
    z = found.sources.extreme(found.gain)
    reached = np.einsum("pdk,pdk->pd", found.gain, z)
    assert reached == pytest.approx(found.worst, rel=1e-12)
    random = np.random.default_rng(3)
    drawn = np.zeros((4000, found.sources.parameters))
    for block in found.sources.blocks:
        d = block.shape.dimension
        drawn[:, block.start : block.start + d] = block.shape.inside(random.random((4000, d)))
    displaced = np.einsum("pdk,nk->npd", found.gain, drawn)
    assert np.all(np.abs(displaced) <= found.worst * (1 + 1e-12))
    place, parts = found.largest()
    size = np.linalg.norm(place, axis=-1)
    assert np.all(np.linalg.norm(displaced[..., :3], axis=-1) <= size * (1 + 1e-4))
    assert np.all(size <= np.linalg.norm(found.worst[:, :3], axis=-1) * (1 + 1e-12))
    assert np.all(size >= found.worst[:, :3].max(axis=-1) * (1 - 1e-4))
    assert parts.sum(axis=-1) == pytest.approx(size, rel=1e-12)


def test_standard_deviation_is_that_of_a_sample() -> None:
    placed, tolerances, errors = hexapod_errors()
    found = accuracy(placed, tolerances, errors)
    uniform = np.random.default_rng(8).random((200_000, found.sources.parameters))
    sample = np.einsum("pdk,nk->npd", found.gain, draw(found.sources, uniform)).std(axis=0)
    # a deviation of n values is uncertain by 1/√(2n) = 0.16 %
    assert found.deviation == pytest.approx(sample, rel=0.01)
    assert np.all(found.deviation < found.root_sum_square)
    assert np.all(found.root_sum_square < found.worst)


def test_sizes_of_sources_by_hand() -> None:
    """One ram: the tool follows its column by half a step; a play by half of it to each side."""
    machine = HexelHexapod()
    placed = machine.structure.at(machine.place(machine.home()))
    column = error_transmission(machine.linkage, placed.placement, [("leg2/ram", "z")]).matrix[:, 0]
    one = accuracy(placed, errors=[JointError("drive error", "leg2/ram", "z", 5e-6)])
    assert one.worst == pytest.approx(5e-6 * np.abs(column), rel=1e-12)
    # uniform over ±5 µm
    assert one.deviation == pytest.approx(5e-6 * np.abs(column) / np.sqrt(3), rel=1e-12)
    # at either stop
    play = accuracy(placed, errors=[JointError("play", "leg2/ram", "z", 5e-6)])
    assert play.deviation == pytest.approx(play.worst, rel=1e-12)


def test_a_batch_is_its_poses_one_by_one() -> None:
    placed, tolerances, errors = hexapod_errors()
    whole = accuracy(placed, tolerances, errors)
    for k in range(2):
        one = accuracy(placed[k], tolerances, errors)
        assert whole.gain[k] == pytest.approx(one.gain, abs=1e-15)


def test_bad_input_is_named() -> None:
    placed, _, _ = hexapod_errors()
    with pytest.raises(ModelError, match="no source of error"):
        accuracy(placed)
    with pytest.raises(ModelError, match=r"play of leg1/ball:rx: is in a direction that is free"):
        accuracy(placed, errors=[JointError("play", "leg1/ball", "rx", 1e-6)])
    with pytest.raises(ModelError, match='unknown joint "nothing"'):
        accuracy(placed, errors=[JointError("play", "nothing", "x", 1e-6)])
    with pytest.raises(ModelError, match="Give a positive size"):
        JointError("drive error", "leg1/ram", "z", 0.0)
    with pytest.raises(ModelError, match="is given twice"):
        accuracy(placed, errors=[JointError("play", "leg1/ball", "x", 1e-6)] * 2)
    model = load(f"{FOLDER}/6-ups.toml")
    linkage = model.structure.linkage
    loose = replace(
        linkage,
        joints=tuple(
            replace(j, driven=(), stiffness={k: v for k, v in j.stiffness.items() if k != "z"})
            if j.name == linkage.driven[0][0]
            else j
            for j in linkage.joints
        ),
    )
    structure = replace(model.structure, linkage=loose)
    with pytest.raises(MechanismError, match="can move although the drives are held"):
        accuracy(
            structure.at(model.placement),
            errors=[JointError("drive error", *linkage.driven[1], 1e-6)],
        )
