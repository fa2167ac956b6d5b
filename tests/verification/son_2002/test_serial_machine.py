"""The serial five-axis machines A-C and A-B: axes of the tool, singularities, reversals.

@phdthesis{son2002,
  author = {Son, Seung-Kil},
  title  = {A Hybrid Type Small 5-Axis {CNC} Milling Machine},
  school = {Massachusetts Institute of Technology},
  year   = {2002}
}

The thesis prints formulas of the tool's axis and no dimension of such a machine. Its formulas are
asserted to 1e-12, some thousand roundings of a unit vector; the closed form beside the joints
alone to 1e-9 m and rad, to which these are closed.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.errors import ModelError
from strutwork.kinematics import Poses, jacobians
from strutwork.kinematics.singular_distance import singularity_distance
from strutwork.kinematics.tool_drive_space import tool_drive_space
from strutwork.machines import SerialFiveAxis, variants
from strutwork.machines.load import load
from strutwork.machines.serial_five_axis import Axes
from strutwork.msa import tool_compliance
from strutwork.msa.materials import Material
from strutwork.papers.son_2002.serial import (
    at_turns,
    axis_rates,
    axis_speeds,
    flat_reversals,
)

Array = NDArray[Any]

BOTH = ("ac", "ab")

both = pytest.mark.parametrize("axes", BOTH)

#: Turns of the second axis away from the singular ones and within its range, rad.
CLEAR = {"ac": (0.05, 1.7), "ab": (-1.4, 1.4)}


def formula(axes: str, first: Array, second: Array) -> Array:
    """Axis of the tool, as section 2.1.2 has it and as eq. 10 integrates to."""
    sin, cos = np.sin, np.cos
    if axes == "ac":
        c, a = first, second
        return np.stack([sin(a) * sin(c), -sin(a) * cos(c), cos(a)], axis=-1)
    a, b = first, second
    return np.stack([sin(b), -sin(a) * cos(b), cos(a) * cos(b)], axis=-1)


def turns(axes: str, count: int = 200, seed: int = 3) -> tuple[Array, Array]:
    draw = np.random.default_rng(seed)
    reach = np.pi if axes == "ac" else np.radians(100.0)
    return draw.uniform(-reach, reach, count), draw.uniform(*CLEAR[axes], count)


@both
def test_axis_of_the_tool(axes: Axes) -> None:
    """The joints' axes, turned one about the other by their coordinates, make the formula."""
    first, second = turns(axes)
    machine = SerialFiveAxis(axes=axes)
    placement = machine.place(at_turns(machine, first, second))
    # branch and all: a ≥ 0, |b| ≤ 90°
    assert placement.values[:, 3] == pytest.approx(first, abs=1e-12)
    assert placement.values[:, 4] == pytest.approx(second, abs=1e-12)
    order = {"ac": "ZX", "ab": "XY"}[axes]
    made = Rotation.from_euler(order, placement.values[:, 3:5]).apply([0.0, 0.0, 1.0])
    wanted = formula(axes, first, second)
    np.testing.assert_allclose(made, wanted, atol=1e-12)
    spindle = machine.linkage.joint_index["spindle"]
    np.testing.assert_allclose(placement.frames[:, spindle, :, 2], wanted, atol=1e-12)
    at = machine.linkage.node_index
    rod = placement.positions[:, at["spindle/pivot"]] - placement.positions[:, at["tool"]]
    np.testing.assert_allclose(rod, machine.tool_length * wanted, atol=1e-12)


