"""Workspaces of machines beside closed forms: reach, joint ranges, interference, spare values."""

from __future__ import annotations

from dataclasses import replace
from math import cos, pi, radians, sin
from typing import Any

import numpy as np
import pytest
import trimesh
import xarray as xr
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import GROUND, Body, Joint, Linkage, Placement, axes_frame
from strutwork.kinematics.inscribed_shape import box_of
from strutwork.kinematics.largest_shape import largest_shape
from strutwork.kinematics.motion import Motion
from strutwork.machines.limits import joint_limits
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.msa import Structure
from strutwork.studies import foresee
from strutwork.studies import workspace as module
from strutwork.studies.workspace import Workspace, workspace
from strutwork.studies.workspace_files import write_workspace
from strutwork.studies.workspace_margin import (
    MachineMargin,
    Spare,
    dexterous,
    interference_of,
    tilted,
)
from tests.linkages import chain

Array = NDArray[Any]

FIRST, SECOND = 1.0, 0.6


def model_of(linkage: Linkage, home: Any) -> Model:
    """A model of a linkage alone."""
    return Model(
        title="arm",
        structure=Structure(linkage),
        placement=home,
        cases=(),
        nodes=linkage.nodes,
        joints=tuple(j.name for j in linkage.joints),
        supports={},
        limits=joint_limits(linkage),
    )


def arm(limits: dict[str, tuple[float, float]] | None = None) -> Model:
    """Two bars of 1 m and 0.6 m at right angles; joint angles are counted from there."""
    linkage, home = chain(
        [[0, 0, 0], [FIRST, 0, 0], [FIRST, SECOND, 0]], [[0, 0, 1.0]] * 3, driven=0, closed=False
    )
    joints = [
        replace(j, limits={"rz": limits[j.name]}) if limits and j.name in limits else j
        for j in linkage.joints
    ]
    return model_of(replace(linkage, joints=tuple(joints)), home)


def space(model: Model, axes: dict[str, Array], *, halvings: int = 6, **options: Any) -> Workspace:
    step = np.array([a[1] - a[0] for a in axes.values()])
    return workspace(MachineMargin(model, tuple(axes), step, **options), axes, halvings=halvings)


def square(half: float, count: int) -> dict[str, Array]:
    return {d: np.linspace(-half, half, count) for d in "xy"}


RING = pi * ((FIRST + SECOND) ** 2 - (FIRST - SECOND) ** 2)


def test_the_ring_of_an_arm_is_reached_round_its_hole() -> None:
    found = space(arm(), square(1.73, 29))
    assert abs(found.measure - RING) <= found.error
    assert found.error < 0.02 * RING
    assert (len(found.regions.sizes), found.regions.holes, found.home_component) == (1, 1, 1)
    # the border is the two circles, to where the motion holds a singular pose to be reached
    radius = np.linalg.norm(found.grid.border, axis=1)
    off = np.minimum(np.abs(radius - 1.6), np.abs(radius - 0.4))
    assert off.max() < 1e-3
    assert found.nearest is not None
    assert found.nearest.distance == pytest.approx(1.6 - np.hypot(1.0, 0.6), abs=0.01)
    assert "out of reach" in found.nearest.reason
    assert sum(found.shares.values()) == pytest.approx(1.0)


def test_joint_ranges_cut_the_ring_and_are_named() -> None:
    span, bend = radians(70), radians(40)
    limits = {"R1": (-span, span), "R2": (-bend, bend)}
    found = space(arm(limits), square(1.73, 41))
    # in polar coordinates dA = l1 l2 sin(elbow) d(elbow) d(shoulder), elbow 90° at home
    area = 2 * span * FIRST * SECOND * (cos(pi / 2 - bend) - cos(pi / 2 + bend))
    assert abs(found.measure - area) <= found.error
    assert found.error < 0.1 * area
    assert set(found.shares) == {
        f"{joint}:rz at its {end}, {sign}{angle} deg"
        for joint, angle in (("R1", 70), ("R2", 40))
        for end, sign in (("least", "-"), ("most", ""))
    }
    # an outer arc of (2 · 70°) at r(50°), an inner one at r(130°)
    outer = np.sqrt(FIRST**2 + SECOND**2 + 2 * FIRST * SECOND * cos(pi / 2 - bend))
    inner = np.sqrt(FIRST**2 + SECOND**2 + 2 * FIRST * SECOND * cos(pi / 2 + bend))
    arcs = found.shares["R2:rz at its least, -40 deg"] / found.shares["R2:rz at its most, 40 deg"]
    # corners of the region belong to either by halves of a cell
    assert arcs == pytest.approx(outer / inner, rel=0.1)


