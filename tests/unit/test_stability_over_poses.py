"""Limiting depths over poses and feed directions, and which part and mode limit them."""

from __future__ import annotations

from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
import pytest

import strutwork
from strutwork.cutting import (
    Frame,
    TipModes,
    absolute_limits,
    depth_effects,
    depth_limits,
    described_milling,
    tip_dynamics,
    turned_matrices,
    zero_order_lobes,
)
from strutwork.errors import ModelError
from strutwork.fea import LossFactor, ModalRatio, PartDamping, Port, Rayleigh, frequency_response
from strutwork.fea.pole_residue import PoleModel
from strutwork.kinematics.tool_turns import ToolTurns
from strutwork.machines.described_process import DescribedProcess
from strutwork.machines.load import load
from strutwork.machines.model import Model
from strutwork.machines.model_poses import at_pose
from strutwork.studies.parametric import Parametric
from strutwork.studies.stability_answer import Stability
from tests.cutting_cases import mill

HEAD = str(Path(__file__).parents[2] / "examples" / "machines" / "3-rps.toml")
BAND = (1.0, 400.0)


@pytest.fixture(scope="module")
def head() -> Model:
    return load(HEAD)


def absolute(model: Model, damping: object, feeds: tuple[float, ...] = (0.0,)):
    (tip,) = tip_dynamics(model.placed, "TCP", damping)  # type: ignore[arg-type]
    assert model.process is not None
    return absolute_limits(tip, described_milling(model.process), Frame(np.eye(3)), BAND, feeds)


def test_the_absolute_limit_is_the_least_of_the_lobes(head: Model) -> None:
    (tip,) = tip_dynamics(head.placed, "TCP", ModalRatio(0.02))
    process = described_milling(head.process)
    dense = zero_order_lobes(tip.response_at(np.linspace(30.0, 40.0, 40001)), process).absolute
    found = absolute(head, ModalRatio(0.02))
    assert found.depth[0] == pytest.approx(dense[0], rel=1e-7)
    assert found.depth[0] <= dense[0]
    assert found.frequencies[0] == pytest.approx(dense[1], abs=3e-4)


def test_a_feed_of_the_rose_is_that_of_a_turned_frame(head: Model) -> None:
    (tip,) = tip_dynamics(head.placed, "TCP", ModalRatio(0.02))
    process = described_milling(head.process)
    rose = absolute(head, ModalRatio(0.02), (0.0, 0.7, 2.0))
    for angle, depth in zip(rose.feeds, rose.depth, strict=True):
        one = absolute_limits(tip, process, Frame.feed(float(angle)), BAND)
        assert one.depth[0] == pytest.approx(depth, rel=1e-12)


def test_an_axial_force_has_three_families(head: Model) -> None:
    """A lead angle below 90° presses along the axis as well: no closed form, the same answer."""
    process = mill(0.5)
    process = replace(process, cutter=replace(process.cutter, lead=radians(45.0)))
    (tip,) = tip_dynamics(head.placed, "TCP", ModalRatio(0.02))
    found = absolute_limits(tip, process, Frame(np.eye(3)), BAND)
    dense = zero_order_lobes(tip.response_at(np.linspace(20.0, 100.0, 20001)), process).absolute
    assert found.depth[0] == pytest.approx(dense[0], rel=1e-4)


@pytest.mark.parametrize(
    "damping", [ModalRatio(0.02), LossFactor(0.03), PartDamping(ModalRatio(0.01))]
)
def test_effects_of_all_parts_add_up_to_one(head: Model, damping: object) -> None:
    """A structure that is twice as stiff takes twice the depth."""
    at = float(absolute(head, damping).frequencies[0])
    matrix = turned_matrices(described_milling(head.process), Frame(np.eye(3)), [0.0])[0]
    found = depth_effects(head.placed, "TCP", damping, matrix, at)  # type: ignore[arg-type]
    assert found.effects.sum() == pytest.approx(1.0, abs=1e-4)
    assert found.shares.sum() == pytest.approx(1.0, abs=1e-6)
    assert found.limiting_mode == pytest.approx(at, rel=0.01)