@pytest.mark.parametrize("axes", BOTH)
@settings(max_examples=10, deadline=None)
@given(seed=st.integers(0, 2**32 - 1))
def test_joints_alone_place_it_as_the_closed_form_does(axes: Axes, seed: int) -> None:
    """All nodes, frames and coordinates, so that it is the same branch."""
    model = load(f"serial-five-axis:{axes}")
    assert model.closed_form is not None
    draw = np.random.default_rng(seed)
    tip = draw.uniform(-0.15, 0.15, (20, 3))
    # 30° at home leave 15° to the upright tool
    lean = Rotation.from_rotvec(draw.uniform(-1.0, 1.0, (20, 3)) * [0.26, 0.5, 1.0])
    poses = Poses(tip, lean.as_matrix() @ model.rotation)
    own, moved = model.closed_form(poses), model.motion.move(tool=poses)
    assert own.reachable.all()
    assert moved.reached.all()
    np.testing.assert_allclose(moved.placement.positions, own.positions, atol=1e-9)
    np.testing.assert_allclose(moved.placement.frames, own.frames, atol=1e-9)
    assert moved.placement.turns is not None
    assert own.turns is not None
    np.testing.assert_allclose(moved.placement.turns, own.turns, atol=1e-9)
    for k, (joint, direction) in enumerate(own.names):
        apart = moved.coordinate(joint, direction) - own.values[:, k]
        # the formulas count no turns
        whole = 2.0 * np.pi * np.round(apart / (2.0 * np.pi)) if direction == "rz" else 0.0
        np.testing.assert_allclose(apart - whole, 0.0, atol=1e-9)


@both
def test_rates_of_the_axis_are_those_of_equations_9_and_10(axes: Axes) -> None:
    """Beside the formulas' derivatives by complex steps: exact to rounding."""
    first, second = turns(axes)
    machine = SerialFiveAxis(axes=axes)
    found = axis_rates(machine, machine.place(at_turns(machine, first, second)))
    step = 1e-150j
    wanted = np.stack(
        [
            formula(axes, first + step, second).imag,
            formula(axes, first, second + step).imag,
        ],
        axis=-1,
    )
    np.testing.assert_allclose(found, wanted / 1e-150, atol=1e-12)
    if axes == "ab":
        # as printed: of the rates of a and b
        sin, cos = np.sin, np.cos
        a, b = first, second
        printed = np.array(
            [
                [0.0 * a, cos(b)],
                [-cos(a) * cos(b), sin(a) * sin(b)],
                [-sin(a) * cos(b), -cos(a) * sin(b)],
            ]
        )
        np.testing.assert_allclose(found, np.moveaxis(printed, -1, 0), atol=1e-12)


@both
def test_speeds_of_the_axis(axes: Axes) -> None:
    """σ = (1, |sin a|) and (1, |cos b|), at the singular turns too."""
    machine = SerialFiveAxis(axes=axes)
    second = np.radians(np.linspace(0.0, 90.0, 91))
    speeds = axis_speeds(machine, machine.place(at_turns(machine, np.array(0.3), second)))
    least = np.sin(second) if axes == "ac" else np.cos(second)
    np.testing.assert_allclose(speeds, np.stack([1.0 + 0.0 * least, least], axis=-1), atol=1e-12)


@pytest.mark.parametrize(("axes", "singular"), [("ac", 0.0), ("ab", 90.0), ("ab", -90.0)])
def test_where_it_is_singular(axes: Axes, singular: float) -> None:
    """A serial singularity at a = 0 and at b = ±90°, found from the joints, and nowhere near."""
    machine = SerialFiveAxis(axes=axes)
    tilt = np.radians(singular + np.array([-10.0, 0.0, 10.0]))
    placement = machine.place(at_turns(machine, np.array(0.2), tilt))
    assert placement.reachable.all()
    found = jacobians(machine.linkage, placement)
    assert found.serial.tolist() == [False, True, False]
    assert not found.parallel.any()
    home = machine.place(machine.home())
    known = tool_drive_space(machine.linkage, home).known
    distance = singularity_distance(machine.linkage, placement, None, known)
    assert distance.serial[1] < 1e-12
    assert distance.serial[[0, 2]].min() > 0.01
    # an open chain of drives alone cannot give way: section 2.1.1
    assert distance.parallel.min() > 0.1


