"""Section III of Corbel et al. 2008: the Delta's condition and the spacing of its rods.

@inproceedings{corbel2008,
  author    = {Corbel, D. and Company, O. and Pierrot, F.},
  title     = {Optimal design of a 6-dof parallel measurement mechanism integrated in a 3-dof
               parallel machine-tool},
  booktitle = {IEEE/RSJ International Conference on Intelligent Robots and Systems},
  year      = {2008}
}

The document prints no condition number. The formula beside which the package is held is its
eqs. 2 to 4, written out here: row i of the inverse Jacobian is (a_i/h_i, 1), with
h_i = √(L² − |a_i|²).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.kinematics import Poses
from strutwork.kinematics.frames import cross_matrix
from strutwork.machines import LinearDelta
from strutwork.machines.linear_delta import LEGS, SIDES, leg
from strutwork.overconstraint import Tolerance
from strutwork.overconstraint.accuracy import accuracy
from strutwork.papers.corbel_2008.actuation import (
    FLAT,
    RODS,
    best_reach,
    condition,
    rod_gain,
    singular_values,
    square,
    turn_by_difference,
    with_reach,
    worst_conditions,
    worst_deviation,
    worst_turn,
)

Array = NDArray[np.float64]


def formula(rod: float, reach: float, places: Array) -> Array:
    """The inverse Jacobian by the document's equations, (..., 3, 3)."""
    x, y = places[..., 0], places[..., 1]
    s = np.sqrt(3.0) / 2.0
    a = np.stack(
        [
            np.stack([x + s * reach, y + reach / 2.0], -1),
            np.stack([x, y - reach], -1),
            np.stack([x - s * reach, y + reach / 2.0], -1),
        ],
        -2,
    )
    h = np.sqrt(rod**2 - (a**2).sum(-1))
    return np.concatenate([a / h[..., None], np.ones((*h.shape, 1))], -1)


def formula_worst(rod: float, reach: float, steps: int = 41) -> float:
    line = np.linspace(-0.15, 0.15, steps)
    places = np.stack(np.meshgrid(line, line, [0.0], indexing="ij"), -1)
    return float(np.linalg.cond(formula(rod, reach, places)).max())


def test_largest_condition_number_at_the_printed_dimensions() -> None:
    """1e-8: of the formula at the same places; 1e-4: digits of our first derivation."""
    machine = LinearDelta()
    places = square(machine, 7)
    found = condition(machine, places)
    np.testing.assert_allclose(found, np.linalg.cond(formula(0.8, 0.48, places)), rtol=1e-8)
    assert found.max() == pytest.approx(2.4591, abs=1e-4)
    worst = places[np.isclose(found, found.max(), rtol=1e-9), :2]
    assert sorted(worst.tolist()) == [[-0.15, 0.15], [0.15, 0.15]]
    assert condition(machine, [0.0, 0.0, 0.0]) == pytest.approx(1.8856, abs=1e-4)
    # √2 h/ΔR, as h/ΔR is above √(1/2)
    assert condition(machine, [0.0, 0.0, 0.0]) == pytest.approx(np.sqrt(2.0) * 0.64 / 0.48)
    # a grid of this step misses the ends of the range by less than its digits
    values = singular_values(machine, square(machine, 13))
    assert (values.min(), values.max()) == pytest.approx((0.471, 1.159), abs=1e-3)


def test_the_place_along_the_rails_does_not_count() -> None:
    machine = LinearDelta()
    places = square(machine, 4)
    apart = places + np.array([0.0, 0.0, 0.13])
    np.testing.assert_allclose(condition(machine, apart), condition(machine, places), rtol=1e-10)


def test_isotropy_in_the_middle() -> None:
    """1e-9: three equal singular values are found to the root of rounding or better."""
    machine = with_reach(LinearDelta(workspace_side=0.15), np.sqrt(2.0 / 3.0) * 0.8)
    found = singular_values(machine, [0.0, 0.0, 0.0])
    np.testing.assert_allclose(found, 1.0 / np.sqrt(3.0), rtol=1e-9)


def test_few_places_hold_the_worst() -> None:
    """The grid of the studies against the formula on one that is twenty times as fine."""
    pairs = ((0.7, 0.3), (0.7, 0.46), (0.8, 0.48), (0.8, 0.56), (1.0, 0.7), (1.1, 0.4))
    made = [with_reach(LinearDelta(), reach, rod) for rod, reach in pairs]
    expected = [formula_worst(rod, reach) for rod, reach in pairs]
    np.testing.assert_allclose(worst_conditions(made), expected, rtol=1e-8)


#: L, best ΔR and its largest condition number: our first derivation, by the formula.
BEST = ((0.7, 0.4017, 2.7112), (0.8, 0.4873, 2.4556), (0.9, 0.5732, 2.2683), (1.0, 0.6592, 2.1245))


