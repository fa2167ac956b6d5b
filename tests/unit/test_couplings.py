"""Couplings: one joint coordinate follows another, in every place where rows go."""

from __future__ import annotations

from math import pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea import modes
from strutwork.kinematics import Body, Joint, Linkage, Placement, jacobians, mobility
from strutwork.kinematics.coordinates import Coordinates
from strutwork.kinematics.coupling import Coupling
from strutwork.kinematics.dynamics import Dynamics
from strutwork.kinematics.error_transmission import error_transmission
from strutwork.kinematics.motion import Motion
from strutwork.machines.model import Model
from strutwork.machines.model_file import parse_model, read_model
from strutwork.msa import solve, tool_compliance
from strutwork.msa.body_mass import body_masses

EXAMPLE = Path(__file__).parents[2] / "examples" / "10_screws_and_belt.toml"
PITCH, BELT = 0.005, 0.5
#: Way of the table per radian of the motor; the nuts do not turn, and the screws' threads are
#: right-handed.
LEAD = -BELT * PITCH / (2 * pi)


def train(ratios: tuple[float, ...], **joint: Any) -> Motion:
    """Shafts side by side on the ground, each geared to the one before; the first is driven."""
    count = len(ratios) + 1
    nodes = tuple(n for k in range(count) for n in (f"g{k}", f"s{k}"))
    joints = tuple(
        Joint(f"j{k}", "revolute", (f"g{k}", f"s{k}"), driven=("rz",) if k == 0 else (), **joint)
        for k in range(count)
    )
    couplings = tuple(
        Coupling(f"gear {k}", (f"j{k}", "rz"), (f"j{k + 1}", "rz"), ratio)
        for k, ratio in enumerate(ratios)
    )
    linkage = Linkage(nodes, (Body("ground", nodes[::2]),), joints, f"s{count - 1}", couplings)
    positions = np.repeat([[0.1 * k, 0, 0] for k in range(count)], 2, axis=0)
    return Motion(linkage, Placement(positions, np.tile(np.eye(3), (count, 1, 1)), np.zeros(0)))


@pytest.mark.parametrize("ratios", [(-2.0,), (-0.5, -3.0), (0.25, -4.0, 1.7)])
def test_a_train_of_gears_has_one_freedom_and_turns_by_the_product(
    ratios: tuple[float, ...],
) -> None:
    motion = train(ratios)
    found = mobility(motion.linkage, motion.home)
    assert (found.mobility, found.mobility_locked, found.redundant) == (1, 0, 0)
    turns = np.array([0.1, -3.3, 40.0])
    moved = motion.move(joints={("j0", "rz"): 2 * pi * turns})
    assert moved.reached.all()
    last = moved.coordinate(f"j{len(ratios)}", "rz")
    np.testing.assert_allclose(last, 2 * pi * turns * np.prod(ratios), atol=1e-9)


def test_the_shaft_at_the_end_may_be_given_and_the_first_follows() -> None:
    motion = train((-0.5, -3.0))
    moved = motion.move(joints={("j2", "rz"): [7.5]})
    np.testing.assert_allclose(moved.coordinate("j0", "rz"), 7.5 / 1.5, atol=1e-10)


def test_it_does_not_matter_which_is_named_first() -> None:
    motion = train((-2.0,))
    linkage = Linkage(
        motion.linkage.nodes,
        motion.linkage.bodies,
        motion.linkage.joints,
        motion.linkage.tool,
        (Coupling("gear", ("j1", "rz"), ("j0", "rz"), -0.5),),
    )
    placement = motion.home
    forward = jacobians(motion.linkage, placement).inverse
    backward = jacobians(linkage, placement).inverse
    np.testing.assert_allclose(backward, forward, atol=1e-12)
    moved = Motion(linkage, placement).move(joints={("j0", "rz"): [3.0]})
    np.testing.assert_allclose(moved.coordinate("j1", "rz"), -6.0, atol=1e-10)


def test_the_table_goes_far_by_many_turns_and_comes_back() -> None:
    motion = read_model(EXAMPLE).motion
    # 80 turns of the motor, more than any count of turns seen at one step
    way = np.array([0.2, -0.199, 1e-5])
    moved = motion.move(task={"z": 0.35 + way})
    assert moved.reached.all()
    np.testing.assert_allclose(moved.coordinate("motor", "rz"), way / LEAD, rtol=1e-9)
    np.testing.assert_allclose(moved.coordinate("left bearing", "rz"), BELT * way / LEAD, rtol=1e-9)
    np.testing.assert_allclose(moved.coordinate("guide", "z"), way, atol=1e-12)
    back = motion.move(joints={("motor", "rz"): moved.coordinate("motor", "rz")})
    assert back.tool is not None
    np.testing.assert_allclose(back.tool.position[:, 2] - 0.35, way, atol=1e-11)


