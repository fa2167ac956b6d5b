"""Singularities of machines whose determinants are known in closed form.

@article{gosselin1990,
  author = {Gosselin, Cl{\\'e}ment and Angeles, Jorge},
  title = {Singularity Analysis of Closed-Loop Kinematic Chains},
  journal = {IEEE Transactions on Robotics and Automation},
  volume = {6}, number = {3}, pages = {281--290}, year = {1990}
}

With the drives held, joint i of a platform on three legs can move along τᵢ = sin φᵢ eᵢ + cos φᵢ k,
φᵢ the link's elevation. Held distances of the joints give a 3 x 3 determinant
s = (e₁₂·τ₁)(e₂₃·τ₂)(e₃₁·τ₃) − (e₁₂·τ₂)(e₂₃·τ₃)(e₃₁·τ₁), and
det J⁻¹ = ± (√3 R_p)³ s / ∏ ρᵢ wᵢ, with wᵢ by the leg's second drive.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from strutwork.kinematics import Placement, Poses, angle, tangent_rotation
from strutwork.kinematics.frames import dot
from strutwork.kinematics.lost_motion import Kind
from strutwork.kinematics.pose_family import PoseFamily
from strutwork.kinematics.singular_distance import singularity_distance
from strutwork.kinematics.singularities import singularities_on_line
from strutwork.kinematics.singularity_curves import singularities_in_plane
from strutwork.kinematics.tool_drive_space import tool_drive_space
from strutwork.machines import (
    Alizade3PRPS,
    Eclipse3PPRS,
    Glozman3PRRS,
    Proposed3PPRS,
    ThreeLegs,
)
from strutwork.machines.legs import LegPlacement, square_root
from strutwork.machines.radial import Radial
from tests.planar_and_delta import biglide

Array = NDArray[np.float64]

MACHINES = [Proposed3PPRS(), Eclipse3PPRS(), Alizade3PRPS(), Glozman3PRRS()]
LENGTH = 0.1


def seats_of(machine: ThreeLegs, poses: Poses) -> tuple[Array, Array, Array]:
    """Joint centres on the platform, their directions from the guide's axis, and radii."""
    seats = machine.seats
    points = poses.position[:, None] + np.einsum("pij,lj->pli", poses.rotation, seats)
    radius = np.hypot(points[..., 0], points[..., 1])
    outward = points * [1.0, 1.0, 0.0] / radius[..., None]
    return points, outward, radius


def closed_form(machine: ThreeLegs, poses: Poses) -> tuple[Array, Array]:
    """s and the determinant of the inverse Jacobian without its sign, (p,) each."""
    points, outward, radius = seats_of(machine, poses)
    placement = machine.place(poses)
    names = list(placement.names)

    def value(joint: str, coordinate: str) -> Array:
        index = [names.index((f"leg{i}/{joint}", coordinate)) for i in (1, 2, 3)]
        return np.asarray(placement.values[:, index])

    if isinstance(machine, Glozman3PRRS):
        phi, shoulder = value("elbow", "elevation"), value("shoulder", "rz")
        w = machine.link_length * np.sin(shoulder - phi)
    elif isinstance(machine, Alizade3PRPS):
        inward = machine.base_radius - radius
        phi, w = np.arctan2(points[..., 2], inward), np.ones_like(radius)
    else:
        phi = value("hinge", "rz")
        w = np.cos(phi) if isinstance(machine, Proposed3PPRS) else np.sin(phi)
    up = np.array([0.0, 0.0, 1.0])
    tau = np.sin(phi)[..., None] * outward + np.cos(phi)[..., None] * up
    side = np.sqrt(3.0) * machine.platform_radius
    e = [(points[:, i] - points[:, j]) / side for i, j in ((0, 1), (1, 2), (2, 0))]

    def along(k: int, leg: int) -> Array:
        return np.asarray((e[k] * tau[:, leg]).sum(axis=-1))

    s = along(0, 0) * along(1, 1) * along(2, 2) - along(0, 1) * along(1, 2) * along(2, 0)
    return s, side**3 * s / (radius * w).prod(axis=-1)


@pytest.mark.parametrize("machine", MACHINES, ids=lambda m: type(m).__name__)
def test_the_determinant_of_four_machines(machine: ThreeLegs) -> None:
    rng = np.random.default_rng(7)
    poses = machine.home().moved(
        np.concatenate([rng.uniform(-0.01, 0.01, (400, 3)), rng.uniform(-0.4, 0.4, (400, 3))], 1)
    )
    placement = machine.place(poses)
    poses = poses[placement.reachable]
    assert len(poses.position) > 200
    s, wanted = closed_form(machine, poses)
    space = tool_drive_space(machine.linkage, machine.place(poses), LENGTH)
    # determinants of motions scaled by L: three turning coordinates of the tool
    turning = sum(direction.startswith("r") for _, direction in space.driven)
    found = space.drive_minor() / space.tool_minor() * LENGTH ** (3.0 - turning)
    sign = np.sign(found / wanted)
    assert np.all(sign == sign[0])
    # near s = 0 the digits are those of s, a difference of products of size one
    error = np.abs(found - sign * wanted) / np.abs(wanted) * np.minimum(1.0, np.abs(s))
    assert error.max() < 1e-12


