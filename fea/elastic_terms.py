"""Matrices of straight cells by SfePy, with its output kept off the standard output."""

from __future__ import annotations

import contextlib
import io
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any, Protocol

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

from strutwork.errors import NumericalError
from strutwork.fea.curved_terms import CurvedAssembler
from strutwork.fea.elasticity import elasticity, thermal_stress
from strutwork.fea.sfepy_home import import_sfepy
from strutwork.fea.solid import Solid
from strutwork.meshes.mesh import Mesh
from strutwork.meshes.order import quadratic
from strutwork.meshes.transform import renumbered

Array = NDArray[Any]
GEOMETRIES = {"hexahedron": "3_8", "tetra": "3_4"}
#: Nodes of a cell by kind and order.
GROUP_NODES = {("hexahedron", 1): 8, ("hexahedron", 2): 27, ("tetra", 1): 4, ("tetra", 2): 10}
#: SfePy's node of a cell for each node in the order of VTK.
NODE_ORDER = {
    ("hexahedron", 1): (*range(8),),
    ("hexahedron", 2): (*range(20), 21, 24, 22, 25, 20, 23, 26),
    ("tetra", 1): (*range(4),),
    ("tetra", 2): (*range(10),),
}
#: Entries of cell matrices that are held at a time: 80 MB.
GROUP_ENTRIES = 10_000_000


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    """Keep SfePy's own use of what its libraries have deprecated from the reader."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)
        yield


def sfepy() -> SimpleNamespace:
    """The parts of SfePy in use.

    Imported where used since it takes half a second. Its import prints about optional
    packages and shortens how NumPy prints arrays; both are undone.
    """
    printing = np.get_printoptions()
    with contextlib.redirect_stdout(io.StringIO()), _quiet():
        import_sfepy()
        from sfepy.base.base import output  # noqa: PLC0415

        output.set_output(quiet=True)
        from sfepy.discrete import (  # noqa: PLC0415
            Equation,
            Equations,
            FieldVariable,
            Integral,
            Problem,
        )
        from sfepy.discrete import Material as Coefficients  # noqa: PLC0415
        from sfepy.discrete.fem import FEDomain, Field, Mesh  # noqa: PLC0415
        from sfepy.terms import Term  # noqa: PLC0415
    np.set_printoptions(**printing)
    return SimpleNamespace(
        Equation=Equation, Equations=Equations, FieldVariable=FieldVariable, Integral=Integral,
        Problem=Problem, Coefficients=Coefficients, FEDomain=FEDomain, Field=Field, Mesh=Mesh,
        Term=Term,
    )  # fmt: skip


class Assembler(Protocol):
    """A solid that can be assembled."""

    def field_mesh(self) -> Mesh:
        """The mesh of the field: the nodes of the solid's mesh first and in its order."""

    def stiffness(self, weights: dict[str, float] | None = None) -> sp.csc_array:
        """Stiffness, N/m, (3n, 3n).

        Parameters
        ----------
        weights : dict of region to float, optional
            Factor on each region's share, no unit; one where it is not named.
        """

    def mass(self) -> sp.csc_array:
        """Consistent mass, kg, (3n, 3n)."""

    def conduction(self, conductivities: Mapping[str, float]) -> sp.csc_array:
        """Conduction of heat, W/K, (n, n).

        Parameters
        ----------
        conductivities : mapping of region to float
            W/(m K).
        """

    def expansion(self, changes: Array, coefficients: Mapping[str, float]) -> Array:
        """Loads of the thermal strain, ∫ Bᵀ D α T 1 dV, N, (3n,).

        Parameters
        ----------
        changes : (n,)
            Change of temperature at the nodes of the field, K.
        coefficients : mapping of region to float
            Of expansion, 1/K.
        """


