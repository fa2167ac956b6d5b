"""Joint forces in closed form: two cantilevers whose tips a joint joins with a misfit.

With C₁ and C₂ the compliances of the tips, E the locked directions and g the misfit, the force
on the second node is λ = [E (C₁ + C₂) Eᵀ]⁻¹ g: it pulls the second side along the misfit.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from strutwork.errors import ModelError
from strutwork.kinematics import DIRECTIONS, JOINT_TYPES
from strutwork.msa import LoadCase, PlacedStructure, solve
from tests.structures import BAR, TUBE, Model, cantilever_compliance, wrench

KINDS = [kind for kind in JOINT_TYPES if kind not in ("support", "bushing")]
GAP = dict(zip(DIRECTIONS, (1e-4, -2e-4, 3e-4, 1e-3, 2e-3, -4e-3), strict=True))
SOLVED = 1e-9


#: Of a steep screw, m.
PITCH = 0.25


def in_line(kind: str, turn: np.ndarray | None = None, **options: Any) -> Model:
    """One cantilever along +x, one along −x; joint axes are the global ones, then all turned."""
    if kind == "helical":
        options |= {"pitch": PITCH}
    model = Model("t1")
    model.nodes(r1=(0, 0, 0), t1=(0.5, 0, 0), r2=(0.9, 0, 0))
    model.joint("J", kind, ("t1", "t2"), **options)
    model.beam("first", "r1", "t1", BAR)
    model.beam("second", "r2", "t2", TUBE)
    model.support("r1")
    model.support("r2")
    return model if turn is None else model.turned(turn)


def tip_compliances() -> tuple[np.ndarray, np.ndarray]:
    beams = in_line("fixed").beams
    first = cantilever_compliance(beams[0], 0.5)
    # along −x: half a turn about z
    back = np.diag([-1.0, -1, 1, -1, -1, 1])
    return first, back @ cantilever_compliance(beams[1], 0.4) @ back


def held_rows(kind: str) -> np.ndarray:
    """E, a row for each locked direction; of a screw z less what its turn makes of it."""
    rows = np.eye(6)[[DIRECTIONS.index(d) for d in JOINT_TYPES[kind]]]
    if kind == "helical":
        rows[2, 5] = -PITCH / (2 * np.pi)
    return rows


@pytest.mark.parametrize("turn", [None, Rotation.from_rotvec([1.0, -0.5, 0.3]).as_matrix()])
@pytest.mark.parametrize("kind", KINDS)
def test_force_of_a_misfit(kind: str, turn: np.ndarray | None) -> None:
    gaps = {("J", d): GAP[d] for d in JOINT_TYPES[kind]}
    found = solve(in_line(kind, turn).place(), [LoadCase("gap", gaps=gaps)])
    c1, c2 = tip_compliances()
    rows, gap = held_rows(kind), np.array([GAP[d] for d in JOINT_TYPES[kind]])
    multipliers = np.linalg.solve(rows @ (c1 + c2) @ rows.T, gap)
    expected = rows.T @ multipliers
    force = found.joint_force("J", "gap")
    np.testing.assert_allclose(force, expected, rtol=SOLVED, atol=SOLVED * np.abs(expected).max())
    # no energy but that of the forced fit: half force times gap
    work = 0.5 * multipliers @ gap
    assert found.strain_energy[0] == pytest.approx(work, rel=1e-8)


@pytest.mark.parametrize("kind", KINDS)
def test_share_of_a_load_that_crosses_the_joint(kind: str) -> None:
    load = np.array([100.0, 200.0, -300.0, 4.0, 5.0, -6.0])
    found = solve(in_line(kind).place(), [wrench("push", "t1", *load)])
    c1, c2 = tip_compliances()
    rows = held_rows(kind)
    # the joint closes the gap that the load opens: E (C₁ + C₂) Eᵀ λ = E C₁ F
    expected = rows.T @ np.linalg.solve(rows @ (c1 + c2) @ rows.T, rows @ c1 @ load)
    force = found.joint_force("J", "push")
    np.testing.assert_allclose(force, expected, rtol=SOLVED, atol=SOLVED * np.abs(expected).max())
    np.testing.assert_allclose(
        found.displacement("t2", "push"), c2 @ expected, rtol=SOLVED, atol=1e-14
    )
    # work of the load, half of it stored (Clapeyron)
    work = 0.5 * load @ found.displacement("t1", "push")
    assert found.strain_energy[0] == pytest.approx(work, rel=1e-8)


@pytest.mark.parametrize("direction", DIRECTIONS)
@pytest.mark.parametrize("kind", ["revolute", "planar"])
def test_an_elastic_direction_adds_its_flexibility(kind: str, direction: str) -> None:
    soft = 2e5 if direction in "xyz" else 3e3
    model = in_line(kind, stiffness={direction: soft})
    resisting = [d for d in DIRECTIONS if d in JOINT_TYPES[kind] or d == direction]
    rows = [DIRECTIONS.index(d) for d in resisting]
    c1, c2 = tip_compliances()
    total = c1 + c2
    i = DIRECTIONS.index(direction)
    total[i, i] += 1 / soft
    expected = np.zeros(6)
    expected[rows] = np.linalg.solve(total[np.ix_(rows, rows)], [GAP[d] for d in resisting])
    gaps = {("J", d): GAP[d] for d in resisting}
    found = solve(model.place(), [LoadCase("gap", gaps=gaps)])
    force = found.joint_force("J", "gap")
    np.testing.assert_allclose(force, expected, rtol=1e-8, atol=SOLVED * np.abs(expected).max())
    work = 0.5 * expected[rows] @ [GAP[d] for d in resisting]
    assert found.strain_energy[0] == pytest.approx(work, rel=1e-8)


def full_matrix() -> np.ndarray:
    root = np.random.default_rng(4).normal(size=(6, 6)) * np.repeat([500.0, 20.0], 3)[:, None]
    return root @ root.T


def test_a_bushing_uses_all_of_its_matrix() -> None:
    matrix = full_matrix()
    model = in_line("bushing", matrix=tuple(tuple(r) for r in matrix.tolist()))
    c1, c2 = tip_compliances()
    gap = np.array([GAP[d] for d in DIRECTIONS])
    expected = np.linalg.solve(c1 + c2 + np.linalg.inv(matrix), gap)
    case = LoadCase("gap", gaps={("J", d): GAP[d] for d in DIRECTIONS})
    force = solve(model.place(), [case]).joint_force("J", "gap")
    np.testing.assert_allclose(force, expected, rtol=1e-8)


@pytest.mark.parametrize("turn", [np.eye(3), Rotation.from_rotvec([0.2, 1.3, -2.0]).as_matrix()])
def test_a_block_on_one_bushing_moves_by_the_inverse_of_the_matrix(turn: np.ndarray) -> None:
    matrix = full_matrix()
    model = Model("tool")
    model.ground(base=(1, 2, 3))
    model.joint(
        "B", "bushing", ("base", "tool"), turn[:, 2], turn[:, 0],
        matrix=tuple(tuple(r) for r in matrix.tolist()),
    )  # fmt: skip
    load = np.array([10.0, -5.0, 3.0, 0.4, 0.5, -0.6])
    found = solve(model.place(), [wrench("push", "tool", *load)])
    six = np.kron(np.eye(2), turn)
    expected = six @ np.linalg.solve(matrix, six.T @ load)
    np.testing.assert_allclose(found.displacement("tool", "push"), expected, rtol=1e-9)
    # the joint holds what pushes
    np.testing.assert_allclose(found.joint_force("B", "push"), -six.T @ load, rtol=1e-9)
    assert found.strain_energy[0] == pytest.approx(0.5 * load @ expected, rel=1e-9)


def test_a_direction_a_bushing_does_not_resist_is_free() -> None:
    """A matrix with zero rows makes a ball joint; the strut between two spins, unexcited."""
    matrix = tuple(tuple(r) for r in np.diag([1e8, 1e8, 1e8, 0, 0, 0]).tolist())
    model = Model()
    model.ground(base=(0, 0, 0))
    model.nodes(top=(0, 0, 0.5))
    model.joint("low", "bushing", ("base", "foot"), matrix=matrix)
    model.joint("high", "bushing", ("head", "top"), matrix=matrix)
    model.beam("strut", "foot", "head", TUBE)
    model.support("top", "x", "y", "rx", "ry", "rz")
    found = solve(model.place(), [wrench("press", "top", 0, 0, -1000.0)])
    ea = model.beams[0].properties[0]
    expected = -1000 * (0.5 / ea + 2e-8)
    assert found.displacement("top", "press")[2] == pytest.approx(expected, rel=1e-9)
    assert found.displacement("foot", "press")[5] == pytest.approx(0.0, abs=1e-15)


def test_a_driven_direction_is_held_and_its_misfit_is_its_travel() -> None:
    model = Model("tool")
    model.ground(base=(0, 0, 0))
    model.joint("slide", "prismatic", ("base", "tool"), (0, 1, 0), driven=("z",))
    case = LoadCase("travel", gaps={("slide", "z"): 2e-3})
    found = solve(model.place(), [case])
    np.testing.assert_allclose(
        found.displacement("tool", "travel"), [0, 2e-3, 0, 0, 0, 0], atol=1e-17
    )
    assert np.abs(found.joint_force("slide", "travel")).max() == 0.0


def placed_plain() -> PlacedStructure:
    return in_line("revolute").place()


@pytest.mark.parametrize(
    ("gaps", "problem"),
    [
        ({("J", "rz"): 1e-3}, "joint J: has a misfit in rz, which is free"),
        ({("K", "x"): 1e-3}, 'names the unknown joint "K"'),
        ({("J", "w"): 1e-3}, "joint J: has a misfit in w"),
    ],
)
def test_a_misfit_must_name_a_direction_that_resists(gaps: Any, problem: str) -> None:
    with pytest.raises(ModelError, match=problem):
        solve(placed_plain(), [LoadCase("gap", gaps=gaps)])