def stiff_but_for_the_motor() -> Model:
    text = EXAMPLE.read_text(encoding="utf-8")
    lines = [line for line in text.splitlines() if not line.startswith("stiffness = { x")]
    text = "\n".join(lines)
    start, end = text.index("[[beams]]"), text.index("[[bodies]]")
    screws = "".join(
        f'[[bodies]]\nname = "{side} screw"\nnodes = ["{side} foot", "{side} at"]\n\n'
        for side in ("left", "right")
    )
    return parse_model(text[:start] + screws + text[end:])


@pytest.mark.parametrize("method", ["saddle_point", "null_space", None])
def test_a_soft_motor_is_soft_along_the_screws(method: Any) -> None:
    """k_z = k_motor / (way per radian)²; belts and threads are rigid."""
    model = stiff_but_for_the_motor()
    compliance = tool_compliance(model.placed, method)
    assert compliance[2, 2] == pytest.approx(LEAD**2 / 150.0, rel=1e-9)


def test_motor_and_table_vibrate_together() -> None:
    wanted = np.sqrt(150.0 / (0.0003 + 40.0 * LEAD**2)) / (2 * pi)
    found = modes(stiff_but_for_the_motor().placed, 1).frequencies[0]
    assert found == pytest.approx(wanted, rel=1e-9)


def test_the_motor_feels_the_table_by_its_lead() -> None:
    model = stiff_but_for_the_motor()
    masses = body_masses(model.structure.at(model.placement))
    dynamics = Dynamics(model.motion, masses, Coordinates((), (("motor", "rz"),)))
    at = dynamics.at(model.motion.move(joints={("motor", "rz"): np.array([0.0, 11.0])}))
    np.testing.assert_allclose(at.mass[:, 0, 0], 0.0003 + 40.0 * LEAD**2, rtol=1e-9)


def test_the_motor_holds_what_pushes_the_table() -> None:
    model = stiff_but_for_the_motor()
    torque = np.asarray(solve(model.placed, model.cases).joint_force("motor", "push"))[5]
    # virtual work: torque × turn = push × way
    assert float(torque) == pytest.approx(1000.0 * LEAD, rel=1e-9)


def test_an_error_of_the_gears_turns_what_follows() -> None:
    motion = train((-0.5, -3.0))
    found = error_transmission(motion.linkage, motion.home, [("j1", "rz"), ("j2", "rz")])
    np.testing.assert_allclose(np.asarray(found.matrix)[5], [-3.0, 1.0], atol=1e-12)


def test_many_geared_shafts_are_counted_block_by_block() -> None:
    motion = train((-1.0,) * 45)
    found = mobility(motion.linkage, motion.home)
    assert (found.mobility, found.mobility_locked, found.redundant) == (1, 0, 0)


GEAR = '[[couplings]]\nname = "gear"\n'


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ('between = ["motor:rz", "guide:z"]\nratio = 2', "a rotation and a translation"),
        (
            'between = ["guide:z", "motor:rz"]\nper_turn = "5 mm"',
            "first a rotation and then a translation",
        ),
        ('between = ["motor:rz", "guide:z"]', "neither ratio nor per_turn"),
        ('between = ["motor:rz", "guide:z"]\nratio = 1\nper_turn = 1', "or both"),
        ('between = ["motor", "guide:z"]\nratio = 1', 'names "motor", which is not a joint'),
        ('between = ["motor:rz", "gide:z"]\nper_turn = 1', 'unknown joint "gide"'),
        ('between = ["motor:rz", "guide:x"]\nper_turn = 1', "guide:x, which is sprung"),
        ('between = ["motor:rz", "motor:rz"]\nratio = 1', "with itself"),
        ('between = ["motor:rz", "left bearing:rz"]\nratio = 1', "follow others already"),
        ('between = ["motor:rz", "left thread:rz"]\nratio = 0', "has the ratio 0.0"),
    ],
)
def test_bad_couplings_are_named(table: str, words: str) -> None:
    text = EXAMPLE.read_text(encoding="utf-8")
    with pytest.raises(ModelError, match=words):
        parse_model(f"{text}\n{GEAR}{table}\n")


def test_two_drives_cannot_be_coupled() -> None:
    joints = tuple(
        Joint(name, "revolute", ("a", node), driven=("rz",))
        for name, node in (("j", "b"), ("k", "c"))
    )
    gear = Coupling("gear", ("j", "rz"), ("k", "rz"), 1.0)
    with pytest.raises(ModelError, match="both are driven"):
        Linkage(("a", "b", "c"), (Body("ground", ("a",)),), joints, "b", (gear,))
