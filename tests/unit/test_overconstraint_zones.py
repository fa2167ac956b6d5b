"""Misfits that each kind of tolerance causes, against displacements made by hand.

The joints of most tests are fixed, so that their misfits hold the whole motion of the feature.
"""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from strutwork.msa import PlacedStructure
from strutwork.overconstraint import MisfitSources, Tolerance, ToleranceWarning, misfit_sources
from tests.structures import Model, vector

Array = NDArray[Any]

AXIS = np.array([0.36, -0.48, 0.8])
ALONG = np.array([0.8, 0.6, 0.0])
PLACES = np.array([0.2, -0.1, 0.3]) + np.outer([0.0, 0.25, -0.4], AXIS) + [0.0, 0.0, 0.05]


def bearings(swapped: tuple[int, ...] = (), kind: str = "fixed", **options: Any) -> PlacedStructure:
    """Joints J0, J1, J2 along an axis between ground, with a datum, and a body with its own."""
    rng = np.random.default_rng(4)
    model = Model("tool")
    model.ground(datum=PLACES[0] - [0.1, 0.0, 0.02], tower=(1.0, 1.0, 1.0))
    model.nodes(tool=(0.5, 0.5, 0.5))
    for i, place in enumerate(PLACES):
        model.ground(**{f"g{i}": place})
        sides = (f"p{i}", f"g{i}") if i in swapped else (f"g{i}", f"p{i}")
        axis, second = (AXIS, None) if i == 0 else rng.normal(size=(2, 3))
        model.joint(f"J{i}", kind, sides, axis, second, **options)
    model.rigid("shaft", "tool", "p0", "p1", "p2")
    return model.place()


def motion(placed: PlacedStructure, sources: MisfitSources, joint: int, z: Array) -> Array:
    """Displacement and turn of a joint's side that the misfits stand for, global axes, (2, 3)."""
    misfits = dict(zip(sources.columns, sources.mean + sources.map @ z, strict=True))
    six = [misfits.get((f"J{joint}", d), 0.0) for d in ("x", "y", "z", "rx", "ry", "rz")]
    return np.asarray(np.reshape(six, (2, 3)) @ placed.placement.frames[joint].T)


def carried(turn: Array, point: Array, about: Array) -> Array:
    """Displacement of a point turned about another by a rotation vector, exact."""
    return np.asarray(Rotation.from_rotvec(turn).apply(point - about) + about - point)


@pytest.mark.parametrize("kind", ["parallelism", "perpendicularity", "angularity"])
@pytest.mark.parametrize("by_size", [False, True])
def test_a_tilted_axis_carries_its_bearings_with_it(kind: str, by_size: bool) -> None:
    """A small rotation about the datum, at any azimuth, of half-angle t/L: all bearings as one."""
    slope = 1e-6
    extent = {"size": 0.3e-6, "length": 0.3} if by_size else {"slope": slope}
    placed = bearings()
    names = ("J0", "J1", "J2")
    tolerance = Tolerance("axis", kind, names, datum="datum", axis=vector(AXIS), **extent)  # type: ignore[arg-type]
    sources = misfit_sources(placed, [tolerance])
    assert sources.parameters == 2
    assert not np.any(sources.mean)
    datum = placed.placement.positions[placed.structure.linkage.node_index["datum"]]
    turns = []
    for azimuth in np.radians(np.arange(0, 360, 30)):
        z = np.array([np.cos(azimuth), np.sin(azimuth)])
        turn = motion(placed, sources, 0, z)[1]
        turns.append(turn)
        assert np.linalg.norm(turn) == pytest.approx(slope, rel=1e-12)
        assert abs(turn @ AXIS) < 1e-12 * slope
        # the axis itself leans by as much
        assert np.linalg.norm(carried(turn, AXIS, np.zeros(3))) == pytest.approx(slope, rel=1e-6)
        for j in range(3):
            moved, turned = motion(placed, sources, j, z)
            np.testing.assert_allclose(turned, turn, atol=1e-12 * slope)
            # small against finite rotation: half the angle of the lever
            np.testing.assert_allclose(moved, carried(turn, PLACES[j], datum), atol=slope**2 * 1.0)
    # once around, evenly
    np.testing.assert_allclose(np.sum(turns, axis=0), 0.0, atol=1e-12 * slope)