def tangent_at(machine: ThreeLegs, tilt: Array, roll: float) -> Poses:
    """Platform tangent to the sphere of 4 mm below the pole."""
    normal = np.stack([np.sin(tilt), 0.0 * tilt, np.cos(tilt)], axis=-1)
    centre = np.array([0.0, 0.0, machine.pole_height - 4e-3])
    turn = tangent_rotation(normal, np.full(tilt.shape, roll))
    return Poses(centre + 4e-3 * normal, np.asarray(turn))


#: Where rolls of 0 to 120° meet the ring on the sphere of 4 mm, 4 mm · sin tilt, from s = 0.
RINGS = {
    "Proposed3PPRS": (2.14, 2.42),
    "Eclipse3PPRS": (2.93, 3.38),
    "Alizade3PRPS": (2.37, 2.70),
    "Glozman3PRRS": (2.01, 2.33),
}


@pytest.mark.parametrize("machine", MACHINES, ids=lambda m: type(m).__name__)
def test_the_ring_of_singular_poses_on_the_hemisphere(machine: ThreeLegs) -> None:
    """No roll leads past it: between pole and equator the determinant changes its sign once."""
    radii = []
    for roll in np.radians(np.arange(0.0, 120.0, 10.0)):

        def place(parameters: Array, roll: float = float(roll)) -> Placement:
            return machine.place(tangent_at(machine, parameters[:, 0], roll))

        def s(tilt: float, roll: float = float(roll)) -> float:
            return float(closed_form(machine, tangent_at(machine, np.array([tilt]), roll))[0][0])

        family = PoseFamily(machine.linkage, place, ("tilt",), LENGTH)
        found = singularities_on_line(family, np.radians(np.arange(0.0, 89.0, 1.0)))
        tilts = [one.parameters["tilt"] for one in found if one.kind is Kind.ACTUATOR]
        assert len(tilts) == 1
        wanted = brentq(s, tilts[0] - 0.01, tilts[0] + 0.01, xtol=1e-14)
        assert tilts[0] == pytest.approx(wanted, abs=1e-9)
        radii.append(4.0 * np.sin(tilts[0]))
    # two digits after the point, over rolls in steps of 10°
    assert (min(radii), max(radii)) == pytest.approx(RINGS[type(machine).__name__], abs=0.006)


@dataclass(frozen=True, kw_only=True)
class Crossed(Eclipse3PPRS):
    """The first Eclipse: leg 1 stands below its joint centre, legs 2 and 3 above.

    Kim, Park et al.; R_b 275, R_p 80, link 312.1 mm, tool 91.2 mm below the platform's plane.
    """

    base_radius: float = 0.275
    platform_radius: float = 0.080
    link_length: float = 0.3121
    pole_height: float = 0.350

    def place_legs(self, seats: Radial) -> LegPlacement:
        """As the machine of one kind of legs, with the sign of each leg's rise."""
        inward = self.base_radius - seats.radius
        rise, missing = square_root(self.link_length**2 - inward * inward, self.link_length)
        top = seats.height - rise * np.array([1.0, -1.0, -1.0])
        upright = super().place_legs(seats)
        hinge = seats.at(self.base_radius, top)
        foot = seats.at(self.base_radius, top - self.column_length)
        link = seats.points - hinge
        link = link / np.sqrt(dot(link, link))[..., None]
        places = {"guideway": foot, "foot": foot, "top": hinge, "root": hinge}
        return replace(
            upright,
            positions={**upright.positions, **places},
            link=link,
            elevation=angle(seats.height - top, inward),
            faults={"its joint centre is too far from the guide": missing},
        )

    def family(self, heading: float, extra: tuple[int, ...] = ()) -> PoseFamily:
        """Tilts of the platform about its tool's tip; hinges of some legs driven too."""
        axis = np.array([-np.sin(heading), np.cos(heading), 0.0])

        def place(parameters: Array) -> Placement:
            turn = Rotation.from_rotvec(parameters[:, :1] * axis).as_matrix()
            return self.place(Poses(np.array([0.0, 0.0, 0.2588]) + 0.0912 * turn[..., 2], turn))

        hinges = {f"leg{i}/hinge" for i in extra}
        joints = tuple(
            replace(j, driven=("rz",)) if j.name in hinges else j for j in self.linkage.joints
        )
        return PoseFamily(replace(self.linkage, joints=joints), place, ("tilt",), LENGTH)


