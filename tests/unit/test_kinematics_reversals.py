"""Singular points of drives over surfaces and their index."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import ModelError, UnreachableError
from strutwork.kinematics import Poses, drive_values
from strutwork.kinematics.drive_fields import FormulaField, MotionField
from strutwork.kinematics.motion import Motion
from strutwork.kinematics.reversals import reversals
from strutwork.kinematics.task_surfaces import Dome, Plane, sphere
from strutwork.machines import HexelHexapod, MitSS1, WorkTable
from strutwork.machines.load import load
from strutwork.papers.son_2002.five_axes import five_axes_field

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
    # a grid of fewer points than the longest step has cells
    small = reversals(MotionField(model.motion, Plane(("x", "y"))), axis[1:4], axis[1:4])
    assert small.reach((1, 1)).all()


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

    def surface(points: Array) -> tuple[Array, Array]:
        z, slope_x, slope_y = bumpy(points)
        normal = np.stack([-slope_x, -slope_y, 1 + 0 * z], axis=-1)
        return np.stack([points[:, 0], points[:, 1], z], axis=-1), normal

    whole = five_axes_field(surface)
    field = FormulaField(whole.drives[:4], lambda points: whole.gradient(points)[:, :4])
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
    with pytest.raises(ModelError, match="second parameter: is not an ascending row"):
        reversals(hexapod(Plane(("x", "y"))), axis, axis[::-1])
    with pytest.raises(UnreachableError, match="no point that the machine can reach"):
        reversals(hexapod(Dome(sphere(0.5, [0, 0, 2.0]))), axis, axis)
    with pytest.raises(ModelError, match="in rx"):
        MotionField(
            load("examples/machines/linear-delta.toml").motion,
            Dome(sphere(0.5, [0, 0, 0]), "normal"),
        ).gradient(np.zeros((1, 2)))
    mixed = hexapod(Plane(("x", "rx")))
    with pytest.raises(ModelError, match="mixes x and rx"):
        mixed.speed(np.zeros((1, 2)), np.array([1.0, 1.0]))