@pytest.mark.parametrize("damping", [ModalRatio(0.02), LossFactor(0.03), Rayleigh(3.0, 1e-4)])
def test_the_effect_of_a_part_is_that_of_a_stiffer_one(head: Model, damping: object) -> None:
    machine = Parametric.of(HEAD)
    matrix = turned_matrices(described_milling(head.process), Frame(np.eye(3)), [0.0])[0]
    here = absolute(head, damping)
    found = depth_effects(
        head.placed,
        "TCP",
        damping,  # type: ignore[arg-type]
        matrix,
        float(here.frequencies[0]),
    )
    effects = found.to_dict()
    drives = [name for name in machine.paths if name.startswith("joints.drive1.stiffness.")]
    assert drives
    for path in drives:
        value, step = machine.paths[path].value, 1e-3
        ends = [absolute(machine.model({path: value * (1 + s * step)}), damping) for s in (1, -1)]
        change = (ends[0].depth[0] - ends[1].depth[0]) / (2 * step * here.depth[0])
        key = f"drive1:{path.rpartition('.')[2]}"
        known = effects.get(f"drive {key}", effects.get(f"joint {key}"))
        assert known == pytest.approx(change, abs=1e-6)


def dashed(model: Model, damping: float) -> Model:
    """The machine with dashpots beside the springs of its drives."""
    linkage = model.structure.linkage
    joints = tuple(
        replace(j, damping={"z": damping}) if j.name.startswith("drive") else j
        for j in linkage.joints
    )
    structure = replace(model.structure, linkage=replace(linkage, joints=joints))
    return replace(model, structure=structure)


def test_exact_limits_take_dashpots_of_joints(head: Model) -> None:
    """Complex modes have the receptance of the direct solution, and depths near zero order's."""
    model = dashed(head, 2e4)
    damping = PartDamping(ModalRatio(0.02))
    (tip,) = tip_dynamics(model.placed, "TCP", damping)
    modes = tip.modes(200.0)
    lines = np.linspace(20.0, 120.0, 41)
    ports = [Port("TCP", axis) for axis in "xyz"]
    direct = frequency_response(model.placed, ports, ports, lines, damping, "direct").receptance
    kept = modes.receptance(lines).receptance
    assert np.abs(kept - direct).max() < 0.01 * np.abs(direct).max()
    np.testing.assert_allclose(tip.receptance(lines), direct, atol=1e-8 * np.abs(direct).max())
    process = described_milling(head.process)
    speeds = [1000.0, 1500.0]
    exact = depth_limits(modes, process, speeds, 5e-3, 5e-5)
    zero = zero_order_lobes(tip.response_at(tip.lines(BAND, 4)), process).at(speeds)
    np.testing.assert_allclose(exact.depth, zero.depth, rtol=0.05)


def test_a_pole_that_only_falls_is_kept_whole() -> None:
    """A real pole counts once, as half of itself and half of its conjugate."""
    poles = np.array([-5.0 + 300.0j, -5.0 - 300.0j, -80.0])
    left = np.array([[1.0 + 0.1j, 1.0 - 0.1j, 0.5]])
    right = np.array([[1e-6 - 2e-6j, 1e-6 + 2e-6j, 3e-6]])
    model = PoleModel((Port("tip", "x"),), poles, left, right, np.zeros((1, 1)), np.zeros((1, 1)))
    modes = TipModes.from_poles(model, None, 100.0, (0,))
    lines = np.linspace(1.0, 100.0, 20)
    ours = modes.receptance(lines).receptance
    np.testing.assert_allclose(ours[:, 0, 0], model.receptance(lines)[:, 0, 0], rtol=1e-12)
    assert not np.any(ours[:, 1:])


def test_a_spring_without_mass_keeps_its_compliance() -> None:
    """What neither mass nor dashpot delays has no pole, and had been left out."""
    poles = np.array([-5.0 + 300.0j, -5.0 - 300.0j])
    left, right = np.ones((1, 2)), np.array([[-1e-6j, 1e-6j]])
    soft = np.array([[2e-9]])
    model = PoleModel((Port("tip", "x"),), poles, left, right, soft, np.zeros((1, 1)))
    modes = TipModes.from_poles(model, None, 100.0, (0,))
    lines = np.linspace(1e-3, 50.0, 20)
    found, expected = modes.receptance(lines).receptance[:, 0, 0], model.receptance(lines)[:, 0, 0]
    np.testing.assert_allclose(found[0], expected[0], rtol=1e-6)
    # brought from infinity to four times the band
    assert np.abs(found - expected).max() < 0.02 * soft[0, 0]
    assert modes.residual_share == pytest.approx(2e-9 / expected[0].real, rel=1e-3)


