"""The certified worst case against enumeration: corners of the zones, azimuths, closed forms."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from itertools import product
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.overconstraint import Responses, Tolerance, tolerance_responses, worst_case
from tests.assemblies import block_on_joints
from tests.structures import Model

Array = NDArray[Any]


def sizes(asked: Responses, z: Array) -> Array:
    """Quantities at parameters (s, k), (s, q)."""
    return np.asarray(np.linalg.norm(asked.mean + np.einsum("qik,sk->sqi", asked.gain, z), axis=-1))


def corners(asked: Responses) -> Array:
    """All corners of zones that are intervals and octahedra, (s, k)."""
    options = []
    for block in asked.sources.blocks:
        d = block.shape.dimension
        assert type(block.shape).__name__ in ("Interval", "PlaneZone")
        options.append([s * e for e in np.eye(d) for s in (1.0, -1.0)])
    return np.array([np.concatenate(choice) for choice in product(*options)])


@pytest.mark.parametrize("seed", range(3))
def test_zones_with_corners_are_worst_at_one_of_them(seed: int) -> None:
    """A convex size is largest at a corner: all 2⁷ · 6² of them, exactly."""
    tolerances = [
        Tolerance("seats", "flatness", ("J0", "J2", "J4"), size=1e-5),
        Tolerance("l1", "length", ("J1",), limits=(-1e-5, 4e-5)),
        Tolerance("l3", "length", ("J3", "J1"), size=2e-5),
        Tolerance("l0", "length", ("J0",), size=2e-5, axis=(1.0, 0.0, 0.0)),
        Tolerance("face", "location", ("J2", "J0"), size=3e-5, length=0.3, width=0.2),
        Tolerance("side", "location", ("J4",), size=3e-5),
        Tolerance("other", "location", ("J3",), size=3e-5, length=0.1, width=0.4),
    ]
    asked = tolerance_responses(block_on_joints(seed, 5, "all").place(), tolerances)
    worst = worst_case(asked)
    exact = sizes(asked, corners(asked)).max(axis=0)
    np.testing.assert_allclose(worst.value, exact, rtol=2e-9)
    assert np.all(worst.bound >= exact * (1 - 1e-12))
    assert np.any(asked.mean)


@pytest.mark.parametrize("kind", ["position", "point_position"])
def test_one_round_zone_is_worst_at_its_largest_singular_value(kind: str) -> None:
    asked = tolerance_responses(
        block_on_joints(2, 4, "all").place(), [Tolerance("a", kind, ("J0", "J2"), size=1e-5)]
    )
    exact = np.linalg.svd(asked.gain, compute_uv=False)[:, 0]
    np.testing.assert_allclose(worst_case(asked).value, exact, rtol=2e-9)


@pytest.mark.parametrize("seed", range(2))
def test_three_tilted_axes_against_every_azimuth(seed: int) -> None:
    """72³ azimuths: never above, and within what five degrees between two hide."""
    tolerances = [
        Tolerance(f"axis {i}", "parallelism", joints, slope=3e-4)
        for i, joints in enumerate((("J0", "J2"), ("J1", "J3"), ("J4", "J0")))
    ]
    asked = tolerance_responses(block_on_joints(seed, 5).place(), tolerances)
    worst = worst_case(asked)
    turn = np.radians(np.arange(0, 360, 5))
    circle = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    for q in (0, 1, 6, 9, 10, 15):
        a, b, c = (circle @ asked.gain[q][:, 2 * i : 2 * i + 2].T for i in range(3))
        total = a[:, None, None] + b[None, :, None] + c[None, None, :]
        largest = np.linalg.norm(total, axis=-1).max()
        assert largest <= worst.bound[q] * (1 + 1e-12)
        # half a step beside the worst in all three: 1 − cos 2.5°
        assert largest >= np.cos(np.radians(2.5)) * worst.value[q] * (1 - 1e-9)


def test_axial_force_is_a_sum_of_norms() -> None:
    tolerances = [
        Tolerance(f"axis {i}", "position", (f"J{i}",), size=1e-5 * (i + 1)) for i in range(4)
    ]
    asked = tolerance_responses(block_on_joints(5, 4).place(), tolerances)
    q = asked.index("J1", "axial force")
    parts = np.linalg.norm(asked.gain[q, 0].reshape(4, 2), axis=-1)
    worst = worst_case(asked)
    assert worst.value[q] == pytest.approx(parts.sum(), rel=1e-12)
    assert worst.bound[q] == worst.value[q]
    np.testing.assert_allclose(worst.shares[q], parts / parts.sum(), rtol=1e-12)


def around(radius: float = 1.0) -> Model:
    """A block on four alike joints on a circle and one in the middle: all azimuths are alike."""
    model = Model("tool")
    places = {"C": (0.0, 0.0, 0.0)}
    for i, (x, y) in enumerate(((1, 0), (0, 1), (-1, 0), (0, -1))):
        places[f"J{i}"] = (radius * x, radius * y, 0.0)
    model.nodes(tool=(0, 0, 0))
    for name, place in places.items():
        model.ground(**{f"g{name}": place})
        model.joint(name, "bushing", (f"g{name}", f"p{name}"), stiffness=dict.fromkeys("xyz", 2e6))
    model.rigid("block", "tool", *(f"p{name}" for name in places))
    return model


def test_a_force_that_is_alike_in_every_direction_is_certified_at_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Every direction is as bad, and no arc can be left out: S = 4/5 k, by hand."""
    monkeypatch.setattr(import_module("strutwork.overconstraint.worst_case"), "STEPS", 1)
    asked = tolerance_responses(around().place(), [Tolerance("c", "position", ("C",), size=2e-5)])
    worst = worst_case(asked)
    q = asked.index("C", "radial force")
    assert worst.value[q] == pytest.approx(4 / 5 * 2e6 * 1e-5, rel=1e-12)
    assert worst.bound[q] <= worst.value[q] * (1 + 1.001e-9)


