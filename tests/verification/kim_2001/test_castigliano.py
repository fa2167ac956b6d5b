"""Structural compliance by Castigliano's theorem, an independent check of the frame solution.

@article{kim2001,
  author  = {Kim, Jongwon and Park, Frank C. and Ryu, Sun Joong and others},
  title   = {Design and Analysis of a Redundantly Actuated Parallel Mechanism for Rapid Machining},
  journal = {IEEE Transactions on Robotics and Automation},
  volume  = {17},
  number  = {4},
  year    = {2001}
}

Section V: with six drives the forces at the balls follow from statics alone, and the energy of
the rods under them gives the compliance. Derived again here, since the scan lost its signs.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.kinematics import Poses, cross_matrix, jacobians, tangent_rotation
from strutwork.machines import EclipseMachine, EclipsePrototype
from strutwork.msa.tool import tool_compliance

Array = NDArray[Any]

MACHINES = [EclipsePrototype(), EclipseMachine()]
every_machine = pytest.mark.parametrize("machine", MACHINES, ids=lambda m: type(m).__name__)


def rod_compliance(length: float, radius: float, young: float, shear: float) -> Array:
    """Compliance (6, 6) at the free end of a round rod along x, moment before force."""
    bend = young * np.pi * radius**4 / 4.0
    w = np.linalg.inv(np.diag([shear * np.pi * radius**4 / 2.0, bend, bend]))
    # moment at s from the loaded end: m - s x × f
    x = cross_matrix([1.0, 0.0, 0.0])
    found = np.zeros((6, 6))
    found[:3, :3] = length * w
    found[:3, 3:] = -(length**2) / 2.0 * w @ x
    found[3:, :3] = found[:3, 3:].T
    found[3:, 3:] = length**3 / 3.0 * x.T @ w @ x
    found[3, 3] += length / (young * np.pi * radius**2)
    return found


def rod_axes(axis: Array) -> Array:
    """Rows: the rod's axis and two normals."""
    first = axis / np.linalg.norm(axis)
    helper = np.eye(3)[np.argmin(np.abs(first))]
    second = np.cross(first, helper)
    second /= np.linalg.norm(second)
    return np.stack([first, second, np.cross(first, second)])


def castigliano(machine: EclipsePrototype, poses: Poses) -> tuple[Array, Array]:
    """Compliance (6, 6), translation first, and the matrix D of a single pose."""
    young, shear = 210e9, 210e9 / 2.6
    points = poses.position + machine.seats @ poses.rotation.T
    columns, blocks = [], np.zeros((6, 6))
    for i, point in enumerate(points):
        radius = np.hypot(point[0], point[1])
        outward = np.array([point[0], point[1], 0.0]) / radius
        tangent = np.cross([0.0, 0.0, 1.0], outward)
        inward = machine.base_radius - radius
        rise = np.sqrt(machine.link_length**2 - inward**2) * (1.0 if machine.below[i] else -1.0)
        hinge = machine.base_radius * outward + [0.0, 0.0, point[2] - rise]
        foot = machine.base_radius * outward
        along = (point - hinge) / machine.link_length
        energy = np.zeros((2, 2))
        for end, start, size in (
            (point, hinge, machine.link_radius),
            (hinge, foot, machine.column_radius),
        ):
            # the rod's axis runs from its loaded end to its held one
            turn = rod_axes(start - end)
            loads = [
                np.concatenate([turn @ np.cross(point - end, f), turn @ f])
                for f in (along, tangent)
            ]
            h = np.stack(loads, axis=-1)
            energy += (
                h.T @ rod_compliance(float(np.linalg.norm(start - end)), size, young, shear) @ h
            )
        blocks[2 * i : 2 * i + 2, 2 * i : 2 * i + 2] = energy
        arm = point - poses.position
        columns += [np.concatenate([np.cross(arm, f), f]) for f in (along, tangent)]
    d = np.stack(columns, axis=-1)
    inverse = np.linalg.inv(d)
    order = [3, 4, 5, 0, 1, 2]
    return (inverse.T @ blocks @ inverse)[np.ix_(order, order)], d


def some_poses(machine: EclipsePrototype, count: int = 60) -> list[Poses]:
    rng = np.random.default_rng(11)
    shift = rng.uniform(-0.15, 0.15, (count, 3)) * machine.base_radius
    tilt, azimuth, roll = rng.uniform(
        [[0.0], [-np.pi], [-0.5]], [[1.4], [np.pi], [0.5]], (3, count)
    )
    normal = np.stack(
        [np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)], axis=-1
    )
    poses = Poses.of(machine.home().position + shift, tangent_rotation(normal, roll))
    kept = machine.place(poses).reachable
    return [Poses(p, r) for p, r in zip(poses.position[kept], poses.rotation[kept], strict=True)]


@every_machine
def test_the_frame_solution_is_castiglianos(machine: EclipsePrototype) -> None:
    """Both are exact for beams without shear: 1e-9 is rounding away from singular poses."""
    checked = 0
    for poses in some_poses(machine):
        wanted, d = castigliano(machine, poses)
        scale = np.diag([1.0 / machine.platform_radius] * 3 + [1.0] * 3)
        if np.linalg.cond(scale @ d) > 100.0:
            continue
        placement = machine.place(poses)
        tops = placement.values[
            [list(placement.names).index((f"leg{i}/slide", "z")) for i in (1, 2, 3)]
        ]
        if np.abs(tops).min() < machine.shortest_column:
            continue
        found = tool_compliance(machine.structure.at(placement))
        unit = np.diag([1.0] * 3 + [machine.platform_radius] * 3)
        wanted, found = unit @ wanted @ unit, unit @ found @ unit
        assert np.abs(found - wanted).max() < 1e-9 * np.abs(wanted).max()
        checked += 1
    assert checked > 20


@every_machine
def test_the_determinant_of_the_statics(machine: EclipsePrototype) -> None:
    """det D = ±(√3 R_p)³ s, and det J⁻¹ is that over ∏ρ sin φ, to rounding: 1e-12."""
    signs: set[tuple[float, float]] = set()
    for poses in some_poses(machine):
        _, d = castigliano(machine, poses)
        points = poses.position + machine.seats @ poses.rotation.T
        radius = np.hypot(points[:, 0], points[:, 1])
        outward = np.stack([points[:, 0] / radius, points[:, 1] / radius, 0.0 * radius], axis=-1)
        placement = machine.place(poses)
        names = list(placement.names)
        phi = placement.values[[names.index((f"leg{i}/hinge", "rz")) for i in (1, 2, 3)]]
        tau = np.sin(phi)[:, None] * outward + np.cos(phi)[:, None] * [0.0, 0.0, 1.0]
        side = np.sqrt(3.0) * machine.platform_radius
        e = [(points[i] - points[j]) / side for i, j in ((0, 1), (1, 2), (2, 0))]
        s = (e[0] @ tau[0]) * (e[1] @ tau[1]) * (e[2] @ tau[2]) - (
            (e[0] @ tau[1]) * (e[1] @ tau[2]) * (e[2] @ tau[0])
        )
        statics = np.linalg.det(d) / (side**3 * s)
        wanted = side**3 * s / np.prod(radius * np.sin(phi))
        motion = float(jacobians(machine.linkage, placement).determinant()) / wanted
        # near s = 0 the digits are those of s, a difference of products of size one
        tolerance = 1e-12 / abs(s)
        assert abs(abs(statics) - 1.0) < tolerance
        assert abs(abs(motion) - 1.0) < tolerance
        signs.add((float(np.sign(statics)), float(np.sign(motion))))
    assert len(signs) == 1