def test_a_tilt_turns_about_the_first_joint_along_its_axis_by_default() -> None:
    placed = bearings()
    sources = misfit_sources(placed, [Tolerance("axis", "parallelism", ("J0", "J2"), slope=1e-6)])
    z = np.array([0.6, -0.8])
    moved, turn = motion(placed, sources, 0, z)
    np.testing.assert_allclose(moved, 0.0, atol=1e-20)
    assert abs(turn @ AXIS) < 1e-18
    np.testing.assert_allclose(
        motion(placed, sources, 2, z)[0], carried(turn, PLACES[2], PLACES[0]), atol=1e-12
    )


@pytest.mark.parametrize("swapped", [(), (0,), (1, 2), (0, 1, 2)])
def test_a_feature_on_the_second_side_gives_the_opposite_misfit(swapped: tuple[int, ...]) -> None:
    """The same feature on ground: whichever side of a joint is the first one, its sign says."""
    z = np.array([0.6, -0.8])
    tolerance = Tolerance("axis", "parallelism", ("J0", "J1", "J2"), slope=1e-6, datum="datum")
    plain, other = bearings(), bearings(swapped)
    first, second = (misfit_sources(p, [tolerance]) for p in (plain, other))
    for j in range(3):
        sign = -1.0 if j in swapped else 1.0
        np.testing.assert_allclose(
            motion(other, second, j, z), sign * motion(plain, first, j, z), atol=1e-20
        )


def test_a_feature_of_the_body_gives_the_opposite_misfit_of_one_of_ground() -> None:
    placed = bearings()
    one, two = (
        misfit_sources(placed, [Tolerance("axis", "position", ("J1", "J2"), size=1e-5, datum=d)])
        for d in ("g1", "p1")
    )
    assert one.columns == two.columns
    np.testing.assert_array_equal(two.map, -one.map)


def test_position_without_length_moves_an_axis_in_its_circle() -> None:
    size = 4e-5
    placed = bearings()
    sources = misfit_sources(placed, [Tolerance("bore", "position", ("J0", "J1"), size=size)])
    for azimuth in np.linspace(0, 6, 13):
        z = np.array([np.cos(azimuth), np.sin(azimuth)])
        both = [motion(placed, sources, j, z) for j in (0, 1)]
        np.testing.assert_allclose(both[0], both[1], atol=1e-18)
        moved, turn = both[0]
        assert np.linalg.norm(moved) == pytest.approx(size / 2, rel=1e-12)
        assert abs(moved @ AXIS) < 1e-17
        assert not np.any(turn)


@pytest.mark.parametrize("kind", ["position", "coaxiality"])
def test_an_axis_stays_in_its_cylinder(kind: str) -> None:
    """Diameter t over length L about the datum: each end anywhere in a circle of radius t/2."""
    size, length = 4e-5, 0.3
    placed = bearings()
    tolerance = Tolerance("bore", kind, ("J0", "J1"), size=size, length=length, axis=vector(AXIS))
    sources = misfit_sources(placed, [tolerance])
    assert [type(b.shape).__name__ for b in sources.blocks] == ["Disc", "Disc"]
    ends = []
    for z in np.eye(4):
        moved, turn = motion(placed, sources, 0, z)
        ends.append([moved + np.cross(turn, s * length / 2 * AXIS) for s in (-1.0, 1.0)])
        np.testing.assert_allclose(
            motion(placed, sources, 1, z)[0],
            moved + np.cross(turn, PLACES[1] - PLACES[0]),
            atol=1e-17,
        )
    maps = np.array(ends)
    np.testing.assert_allclose(maps @ AXIS, 0.0, atol=1e-17)
    # a block moves one end alone, as far as the circle's radius in every azimuth
    for block, (own, other) in enumerate(((0, 1), (1, 0))):
        rows = maps[2 * block : 2 * block + 2]
        np.testing.assert_allclose(rows[:, other], 0.0, atol=1e-17)
        np.testing.assert_allclose(
            rows[:, own] @ rows[:, own].T, (size / 2) ** 2 * np.eye(2), atol=1e-18
        )


