"""Jacobians leg by leg against those from all rows of the linkage."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.kinematics import Body, Joint, Linkage, Placement, Poses, jacobians
from strutwork.kinematics.leg_chains import leg_chains
from strutwork.kinematics.motion_spaces import motion_spaces
from strutwork.kinematics.singular_values import FEW, singular_values
from strutwork.machines import (
    Alizade3PRPS,
    Eclipse3PPRS,
    Glozman3PRRS,
    HexelHexapod,
    MitSS1,
    Proposed3PPRS,
    Prototype3PPPRS,
)
from tests.linkages import gough, open_chain, slider_crank

MACHINES: dict[str, Any] = {
    "proposed": Proposed3PPRS(),
    "eclipse": Eclipse3PPRS(),
    "alizade": Alizade3PRPS(),
    "glozman": Glozman3PRRS(),
    "prototype": Prototype3PPPRS().locked(),
    "hexapod": HexelHexapod(),
    "gough": gough(),
    "spinning struts": gough("spherical"),
}


def placed(machine: Any, count: int = 60) -> Placement:
    random = np.random.default_rng(2)
    small = np.array([4e-3] * 3 + [0.3] * 3)
    twists = random.uniform(-1, 1, (count, 6)) * small
    home = machine.home()
    placement = machine.place(
        Poses.of(np.tile(home.position, (count, 1)), home.rotation).moved(twists)
    )
    return placement[placement.reachable]


@pytest.mark.parametrize("name", MACHINES)
def test_legs_and_rows_agree(name: str) -> None:
    machine = MACHINES[name]
    placement = placed(machine)
    assert placement.batch[0] > 20
    legs, rows = (jacobians(machine.linkage, placement, m) for m in ("legs", "rows"))  # type: ignore[arg-type]
    assert legs.by_rank is None or not legs.by_rank.any()
    size = np.abs(rows.inverse).max(axis=-1, keepdims=True)
    # both from screws and rows of size one, with condition numbers below 1e4
    np.testing.assert_allclose(legs.inverse / size, rows.inverse / size, rtol=0, atol=1e-11)
    np.testing.assert_allclose(legs.condition(0.1), rows.condition(0.1), rtol=1e-10)
    np.testing.assert_allclose(legs.margin(0.1), rows.margin(0.1), rtol=1e-10)
    np.testing.assert_allclose(
        legs.forward @ legs.inverse, np.broadcast_to(np.eye(6), legs.forward.shape), atol=1e-9
    )
    twist = np.arange(1.0, 7.0)
    np.testing.assert_allclose(legs.rates(twist), legs.inverse @ twist, rtol=1e-12, atol=1e-12)


def test_batch_axes_and_single_poses() -> None:
    machine = MACHINES["hexapod"]
    placement = placed(machine, 12)
    flat = jacobians(machine.linkage, placement)
    shaped = Placement(
        placement.positions.reshape(3, 4, -1, 3),
        placement.frames.reshape(3, 4, -1, 3, 3),
        placement.values.reshape(3, 4, -1),
        placement.names,
    )
    for method in (None, "rows"):
        found = jacobians(machine.linkage, shaped, method)  # type: ignore[arg-type]
        assert found.inverse.shape == (3, 4, 6, 6)
        assert found.condition(0.2).shape == found.singular.shape == (3, 4)
        np.testing.assert_allclose(found.inverse.reshape(12, 6, 6), flat.inverse, atol=1e-12)
    alone = jacobians(machine.linkage, placement[5])
    np.testing.assert_array_equal(alone.inverse, flat.inverse[5])
    assert np.shape(alone.condition()) == ()


def test_joints_may_be_written_from_either_side() -> None:
    machine = MACHINES["hexapod"]
    placement = placed(machine, 5)
    linkage = machine.linkage
    joints = tuple(
        replace(j, between=j.between[::-1]) if i % 3 else j for i, j in enumerate(linkage.joints)
    )
    other = Linkage(linkage.nodes, linkage.bodies, joints, linkage.tool)
    legs, rows = (jacobians(other, placement, m) for m in ("legs", "rows"))  # type: ignore[arg-type]
    np.testing.assert_allclose(legs.inverse, rows.inverse, atol=1e-12)
    # a ram written from the rod to the cylinder counts its rate the other way
    np.testing.assert_allclose(legs.inverse, -jacobians(linkage, placement).inverse, atol=1e-12)


def test_a_serial_arm_is_one_leg() -> None:
    random = np.random.default_rng(6)
    points = np.cumsum(random.normal(size=(7, 3)), axis=0)
    linkage, placement = open_chain(points, random.normal(size=(7, 3)))
    legs, rows = (jacobians(linkage, placement, m) for m in ("legs", "rows"))  # type: ignore[arg-type]
    np.testing.assert_allclose(legs.inverse, rows.inverse, rtol=1e-10, atol=1e-12)


def test_a_leg_beside_the_drives_changes_nothing() -> None:
    """A passive leg of six freedoms has no row; one that hangs loose makes it no such machine."""
    machine = gough()
    linkage = machine.linkage
    idle = tuple(replace(j, driven=()) if j.name == "P6" else j for j in linkage.joints)
    six = Linkage(linkage.nodes, linkage.bodies, idle, "tool")
    chains = leg_chains(six)
    assert chains is not None
    assert chains.passive.tolist() == [5] * 5 + [6]
    loose = Linkage(
        (*linkage.nodes, "a", "b"),
        (*linkage.bodies, Body("bob", ("b",))),
        (*linkage.joints, Joint("hook", "spherical", ("a", "b"))),
        "tool",
    )
    assert leg_chains(loose) is None


def test_what_is_no_machine_of_legs_goes_by_all_rows() -> None:
    mit = MitSS1()
    placement = mit.place(mit.home())
    for linkage, at in ((mit.linkage, placement), slider_crank(0.5)):
        assert leg_chains(linkage) is None
        with pytest.raises(ModelError, match="does not split into legs"):
            jacobians(linkage, at, "legs")
        assert np.isfinite(jacobians(linkage, at).inverse).all()


def test_a_leg_with_more_drives_than_it_needs_has_the_least_rates() -> None:
    """Leg by leg, and as the null space of all rows has them at the same arm of turning drives."""
    nine = Prototype3PPPRS()
    placement = placed(nine)
    found = jacobians(nine.linkage, placement, "legs")
    assert found.inverse.shape == (*placement.batch, 9, 6)
    assert found.by_rank is None
    spaces = motion_spaces(nine.linkage, placement, found.length)
    # both well conditioned, entries of some tens
    np.testing.assert_allclose(found.inverse, spaces.inverse, atol=1e-11)
    np.testing.assert_allclose(found.forward, spaces.forward, atol=1e-11)
    assert not spaces.serial.any()
    assert not spaces.parallel.any()
    # more drives than freedoms: no singularity, and the least rates
    assert not found.singular.any()
    rotary = [direction.startswith("r") for _, direction in found.driven]
    arm = np.where(rotary, found.length[:, None], 1.0)[..., None]
    least = np.linalg.pinv(found.forward / np.swapaxes(arm, -1, -2)) / arm
    np.testing.assert_allclose(found.inverse, least, atol=1e-9)


def test_a_pose_near_a_serial_singularity_is_looked_at_by_rank() -> None:
    """A joint centre near the guide's axis: the carriage whirls, and the kernel steps aside."""
    machine = Proposed3PPRS()
    radius = machine.platform_radius
    poses = Poses.of([[-radius + 1e-7, 0.0, 0.12], [0.001, 0.0, 0.12]])
    found = jacobians(machine.linkage, machine.place(poses))
    assert found.by_rank is not None
    assert found.by_rank.tolist() == [True, False]
    rows = jacobians(machine.linkage, machine.place(poses), "rows")
    np.testing.assert_allclose(found.inverse, rows.inverse, rtol=1e-6, atol=1e-6)
    assert found.condition(0.1)[0] > 1e5