def gantry(travel: tuple[tuple[float, float], ...]) -> Model:
    """Three slides one on another, along x, y and z."""
    names = ("bed", "f0", "s0", "f1", "s1", "tool")
    linkage = Linkage(
        names,
        (
            Body(GROUND, ("bed",)),
            Body("bridge", ("f0", "s0")),
            Body("carriage", ("f1", "s1")),
            Body("ram", ("tool",)),
        ),
        tuple(
            Joint(f"P{k}", "prismatic", pair, driven=("z",), limits={"z": travel[k]})
            for k, pair in enumerate((("bed", "f0"), ("s0", "f1"), ("s1", "tool")))
        ),
        "tool",
    )
    home = Placement(np.zeros((6, 3)), axes_frame(np.eye(3)), np.zeros(0))
    return model_of(linkage, home)


def test_the_box_of_a_gantry_exactly() -> None:
    travel = ((-0.4, 0.5), (-0.31, 0.27), (-0.2, 0.1))
    model = gantry(travel)
    axes = {d: np.linspace(-0.6, 0.65, 11) for d in "xyz"}
    step = np.array([0.125] * 3)
    margin = MachineMargin(model, ("x", "y", "z"), step)
    found = workspace(margin, axes)
    wanted = np.ptp(travel, axis=1)
    # cells at edges are cut, of second order
    assert abs(found.measure - wanted.prod()) <= found.error
    middle = np.mean(travel, axis=1)
    inside = largest_shape(found.grid, margin, box_of(wanted), centre=middle, accuracy=1e-3)
    # halved to the last digits, and a joint's range has a slack of 1e-9 m in rounding
    np.testing.assert_allclose(inside.sides, wanted, rtol=1e-8)
    assert inside.reason.startswith("P")


def test_tilts_and_rolls_shrink_what_is_reached() -> None:
    model = load("proposed-3pprs")
    axes = {d: np.linspace(-0.03, 0.03, 13) for d in "xy"}
    upright, leaning = space(model, axes), space(model, axes, turns=tilted(radians(15))[None])
    all_round = space(model, axes, turns=dexterous(radians(15), 6))
    assert 0.0 < all_round.measure < leaning.measure
    assert (all_round.grid.good <= (upright.grid.good & leaning.grid.good)).all()
    # a tilt of nothing is none
    none = space(model, axes, turns=dexterous(0.0, 3))
    assert none.measure == pytest.approx(upright.measure, rel=1e-6)


def test_turns_are_those_of_the_tool() -> None:
    axis = tilted(radians(30), radians(90))[:, 2]
    np.testing.assert_allclose(axis, [0.0, sin(radians(30)), cos(radians(30))], atol=1e-15)
    found = dexterous(radians(20), 8, [-0.1, 0.0, 0.1])
    assert len(found) == 3 * (1 + 2 * 8)
    tilts = np.degrees(np.arccos(np.clip(found[:, 2, 2], -1, 1)))
    np.testing.assert_allclose(np.unique(np.round(tilts, 6)), [0.0, 10.0, 20.0])


def test_a_spare_roll_makes_poses_good() -> None:
    model = load("proposed-3pprs")
    axes = {d: np.linspace(-0.03, 0.03, 13) for d in "xy"}
    leaning = {"turns": tilted(radians(20))[None]}
    fixed = space(model, axes, **leaning)
    free = space(model, axes, **leaning, spare=Spare("roll", np.radians(np.linspace(-60, 60, 9))))
    assert (free.grid.good >= fixed.grid.good).all()
    assert free.measure > 1.1 * fixed.measure
    # 0 is among the values: nowhere is the margin less, and the chosen value has that margin
    assert (free.grid.margins.value >= fixed.grid.margins.value - 1e-12).all()
    assert free.spare is not None
    index = tuple(np.argwhere(free.grid.good)[0])
    point = np.array([[axes[d][i] for d, i in zip("xy", index, strict=True)]])
    turn = tilted(radians(20), 0.0, float(free.spare[index]))
    there = MachineMargin(model, ("x", "y"), np.ones(2), turn[None])(point)
    assert there.value[0] == pytest.approx(free.grid.margins.value[index], abs=1e-12)


def test_a_spare_stage_of_a_redundant_machine() -> None:
    model = load("prototype-3ppprs")
    axes = {"x": np.linspace(-0.02, 0.02, 5)}
    stages = Spare(("leg1/tangential", "z"), np.array([-0.02, 0.0, 0.02]))
    found = space(model, axes, halvings=2, spare=stages)
    assert found.spare is not None
    assert found.grid.good.any()
    assert set(found.spare[found.grid.good]) <= {-0.02, 0.0, 0.02}


