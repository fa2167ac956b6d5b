"""Conduction in solids and the loads of any temperature, against closed forms."""

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.fea.free_expansion import linear_load
from strutwork.fea.interface import Interface
from strutwork.fea.solid import Solid
from strutwork.fea.solid_heat import HeatedSolid, HeatedSurface
from strutwork.meshes.grids import grid
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.order import quadratic
from strutwork.meshes.tube import tube
from tests.heated_solids import ENDS, free_end, material, reduced


def bar(length: float = 0.3, cells: int = 6) -> Mesh:
    x, y, z = (np.linspace(0, size, n + 1) for size, n in ((length, cells), (0.04, 2), (0.06, 3)))
    return grid(x, y, z, name="bar")


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
