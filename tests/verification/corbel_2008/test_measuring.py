"""Section IV of Corbel et al. 2008: what encoder errors of the platform do at the tool.

The citation stands in `test_actuation.py`. The printed resolution is not legible: numbers are
ours, as regression, and beside them stand the properties that the document derives.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.kinematics import jacobians
from strutwork.kinematics.capability import Zonotope, velocity_zonotope
from strutwork.kinematics.frames import cross_matrix
from strutwork.machines import GoughPlatform
from strutwork.papers.corbel_2008.measuring import (
    amplification,
    amplifications,
    corners,
    heights,
    leg_range,
    lowest,
    tool_errors,
    widest_base,
    workspace,
)

Array = NDArray[np.float64]

#: As our first derivation had it: the plate's centre between 623 and 923 mm.
FIRST = GoughPlatform(plate_height=0.773)


@pytest.mark.parametrize(("ahead", "worst"), [(0.0, 6.042), (0.1, 4.82), (0.2, 5.05), (0.3, 6.94)])
def test_amplification_by_the_tool_point(ahead: float, worst: float) -> None:
    """Half a digit of the first derivation; with our height of the plate within 0.1 %."""
    arm = [[0.0, 0.0, ahead]]
    found = amplification(FIRST, arm)
    assert found == pytest.approx(worst, abs=5.1e-3 if ahead else 5e-4)
    assert amplification(GoughPlatform(), arm) == pytest.approx(found, rel=1e-3)


@pytest.mark.parametrize(
    ("pair", "worst"), [(10.0, 4.61), (20.0, 4.90), (30.0, 5.33), (40.0, 6.04), (50.0, 6.94)]
)
def test_amplification_by_the_plates_angle(pair: float, worst: float) -> None:
    """5.1e-3: half a digit of the first derivation."""
    found = amplification(replace(FIRST, plate_pair=np.radians(pair)))
    assert found == pytest.approx(worst, abs=5.1e-3)


def test_errors_of_a_tool_point_are_those_of_a_platform_with_it() -> None:
    """Eqs. 11 to 14 against a machine whose tool stands there: 1e-10, of an inverse of six."""
    arm = (0.03, -0.02, 0.14)
    machine = GoughPlatform(tool=arm)
    places = workspace(machine, 3)
    placement = machine.place(machine.at_plate(places))
    own = velocity_zonotope(jacobians(machine.linkage, placement).forward[:, :3], np.ones(6))
    found = tool_errors(GoughPlatform(), places, [arm])
    np.testing.assert_allclose(found.generators[:, 0], own.generators, atol=1e-10)


def test_the_worst_case_is_at_vertices() -> None:
    """Over signs and over a box of tool points: none of 4000 random ones inside is worse."""
    machine, rng = GoughPlatform(), np.random.default_rng(5)
    places = workspace(machine, 3)
    worst = tool_errors(machine, places, corners()).largest.max(axis=1)
    box = corners()
    arms = rng.uniform(box.min(axis=0), box.max(axis=0), (200, 3))
    inside = tool_errors(machine, places, arms)
    errors = inside.generators @ rng.uniform(-1.0, 1.0, (6, 20))
    assert np.all(np.linalg.norm(errors, axis=-2).max(axis=(1, 2)) < worst)
    # nor is any vertex of another tool point
    assert np.all(inside.largest.max(axis=1) < worst)
    # 32 signs do: the 64 are counted out
    signs = np.array(list(product((-1.0, 1.0), repeat=6)))
    at_corners = tool_errors(machine, places, corners())
    all_64 = np.linalg.norm(at_corners.generators @ signs.T, axis=-2).max(axis=-1)
    np.testing.assert_allclose(at_corners.largest, all_64, rtol=1e-12)


def test_hessian_over_the_tool_point() -> None:
    """Eq. 21 as printed, from the rotation (S₄, S₅, S₆), against second differences.

    The squared error is a quadratic, so that they are exact but for rounding, 1e-6.
    """
    machine, rng = GoughPlatform(), np.random.default_rng(1)
    place = workspace(machine, 3)[4:5]
    turning = jacobians(machine.linkage, machine.place(machine.at_plate(place))).forward[0, 3:]
    error = rng.choice([-1.0, 1.0], 6)
    s4, s5, s6 = turning @ error
    printed = 2.0 * np.array(
        [
            [s5**2 + s6**2, -s5 * s4, -s6 * s4],
            [-s5 * s4, s4**2 + s6**2, -s6 * s5],
            [-s6 * s4, -s6 * s5, s4**2 + s5**2],
        ]
    )
    step = 0.05
    arms = np.array([0.01, 0.02, 0.1]) + step * np.array(list(product((0, 1, 2), repeat=3)))
    moved = tool_errors(machine, place, arms).generators[0] @ error
    square = (moved**2).sum(axis=-1).reshape(3, 3, 3)
    found = np.empty((3, 3))
    for i, j in product(range(3), repeat=2):
        e, f = np.eye(3, dtype=int)[[i, j]]
        found[i, j] = sum(
            sign * square[tuple(a * e + b * f)]
            for sign, a, b in ((1, 1, 1), (-1, 1, 0), (-1, 0, 1), (1, 0, 0))
        )
    np.testing.assert_allclose(found / step**2, printed, rtol=1e-6, atol=1e-6 * printed.max())
    values = np.linalg.eigvalsh(printed)
    twice = 2.0 * (s4**2 + s5**2 + s6**2)
    np.testing.assert_allclose(values, [0.0, twice, twice], atol=1e-9 * twice)


@pytest.mark.parametrize(("ahead", "worst"), [(0.1, 8.28), (0.2, 10.86), (0.3, 13.98)])
def test_the_printed_sign_of_the_second_block_is_wrong(ahead: float, worst: float) -> None:
    """Rates of the legs by differences say which sign holds; the other gives other errors.

    It turns the platform the other way, which a tool at its centre does not see, while any other
    is mirrored by it: the amplification is that of a tool point behind the plate.
    1e-6: central differences of 1 µm and 1 µrad; 5.1e-3: half a digit of our first derivation.
    """
    poses = FIRST.at_plate(workspace(FIRST, 2))
    placement = FIRST.place(poses)
    index = FIRST.linkage.node_index
    feet = placement.positions[:, [index[f"base{i}"] for i in range(1, 7)]]
    seats = placement.positions[:, [index[f"platform/P{i}"] for i in range(1, 7)]]
    u = seats - feet
    u = u / np.linalg.norm(u, axis=-1, keepdims=True)
    # from the joint to the plate's centre: B E
    block = np.cross(u, poses.position[:, None] - seats)
    column = [placement.names.index((f"leg{i}/ram", "z")) for i in range(1, 7)]
    rates = np.empty((len(feet), 6, 6))
    for k, twist in enumerate(1e-6 * np.eye(6)):
        after, before = (FIRST.place(poses.moved(s * twist)).values[:, column] for s in (1, -1))
        rates[..., k] = (after - before) / 2e-6
    np.testing.assert_allclose(rates, np.concatenate([u, block], -1), atol=1e-6)
    printed = np.linalg.inv(np.concatenate([u, -block], -1))
    arm = np.array([0.0, 0.0, ahead])
    wrong = printed[:, :3] - cross_matrix(arm) @ printed[:, 3:]
    found = Zonotope(wrong).largest.max()
    assert found == pytest.approx(worst, abs=5.1e-3)
    assert found > 1.5 * amplification(FIRST, [arm], 2)
    assert found == pytest.approx(amplification(FIRST, [-arm], 2), rel=1e-10)


def test_legs_keep_the_printed_range() -> None:
    """Shortest and longest leg against a fine grid of the cube: 1e-4 m, of its steps."""
    machine = GoughPlatform()
    found = leg_range(machine)
    placement = machine.place(machine.at_plate(workspace(machine, 31)))
    column = [placement.names.index((f"leg{i}/ram", "z")) for i in range(1, 7)]
    lengths = placement.values[:, column]
    assert (lengths.min(), lengths.max()) == pytest.approx(
        (found.shortest, found.longest), abs=1e-4
    )
    assert 0.634 <= found.shortest < 0.6342
    assert found.longest == pytest.approx(1.0641, abs=1e-4)
    low, high = heights(machine)
    assert low <= machine.plate_height <= high
    assert leg_range(lowest(machine)).shortest == pytest.approx(0.634, abs=1e-12)
    assert leg_range(replace(machine, plate_height=high)).longest == pytest.approx(1.08, abs=1e-12)


TRENDS = (
    ("base_pair", np.radians([2.0, 6.0, 10.0, 20.0, 30.0]), 1),
    ("plate_pair", np.radians([25.0, 30.0, 35.0, 40.0, 50.0, 60.0]), 1),
    ("base_radius", np.array([0.30, 0.325, 0.35, 0.375, 0.40, 0.42]), -1),
    ("plate_radius", np.array([0.05, 0.06, 0.075, 0.08, 0.09, 0.1, 0.12]), -1),
)


@pytest.mark.parametrize(("field", "values", "sign"), TRENDS)
def test_small_angles_and_large_radii_are_better(field: str, values: Array, sign: int) -> None:
    """In our box of tool points, each geometry as low as the legs allow."""
    made = [lowest(replace(GoughPlatform(), **{field: float(v)})) for v in values]  # type: ignore[arg-type]
    found = sign * np.diff(amplifications(made, corners()))
    assert np.all(found > 0.0)


def test_angles_of_the_plate_below_25_degrees_are_alike_in_the_box() -> None:
    made = [
        lowest(replace(GoughPlatform(), plate_pair=a)) for a in np.radians([10.0, 15.0, 20.0, 25.0])
    ]
    found = amplifications(made, corners())
    assert np.ptp(found) < 0.02 * found.mean()


def test_nearer_to_the_base_is_better() -> None:
    machine = GoughPlatform()
    made = [replace(machine, plate_height=float(h)) for h in np.linspace(*heights(machine), 5)]
    for arms in ([[0.0, 0.0, 0.0]], corners()):
        assert np.all(np.diff(amplifications(made, arms)) > 0.0)


def test_the_leg_range_alone_would_allow_a_wider_base() -> None:
    """Own numbers as regression; beyond the widest base no height keeps the legs' range."""
    machine = GoughPlatform()
    widest = widest_base(machine)
    assert widest == pytest.approx(0.4260, abs=1e-4)
    found = amplification(lowest(replace(machine, base_radius=widest - 1e-6)), corners())
    assert (amplification(machine, corners()), found) == pytest.approx((6.817, 6.115), abs=1e-3)
    with pytest.raises(ModelError, match="no height keeps its legs"):
        heights(replace(machine, base_radius=widest + 1e-4))


def test_a_grid_of_places_finds_no_worse_than_the_corners() -> None:
    machine = GoughPlatform()
    for arms in ([[0.0, 0.0, 0.0]], [[0.0, 0.0, 0.2]], corners()):
        assert amplification(machine, arms, 9) == pytest.approx(amplification(machine, arms, 2))
