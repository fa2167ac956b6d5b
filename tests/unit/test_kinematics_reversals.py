"""Reversals of drives over surfaces: cones, singular points and their index, lines, plates."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import ModelError, UnreachableError
from strutwork.kinematics import Poses, angle, drive_values, rotation_y
from strutwork.kinematics.clear_paths import path_reversals
from strutwork.kinematics.drive_fields import FormulaField, MotionField
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.reversal_cones import cone, sectors
from strutwork.kinematics.reversal_points import hessians
from strutwork.kinematics.reversals import reversals
from strutwork.kinematics.task_surfaces import Dome, Plane, paraboloid, sphere
from strutwork.kinematics.turns import rotation_matrix
from strutwork.machines import HexelHexapod, MitSS1, WorkTable
from strutwork.machines.load import load

Array = NDArray[Any]


def hexapod(surface: Any) -> MotionField:
    machine = HexelHexapod()
    home = machine.home()
    motion = Motion(machine.linkage, machine.place(home), home.rotation)
    return MotionField(motion, surface, machine.place)


def stepped(values: Any) -> Any:
    """Gradient of a formula over two parameters, by complex steps."""
    step = 1e-150

    def gradient(points: Array) -> Array:
        return np.stack(
            [values(points + 1j * step * np.eye(2)[k]).imag / step for k in (0, 1)], axis=-1
        )

    return gradient


# cones ---------------------------------------------------------------------------------------


def test_cone_of_the_thesis() -> None:
    """Son 2002, eqs 30 and 34: α + 2β ≥ 0, α − β ≤ 0, 2α + 3β ≥ 0; rays (1, 1) and (−3, 2)."""
    gradient = np.array([[1.0, 2.0], [1.0, -1.0], [2.0, 3.0]])
    found = np.degrees(cone(gradient, [1, -1, 1]))
    assert found == pytest.approx([45.0, np.degrees(np.arctan2(2, -3))], abs=1e-12)
    # α + 2β ≥ 0 bounds nothing
    assert np.degrees(cone(gradient[1:], [-1, 1])) == pytest.approx(found, abs=1e-12)
    _, signs = sectors(gradient)
    assert len(signs) == len(np.unique(signs, axis=0)) == 6


def test_cones_against_every_direction() -> None:
    random = np.random.default_rng(4)
    around = np.linspace(-np.pi, np.pi, 20001)
    way = np.stack([np.cos(around), np.sin(around)], axis=-1)
    for _ in range(200):
        gradient = random.normal(size=(4, 2))
        signs = random.choice([-1, 1], size=4)
        low, high = cone(gradient, signs)
        inside = np.all(signs * (way @ gradient.T) >= 0, axis=-1)
        if np.isnan(low):
            # a cone narrower than the step between directions may hide
            assert not inside.any()
            continue
        apart = (around - (low + high) / 2 + np.pi) % (2 * np.pi) - np.pi
        clear = np.abs(np.abs(apart) - (high - low) / 2) > 1e-9
        assert np.array_equal(inside[clear], (np.abs(apart) < (high - low) / 2)[clear])
        angles, patterns = sectors(gradient)
        assert len(patterns) <= 8
        assert angles[:, 1] - angles[:, 0] == pytest.approx(
            [np.ptp(cone(gradient, p)) for p in patterns], abs=1e-9
        )


def test_a_drive_that_stands_still_bounds_no_cone() -> None:
    assert cone([[0.0, 0.0], [0.0, 1.0]], [1, 1]) == pytest.approx([0.0, np.pi])
    assert cone([[0.0, 0.0]], [1]) == pytest.approx([-np.pi, np.pi])
    _, signs = sectors([[0.0, 0.0], [0.0, 1.0]])
    assert sorted(signs[:, 1]) == [-1, 1]
    assert not signs[:, 0].any()


# singular points -----------------------------------------------------------------------------


def test_flat_surface_and_vertical_tool_of_a_hexapod() -> None:
    """Each leg stands upright at one place, (feet − seats), and is shortest there."""
    machine = HexelHexapod()
    grid = np.linspace(-0.4, 0.4, 17)
    found = reversals(hexapod(Plane(("x", "y"))), grid, grid)
    wanted = (machine.feet - machine.seats)[:, :2]
    for drive, place in zip(found.singular, wanted, strict=True):
        (point,) = drive.points
        assert (point.kind, drive.winding, drive.complete) == ("strong", 1, True)
        assert point.place == pytest.approx(place, abs=1e-9)
        assert np.linalg.norm(point.place) == pytest.approx(305.01e-3, abs=5e-6)
        # 1/l: h = 600 mm between foot and seat
        assert point.hessian == pytest.approx(np.eye(2) / 0.6, abs=1e-9)


def test_planar_machine_with_a_table_has_whole_lines() -> None:
    machine, table = MitSS1(), WorkTable()
    upright = np.array([-0.2025, 0.2125, 0.1575])

    def values(points: Array) -> Array:
        tip = np.stack([points[:, 0], 0 * points[:, 0], 0 * points[:, 0]], axis=-1)
        placement = machine.place(Poses(tip, np.eye(3) + np.zeros((len(points), 3, 3))))
        # on the table the tool's place along y is its slide
        work = np.stack([points[:, 0], points[:, 1], 0 * points[:, 0]], axis=-1)
        slide = table.drive_values(work, np.zeros(len(points)))
        # where one strut is too short another may reach: each for itself
        reached = np.abs(points[:, :1].real - upright) < machine.strut_lengths
        struts = np.where(reached, drive_values(machine, placement), complex(np.nan, np.nan))
        return np.concatenate([struts, slide], axis=-1)

    field = FormulaField(("strut 1", "strut 2", "strut 3", "slide", "turn"), stepped(values))
    found = reversals(field, np.linspace(-0.3, 0.3, 25), np.linspace(-0.1, 0.1, 5))
    # the table does not turn: it is excluded, not singular
    assert [field.drives[k] for k in found.moving] == ["strut 1", "strut 2", "strut 3", "slide"]
    for drive, x in zip(found.singular, upright, strict=False):
        assert (drive.points, drive.complete) == ((), None)
        (line,) = drive.lines
        assert line[:, 0] == pytest.approx(np.full(len(line), x), abs=1e-9)
        assert (line[0, 1], line[-1, 1]) == (pytest.approx(-0.1), pytest.approx(0.1))
    slide = found.singular[3]
    assert (slide.points, slide.lines, slide.winding) == ((), (), 0)


def test_serial_machine_never_turns_back() -> None:
    model = load("examples/machines/gantry.toml")
    axis = np.linspace(-0.1, 0.1, 5)
    found = reversals(MotionField(model.motion, Plane(("x", "y"))), axis, axis)
    # two ball screws move the bridge; the upright slide stands still
    names = [model.structure.linkage.driven[k][0] for k in found.moving]
    assert len(names) == 3
    assert [(d.points, d.lines, d.winding) for d in found.singular] == [((), (), 0)] * 3
    assert found.plates.max() == 1
    assert found.reach((2, 2)).all()


def bumpy(points: Array) -> tuple[Array, Array, Array]:
    """Height of a curved patch and its slopes, m."""
    k = 2 * np.pi / 0.12
    x, y = points[:, 0], points[:, 1]
    height = 0.006 * np.sin(k * x) * np.cos(0.8 * k * y) - x * x
    return (
        height,
        0.006 * k * np.cos(k * x) * np.cos(0.8 * k * y) - 2 * x,
        -0.006 * 0.8 * k * np.sin(k * x) * np.sin(0.8 * k * y),
    )


def test_strong_less_weak_points_are_the_winding_with_the_tool_normal() -> None:
    """All four drives that the normal orientation moves on the struts' side and the slide."""
    machine, table = MitSS1(), WorkTable()

    def values(points: Array) -> Array:
        z, slope_x, slope_y = bumpy(points)
        size = np.sqrt(1 + slope_x * slope_x + slope_y * slope_y)
        n = np.stack([-slope_x, -slope_y, 1 + 0 * z], axis=-1) / size[:, None]
        a = -angle(n[:, 1], n[:, 2])
        b = angle(n[:, 0], np.sqrt(n[:, 1] ** 2 + n[:, 2] ** 2))
        work = np.stack([points[:, 0], points[:, 1], z], axis=-1)
        tip = table.tool_position(work, a) - np.array([0, 0, 0.2])
        struts = drive_values(machine, machine.place(Poses(tip, rotation_y(b))))
        return np.concatenate([struts, table.drive_values(work, a)[:, :1]], axis=-1)

    field = FormulaField(("strut 1", "strut 2", "strut 3", "slide"), stepped(values))
    found = reversals(field, np.linspace(-0.05, 0.045, 33), np.linspace(-0.04, 0.055, 33))
    assert [d.complete for d in found.singular] == [True] * 4
    assert all(d.strong + d.weak > 0 for d in found.singular)
    for k, drive in enumerate(found.singular):
        at = np.array([p.place for p in drive.points])
        size = np.abs(found.gradient[:, :, k]).max()
        assert np.abs(field.gradient(at)[:, k]).max() <= 1e-9 * size