def test_poles_of_a_loss_factor_have_no_time_response(head: Model) -> None:
    damping = PartDamping(ModalRatio(0.01), joints={"drive1": 0.1})
    (tip,) = tip_dynamics(head.placed, "TCP", damping)
    with pytest.raises(ModelError, match="no response in time"):
        tip.modes(200.0)


def test_axis_and_feed_turn_with_the_tool(head: Model) -> None:
    """A pose of a survey is the machine moved there, with its own axes turned along."""
    answer = Stability.of(head)
    there = at_pose(head, {"rx": 0.1, "z": 0.63})
    turned = Stability.of(there)
    assert not np.allclose(turned.axes, answer.axes)
    placed = there.structure.at(there.placement.flat())
    ours, outcome = answer(placed)
    assert outcome.solved.all()
    same, _ = turned(placed)
    for name, values in ours.items():
        # of two bands, which hold other lines, depths by speed differ most
        near = 1e-3 if name in ("pocket_depth", "removal_rate") else 1e-6
        np.testing.assert_allclose(values, same[name], rtol=near, err_msg=name)


def test_turns_are_found_from_the_places_of_nodes() -> None:
    model = load("mit-ss1")
    turned = ToolTurns.of(model.structure.linkage, model.placement)
    there = at_pose(model, {"ry": 0.2})
    got = turned.at(there.placement.flat())
    np.testing.assert_allclose(got[0], there.rotation @ model.rotation.T, atol=1e-9)


def test_a_survey_answers_with_depths_and_removal_rates() -> None:
    machine = strutwork.load(HEAD)
    found = machine.survey({"rx": [0.0, 0.1], "z": [0.63]}, Stability.of(machine), workers=1)
    assert found["status"].to_numpy().tolist() == [[0], [0]]
    rose = found["depth_by_feed"].to_numpy()
    assert rose.shape == (2, 1, 36)
    np.testing.assert_array_equal(found["least_depth"].to_numpy(), rose.min(axis=-1))
    assert np.all(found["limiting_depth"].to_numpy() <= found["pocket_depth"].to_numpy() * 1.001)
    speeds = 60.0 * found["pocket_speed"].to_numpy()
    assert np.all((speeds > 499.9) & (speeds < 2500.1))
    # depth by width by feed per tooth by passes
    rate = found["pocket_depth"] * 0.5 * 0.02 * 1e-4 * 4 * found["pocket_speed"]
    np.testing.assert_allclose(found["removal_rate"], rate)


def test_a_study_asks_by_name_and_varies_the_cut() -> None:
    machine = strutwork.load(HEAD)
    found = machine.study(
        {"process.immersion": [0.1, 0.5]}, "stability", workspace={"rx": [0.0]}, workers=1
    )
    depth = found["limiting_depth_worst"].to_numpy().ravel()
    assert depth[0] > 2.0 * depth[1]


def test_what_a_machine_lacks_is_said() -> None:
    model = load(HEAD)
    with pytest.raises(ModelError, match="process: is missing"):
        Stability.of(replace(model, process=None))
    assert isinstance(model.process, DescribedProcess)
    with pytest.raises(ModelError, match="damping: is missing"):
        Stability.of(replace(model, damping=None))
    # a ratio of the process stands where the machine states no damping
    ratio = replace(model.process, modal_ratio=0.02)
    assert Stability.of(replace(model, damping=None, process=ratio)).damping == ModalRatio(0.02)


def test_a_process_without_a_mode_in_the_band_is_refused(head: Model) -> None:
    (tip,) = tip_dynamics(head.placed, "TCP", ModalRatio(0.02))
    process = described_milling(head.process)
    with pytest.raises(ModelError, match=r"meets no mode between 1 and 5 Hz; the nearest is at 35"):
        absolute_limits(tip, process, Frame(np.eye(3)), (1.0, 5.0))