@pytest.mark.parametrize(
    ("heading", "extra", "tilts"),
    [
        (0.0, (), (30.00, 60.01)),
        (10.0, (), (29.73, 63.16)),
        (20.0, (), (29.23, 72.70)),
        (30.0, (), (29.00,)),
        # a hinge that is driven too: seven drives, poses at which no 6 x 6 determinant stays
        (0.0, (1,), (30.00,)),
        (0.0, (2,), (60.01,)),
        (0.0, (1, 2), ()),
    ],
)
def test_tilts_of_the_first_eclipse(
    heading: float, extra: tuple[int, ...], tilts: tuple[float, ...]
) -> None:
    family = Crossed().family(np.radians(heading), extra)
    found = singularities_on_line(family, np.radians(np.linspace(0.0, 90.0, 91)))
    assert all(one.kind is Kind.ACTUATOR for one in found)
    degrees = [np.degrees(one.parameters["tilt"]) for one in found]
    # two digits after the point
    assert degrees == pytest.approx(tilts, abs=0.006)


def test_two_driven_hinges_keep_the_first_eclipse_away_from_singularities() -> None:
    family = Crossed().family(0.0, (1, 2))
    placement = family.place(np.radians(np.linspace(0.0, 90.0, 91))[:, None])
    alone = Crossed().family(0.0)
    assert singularity_distance(family.linkage, placement, LENGTH).parallel.min() > 0.2
    assert singularity_distance(alone.linkage, placement, LENGTH).parallel.min() < 0.02


def biglide_family() -> PoseFamily:
    machine = biglide()

    def place(parameters: Array) -> Placement:
        return machine.place(np.concatenate([parameters, np.zeros((len(parameters), 1))], axis=1))

    return PoseFamily(machine.linkage, place, ("x", "y"), 1.0)


def test_the_biglide_is_singular_on_its_circle_and_at_the_ends_of_its_rods() -> None:
    """J⁻¹ = [[1, s], [t, 1]], s = Y/√(1 − Y²), t = X/√(1 − X²): type 2 at st = 1, type 1 at ±1."""
    axis = np.linspace(-1.2, 1.2, 26)
    found = singularities_in_plane(biglide_family(), (axis, axis))
    inner = [c for c in found.curves if not c.border]
    assert all(c.kind is Kind.ACTUATOR for c in inner)
    points = np.concatenate([c.points for c in inner])
    assert len(points) > 20
    np.testing.assert_allclose((points**2).sum(axis=1), 1.0, atol=1e-9)
    # both quadrants with XY > 0, and no other
    assert np.all(points.prod(axis=1) > 0.0)
    assert {tuple(s) for s in np.sign(points)} == {(1.0, 1.0), (-1.0, -1.0)}
    border = [c for c in found.curves if c.border]
    assert {c.kind for c in border} <= {Kind.END_EFFECTOR, Kind.BOTH}
    ends = np.concatenate([c.points for c in border])
    assert len(ends) > 60
    np.testing.assert_allclose(np.abs(ends).max(axis=1), 1.0, atol=1e-9)
    assert found.missed == 0


def test_the_distance_of_the_biglide() -> None:
    points = np.array([[0.0, 0.0], [0.3, -0.6], [0.5, 0.5]])
    family = biglide_family()
    found = singularity_distance(family.linkage, family.place(points), 1.0)
    t, s = (points / np.sqrt(1.0 - points**2)).T
    one = np.ones(3)
    inverse = np.stack([np.stack([one, s], -1), np.stack([t, one], -1)], axis=-2)
    values = np.linalg.svd(inverse, compute_uv=False)
    np.testing.assert_allclose(found.parallel, values[:, 1], rtol=1e-12)
    np.testing.assert_allclose(found.serial, 1.0 / values[:, 0], rtol=1e-12)


def test_a_seventh_drive_leaves_a_single_pose_of_a_curve() -> None:
    """Tilts in all directions: six drives have a curve, with leg 1's hinge one pose is left."""
    machine = Crossed()

    def place(parameters: Array) -> Placement:
        tilt, heading = parameters.T
        axis = np.stack([-np.sin(heading), np.cos(heading), 0.0 * heading], axis=1)
        turn = Rotation.from_rotvec(tilt[:, None] * axis).as_matrix()
        return machine.place(Poses(np.array([0.0, 0.0, 0.2588]) + 0.0912 * turn[..., 2], turn))

    axes = np.radians(np.linspace(21.0, 40.0, 12)), np.radians(np.linspace(-8.0, 9.0, 12))
    six = PoseFamily(machine.linkage, place, ("tilt", "heading"), LENGTH)
    seven = replace(six, linkage=machine.family(0.0, (1,)).linkage)
    (curve,) = singularities_in_plane(six, axes).curves
    assert curve.kind is Kind.ACTUATOR
    found = singularities_in_plane(seven, axes)
    assert found.curves == ()
    (one,) = found.points
    assert one.kind is Kind.ACTUATOR
    on_line = singularities_on_line(machine.family(0.0), np.radians(np.linspace(20.0, 40.0, 5)))
    # on the plane of symmetry, where the curve of six drives crosses it
    assert one.parameters["heading"] == pytest.approx(0.0, abs=1e-8)
    assert one.parameters["tilt"] == pytest.approx(on_line[0].parameters["tilt"], abs=1e-8)
