"""Dynamics of a three-legged machine by its legs' own formulas, beside the constraint rows.

Azulay et al. 2014, section 2.2, corrected: the matrix from the platform's twist to a chain's
rates is 3 x 6, and the bias in the drives' space takes the drives' rates.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.kinematics import Poses, cross_matrix, jacobians
from strutwork.kinematics.coordinates import Coordinates, completed
from strutwork.kinematics.drive_forces import inverse_dynamics
from strutwork.kinematics.dynamics import Dynamics
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.turns import rotation_vector, vector_rates, velocity_rates
from strutwork.machines import (
    Alizade3PRPS,
    Eclipse3PPRS,
    Glozman3PRRS,
    HexelHexapod,
    Proposed3PPRS,
)
from tests.dynamics import Case, masses_of

Array = NDArray[Any]

G = 9.81
M_CARRIAGE, M_SLIDER, M_LINK, M_PLATFORM = 1.3, 0.4, 0.9, 2.2
I_PLATFORM = np.array([[0.012, 0.001, 0.0], [0.001, 0.014, -0.002], [0.0, -0.002, 0.02]])
MACHINE = Proposed3PPRS()


def dynamics() -> Dynamics:
    """Carriages at the guide, sliders at their ends and slender links; the platform at its TCP."""
    home = MACHINE.home()
    placement = MACHINE.place(home)
    motion = Motion(MACHINE.linkage, placement, home.rotation)
    coordinates, _ = completed(motion, Coordinates())
    places = dict(zip(MACHINE.linkage.nodes, placement.positions, strict=True))
    parts: dict[str, Any] = {"platform": (M_PLATFORM, home.position, I_PLATFORM)}
    for leg in ("leg1", "leg2", "leg3"):
        slider, end = places[f"{leg}/slider"], places[f"{leg}/root"]
        seat = MACHINE.linkage.joints[MACHINE.linkage.joint_index[f"{leg}/ball"]].between[1]
        along = places[seat] - end
        length = np.linalg.norm(along)
        along = along / length
        outward = slider * [1, 1, 0] / np.linalg.norm(slider[:2])
        parts[f"{leg}/first link"] = (M_CARRIAGE, MACHINE.base_radius * outward, 0.0)
        parts[f"{leg}/slider"] = (M_SLIDER, slider, 0.0)
        parts[f"{leg}/link"] = (
            M_LINK,
            end + along * length / 2,
            M_LINK * length**2 / 12 * (np.eye(3) - np.outer(along, along)),
        )
    masses = masses_of(MACHINE.linkage, **parts)
    return Dynamics(motion, masses, coordinates, (0.0, 0.0, -G))


@dataclass(frozen=True)
class Chain:
    """One chain at a pose: q = (θ, d, φ), W, and the chain's own equation of motion."""

    w: Array
    w_rate: Array
    mass: Array
    bias: Array
    weight: Array


def chain(seat: Array, velocity: Array) -> tuple[Chain, Array]:
    """The chain whose platform joint is at `seat` and moves, and its rates."""
    length, r_b = MACHINE.link_length, MACHINE.base_radius
    turn = np.arctan2(seat[1], seat[0])
    phi = np.arcsin(seat[2] / length)
    s, c = np.sin(phi), np.cos(phi)
    d = np.hypot(seat[0], seat[1]) + length * c
    e, t, k = np.array([np.cos(turn), np.sin(turn), 0]), None, np.array([0, 0, 1.0])
    t = np.array([-e[1], e[0], 0.0])
    w = np.stack([(d - length * c) * t, e, length * (s * e + c * k)], axis=1)
    rates = np.linalg.solve(w, velocity)
    turning, sliding, rising = rates
    w_rate = np.stack(
        [
            (sliding + length * s * rising) * t - (d - length * c) * turning * e,
            turning * t,
            length * (c * rising * e + s * turning * t - s * rising * k),
        ],
        axis=1,
    )
    m11 = M_CARRIAGE * r_b**2 + M_SLIDER * d**2
    m11 += M_LINK * (d**2 - d * length * c + length**2 * c**2 / 3)
    m23 = M_LINK * length * s / 2
    mass = np.array([[m11, 0, 0], [0, M_SLIDER + M_LINK, m23], [0, m23, M_LINK * length**2 / 3]])
    by_d = 2 * M_SLIDER * d + M_LINK * (2 * d - length * c)
    by_phi = M_LINK * (d * length * s - 2 / 3 * length**2 * c * s)
    bias = np.array(
        [
            (by_d * sliding + by_phi * rising) * turning,
            M_LINK * length * c / 2 * rising**2 - by_d * turning**2 / 2,
            -by_phi * turning**2 / 2,
        ]
    )
    weight = np.array([0, 0, M_LINK * G * length * c / 2])
    return Chain(w, w_rate, mass, bias, weight), rates