@pytest.mark.parametrize("roundness", [0.0, 0.5, 0.99, 1 - 1e-7])
def test_round_and_cornered_zones_together_are_certified_in_a_few_steps(
    roundness: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    """From a line to nearly a circle: never more steps than a slender ellipse takes."""
    monkeypatch.setattr(import_module("strutwork.overconstraint.worst_case"), "STEPS", 10)
    tolerances = [
        Tolerance("c", "position", ("C",), size=2e-5),
        Tolerance("l", "length", ("C",), limits=(-1e-7, 3e-7), axis=(0.6, 0.8, 0.0)),
    ]
    asked = tolerance_responses(around().place(), tolerances)
    squeezed = replace(asked, gain=asked.gain * np.array([1.0, roundness])[:, None])
    worst = worst_case(squeezed)
    q = asked.index("C", "radial force")
    turn = np.linspace(0, 2 * np.pi, 100_001)
    e = np.stack([np.cos(turn), np.sin(turn)])
    parts = squeezed.gain[q].T @ e
    f = squeezed.mean[q] @ e + np.hypot(parts[0], parts[1]) + np.abs(parts[2])
    assert f.max() <= worst.bound[q] * (1 + 1e-12)
    assert f.max() >= worst.value[q] * (1 - 1e-8)


def test_limits_off_the_middle_add_to_the_worst() -> None:
    """A length between −1 and 3 hundredths: the worst is at 3, the share of its range 2/3."""
    tolerance = Tolerance("c", "length", ("C",), limits=(-1e-5, 3e-5), axis=(1.0, 0.0, 0.0))
    asked = tolerance_responses(around().place(), [tolerance])
    worst = worst_case(asked)
    q = asked.index("C", "radial force")
    assert worst.value[q] == pytest.approx(4 / 5 * 2e6 * 3e-5, rel=1e-9)
    np.testing.assert_allclose(worst.misfits(q), [3e-5], rtol=1e-9)
    assert worst.shares[q, 0] == pytest.approx(2 / 3, rel=1e-6)


def test_nothing_to_tolerate_is_nothing_at_worst() -> None:
    worst = worst_case(tolerance_responses(block_on_joints(1).place(), []))
    np.testing.assert_array_equal(worst.value, 0.0)
    np.testing.assert_array_equal(worst.bound, 0.0)
    assert worst.parameters.shape == worst.shares.shape == (len(worst.value), 0)


def test_what_no_tolerance_reaches_is_zero_with_no_share() -> None:
    """Six struts in a row of joints without redundancy: the tool moves, the forces are zero."""
    model = block_on_joints(3, 2, "xyz")
    model.joints = [replace(model.joints[0], stiffness=dict.fromkeys(("x", "y", "z"), 1e6))]
    model.joints.append(
        replace(model.joints[0], name="R", stiffness=dict.fromkeys(("rx", "ry", "rz"), 1e5))
    )
    model.axes["R"] = model.axes["J0"]
    asked = tolerance_responses(model.place(), [Tolerance("a", "position", ("J0",), size=1e-5)])
    worst = worst_case(asked)
    joint = [q.joint is not None for q in asked.quantities]
    np.testing.assert_array_equal(worst.value[joint], 0.0)
    np.testing.assert_array_equal(worst.shares[joint], 0.0)
    assert worst.value[asked.index(None, "displacement")] > 0
    assert np.all(np.isfinite(worst.shares))