def test_a_point_stays_in_its_sphere() -> None:
    size = 4e-5
    placed = bearings()
    sources = misfit_sources(placed, [Tolerance("centre", "point_position", ("J1",), size=size)])
    rows = np.array([motion(placed, sources, 1, z)[0] for z in np.eye(3)])
    np.testing.assert_allclose(rows @ rows.T, (size / 2) ** 2 * np.eye(3), atol=1e-18)
    assert type(sources.blocks[0].shape).__name__ == "Ball"
    assert all(d in ("x", "y", "z") for _, d in sources.columns)


def test_a_surface_stays_between_its_planes() -> None:
    """Corners of the rectangle reach ± t/2 and go no farther; all planes between are allowed."""
    size, length, width = 4e-5, 0.3, 0.12
    placed = bearings()
    tolerance = Tolerance(
        "face",
        "location",
        ("J0", "J2"),
        size=size,
        length=length,
        width=width,
        axis=vector(AXIS),
        along=vector(ALONG),
    )
    sources = misfit_sources(placed, [tolerance])
    block = sources.blocks[0].shape
    assert type(block).__name__ == "PlaneZone"
    x = ALONG - (ALONG @ AXIS) * AXIS
    x /= np.linalg.norm(x)
    y = np.cross(AXIS, x)
    corners = [a * length / 2 * x + b * width / 2 * y for a, b in product((-1, 1), repeat=2)]

    def heights(z: Array) -> Array:
        moved, turn = motion(placed, sources, 0, z)
        np.testing.assert_allclose(
            motion(placed, sources, 2, z)[0],
            moved + np.cross(turn, PLACES[2] - PLACES[0]),
            atol=1e-17,
        )
        assert abs(turn @ AXIS) < 1e-15
        return np.array([(moved + np.cross(turn, corner)) @ AXIS for corner in corners])

    rng = np.random.default_rng(0)
    for z in block.surface(rng.random((50, 3))):
        assert np.abs(heights(z)).max() == pytest.approx(size / 2, rel=1e-10)
    # height, tilt along and tilt across are three parameters of their own
    np.testing.assert_allclose(heights(np.array([1.0, 0, 0])), size / 2, rtol=1e-10)
    along, across = (np.array([c @ e for c in corners]) for e in (x, y))
    for z, where, side in (((0.0, 1.0, 0.0), along, length), ((0.0, 0.0, 1.0), across, width)):
        slope = heights(np.array(z)) / where
        np.testing.assert_allclose(np.abs(slope), size / side, rtol=1e-10)
        np.testing.assert_allclose(slope, slope[0], rtol=1e-10)


def test_a_surface_without_sides_only_rises() -> None:
    placed = bearings()
    sources = misfit_sources(placed, [Tolerance("face", "location", ("J0", "J1"), size=4e-5)])
    assert sources.parameters == 1
    for j in (0, 1):
        moved, turn = motion(placed, sources, j, np.ones(1))
        np.testing.assert_allclose(moved, 2e-5 * AXIS, atol=1e-17)
        np.testing.assert_allclose(turn, 0.0, atol=1e-17)


