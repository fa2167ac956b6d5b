"""Loads, supports and static solutions of solids."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from strutwork.errors import (
    InconsistentConstraintsError,
    MechanismError,
    ModelError,
    NumericalError,
)
from strutwork.fea.factorize import factorize
from strutwork.fea.solid_loads import (
    acceleration_load,
    force_load,
    gravity_load,
    load_resultant,
    pressure_load,
    traction_load,
)
from strutwork.fea.solid_matrices import SolidMatrices
from strutwork.fea.solid_static import solve_solid
from strutwork.fea.solid_supports import Supports, supports
from strutwork.meshes import Mesh, block, joined, merged, moved, node_set, tube
from tests.solid_cases import FIELDS, STEEL, cells_of, matrices_of

Array = NDArray[Any]

SIZE = (0.4, 0.2, 0.3)
VOLUME = 0.024


@pytest.fixture(scope="module")
def brick() -> SolidMatrices:
    mesh = node_set(block(SIZE, (3, 2, 2)), "corner", (0, 0, 0), (0, 0, 0))
    return matrices_of(node_set(mesh, "edge", (0, None, 0), (0, None, 0)))


@pytest.mark.parametrize(("kind", "order"), FIELDS)
def test_resultants(kind: str, order: int) -> None:
    matrices = matrices_of(cells_of(kind, SIZE, (2, 2, 2)), order)
    about = np.array(SIZE) / 2
    weight = 8000.0 * VOLUME * 9.80665
    cases = [
        (gravity_load(matrices), [0, 0, -weight, 0, 0, 0]),
        # at the middle of the side x = 0.4
        (traction_load(matrices, "+x", [1e3, 2e3, 0]), [60, 120, 0, 0, 0, 0.2 * 120]),
        (force_load(matrices, "+x", [5.0, 0, 7.0]), [5, 0, 7, 0, -0.2 * 7, 0]),
        (pressure_load(matrices, "+z", 1e3), [0, 0, -80, 0, 0, 0]),
    ]
    for load, expected in cases:
        assert load.shape == (matrices.size, 1)
        np.testing.assert_allclose(
            load_resultant(matrices, load, about)[:, 0], expected, atol=1e-10 * weight
        )


def test_pressure_all_around_is_in_balance() -> None:
    mesh = tube(0.1, 0.15, 0.3, (2, 8, 2))
    matrices = matrices_of(mesh)
    total = sum(pressure_load(matrices, name, 1e5) for name in mesh.patches)
    np.testing.assert_allclose(load_resultant(matrices, total), 0.0, atol=1e-8)


def test_cases_are_columns(brick: SolidMatrices) -> None:
    loads = gravity_load(brick, [[0, 0, -9.8], [9.8, 0, 0]])
    assert loads.shape == (brick.size, 2)
    turning = acceleration_load(brick, [0, 0, 0, 0, 0, 2.0], np.array(SIZE) / 2)
    inertia = 8000.0 * VOLUME * (0.4**2 + 0.2**2) / 12
    np.testing.assert_allclose(
        load_resultant(brick, turning)[:, 0], [0, 0, 0, 0, 0, -2 * inertia], atol=1e-10
    )


@pytest.mark.parametrize("wrong", [[1.0, 2.0], [np.nan, 0, 0], [[1.0], [2.0]]])
def test_loads_that_make_no_sense_are_refused(brick: SolidMatrices, wrong: list[float]) -> None:
    with pytest.raises(ModelError, match="Give 3 finite numbers"):
        traction_load(brick, "+x", wrong)


def test_reactions_balance_the_loads(brick: SolidMatrices) -> None:
    loads = np.hstack([gravity_load(brick), force_load(brick, "+x", [1e3, 2e3, 3e3])])
    found = solve_solid(brick, loads, {"-x": "xyz"})
    # the residual of the solution, times the loads
    np.testing.assert_allclose(
        load_resultant(brick, found.reactions), -load_resultant(brick, loads), atol=1e-5
    )
    free = np.setdiff1d(np.arange(brick.size), supports(brick, {"-x": "xyz"}).dofs)
    assert not found.reactions[free].any()
    # Clapeyron
    work = np.einsum("nm,nm->m", found.displacements, loads) / 2
    np.testing.assert_allclose(found.strain_energy, work, rtol=1e-9)
    assert "load cases" in repr(found)
    assert found.to_dict()["degrees_of_freedom"] == brick.size


def test_supports_may_be_displaced(brick: SolidMatrices) -> None:
    # stretched between smooth grips: u = ε x, stress E ε
    held = {"-x": "x", "+x": {"x": 4e-5}, "corner": "yz", "-y": "y", "-z": "z"}
    found = solve_solid(brick, np.zeros(brick.size), held)
    expected = brick.points * [1e-4, -0.3e-4, -0.3e-4]
    np.testing.assert_allclose(found.at_nodes(), expected, atol=1e-14)
    pull = found.reactions.reshape(-1, 3)[brick.nodes_of_set("+x"), 0].sum()
    assert pull == pytest.approx(200e9 * 1e-4 * 0.06)
    assert found.strain_energy[0] == pytest.approx(200e9 * 1e-8 / 2 * VOLUME)


def test_a_displacement_for_each_node(brick: SolidMatrices) -> None:
    nodes = brick.nodes_of_set("+x")
    lifts = 1e-5 * brick.points[nodes, 1]
    held = supports(brick, {"+x": {"z": lifts}})
    np.testing.assert_array_equal(held.values, lifts)
    np.testing.assert_array_equal(held.dofs, 3 * nodes + 2)


@pytest.mark.parametrize(
    ("held", "free"),
    [
        ({}, "translation along x; translation along y; translation along z; rotation about x"),
        ({"-x": "x"}, r"along y; translation along z; rotation about x through \(0.2, 0.1, 0.15\)"),
        ({"edge": "xyz"}, r"against rotation about y through \(0, 0.1, 0\) m\.$"),
        ({"corner": "xyz"}, "against rotation about x .* rotation about y .* rotation about z"),
        ({"-z": "z", "corner": "x"}, r"translation along y; rotation about z through \(0.2, 0,"),
    ],
)
def test_what_is_not_held_is_named(brick: SolidMatrices, held: dict[str, str], free: str) -> None:
    with pytest.raises(MechanismError) as raised:
        solve_solid(brick, gravity_load(brick), held)
    assert re.search(free, raised.value.problem)


def test_free_motion_in_an_oblique_direction_is_named() -> None:
    # hinged along the diagonal of its base
    mesh = block((1, 1, 1), (1, 1, 1))
    matrices = matrices_of(mesh, 1)
    low = mesh.points[:, 2] == 0
    ends = np.flatnonzero(low & (mesh.points[:, 0] == mesh.points[:, 1]))
    dofs = (3 * ends[:, None] + np.arange(3)).ravel()
    with pytest.raises(MechanismError, match=r"rotation about \(0\.707, 0\.707, 0\) through"):
        solve_solid(matrices, np.zeros(matrices.size), Supports(dofs, np.zeros(len(dofs))))


def test_contradicting_supports_are_named(brick: SolidMatrices) -> None:
    held = {"-x": {"z": 0.0}, "-z": {"z": 1e-3}}
    with pytest.raises(InconsistentConstraintsError, match="'-x' and '-z' displace node"):
        supports(brick, held)


@pytest.mark.parametrize(
    ("held", "message"),
    [
        ({"-x": "q"}, "holds 'q'"),
        ({"nowhere": "x"}, "'nowhere'"),
        ({"-x": {"x": np.inf}}, "its displacement along x"),
        ({"-x": {"x": [1.0, 2.0]}}, "its displacement along x"),
    ],
)
def test_supports_that_make_no_sense(brick: SolidMatrices, held: dict, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        supports(brick, held)


def test_loads_of_another_size_are_refused(brick: SolidMatrices) -> None:
    with pytest.raises(ModelError, match=r"loads have the shape \(5,\)"):
        solve_solid(brick, np.zeros(5), {"-x": "xyz"})


def test_parts_that_meet_along_an_edge_are_a_mechanism_within() -> None:
    left = block((1, 1, 1), (1, 1, 1))
    right = moved(left, translation=(1, 1, 0))
    hinged: Mesh = merged(joined(left, right))
    hinged = replace(hinged, patches={})
    low = np.flatnonzero(hinged.points[:, 0] < 1e-9)
    hinged = replace(hinged, node_sets={"wall": low})
    matrices = matrices_of(hinged, 1, STEEL)
    load = np.zeros(matrices.size)
    load[3 * np.argmax(hinged.points[:, 0] * hinged.points[:, 1])] = 1.0
    with pytest.raises(NumericalError):
        solve_solid(matrices, load, {"wall": "xyz"})


def needle(slenderness: int) -> tuple[SolidMatrices, Array]:
    """A held bar of square section, 1 m long, and a push across its end."""
    side = 1.0 / slenderness
    matrices = matrices_of(block((1.0, side, side), (min(slenderness, 200), 1, 1)))
    return matrices, force_load(matrices, "+x", [0.0, 0.0, 1.0])


def test_a_slender_solid_is_answered_to_what_it_claims() -> None:
    """Its residual is some 1e-6 of the load, as rounding of its cells' forces, and was refused.

    Of 200 cells: of 333, rounding alone leaves 1e-6 to 3e-6 of the displacement, as the processor's
    kernels have it.
    """
    matrices, load = needle(200)
    found = solve_solid(matrices, load, {"-x": "xyz"}, "superlu")
    assert found.error < 1e-6
    free = np.setdiff1d(np.arange(matrices.size), supports(matrices, {"-x": "xyz"}).dofs)
    inner = matrices.stiffness[free][:, free].tocoo()
    factor = factorize(inner.tocsc(), "superlu")
    exact = found.displacements[free, 0].astype(np.longdouble)
    for _ in range(8):
        left = load[free, 0].astype(np.longdouble)
        np.subtract.at(left, inner.row, inner.data.astype(np.longdouble) * exact[inner.col])
        exact += factor.solve(left.astype(float))
    off = np.abs(found.displacements[free, 0] - exact).max() / np.abs(exact).max()
    assert off < 1e-6


def test_a_solid_too_slender_for_doubles_is_withheld() -> None:
    matrices, load = needle(1000)
    with pytest.raises(NumericalError, match=r"accurate to .* of its largest displacement only"):
        solve_solid(matrices, load, {"-x": "xyz"}, "superlu")