def test_kinds_by_formula() -> None:
    field = FormulaField(
        ("bowl", "saddle", "eggs"),
        stepped(
            lambda p: np.stack(
                [
                    p[:, 0] ** 2 + 3 * p[:, 1] ** 2,
                    (p[:, 0] - 0.1) * (p[:, 1] + 0.2),
                    np.cos(np.pi * p[:, 0]) * np.cos(np.pi * p[:, 1]),
                ],
                axis=-1,
            )
        ),
    )
    # eggs: strong at the integers, weak at the half ones, as the cosines' product has it
    found = reversals(field, np.linspace(-1.3, 1.2, 26), np.linspace(-1.25, 1.35, 26))
    bowl, saddle, eggs = found.singular
    assert [(d.strong, d.weak, d.winding) for d in (bowl, saddle)] == [(1, 0, 1), (0, 1, -1)]
    assert saddle.points[0].place == pytest.approx([0.1, -0.2], abs=1e-9)
    assert (eggs.strong, eggs.weak, eggs.winding) == (9, 4, 5)
    assert eggs.complete


def test_the_index_finds_what_a_coarse_grid_misses() -> None:
    """Two zeros of the gradient within one cell: the winding 2 asks for a finer grid."""

    def gradient(points: Array) -> Array:
        # z² − c, as a field (Re, −Im): of the harmonic Re(z³/3 − c z), saddles at ±√c
        z = points[:, 0] + 1j * points[:, 1] - (0.02 + 0.013j)
        w = z * z - (0.06 + 0.01j) ** 2
        return np.stack([w.real, -w.imag], axis=-1)[:, None]

    found = reversals(FormulaField(("one",), gradient), *[np.linspace(-1, 1, 4)] * 2)
    (drive,) = found.singular
    assert (drive.strong, drive.weak, drive.winding, drive.complete) == (0, 2, -2, True)