def test_seats_on_a_flat_surface_rise_each_for_itself() -> None:
    placed = bearings()
    names = ("J0", "J1", "J2")
    sources = misfit_sources(
        placed, [Tolerance("seats", "flatness", names, size=4e-5, axis=vector(AXIS))]
    )
    assert len(sources.blocks) == sources.parameters == 3
    assert sources.owner.tolist() == [0, 0, 0]
    for i, j in product(range(3), repeat=2):
        moved = motion(placed, sources, j, np.eye(3)[i])[0]
        np.testing.assert_allclose(moved, 2e-5 * AXIS if i == j else 0.0, atol=1e-17)


def test_a_length_is_plus_minus_its_size_or_between_its_limits() -> None:
    placed = bearings()
    plain = Tolerance("long", "length", ("J1",), size=1e-5, axis=vector(AXIS))
    between = Tolerance("limits", "length", ("J1",), limits=(-1e-5, 5e-5), axis=vector(AXIS))
    for tolerance, low, high in ((plain, -1e-5, 1e-5), (between, -1e-5, 5e-5)):
        sources = misfit_sources(placed, [tolerance])
        for z, value in ((-1.0, low), (1.0, high)):
            moved = motion(placed, sources, 1, np.array([z]))[0]
            np.testing.assert_allclose(moved, value * AXIS, atol=1e-17)


def test_one_tolerance_is_shared_and_two_are_not() -> None:
    placed = bearings()
    shared = misfit_sources(placed, [Tolerance("a", "position", ("J0", "J1"), size=1e-5)])
    apart = misfit_sources(
        placed,
        [
            Tolerance("a", "position", ("J0",), size=1e-5),
            Tolerance("b", "position", ("J1",), size=1e-5, axis=vector(AXIS)),
        ],
    )
    assert (shared.parameters, apart.parameters) == (2, 4)
    assert apart.owner.tolist() == [0, 1]
    # the same azimuth for both is the shared one
    assert apart.columns == shared.columns
    np.testing.assert_allclose(apart.map @ np.vstack([np.eye(2)] * 2), shared.map, atol=1e-20)


def test_free_directions_take_no_misfit() -> None:
    """Bearings that hold x, y and z: the tilt of a feature reaches them as displacement alone."""
    fixed, balls = bearings(), bearings(kind="spherical")
    tolerance = Tolerance("axis", "parallelism", ("J0", "J1", "J2"), slope=1e-6, datum="datum")
    one, two = (misfit_sources(p, [tolerance]) for p in (fixed, balls))
    assert two.columns == tuple(c for c in one.columns if c[1] in "xyz")
    rows = [one.columns.index(c) for c in two.columns]
    np.testing.assert_array_equal(two.map, one.map[rows])


def test_a_tolerance_in_free_directions_alone_is_warned_of() -> None:
    """Exactly free, though turning into the joint's skew axes leaves round-off in the others."""
    placed = bearings(kind="cylindrical")
    with pytest.warns(ToleranceWarning, match=r"tolerance long: joint J0 is free.*no effect"):
        sources = misfit_sources(placed, [Tolerance("long", "length", ("J0",), size=1e-5)])
    assert sources.columns == ()
    axis = vector(placed.placement.frames[1][:, 2])
    with pytest.warns(ToleranceWarning, match="joint J1 is free"):
        misfit_sources(placed, [Tolerance("long", "length", ("J1",), size=1e-5, axis=axis)])


def test_the_pivot_of_a_tilt_that_others_feel_is_not_warned_of(
    recwarn: pytest.WarningsRecorder,
) -> None:
    placed = bearings(kind="spherical")
    misfit_sources(placed, [Tolerance("axis", "parallelism", ("J0", "J1"), slope=1e-6)])
    assert not recwarn.list
    with pytest.warns(ToleranceWarning, match="joint J0 is free"):
        misfit_sources(placed, [Tolerance("axis", "parallelism", ("J0",), slope=1e-6)])


def test_no_tolerance_is_no_misfit() -> None:
    sources = misfit_sources(bearings(), [])
    assert (sources.parameters, sources.columns, sources.map.shape) == (0, (), (0, 0))
