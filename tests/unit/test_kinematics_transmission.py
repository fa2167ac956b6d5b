"""Ellipsoids, zonotopes and polytopes of the tool against what they are by definition."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import Poses, jacobians
from strutwork.kinematics.capability import Zonotope, force_zonotope, velocity_zonotope
from strutwork.kinematics.polytopes import Polytope
from strutwork.kinematics.tool_drive_space import ToolDriveSpace, tool_drive_space
from strutwork.kinematics.transmission import force_ellipsoids, velocity_ellipsoids
from tests.linkages import Gough, gough
from tests.planar_and_delta import biglide, linear_delta

Array = NDArray[np.float64]
LENGTH = 0.3


def platform() -> tuple[ToolDriveSpace, Array]:
    machine = gough()
    rng = np.random.default_rng(3)
    twists = np.concatenate([rng.uniform(-0.05, 0.05, (5, 3)), rng.uniform(-0.2, 0.2, (5, 3))], 1)
    placement = machine.place(machine.home().moved(twists))
    found = jacobians(machine.linkage, placement)
    return tool_drive_space(machine.linkage, placement, LENGTH), np.asarray(found.inverse)


def test_velocity_ellipsoids_are_the_singular_values_of_parts_of_the_jacobian() -> None:
    space, inverse = platform()
    forward = np.linalg.inv(inverse)

    def values(matrix: Array) -> Array:
        return np.asarray(np.linalg.svd(matrix, compute_uv=False))

    free = velocity_ellipsoids(space, "translation", "free")
    np.testing.assert_allclose(free.semi_axes, values(forward[:, :3]), rtol=1e-10)
    turning = velocity_ellipsoids(space, "rotation", "free")
    np.testing.assert_allclose(turning.semi_axes, values(forward[:, 3:]), rtol=1e-10)
    blocked = velocity_ellipsoids(space, "translation", "blocked")
    np.testing.assert_allclose(
        blocked.semi_axes, 1.0 / values(inverse[..., :3])[:, ::-1], rtol=1e-10
    )
    # a projection holds the section
    assert np.all(blocked.semi_axes < free.semi_axes * (1 + 1e-12))
    scaled = forward * np.repeat([1.0, LENGTH], 3)[:, None]
    np.testing.assert_allclose(
        velocity_ellipsoids(space, "all").semi_axes, values(scaled), rtol=1e-10
    )
    # directions: what moves least for the unit rates that make it
    along = np.einsum("pji,pjk->pik", free.directions, forward[:, :3])
    np.testing.assert_allclose(np.linalg.norm(along, axis=-1), free.semi_axes, rtol=1e-10)


def test_weights_are_the_rates_that_count_as_one() -> None:
    space, inverse = platform()
    speeds = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    forward = np.linalg.inv(inverse)[:, :3] * speeds
    found = velocity_ellipsoids(space, weights=speeds.tolist()).semi_axes
    np.testing.assert_allclose(found, np.linalg.svd(forward, compute_uv=False), rtol=1e-10)
    with pytest.raises(ModelError, match="6 positive numbers"):
        velocity_ellipsoids(space, weights=[1.0, 0.0, 1.0, 1.0, 1.0, 1.0])


def test_force_ellipsoids_are_the_reciprocals() -> None:
    space, inverse = platform()
    # τ = Jᵀ w: no moment, |J_vᵀ f| = 1; any moment, f = C_vᵀ τ with |τ| = 1
    forward = np.linalg.inv(inverse)
    free = force_ellipsoids(space, "translation", "free").semi_axes
    wanted = 1.0 / np.linalg.svd(forward[:, :3], compute_uv=False)[:, ::-1]
    np.testing.assert_allclose(free, wanted, rtol=1e-10)
    blocked = force_ellipsoids(space, "translation", "blocked").semi_axes
    wanted = np.linalg.svd(inverse[..., :3], compute_uv=False)
    np.testing.assert_allclose(blocked, wanted, rtol=1e-10)


def test_an_ellipsoid_has_no_end_at_an_actuator_singularity() -> None:
    """The biglide at 45° on its circle: the tool moves along (1, −1) at held drives."""
    machine = biglide()
    half = np.sqrt(0.5)
    placement = machine.place(np.array([[0.2, 0.1, 0.0], [half, half, 0.0]]))
    space = tool_drive_space(machine.linkage, placement, 1.0)
    found = velocity_ellipsoids(space)
    assert found.used == 2
    assert np.isfinite(found.semi_axes[0]).all()
    assert np.isinf(found.largest[1])
    assert abs(found.directions[1, :, 0] @ [half, -half, 0.0]) == pytest.approx(1.0, abs=1e-9)
    # along (1, 1) one rate of √½ each makes √½ (J⁻¹ (1, 1) = 2 (1, 1)): half a unit
    assert found.smallest[1] == pytest.approx(0.5, rel=1e-9)
    assert found.isotropy[1] == 0.0
    assert force_ellipsoids(space).semi_axes[1, 1] == 0.0


@pytest.mark.parametrize(
    ("rod", "reach", "place", "condition"),
    [
        (0.8, 0.48, (0.0, 0.0), 1.8856),
        (0.8, 0.48, (0.15, -0.15), 2.4591),
        (0.7, 0.4017, (0.15, -0.15), 2.7112),
        (1.0, 0.6592, (0.15, -0.15), 2.1245),
    ],
)
def test_the_linear_delta(
    rod: float, reach: float, place: tuple[float, float], condition: float
) -> None:
    machine = linear_delta(rod, reach)
    placement = machine.place(np.array([[*place, -0.5], [*place, 0.3]]))
    found = velocity_ellipsoids(tool_drive_space(machine.linkage, placement, 1.0))
    worst = 1.0 / found.isotropy
    # z enters nowhere
    assert worst[0] == pytest.approx(worst[1], rel=1e-10)
    if place == (0.0, 0.0):
        assert worst[0] == pytest.approx(condition, abs=1e-4)
        return
    corners = np.array([[x, y, 0.0] for x, y in product((-0.15, 0.15), repeat=2)])
    found = velocity_ellipsoids(tool_drive_space(machine.linkage, machine.place(corners), 1.0))
    assert (1.0 / found.isotropy).max() == pytest.approx(condition, abs=1e-4)


def test_an_isotropic_delta_does_not_transmit_one_to_one() -> None:
    machine = linear_delta(0.8, np.sqrt(2.0 / 3.0) * 0.8)
    space = tool_drive_space(machine.linkage, machine.place(np.zeros((1, 3))), 1.0)
    np.testing.assert_allclose(velocity_ellipsoids(space).semi_axes, 1 / np.sqrt(3.0), rtol=1e-10)


def measuring_platform(pair: float) -> Gough:
    """r_b 375 mm, pairs of 6°; r_TP 75 mm, plate lines turned by 60°."""
    thirds = np.radians([0.0, 120.0, 240.0])
    base = [c + s * np.radians(3.0) for c in thirds for s in (-1, 1)]
    plate = [c + np.radians(60.0 + s * pair / 2) for c in thirds for s in (-1, 1)]
    plate = plate[-1:] + plate[:-1]

    def circle(angles: list[float], radius: float) -> tuple[tuple[float, float, float], ...]:
        return tuple((radius * float(np.cos(a)), radius * float(np.sin(a)), 0.0) for a in angles)

    return Gough(circle(base, 0.375), circle(plate, 0.075))


@pytest.mark.parametrize(
    ("pair", "worst"), [(10.0, 4.61), (20.0, 4.90), (30.0, 5.33), (40.0, 6.042), (50.0, 6.94)]
)
def test_the_worst_error_of_a_measuring_platform_is_at_a_vertex(pair: float, worst: float) -> None:
    machine = measuring_platform(pair)
    corners = np.array(list(product((-0.15, 0.15), (-0.15, 0.15), (0.623, 0.923))))
    placement = machine.place(Poses.of(corners))
    if pair == 40.0:
        lengths = placement.values.min(), placement.values.max()
        assert lengths == pytest.approx((0.6336, 1.0636), abs=5e-5)
    errors = velocity_zonotope(jacobians(machine.linkage, placement).forward[:, :3], np.ones(6))
    # digits as they are known
    assert errors.largest.max() == pytest.approx(worst, abs=0.005 if worst < 6 else 0.0055)
    # the norm is convex: no error inside is worse
    rng = np.random.default_rng(5)
    inside = rng.uniform(-1.0, 1.0, (8, 6, 2000))
    apart = np.linalg.norm(errors.generators @ inside, axis=1)
    assert apart.max() < errors.largest.max()


def test_a_zonotope_is_the_hull_of_its_corners() -> None:
    rng = np.random.default_rng(11)
    generators = rng.normal(size=(3, 3, 5))
    found = Zonotope(generators)
    normals, offsets = found.facets()
    heights = np.abs(np.einsum("pmd,pcd->pmc", normals, found.corners))
    # every corner is inside, and every facet is touched
    np.testing.assert_allclose(heights.max(axis=-1), offsets, rtol=1e-12)
    # the guaranteed force is there in every direction, and no more in one of them
    directions = rng.normal(size=(500, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    supports = np.abs(np.einsum("pda,nd->pna", generators, directions)).sum(axis=-1)
    assert np.all(supports >= found.guaranteed[:, None] * (1 - 1e-12))
    least = np.abs(np.einsum("pmd,pda->pma", normals, generators)).sum(axis=-1).min(axis=-1)
    np.testing.assert_allclose(least, found.guaranteed, rtol=1e-12)
    np.testing.assert_allclose(found.support([0.0, 0.0, 1.0]), np.abs(generators[:, 2]).sum(-1))


def test_forces_of_redundant_drives_without_a_moment_are_a_section() -> None:
    """Against linear programs: the largest force along a direction with all moments zero."""
    from scipy.optimize import linprog  # noqa: PLC0415 - of this test alone

    rng = np.random.default_rng(2)
    inverse, limits = rng.normal(size=(7, 6)), rng.uniform(0.5, 2.0, 7)
    zonotope = force_zonotope(inverse, limits)
    section = Polytope.of(zonotope).section((0, 1, 2))
    for direction in rng.normal(size=(6, 3)):
        found = (section.vertices @ direction).max()
        best = linprog(
            -(direction @ inverse.T[:3]),
            A_eq=inverse.T[3:],
            b_eq=np.zeros(3),
            bounds=list(zip(-limits, limits, strict=True)),
        )
        assert found == pytest.approx(-best.fun, rel=1e-8)
    assert section.guaranteed <= section.largest
    # with any moment more can be had
    assert force_zonotope(inverse[:, :3], limits).guaranteed >= section.guaranteed


def test_velocities_within_the_drives_rates() -> None:
    _, inverse = platform()
    limits = np.array([0.1, 0.2, 0.3, 0.4, 0.5, 0.6])
    forward = np.linalg.inv(inverse[0])
    whole = Polytope.of_rates(inverse[0], limits)
    assert len(whole.vertices) == 2**6
    shadow = whole.projection((0, 1, 2))
    zonotope = velocity_zonotope(forward[:3], limits)
    assert shadow.guaranteed == pytest.approx(float(zonotope.guaranteed), rel=1e-8)
    assert shadow.largest == pytest.approx(float(zonotope.largest), rel=1e-8)


def test_a_flat_zonotope_guarantees_nothing() -> None:
    assert Zonotope(np.eye(3)[:, :2]).guaranteed == 0.0
    flat = np.concatenate([np.random.default_rng(1).normal(size=(2, 5)), np.zeros((1, 5))])
    assert Zonotope(flat).guaranteed == 0.0
    with pytest.raises(ModelError, match="serial singularity"):
        force_zonotope(np.full((6, 3), np.inf), np.ones(6))
    with pytest.raises(ModelError, match="6 positive numbers"):
        velocity_zonotope(np.ones((3, 6)), np.zeros(6))