# gradients from the rows -----------------------------------------------------------------------


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


# lines, plates, paths --------------------------------------------------------------------------


def circles() -> FormulaField:
    """Along u it turns back on a circle of radius 0.7; a second drive follows v."""
    return FormulaField(
        ("ring", "plain"),
        lambda p: np.stack(
            [
                np.stack([(p * p).sum(-1) - 0.49, 2 * p[:, 0] * p[:, 1]], axis=-1),
                np.stack([0 * p[:, 0], 1 + 0 * p[:, 0]], axis=-1),
            ],
            axis=1,
        ),
    )


def test_reversal_line_is_the_whole_circle() -> None:
    found = reversals(circles(), np.linspace(-1, 1, 22), np.linspace(-1, 1, 23))
    lines = found.lines([1, 0])
    # the feed does not move the second drive
    assert list(lines) == ["ring"]
    (line,) = lines["ring"]
    assert np.array_equal(line[0], line[-1])
    assert np.linalg.norm(line, axis=-1) == pytest.approx(np.full(len(line), 0.7), abs=1e-9)
    around = np.unwrap(np.arctan2(line[:, 1], line[:, 0]))
    assert abs(around[-1] - around[0]) == pytest.approx(2 * np.pi)


def test_two_lines_through_one_cell_stay_apart() -> None:
    """A hyperbola whose branches pass the cell in the middle: its centre says how."""
    for sign in (1.0, -1.0):
        field = FormulaField(
            ("one",),
            lambda p, s=sign: np.stack([p[:, 0] * p[:, 1] - s * 0.01, 0 * p[:, 0] + 1], -1)[
                :, None
            ],
        )
        found = reversals(field, *[np.linspace(-1.5, 1.5, 4)] * 2)
        lines = found.lines([1, 0])["one"]
        assert len(lines) == 2
        for line in lines:
            product = np.sign(line[:, 0]) * np.sign(line[:, 1])
            assert np.all(product == sign)


def test_plates_and_their_borders() -> None:
    """det(C₁, C₂) of (1, 0) and (u, v) is v: two plates, whose border is v = 0."""
    field = FormulaField(
        ("first", "second"),
        lambda p: np.stack([np.broadcast_to([1.0, 0.0], p.shape), p], axis=1),
    )
    found = reversals(field, np.linspace(-1, 1, 8), np.linspace(-1, 1, 10))
    assert found.plates.max() == 2
    assert (found.plates[:, 5:] == 2).all() ^ (found.plates[:, 5:] == 1).all()
    ((line,),) = found.plate_borders().values()
    assert np.abs(line[:, 1]).max() <= 1e-9