@pytest.mark.parametrize("seed", range(5))
def test_leg_by_leg_as_by_rows(seed: int) -> None:
    random = np.random.default_rng(seed)
    found = dynamics()
    turn = random.uniform(-0.15, 0.15, 3)
    values = np.array([0, 0, MACHINE.pole_height, *turn])
    values[:3] += random.uniform(-3e-3, 3e-3, 3)
    rates = random.uniform(-1, 1, 6) * [0.1, 0.1, 0.1, 1, 1, 1]
    changes = random.uniform(-1, 1, 6) * [2, 2, 2, 20, 20, 20]
    case = Case(found, values, rates, changes)
    at = case.at(values)
    rotation = at.placed.rotation[0, MACHINE.linkage.tool_body]
    np.testing.assert_allclose(rotation_vector(rotation), turn, atol=1e-10)
    back = np.linalg.inv(vector_rates(turn))
    twist = np.concatenate([rates[:3], back @ rates[3:]])
    spin = twist[3:]
    change = np.concatenate(
        [changes[:3], back @ changes[3:] + velocity_rates(turn, rates[3:]) @ rates[3:]]
    )
    # the platform
    inertia = rotation @ I_PLATFORM @ rotation.T
    mass = np.zeros((6, 6))
    mass[:3, :3], mass[3:, 3:] = M_PLATFORM * np.eye(3), inertia
    bias = np.concatenate([np.zeros(3), np.cross(spin, inertia @ spin)])
    weight = np.array([0, 0, M_PLATFORM * G, 0, 0, 0])
    driven = []
    for leg in ("leg1", "leg2", "leg3"):
        seat = MACHINE.linkage.joints[MACHINE.linkage.joint_index[f"{leg}/ball"]].between[1]
        place = at.placed.placement.positions[0, MACHINE.linkage.node_index[seat]]
        arm = place - values[:3]
        u = np.hstack([np.eye(3), -cross_matrix(arm)])
        u_rate = np.hstack([np.zeros((3, 3)), -cross_matrix(np.cross(spin, arm))])
        part, _ = chain(place, u @ twist)
        z = np.linalg.solve(part.w, u)
        z_rate = np.linalg.solve(part.w, u_rate - part.w_rate @ z)
        mass = mass + z.T @ part.mass @ z
        bias = bias + z.T @ (part.mass @ z_rate @ twist + part.bias)
        weight = weight + z.T @ part.weight
        driven.append(z[:2])
    forces = np.linalg.solve(np.concatenate(driven).T, mass @ change + bias + weight)
    rows = inverse_dynamics(at, rates, changes)
    # two solutions in double precision of poses that are closed to 1e-11
    largest = np.abs(forces).max()
    np.testing.assert_allclose(rows.drives[0], forces, rtol=0, atol=1e-9 * largest)
    carry = np.zeros((6, 6))
    carry[:3, :3], carry[3:, 3:] = np.eye(3), back
    whole = carry.T @ mass @ carry
    np.testing.assert_allclose(at.mass[0], whole, rtol=0, atol=1e-9 * np.abs(whole).max())


@pytest.mark.parametrize(
    "machine",
    [Alizade3PRPS(), Eclipse3PPRS(), Glozman3PRRS(), HexelHexapod(), Proposed3PPRS()],
    ids=lambda m: type(m).__name__,
)
def test_accelerations_of_drives_as_by_a_complex_step(machine: Any) -> None:
    """q̈ = J⁻¹ V̇ + d(J⁻¹)/dt V, its derivative through the closed form (Squire and Trapp 1998)."""
    random = np.random.default_rng(7)
    home = machine.home()
    motion = Motion(machine.linkage, machine.place(home), home.rotation)
    coordinates, _ = completed(motion, Coordinates())
    count = len(machine.linkage.body_names)
    masses = masses_of(machine.linkage, platform=(1.0, home.position, 1.0))
    assert len(masses.mass) == count
    found = Dynamics(motion, masses, coordinates, (0.0, 0.0, 0.0))
    # the rotation vector's rates are ω only where it is zero: only places differ from home
    values = np.concatenate([home.position, np.zeros(3)])
    values[:3] += random.uniform(-2e-3, 2e-3, 3)
    rates = random.uniform(-1, 1, 6) * [0.1, 0.1, 0.1, 1, 1, 1]
    changes = random.uniform(-1, 1, 6)
    case = Case(found, values, rates, changes)
    forces = inverse_dynamics(case.at(values), rates, changes)
    h = 1e-20
    step = Poses(
        values[:3] + 1j * h * rates[:3],
        (np.eye(3) + 1j * h * cross_matrix(rates[3:])) @ home.rotation,
    )
    placed = machine.place(step)
    inverse = jacobians(machine.linkage, placed, "rows").inverse
    wanted = inverse.real @ changes + inverse.imag / h @ rates
    size = np.abs(wanted).max()
    np.testing.assert_allclose(forces.accelerations_of_drives[0], wanted, rtol=0, atol=1e-9 * size)
    np.testing.assert_allclose(
        forces.rates_of_drives[0], inverse.real @ rates, rtol=0, atol=1e-9 * np.abs(rates).max()
    )
