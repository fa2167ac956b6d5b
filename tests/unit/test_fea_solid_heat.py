"""Conduction in solids and the loads of any temperature, against closed forms."""

from dataclasses import replace

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea.free_expansion import linear_load
from strutwork.fea.interface import Interface
from strutwork.fea.reduce_solid import tied
from strutwork.fea.solid import Solid
from strutwork.fea.solid_heat import HeatedSolid, HeatedSurface
from strutwork.fea.superelement import Superelement
from strutwork.fea.tied_solid import StaticSolver
from strutwork.meshes.grids import grid
from strutwork.meshes.mesh import CellBlock, Mesh
from strutwork.meshes.order import quadratic
from strutwork.meshes.tube import tube
from strutwork.msa import Material

ENDS = (Interface("A", "-x"), Interface("B", "+x"))


def material(poisson: float = 0.3) -> Material:
    return Material(200e9, 200e9 / (2 + 2 * poisson), 7800, name="steel")


def bar(length: float = 0.3, cells: int = 6) -> Mesh:
    x, y, z = (np.linspace(0, size, n + 1) for size, n in ((length, cells), (0.04, 2), (0.06, 3)))
    return grid(x, y, z, name="bar")


def reduced(solid: Solid, interfaces: tuple[Interface, ...] = ENDS) -> Superelement:
    """Statically alone: a strip without coupling has shapes that monitors do not tell apart."""
    whole = tied(solid, interfaces)
    shapes = StaticSolver(whole).constraint_modes()
    return Superelement(
        solid.name,
        tuple(i.name for i in interfaces),
        np.array([p.position for p in whole.patches]),
        shapes.T @ (whole.stiffness @ shapes),
        np.zeros((12, 12)),
        whole.recovery @ shapes,
        np.zeros(0),
        "",
    )


def free_end(element: Superelement, load: np.ndarray) -> np.ndarray:
    """Motion of the second node, the first one held."""
    stiffness = element.local_stiffness[6:, 6:]
    return np.asarray(np.linalg.solve(stiffness, load[6:])[:6])


@pytest.mark.parametrize("kind", ["average", "rigid"])
@pytest.mark.parametrize("curved", [False, True], ids=["SfePy", "isoparametric"])
def test_the_mesh_carries_a_linear_temperature_exactly(kind: str, curved: bool) -> None:
    """Both ways to the load agree where one of them is exact, nodes off their patches' middles."""
    mesh = quadratic(bar(), serendipity=True) if curved else bar()
    solid = Solid(mesh, {"solid": material()}, 2)
    ends = (Interface("A", "-x", kind=kind), Interface("B", "+x", (0.3, 0.022, 0.033), kind))
    element, heated = reduced(solid, ends), HeatedSolid(solid, ends)
    alpha, gradient, about = 1e-5, np.array([3.0, 5.0, -7.0]), np.array([0.1, 0.2, 0.3])
    exact = linear_load(solid, ends, element, 4 * alpha, alpha * gradient, about)
    changes = 4.0 + (heated.points - about) @ gradient
    meshed = heated.load(element, changes, {"solid": alpha})
    expected = free_end(element, exact)
    np.testing.assert_allclose(
        free_end(element, meshed), expected, atol=1e-7 * np.abs(expected).max()
    )


def test_a_bimetal_strip_bends_as_timoshenko_has_it() -> None:
    """κ = 3 Δε / (2 h) of two equal layers (Timoshenko 1925), away from what the ends do.

    With ν = 0, the layers share no strain across the strip; the rotation of a longer strip beyond
    that of a shorter one is then κ times the difference.
    """
    turns = []
    for cells in (8, 16):
        lines = (np.linspace(0, 0.02 * cells, cells + 1), [0, 0.01], [0, 0.01, 0.02])
        mesh = grid(*(np.array(line) for line in lines), name="strip")
        block = mesh.blocks[0]
        high = mesh.points[block.nodes].mean(axis=1)[:, 2] > 0.01
        mesh = replace(
            mesh,
            blocks=(CellBlock(block.kind, block.nodes, high.astype(int)),),
            regions=("low", "high"),
        )
        solid = Solid(mesh, {"low": material(0.0), "high": material(0.0)}, 2)
        element, heated = reduced(solid), HeatedSolid(solid, ENDS)
        changes = np.full(len(heated.points), 10.0)
        load = heated.load(element, changes, {"low": 2e-6, "high": 12e-6})
        turns.append(free_end(element, load)[4])
    # the upper layer grows more: the strip bends down, and its end turns about +y
    curvature = 1.5 * 1e-5 * 10.0 / 0.02
    np.testing.assert_allclose(turns[1] - turns[0], curvature * 0.16, rtol=1e-5)