@pytest.mark.parametrize("shape", [(6, 6), (9, 6), (3, 3), (8, 2)])
def test_singular_values_are_lapacks(shape: tuple[int, int]) -> None:
    random = np.random.default_rng(1)
    matrices = random.normal(size=(FEW + 7, *shape)) * 10.0 ** random.uniform(
        -9, 9, (FEW + 7, 1, 1)
    )
    matrices[0] = 0.0
    matrices[1, :, 0] = matrices[1, :, 1]
    matrices[2] = np.eye(*shape)
    expected = np.linalg.svd(matrices, compute_uv=False)
    found = singular_values(matrices)
    size = np.maximum(expected[:, :1], 1e-300)
    np.testing.assert_allclose(found / size, expected / size, rtol=0, atol=1e-13)
    assert (np.diff(found, axis=-1) <= 0).all()


def test_the_least_singular_value_keeps_its_size_beside_columns_of_any_scale() -> None:
    """A column far smaller than the others has its own digits, and any unit of all is as good."""
    random = np.random.default_rng(5)
    near = np.linalg.qr(random.normal(size=(FEW, 6, 6)))[0]
    scales = np.array([1.0, 1e-3, 1e-6, 1e-9, 1e-12, 1e-15])
    for unit in (1e-100, 1.0, 1e100):
        found = singular_values(unit * near * scales) / unit
        np.testing.assert_allclose(found, np.broadcast_to(scales, found.shape), rtol=1e-12)
