"""The index of a gradient along the border counts its zeros inside, on random smooth patches."""

from __future__ import annotations

from typing import Any

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from strutwork.kinematics.drive_fields import FormulaField
from strutwork.kinematics.reversals import reversals

Array = NDArray[Any]

#: Plane waves of a patch.
WAVES = 4

#: Points along each side when the border is walked without the product, and its grid.
BORDER, GRID = 4000, np.linspace(-1.0, 1.0, 25)


def waves(seed: int) -> tuple[Array, Array, Array, Array]:
    """Amplitudes, wave vectors and phases of a sum of waves, and the slope of a plane below it."""
    draw = np.random.default_rng(seed)
    return (
        draw.uniform(0.3, 1.0, WAVES),
        draw.uniform(-3.0, 3.0, (WAVES, 2)),
        draw.uniform(0.0, 2 * np.pi, WAVES),
        draw.uniform(-1.0, 1.0, 2),
    )


def slope(patch: tuple[Array, Array, Array, Array], points: Array) -> Array:
    """Gradient of the patch's height at points (p, 2), (p, 2)."""
    size, way, phase, plane = patch
    return np.asarray(plane - (size * np.sin(points @ way.T + phase)) @ way)


def turns(patch: tuple[Array, Array, Array, Array]) -> tuple[int, float]:
    """Turns of the gradient once around the square, and its least size there over its largest."""
    t = np.linspace(-1.0, 1.0, BORDER)
    one = np.ones_like(t)
    border = np.concatenate(
        [np.stack(side, axis=-1) for side in ((t, -one), (one, t), (-t, one), (-one, -t))]
    )
    g = slope(patch, border)
    angle = np.unwrap(np.arctan2(g[:, 1], g[:, 0]))
    size = np.linalg.norm(g, axis=-1)
    return round(float(angle[-1] - angle[0]) / (2 * np.pi)), float(size.min() / size.max())


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=40, deadline=None)
def test_strong_less_weak_is_the_winding_along_the_border(seed: int) -> None:
    patch = waves(seed)
    wound, least = turns(patch)
    # a zero on the border itself has no index: the walk must stay clear of it
    assume(least > 0.02)
    field = FormulaField(("one",), lambda points: slope(patch, points)[:, None])
    (drive,) = reversals(field, GRID, GRID).singular
    assert drive.winding == wound
    assert drive.complete is True
    assert drive.strong - drive.weak == wound
    at = np.array([p.place for p in drive.points]).reshape(-1, 2)
    assert np.abs(slope(patch, at)).max(initial=0.0) < 1e-8