def test_interference_bounds_it() -> None:
    # three bars, of which the first and the last may collide; the last stays upright
    linkage, home = chain(
        [[0, 0, 0], [0, 1, 0], [1, 1, 0], [1, 0.1, 0]], [[0, 0, 1.0]] * 4, driven=0, closed=False
    )
    model = model_of(linkage, home)
    axes = {"x": np.linspace(0.05, 1.2, 11)}
    free = space(model, axes)
    assert free.shares == {"the grid ends": 1.0}
    safe = interference_of(model, 0.1)
    assert [safe.words(q) for q in range(len(safe.pairs))] == ["bar1 and bar3"]
    kept = space(model, axes, halvings=12, interference=safe)
    # the tip at (x, 0.1) comes within two radii of the first bar's foot
    assert kept.measure == pytest.approx(1.2 - np.sqrt(0.2**2 - 0.1**2), abs=2e-5)
    assert kept.nearest is not None
    assert kept.nearest.reason == "interference of bar1 and bar3"
    assert kept.nearest.distance == pytest.approx(1.0 - np.sqrt(0.03), abs=2e-5)
    # as thick as the two are apart at home, they collide there
    with pytest.raises(ModelError, match=r"bar1 and bar3: interfere at home: they overlap by 100"):
        interference_of(model, 0.55)


def test_bad_questions() -> None:
    model = arm()
    with pytest.raises(ModelError, match="cannot hold"):
        MachineMargin(model, ("x", "y"), np.ones(2), tilted(0.2)[None])
    with pytest.raises(ModelError, match="outer size"):
        interference_of(model, None)
    with pytest.raises(ModelError, match=r"cannot move|not move|depend|held"):
        space(model, {d: np.linspace(-0.1, 0.1, 5) for d in "xyz"})
    with pytest.raises(ModelError, match="direction of the grid"):
        MachineMargin(model, ("x", "y"), np.ones(2), spare=Spare("x", np.zeros(1)))
    with pytest.raises(ModelError, match="conditioning"):
        MachineMargin(model, ("x", "y"), np.ones(2), conditioning=1.5)


def test_a_grid_too_large_is_refused_beforehand(monkeypatch: pytest.MonkeyPatch) -> None:
    model = load("proposed-3pprs")
    axes = {d: np.linspace(-0.05, 0.05, 401) for d in "xyz"}
    margin = MachineMargin(model, tuple("xyz"), np.ones(3))
    with pytest.raises(ModelError, match=r"64,481,201 poses, which would take about .* GB"):
        workspace(margin, axes)
    axes = {d: np.linspace(-0.05, 0.05, 41) for d in "xyz"}
    monkeypatch.setattr(module, "LONGEST", 1e-3)
    with pytest.raises(
        ModelError, match=r"68,921 poses, which would take .* GB; at most 10,000,000 poses, 2"
    ):
        workspace(margin, axes)
    monkeypatch.setattr(module, "LONGEST", 7200.0)
    monkeypatch.setattr(foresee, "available_memory", lambda: 1e6)
    with pytest.raises(ModelError, match=r"68,921 poses, which .* and 0.0055 GB; .* 2 hours, 0.0"):
        workspace(margin, axes)


def test_conditioning_keeps_away_from_singular_poses() -> None:
    model = load("proposed-3pprs")
    axes = {d: np.linspace(-0.05, 0.05, 13) for d in "xy"}
    loose, strict = space(model, axes, conditioning=0.2), space(model, axes, conditioning=0.9)
    assert 0.0 < strict.measure < loose.measure
    assert "conditioning of the drives" in strict.shares


def test_files_hold_what_was_found(tmp_path: Any) -> None:
    model = load("proposed-3pprs")
    axes = {
        "x": np.linspace(-0.03, 0.03, 9),
        "y": np.linspace(-0.03, 0.03, 9),
        "z": np.linspace(0.1, 0.16, 9),
    }
    found = space(model, axes)
    written = write_workspace(tmp_path, "w", found)
    assert [p.name for p in written] == ["w.nc", "w.csv", "w-border.csv", "w.stl", "w.ply"]
    for path in written[3:]:
        surface = trimesh.load(path, force="mesh")
        # STL holds single precision
        assert abs(surface.volume) == pytest.approx(1e9 * found.measure, rel=1e-5)
    with xr.open_dataset(written[0], engine="h5netcdf") as dataset:
        assert dataset.attrs["measure"] == found.measure
        assert int((dataset["component"] > 0).sum()) == found.grid.good.sum()
    rows = written[2].read_text(encoding="utf-8").splitlines()
    assert len(rows) == 1 + len(found.border.points)


def test_a_motion_follows_from_home() -> None:
    # the follower's margins are those of the motion where the straight way is free
    model = arm()
    points = np.array([[1.1, 0.5], [0.9, 0.8], [1.2, 0.9], [1.5, 0.9]])
    margin = MachineMargin(model, ("x", "y"), np.array([0.4, 0.4]))
    straight = Motion(model.structure.linkage, model.placement).move(
        task={"x": points[:, 0], "y": points[:, 1]}
    )
    np.testing.assert_array_equal(margin(points).good, straight.reached)
