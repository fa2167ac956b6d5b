"""Shape functions, quadrature and faces of every kind of cell."""

from __future__ import annotations

from math import factorial, prod

import numpy as np
import pytest

from strutwork.errors import ModelError
from strutwork.meshes.cells import CELL_TYPES, CellType, cell_type

EVERY = pytest.mark.parametrize("kind", list(CELL_TYPES.values()), ids=lambda kind: kind.name)
SOLID = [kind for kind in CELL_TYPES.values() if kind.dimension == 3]


@EVERY
def test_shape_functions_are_one_at_their_own_node(kind: CellType) -> None:
    assert kind.shape(kind.reference) == pytest.approx(np.eye(kind.size), abs=1e-13)


@EVERY
def test_gradients_are_those_of_the_shape_functions(kind: CellType) -> None:
    at = np.random.default_rng(1).uniform(0.1, 0.3, (5, kind.dimension))
    step = 1e-6
    for axis in range(kind.dimension):
        move = step * np.eye(kind.dimension)[axis]
        numerical = (kind.shape(at + move) - kind.shape(at - move)) / (2 * step)
        assert kind.gradient(at)[:, :, axis] == pytest.approx(numerical, abs=1e-8)


@EVERY
def test_shape_functions_reproduce_a_linear_field(kind: CellType) -> None:
    at = np.random.default_rng(2).uniform(0.0, 0.3, (5, kind.dimension))
    slope = np.arange(1.0, kind.dimension + 1.0)
    assert kind.shape(at) @ (2.0 + kind.reference @ slope) == pytest.approx(2.0 + at @ slope)


@EVERY
@pytest.mark.parametrize("degree", [1, 4, 9])
def test_quadrature_is_exact_to_its_degree(kind: CellType, degree: int) -> None:
    at, weights = kind.quadrature(degree)
    d = kind.dimension
    # Dirichlet's integral of x^degree over the simplex, 1/(degree + 1) over the cube
    simplex = factorial(degree) / factorial(degree + d)
    wanted = simplex if kind.is_simplex else 1.0 / (degree + 1)
    for axis in range(d):
        assert weights @ at[:, axis] ** degree == pytest.approx(wanted, rel=1e-12)
    powers = [degree // d] * d
    mixed = weights @ np.prod(at**powers, axis=1)
    top = prod(factorial(p) for p in powers)
    simplex = top / factorial(sum(powers) + d)
    assert mixed == pytest.approx(
        simplex if kind.is_simplex else prod(1 / (p + 1) for p in powers), rel=1e-12
    )


@pytest.mark.parametrize("kind", SOLID, ids=lambda kind: kind.name)
def test_faces_point_outwards_and_hold_the_nodes_between_their_corners(kind: CellType) -> None:
    middle = kind.reference[: kind.corners].mean(axis=0)
    face_type = CELL_TYPES[kind.face_kind]
    for face in kind.faces:
        places = kind.reference[face]
        normal = np.cross(places[1] - places[0], places[2] - places[0])
        assert normal @ (places.mean(axis=0) - middle) > 0
        corners = places[: face_type.corners]
        wanted = [corners[list(p)].mean(axis=0) for p in face_type.parents]
        assert places == pytest.approx(np.array(wanted))


def test_the_node_order_is_that_of_vtk() -> None:
    # vtkTriQuadraticHexahedron.h: 8 between 0 and 1, 16 between 0 and 4, 20 on -x, 26 inside
    reference = CELL_TYPES["hexahedron27"].reference
    assert reference[8].tolist() == [0.5, 0.0, 0.0]
    assert reference[16].tolist() == [0.0, 0.0, 0.5]
    assert reference[20:26].tolist() == [
        *([0.0, 0.5, 0.5], [1.0, 0.5, 0.5], [0.5, 0.0, 0.5]),
        *([0.5, 1.0, 0.5], [0.5, 0.5, 0.0], [0.5, 0.5, 1.0]),
    ]
    assert reference[26].tolist() == [0.5, 0.5, 0.5]
    # vtkQuadraticTetra.h: 4 (0,1), 5 (1,2), 6 (2,0), 7 (0,3), 8 (1,3), 9 (2,3)
    assert CELL_TYPES["tetra10"].reference[7:].tolist() == [
        *([0.0, 0.0, 0.5], [0.5, 0.0, 0.5], [0.0, 0.5, 0.5])
    ]


def test_a_kind_that_cannot_be_used_is_refused() -> None:
    with pytest.raises(ModelError, match=r"'wedge'.*\n.*tetra10"):
        cell_type("wedge")
