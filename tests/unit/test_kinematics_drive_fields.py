"""Gradients and second derivatives of drives over a surface."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.kinematics.drive_fields import MotionField
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.reversal_points import hessians
from strutwork.kinematics.reversals import reversals
from strutwork.kinematics.task_surfaces import Dome, Plane, paraboloid, sphere
from strutwork.kinematics.turns import rotation_matrix
from strutwork.machines import HexelHexapod
from strutwork.machines.load import load

Array = NDArray[Any]


def hexapod(surface: Any) -> MotionField:
    machine = HexelHexapod()
    home = machine.home()
    motion = Motion(machine.linkage, machine.place(home), home.rotation)
    return MotionField(motion, surface, machine.place)


@pytest.mark.parametrize(
    ("target", "surface", "spread"),
    [
        ("examples/machines/6-ups.toml", Dome(paraboloid(0.4, [0, 0, 0.0]), "normal"), 0.05),
        ("examples/machines/linear-delta.toml", Dome(sphere(0.5, [0, 0, 0.02])), 0.05),
        # its tool moves aside as it tilts
        ("examples/machines/3-rps.toml", Plane(("rx", "ry")), 0.1),
    ],
)
def test_gradients_are_the_differences_of_the_motion(
    target: str, surface: Any, spread: float
) -> None:
    model = load(target)
    field = MotionField(model.motion, surface)
    if isinstance(surface, Dome):
        # the surface is shifted to where the tool stands at home
        top = model.motion.home_pose.position
        field = MotionField(
            model.motion,
            Dome(shifted(surface.height, top), surface.orientation),
        )
    points = spread * np.random.default_rng(2).uniform(-1, 1, (5, 2))
    names = model.structure.linkage.driven

    def drives(some: Array) -> Array:
        placement = field.placements(some)[0].require_reachable()
        return placement.values[..., [placement.names.index(n) for n in names]]

    h = 1e-4
    for k in (0, 1):
        step = h * np.eye(2)[k]
        rate = (
            8 * (drives(points + step) - drives(points - step))
            - (drives(points + 2 * step) - drives(points - 2 * step))
        ) / (12 * h)
        # joints close to 1e-11, parted by 1e-4
        assert field.gradient(points)[..., k] == pytest.approx(rate, abs=1e-6)


def shifted(height: Any, top: Array) -> Any:
    def moved(points: Array) -> Any:
        z, slope, bend = height(points - top[:2])
        return z + top[2], slope, bend

    return moved


def test_normal_orientation_turns_the_tool_into_the_normal() -> None:
    field = hexapod(Dome(sphere(0.3, [0.0, 0.0, 0.4]), "normal"))
    points = np.array([[0.0, 0.0], [0.05, -0.08], [1e-4, 0.0]])
    _, turn, _ = field.placements(points)
    outward = np.concatenate([points, np.sqrt(0.09 - (points**2).sum(1))[:, None]], axis=1) / 0.3
    assert rotation_matrix(turn)[..., 2] == pytest.approx(outward, abs=1e-12)


def test_second_derivatives_on_a_dome_are_differences_of_drives() -> None:
    field = hexapod(Dome(paraboloid(0.3, [0.0, 0.0, 0.4]), "normal"))
    grid = np.linspace(-0.05, 0.05, 5)
    found = reversals(field, grid, grid)
    p, h = np.array([0.02, -0.01]), 2e-3
    names = field.motion.linkage.driven

    def drive(x: float, y: float) -> float:
        placement = field.placements(p[None] + [x, y])[0]
        return float(placement.values[0, placement.names.index(names[0])])

    bend = hessians(field, found.patch, p[None], np.array([0]))[0]
    mixed = (drive(h, h) - drive(h, -h) - drive(-h, h) + drive(-h, -h)) / (4 * h * h)
    # second differences: h² of the fourth derivatives, some 10 /m³
    assert bend[0, 1] == pytest.approx(mixed, abs=1e-3)
    assert bend[0, 0] == pytest.approx((drive(h, 0) - 2 * drive(0, 0) + drive(-h, 0)) / h**2, 1e-3)