def test_heat_flows_through_a_wall_and_a_film() -> None:
    """q = ΔT / (L / k + 1 / h)."""
    heated = HeatedSolid(Solid(bar(), {"solid": material()}, 2), ENDS)
    surfaces = [HeatedSurface("-x", change=10.0), HeatedSurface("+x", film=100.0, surroundings=2.0)]
    found = heated.steady({"solid": 50.0}, surfaces)
    flow = 8.0 / (0.3 / 50.0 + 1.0 / 100.0)
    np.testing.assert_allclose(found, 10.0 - flow * heated.points[:, 0] / 50.0, rtol=1e-9)
    # the same flow given as a power through the end
    surfaces = [HeatedSurface("-x", change=10.0), HeatedSurface("+x", power=-flow * 0.04 * 0.06)]
    np.testing.assert_allclose(heated.steady({"solid": 50.0}, surfaces), found, rtol=1e-9)


def test_a_hot_bore_warms_a_tube_logarithmically() -> None:
    """T = T₀ ln(r₁ / r) / ln(r₁ / r₀), in curved cells."""
    mesh = tube(0.02, 0.04, 0.02, [3, 24, 1], order=2)
    solid = Solid(mesh, {mesh.regions[0]: material()}, 2)
    heated = HeatedSolid(solid, (Interface("A", "-z"),))
    surfaces = [HeatedSurface("inner", change=10.0), HeatedSurface("outer", change=0.0)]
    found = heated.steady({mesh.regions[0]: 50.0}, surfaces)
    radius = np.hypot(*heated.points[:, :2].T)
    np.testing.assert_allclose(found, 10 * np.log(0.04 / radius) / np.log(2.0), atol=0.01)


def test_a_conducted_gradient_bends_like_a_given_one() -> None:
    """Faces at ± 3 K: κ = α ΔT / h."""
    heated = HeatedSolid(solid := Solid(bar(), {"solid": material()}, 2), ENDS)
    changes = heated.steady(
        {"solid": 50.0}, [HeatedSurface("+z", change=3.0), HeatedSurface("-z", change=-3.0)]
    )
    element = reduced(solid)
    turned = free_end(element, heated.load(element, changes, {"solid": 1e-5}))[4]
    np.testing.assert_allclose(turned, 1e-5 * 6.0 / 0.06 * 0.3, rtol=1e-7)


def test_surfaces_that_do_not_fit_are_named() -> None:
    heated = HeatedSolid(Solid(bar(), {"solid": material()}, 2), ENDS)
    with pytest.raises(ModelError, match="nothing fixes its temperature"):
        heated.steady({"solid": 50.0}, [HeatedSurface("+x", flux=10.0)])
    with pytest.raises(ModelError, match="shares nodes with a surface of another temperature"):
        heated.steady(
            {"solid": 50.0}, [HeatedSurface("+x", change=1.0), HeatedSurface("+z", change=2.0)]
        )
    with pytest.raises(ModelError, match="a temperature and a flow of heat"):
        HeatedSurface("+x", change=1.0, flux=1.0)
    with pytest.raises(ModelError, match="film coefficient -1"):
        HeatedSurface("+x", film=-1.0)
    with pytest.raises(ModelError, match="not finite"):
        HeatedSurface("+x", change=float("nan"))