@dataclass(frozen=True, repr=False)
class StraightAssembler:
    """A solid in SfePy: its field and how to assemble it.

    Parameters
    ----------
    solid : Solid
    points : (n, 3)
        All nodes of the field, corners first, m.
    cells : (m, k) int
        Nodes of the cells in SfePy's order.
    groups : tuple of str
        Region of each group of cells that is worked on at a time.
    domain : object
        SfePy's.
    """

    solid: Solid
    points: Array
    cells: NDArray[np.int64]
    groups: tuple[str, ...]
    domain: Any

    def __repr__(self) -> str:
        return f"StraightAssembler({self.solid.name}: {len(self.points)} nodes)"

    def field_mesh(self) -> Mesh:
        """The mesh of the field in SfePy's numbering, with the patches and node sets."""
        if self.solid.order == 1:
            return self.solid.mesh
        mesh = quadratic(self.solid.mesh)
        ours = np.concatenate([b.nodes for b in mesh.blocks])
        number = np.empty(len(mesh.points), dtype=np.int64)
        number[ours] = self.cells[:, NODE_ORDER[self.solid.kind, self.solid.order]]
        points = np.empty_like(mesh.points)
        points[number] = mesh.points
        return renumbered(mesh, points, number)

    def stiffness(self, weights: dict[str, float] | None = None) -> sp.csc_array:
        """Stiffness, N/m, (3n, 3n).

        Parameters
        ----------
        weights : dict of region to float, optional
            Factor on each region's share, no unit; one where it is not named.
        """
        values = {
            region: elasticity(self.solid.materials[region]) * (weights or {}).get(region, 1.0)
            for region in self.solid.used_regions
        }
        with _quiet():
            return self._assemble("dw_lin_elastic", values, "vector")

    def mass(self) -> sp.csc_array:
        """Consistent mass, kg, (3n, 3n)."""
        values = {r: self.solid.materials[r].density for r in self.solid.used_regions}
        # the three directions have one and the same matrix: a third of the work and of the fill
        with _quiet():
            one = self._assemble("dw_dot", values, "scalar")
        return sp.csc_array(sp.kron(one, sp.eye_array(3)))

    def conduction(self, conductivities: Mapping[str, float]) -> sp.csc_array:
        """Conduction of heat, W/K, (n, n).

        Parameters
        ----------
        conductivities : mapping of region to float
            W/(m K).
        """
        with _quiet():
            return self._assemble("dw_laplace", dict(conductivities), "scalar")

    def expansion(self, changes: Array, coefficients: Mapping[str, float]) -> Array:
        """Loads of the thermal strain, ∫ Bᵀ D α T 1 dV, N, (3n,).

        Parameters
        ----------
        changes : (n,)
            Change of temperature at the nodes of the field, K.
        coefficients : mapping of region to float
            Of expansion, 1/K.
        """
        values = {
            region: thermal_stress(self.solid.materials[region], coefficients[region])[:, None]
            for region in self.solid.used_regions
        }
        with _quiet():
            v, _ = self._variables("vector")
            field = self._field("scalar")
            heat = sfepy().FieldVariable("p", "parameter", field, primary_var_name="(set-to-None)")
            heat.set_data(np.asarray(changes, dtype=float))
            equations, _ = self._equations("dw_biot", values, {"v": v, "p": heat})
            loads = np.zeros(3 * len(self.points))
            equations["e"].evaluate(mode="weak", dw_mode="vector", asm_obj=loads)
        return loads

    def _field(self, shape: str) -> Any:
        return sfepy().Field.from_args(
            f"{shape} field", np.float64, shape, self.domain.regions["Omega"],
            approx_order=self.solid.order,
        )  # fmt: skip

    def _variables(self, shape: str) -> tuple[Any, Any]:
        """Test and unknown of a field."""
        lib, field = sfepy(), self._field(shape)
        u = lib.FieldVariable("u", "unknown", field)
        return lib.FieldVariable("v", "test", field, primary_var_name="u"), u

    def _equations(
        self, term: str, values: dict[str, Any], variables: dict[str, Any]
    ) -> tuple[Any, Any]:
        """The sum of a term over the groups of cells, and the pattern of its matrix."""
        lib = sfepy()
        # twice the order: one less leaves quadratic hexahedra spurious motions without energy
        integral = lib.Integral("i", order=2 * self.solid.order)
        sum_of_terms: Any = None
        for group, region in enumerate(self.groups):
            constants = lib.Coefficients(f"m{group}", c=values[region])
            part = lib.Term.new(
                f"{term}(m{group}.c, {', '.join(variables)})", integral,
                self.domain.regions[f"group{group}"], **{f"m{group}": constants}, **variables,
            )  # fmt: skip
            sum_of_terms = part if sum_of_terms is None else sum_of_terms + part
        equations = lib.Equations([lib.Equation("e", sum_of_terms)])
        problem = lib.Problem("p", equations=equations)
        problem.time_update()
        problem.update_materials()
        return equations, problem.mtx_a

    def _assemble(self, term: str, values: dict[str, Any], shape: str) -> sp.csc_array:
        v, u = self._variables(shape)
        equations, pattern = self._equations(term, values, {"v": v, "u": u})
        found = equations["e"].evaluate(mode="weak", dw_mode="matrix", asm_obj=pattern)
        if not np.isfinite(found.data).all():
            raise NumericalError(
                f"solid {self.solid.name}",
                "its matrices are not finite.",
                "Check the size of its cells and the units of its materials.",
            )
        # rows of a symmetric matrix are its columns
        return sp.csc_array((found.data, found.indices, found.indptr), shape=found.shape)


def assembler(solid: Solid) -> Assembler:
    """What assembles the solid: SfePy where its cells are linear, else their own mapping.

    Parameters
    ----------
    solid : Solid
    """
    if solid.keeps_curves:
        return CurvedAssembler(solid)
    with _quiet():
        return _straight(solid)


def _straight(solid: Solid) -> StraightAssembler:
    lib = sfepy()
    group, regions = _groups(solid)
    mesh = lib.Mesh.from_data(
        "mesh", solid.mesh.points.copy(), None, [solid.cells.astype(np.int32)],
        [group], [GEOMETRIES[solid.kind]],
    )  # fmt: skip
    domain = lib.FEDomain("domain", mesh)
    omega = domain.create_region("Omega", "all")
    for index in range(len(regions)):
        domain.create_region(f"group{index}", f"cells of group {index}")
    field = lib.Field.from_args("field", np.float64, "scalar", omega, approx_order=solid.order)
    cells = np.asarray(field.econn, dtype=np.int64)
    return StraightAssembler(solid, np.array(field.get_coor()), cells, regions, domain)


def _groups(solid: Solid) -> tuple[NDArray[np.int32], tuple[str, ...]]:
    """Group of each cell, and the region of each group: one region, and few enough cells."""
    region = solid.cell_regions
    entries = 9 * GROUP_NODES[solid.kind, solid.order] ** 2
    most = max(1, GROUP_ENTRIES // entries)
    group = np.zeros(len(region), dtype=np.int32)
    names: list[str] = []
    for index in np.unique(region):
        own = np.flatnonzero(region == index)
        group[own] = len(names) + np.arange(len(own)) // most
        names += [solid.mesh.regions[index]] * (-(-len(own) // most))
    return group, tuple(names)