@pytest.mark.parametrize(("rod", "reach", "worst"), BEST)
def test_best_reach_by_the_length_of_the_rods(rod: float, reach: float, worst: float) -> None:
    """1e-4: half a digit of what is stated, and flat; the printed ΔR is within 1 %."""
    found = best_reach(rod)
    assert (found.reach, found.worst) == pytest.approx((reach, worst), abs=1e-4)
    for end in (found.low, found.high):
        assert formula_worst(rod, end, 3) == pytest.approx((1.0 + FLAT) * found.worst, rel=1e-5)
    # no other is better
    others = [formula_worst(rod, r, 3) for r in np.linspace(0.3 * rod, 0.95 * rod - 0.21, 60)]
    assert min(others) >= found.worst * (1.0 - 1e-9)
    if rod == 0.8:
        assert found.low < 0.480 < found.high
        assert (found.low, found.high) == pytest.approx((0.468, 0.504), abs=2e-3)


def test_longer_rods_move_more_evenly() -> None:
    assert [b[0] for b in BEST] == list(RODS)
    least = [b[2] for b in BEST]
    assert least == sorted(least, reverse=True)


def turned(machine: LinearDelta, places: Array, difference: Array) -> Array:
    """Rotation by differences of the parallelograms' rods, (..., 3): d (t_i × u_i)·ω = δ_i."""
    inverse = formula(machine.rod_length, machine.reach, places)
    # of a rod (a, h)/L
    u = inverse / np.linalg.norm(inverse, axis=-1, keepdims=True)
    s = np.sqrt(3.0) / 2.0
    tangent = np.array([[0.5, -s, 0.0], [-1.0, 0.0, 0.0], [0.5, s, 0.0]])
    rows = machine.rod_spacing * np.cross(tangent, u)
    return np.linalg.solve(rows, np.broadcast_to(difference, rows.shape[:-1])[..., None])[..., 0]


def test_a_difference_of_two_rods_turns_the_platform() -> None:
    """1e-8 against the three equations of the parallelograms; about δ/d, within a ninth."""
    machine = LinearDelta()
    places = square(machine, 5)
    found = turn_by_difference(machine, places)
    for i in range(3):
        expected = np.linalg.norm(turned(machine, places, np.eye(3)[i]), axis=-1)
        np.testing.assert_allclose(found[:, i], machine.rod_spacing * expected, rtol=1e-8)
    middle = turn_by_difference(machine, [0.0, 0.0, 0.0])
    # L √(1/(9 ΔR²) + 4/(9 h²))
    np.testing.assert_allclose(middle, 0.8 * np.hypot(1 / (3 * 0.48), 2 / (3 * 0.64)), rtol=1e-8)
    assert found.min() > 1.0 - 1e-6
    assert found.max() < 1.11


def test_rotation_falls_with_the_spacing() -> None:
    """As 1/d exactly, while the Jacobian stays what it is."""
    machine = LinearDelta()
    places = square(machine, 3)
    wide = replace(machine, rod_spacing=2.0 * machine.rod_spacing)
    np.testing.assert_allclose(
        worst_turn(wide, places), 0.5 * worst_turn(machine, places), rtol=1e-9
    )
    np.testing.assert_allclose(condition(wide, places), condition(machine, places), rtol=1e-9)
    assert np.all(worst_deviation(wide, places, 0.2) < worst_deviation(machine, places, 0.2))


def test_toleranced_rods_move_the_tool_as_the_rows_say() -> None:
    """The tolerances of `overconstraint` with the structure's own choice: rows, no stiffness."""
    machine = LinearDelta()
    size = 10e-6
    rods = [
        Tolerance(f"rod {i}{s}", "length", (leg(i, f"ball-{s}"),), size=size)
        for i in LEGS
        for s in SIDES
    ]
    place = np.array([0.15, 0.15, 0.0])

    found = accuracy(machine.structure.at(machine.place(Poses.of(place))), rods)
    assert not found.elastic
    np.testing.assert_allclose(found.gain, size * rod_gain(machine, place), atol=1e-12)
    # the worst case in any direction, by its certified search, is that of the vertices
    largest = np.linalg.norm(found.largest()[0])
    assert largest == pytest.approx(size * float(worst_deviation(machine, place, 0.0)), rel=1e-4)
    # and none inside is worse, at a tool point ahead of the plate
    gain = rod_gain(machine, place)
    ahead = gain[:3] - cross_matrix([0.0, 0.0, 0.2]) @ gain[3:]
    inside = np.random.default_rng(2).uniform(-1.0, 1.0, (6, 2000))
    moved = np.linalg.norm(ahead @ inside, axis=0)
    assert moved.max() < float(worst_deviation(machine, place, 0.2))