def test_reach_goes_round_no_extremum() -> None:
    """f = u² + v² beside u and v, from (a, 0): beyond the middle all of |v| < a is lost.

    A path there crosses u = 0, where f = v²; v keeps its way and has less than a to go, so that
    f has fallen, and has to grow again.
    """
    field = FormulaField(
        ("bowl", "along", "across"),
        lambda p: np.stack(
            [2 * p, np.broadcast_to([1.0, 0.0], p.shape), np.broadcast_to([0.0, 1.0], p.shape)],
            axis=1,
        ),
    )
    shares = []
    for half in (10, 20):
        axis = np.linspace(-1, 1, 2 * half + 1)
        seen = reversals(field, axis, axis).reach((3 * half // 2, half))
        u, v = np.meshgrid(axis, axis, indexing="ij")
        lost = (np.abs(v) < 0.5 - 1e-9) & (u < -1e-9)
        assert not seen[lost].any()
        shares.append(float(seen[~lost].mean()))
    # all the rest can be reached: where the way is narrow, along the circle, by a finer grid
    assert 0.7 < shares[0] < shares[1] - 0.02


def test_reversals_along_a_path_and_the_longest_clear_one() -> None:
    field = circles()
    path = path_reversals(field, [[-1, 0.3], [1, 0.3], [1, -0.3]])
    edge = np.sqrt(0.49 - 0.09)
    assert path.drives[:2] == ("ring", "ring")
    assert path.places[:2] == pytest.approx(np.array([[-edge, 0.3], [edge, 0.3]]), abs=1e-9)
    assert path.along[:2] == pytest.approx([(1 - edge) / 2, (1 + edge) / 2], abs=1e-9)
    # the second drive stands still on the first piece and moves on the second
    assert path.signs.tolist() == [[1, 0], [-1, -1]]
    # on the second piece the first drive goes back at v = 0, where it also stood at the corner
    assert path.along[2:] == pytest.approx([1.0, 1.5])
    found = reversals(field, np.linspace(-1, 1, 21), np.linspace(-1, 1, 21))
    longest = found.longest([[1, 0]])
    assert longest is not None
    # at v = ±0.7 and beyond it runs through
    assert longest.length == pytest.approx(2.0, abs=1e-12)
    assert abs(longest.start[1]) >= 0.7
    narrow = reversals(field, np.linspace(-1, 1, 21), np.linspace(-0.1, 0.1, 21)).longest([[1, 0]])
    assert narrow is not None
    assert narrow.length == pytest.approx(2 * 0.7, abs=1e-9)


def test_length_of_a_path_over_a_dome_is_its_arc() -> None:
    field = hexapod(Dome(sphere(0.3, [0.0, 0.0, 0.4])))
    axis = np.linspace(-0.1, 0.1, 5)
    longest = reversals(field, axis, axis).longest([[1.0, 0.0]], lines=1)
    assert longest is not None
    low, high = (np.arcsin(p[0] / 0.3) for p in (longest.start, longest.end))
    assert longest.length == pytest.approx(0.3 * (high - low), abs=1e-9)


# bad input -------------------------------------------------------------------------------------


def test_bad_input_is_named() -> None:
    with pytest.raises(ModelError, match='unknown direction "w"'):
        Plane(("x", "w"))
    with pytest.raises(ModelError, match="names x twice"):
        Plane(("x", "x"))
    with pytest.raises(ModelError, match="radius 0 m"):
        sphere(0.0, [0, 0, 0])
    axis = np.linspace(-0.1, 0.1, 5)
    with pytest.raises(ModelError, match="beyond the sphere's radius of 50 mm"):
        reversals(hexapod(Dome(sphere(0.05, [0, 0, 0.4]))), axis, axis)
    with pytest.raises(ModelError, match="second parameter: is no ascending row"):
        reversals(circles(), axis, axis[::-1])
    with pytest.raises(UnreachableError, match="no point that the machine can take"):
        reversals(hexapod(Dome(sphere(0.5, [0, 0, 2.0]))), axis, axis)
    with pytest.raises(ModelError, match="in rx"):
        MotionField(
            load("examples/machines/linear-delta.toml").motion,
            Dome(sphere(0.5, [0, 0, 0]), "normal"),
        ).gradient(np.zeros((1, 2)))
    mixed = hexapod(Plane(("x", "rx")))
    with pytest.raises(ModelError, match="mixes x and rx"):
        mixed.speed(np.zeros((1, 2)), np.array([1.0, 1.0]))