@both
def test_a_flat_surface_turns_no_drive_back(axes: Axes) -> None:
    """Fig. 15: none, the tool's direction held; A-C on a surface turned about x (4.4.1)."""
    found = flat_reversals(SerialFiveAxis(axes=axes))
    names = [SerialFiveAxis(axes=axes).linkage.driven[k][0] for k in found.moving]
    assert names == ["slide x", "slide y"]
    assert [(d.points, d.lines, d.winding) for d in found.singular] == [((), (), 0)] * 2
    assert found.plates.max() == 1


@both
def test_the_spindle_takes_the_sixth_direction(axes: Axes) -> None:
    """Tip and axis settle five axes: a turn about the tool's axis is the spindle's alone."""
    machine = SerialFiveAxis(axes=axes)
    first, second = turns(axes, 20)
    poses = at_turns(machine, first, second)
    spin = np.linspace(-3.0, 3.0, 20)
    about = Rotation.from_rotvec(spin[:, None] * [0.0, 0.0, 1.0]).as_matrix()
    turned = machine.place(Poses(poses.position, poses.rotation @ about))
    still = machine.place(poses)
    np.testing.assert_allclose(turned.values[:, :5], still.values[:, :5], atol=1e-12)
    np.testing.assert_allclose(turned.values[:, 5], spin, atol=1e-12)


@both
def test_values_are_analytic_in_the_pose(axes: Axes) -> None:
    """Derivatives by complex steps are the inverse Jacobian's rows from the joints, to 1e-10."""
    machine = SerialFiveAxis(axes=axes)
    poses = at_turns(machine, *turns(axes, 5))
    rows = jacobians(machine.linkage, machine.place(poses)).inverse
    step = 1e-30
    for k in range(6):
        way = np.eye(6)[k]
        omega = np.cross(way[3:], np.eye(3)).T
        moved = Poses(
            poses.position + 1j * step * way[:3],
            poses.rotation + 1j * step * (omega @ poses.rotation),
        )
        found = machine.place(moved).values.imag / step
        np.testing.assert_allclose(found, rows[..., k], atol=1e-10)


@both
def test_stiffness_is_that_of_springs_in_a_row(axes: Axes) -> None:
    """With beams far stiffer than the joints their compliances add up, carried to the tool.

    1e-4 of the largest entry: what beams a million times stiffer than steel leave.
    """
    machine = SerialFiveAxis(axes=axes)
    machine = replace(machine, material=Material.isotropic(200e15, 0.3, 7850.0, name="stiff"))
    placement = machine.place(machine.home())
    tool = placement.positions[machine.linkage.node_index["tool"]]
    wanted = np.zeros((6, 6))
    for joint, frame in zip(machine.linkage.joints, placement.frames, strict=True):
        arm = tool - placement.positions[machine.linkage.node_index[joint.between[0]]]
        for direction, k in joint.stiffness.items():
            axis = frame[:, "xyz".index(direction[-1])]
            turn = direction.startswith("r")
            twist = np.concatenate([np.cross(axis, arm), axis] if turn else [axis, 0.0 * axis])
            wanted += np.outer(twist, twist) / k
    found = tool_compliance(machine.structure.at(placement))
    np.testing.assert_allclose(found, wanted, atol=1e-4 * np.abs(wanted).max())


def test_variants_and_errors() -> None:
    assert list(variants("serial-five-axis")) == ["ac", "ab"]
    for which in BOTH:
        assert variants("serial-five-axis")[which].factory() == SerialFiveAxis(axes=which)
    with pytest.raises(ModelError, match=r'SerialFiveAxis\.axes(.|\n)*"ac" or "ab"'):
        SerialFiveAxis(axes="bc")  # type: ignore[arg-type]
    with pytest.raises(ModelError, match="guide_stiffness"):
        SerialFiveAxis(guide_stiffness=0.0)
    with pytest.raises(ModelError, match=r"cannot stand at home(.|\n)*ram's end"):
        SerialFiveAxis(saddle_depth=0.9)
    low = SerialFiveAxis().place(Poses(np.array([0.0, 0.0, -0.7]), np.eye(3)))
    assert "foot of the column" in low.reason(())
