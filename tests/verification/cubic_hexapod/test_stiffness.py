"""The cubic hexapod at the centre of its cube: K = k diag(2, 2, 2, 1.5 H², 1.5 H², 6 H²).

@article{geng1994,
  author  = {Geng, Zheng and Haynes, Leonard S.},
  title   = {Six degree-of-freedom active vibration control using the {Stewart} platforms},
  journal = {IEEE Transactions on Control Systems Technology},
  volume  = {2}, number = {1}, pages = {45--53}, year = {1994},
}

Six struts of stiffness k lie on the edges of a cube that touch neither its lowest nor its
highest corner; H = a/√3 is the height between the planes of their ends. K = k Σ s sᵀ with s the
unit Plücker lines of the struts about the centre: each lies a/√2 from it, two along each edge
direction. Exact, so only round-off is allowed for.
"""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from strutwork.kinematics import mobility
from strutwork.msa import (
    LoadCase,
    PlacedStructure,
    axis_stiffness_blocked,
    axis_stiffness_free,
    solve,
    stiffness_ellipsoid,
    tool_compliance,
    tool_stiffness,
)
from tests.structures import Model

EDGE, STIFFNESS = 0.6, 4e7
HEIGHT = EDGE / np.sqrt(3)
EXPECTED = STIFFNESS * np.array([2, 2, 2, 1.5 * HEIGHT**2, 1.5 * HEIGHT**2, 6 * HEIGHT**2])


def cubic(lower: str = "universal") -> PlacedStructure:
    """Struts of a rigid cylinder and piston with an elastic drive between."""
    corners = np.array(list(product((-1.0, 1.0), repeat=3)))
    up = np.ones(3) / np.sqrt(3)
    x = np.array([1.0, -1.0, 0.0]) / np.sqrt(2)
    to_space_diagonal = np.stack([x, np.cross(up, x), up])
    low = [c for c in corners if c.sum() == -1]
    high = [c for c in corners if c.sum() == 1]
    edges = [(a, b) for a in low for b in high if np.abs(a - b).sum() == 2]
    assert len(edges) == 6
    model = Model("tool")
    model.nodes(tool=(0, 0, 0))
    for i, (a, b) in enumerate(edges):
        foot, head = (to_space_diagonal @ corner * EDGE / 2 for corner in (a, b))
        along = head - foot
        model.ground(**{f"base{i}": foot})
        model.nodes(**{f"plate{i}": head, f"slide{i}": (foot + head) / 2})
        across = np.cross(along, (0.1, 0.2, 1.0))
        model.joint(f"U{i}", lower, (f"base{i}", f"foot{i}"), across, np.cross(across, along))
        model.joint(
            f"P{i}", "prismatic", (f"slide{i}", f"rod{i}"), along,
            driven=("z",), stiffness={"z": STIFFNESS},
        )  # fmt: skip
        model.joint(f"S{i}", "spherical", (f"head{i}", f"plate{i}"))
        model.rigid(f"cylinder{i}", f"foot{i}", f"slide{i}")
        model.rigid(f"piston{i}", f"rod{i}", f"head{i}")
    model.rigid("platform", "tool", *(f"plate{i}" for i in range(6)))
    return model.place()


@pytest.mark.parametrize("lower", ["universal", "spherical"])
@pytest.mark.parametrize("method", ["saddle_point", "null_space", "condensed", "sparse"])
def test_stiffness_at_the_centre(lower: str, method: str) -> None:
    k = tool_stiffness(tool_compliance(cubic(lower), method))  # type: ignore[arg-type]
    scale = np.sqrt(np.outer(EXPECTED, EXPECTED))
    np.testing.assert_allclose(k / scale, np.eye(6), atol=1e-12)


def test_nothing_is_coupled_so_both_definitions_agree() -> None:
    c = tool_compliance(cubic())
    np.testing.assert_allclose(axis_stiffness_free(c), EXPECTED, rtol=1e-12)
    np.testing.assert_allclose(axis_stiffness_blocked(c), EXPECTED, rtol=1e-12)
    ellipsoid = stiffness_ellipsoid(c)
    np.testing.assert_allclose(ellipsoid.values, 2 * STIFFNESS, rtol=1e-12)


@pytest.mark.parametrize(("lower", "spins"), [("universal", 0), ("spherical", 6)])
def test_no_constraint_is_redundant_so_leg_errors_cost_no_force(lower: str, spins: int) -> None:
    """6-UPS and 6-SPS: any error of any leg only moves the platform."""
    placed = cubic(lower)
    found = mobility(placed.structure.linkage, placed.placement)
    assert (found.redundant, found.mobility, found.mobility_locked) == (0, 6 + spins, spins)
    assert found.self_stress == ()
    rng = np.random.default_rng(1)
    errors = {
        **{(f"P{i}", "z"): rng.normal() * 1e-4 for i in range(6)},
        **{(f"S{i}", d): rng.normal() * 1e-4 for i in range(6) for d in "xyz"},
        **{(f"U{i}", d): rng.normal() * 1e-4 for i in range(6) for d in "xyz"},
        **{(f"P{i}", d): rng.normal() * 1e-4 for i in range(6) for d in ("x", "y", "rx", "ry")},
    }
    for method in ("saddle_point", "null_space", "condensed"):
        case = LoadCase("errors", gaps=errors)
        solution = solve(placed, [case], method)  # type: ignore[arg-type]
        # k times an error is 4000 N: what is left is its round-off
        assert np.abs(solution.joint_forces).max() < 4000 * 1e-11
        assert solution.strain_energy[0] < 1e-20 * STIFFNESS
        assert np.abs(solution.displacement("tool", "errors")).max() > 1e-5
