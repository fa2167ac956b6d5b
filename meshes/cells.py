"""Cell types: nodes, edges, faces and shape functions, in the node order of VTK and meshio."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import roots_jacobi

from strutwork.errors import ModelError

Array = NDArray[Any]
Ints = NDArray[np.int64]

SQUARE = ((0, 0), (1, 0), (1, 1), (0, 1))
CUBE = (*((x, y, 0) for x, y in SQUARE), *((x, y, 1) for x, y in SQUARE))
TRIANGLE = ((0, 0), (1, 0), (0, 1))
TETRAHEDRON = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
CUBE_EDGES = (
    *((0, 1), (1, 2), (2, 3), (3, 0)),
    *((4, 5), (5, 6), (6, 7), (7, 4)),
    *((0, 4), (1, 5), (2, 6), (3, 7)),
)
TETRAHEDRON_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
#: Corners of each face, counter-clockwise from outside; −x +x −y +y −z +z, the order of
#: the mid-face nodes of a hexahedron27.
CUBE_FACES = (
    *((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4)),
    *((2, 3, 7, 6), (0, 3, 2, 1), (4, 5, 6, 7)),
)
TETRAHEDRON_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))


@dataclass(frozen=True)
class CellType:
    """One type of cell.

    Parameters
    ----------
    name : str
        meshio's name.
    dimension : int
        2 for faces, 3 for solids.
    reference_corners : tuple of tuple of int
        Corners in reference coordinates, 0 to 1.
    corner_edges : tuple of (int, int)
        Corners of each edge, in the order of the mid-edge nodes.
    corner_faces : tuple of tuple of int
        Corners of each face, counter-clockwise from outside; empty for faces.
    parents : tuple of tuple of int
        The corners whose mean each node is, corners first.
    face_kind : str
        Kind of the faces; empty for faces.
    linear_kind : str
        The kind with the corners alone.
    """

    name: str
    dimension: int
    reference_corners: tuple[tuple[int, ...], ...]
    corner_edges: tuple[tuple[int, int], ...]
    corner_faces: tuple[tuple[int, ...], ...]
    parents: tuple[tuple[int, ...], ...]
    face_kind: str
    linear_kind: str

    @property
    def size(self) -> int:
        """Number of nodes."""
        return len(self.parents)

    @property
    def corners(self) -> int:
        """Number of corner nodes, which come first."""
        return len(self.reference_corners)

    @property
    def is_simplex(self) -> bool:
        """Whether it is a triangle or a tetrahedron."""
        return self.corners == self.dimension + 1

    @property
    def order(self) -> int:
        """1 for linear shape functions, 2 for quadratic ones."""
        return 1 if self.size == self.corners else 2

    @property
    def jacobian_degree(self) -> int:
        """Degree of det J of a solid in each reference coordinate."""
        return 3 * (self.order - 1) if self.is_simplex else 3 * self.order - 1

    @property
    def field_degree(self) -> int:
        """Degree of the Gauss rule for the stiffness: 2 or 3 points in each direction."""
        return 2 * self.order

    @property
    def mass_degree(self) -> int:
        """Degree of the Gauss rule that is exact for the mass of a curved solid."""
        return self.jacobian_degree + 2 * self.order

    @cached_property
    def reference(self) -> Array:
        """Reference coordinates of the nodes, (n, dimension)."""
        corners = np.array(self.reference_corners, dtype=float)
        return np.array([corners[list(p)].mean(axis=0) for p in self.parents])

    @cached_property
    def faces(self) -> Ints:
        """Local nodes of each face, (faces, k)."""
        index = {frozenset(p): i for i, p in enumerate(self.parents)}
        parents = CELL_TYPES[self.face_kind].parents
        return np.array(
            [[index[frozenset(face[c] for c in p)] for p in parents] for face in self.corner_faces]
        )

    @cached_property
    def exponents(self) -> Ints:
        """Exponents of the monomials that the shape functions are made of, (n, dimension)."""
        powers = np.array(list(product(range(self.order + 1), repeat=self.dimension)))
        if self.is_simplex:
            return np.asarray(powers[powers.sum(axis=1) <= self.order])
        # serendipity: at most quadratic, linear factors not counted (Arnold and Awanou 2011)
        superlinear = np.where(powers > 1, powers, 0).sum(axis=1)
        serendipity = self.name in {"quad8", "hexahedron20"}
        return np.asarray(powers[superlinear <= self.order] if serendipity else powers)

    @cached_property
    def _coefficients(self) -> Array:
        return np.linalg.inv(_monomials(self.reference, self.exponents))

    def shape(self, at: Array) -> Array:
        """Shape functions at reference coordinates, (q, n).

        Parameters
        ----------
        at : (q, dimension)
            Reference coordinates, 0 to 1, no unit.
        """
        return np.asarray(_monomials(at, self.exponents) @ self._coefficients)

    def gradient(self, at: Array) -> Array:
        """Derivatives of the shape functions, (q, n, dimension).

        Parameters
        ----------
        at : (q, dimension)
            Reference coordinates, 0 to 1, no unit.
        """
        columns = []
        for axis in range(self.dimension):
            lowered = self.exponents.copy()
            lowered[:, axis] = np.maximum(lowered[:, axis] - 1, 0)
            columns.append(self.exponents[:, axis] * _monomials(at, lowered) @ self._coefficients)
        return np.stack(columns, axis=-1)

    def quadrature(self, degree: int) -> tuple[Array, Array]:
        """Points (q, dimension) and weights (q,) exact to `degree` in each coordinate.

        Gauss-Legendre on squares and cubes; on simplices their image under the collapse of
        an edge, Gauss-Jacobi (Stroud 1971).

        Parameters
        ----------
        degree : int
            Of the polynomial in each reference coordinate.
        """
        count = degree // 2 + 1
        jacobi = [self.dimension - 1 - i if self.is_simplex else 0 for i in range(self.dimension)]
        rules = [_jacobi_rule(count, power) for power in jacobi]
        grid = np.stack(
            [g.ravel() for g in np.meshgrid(*(p for p, _ in rules), indexing="ij")], axis=-1
        )
        weights = np.prod(
            [g.ravel() for g in np.meshgrid(*(w for _, w in rules), indexing="ij")], axis=0
        )
        if self.is_simplex:
            left = np.cumprod(1.0 - grid, axis=1)
            grid[:, 1:] *= left[:, :-1]
        return grid, np.asarray(weights)


def _monomials(at: Array, exponents: Ints) -> Array:
    return np.asarray(np.prod(np.asarray(at)[:, None, :] ** exponents, axis=-1))


def _jacobi_rule(count: int, power: int) -> tuple[Array, Array]:
    """Gauss rule on 0..1 for the weight (1 − x)^power."""
    points, weights = roots_jacobi(count, power, 0)
    return np.asarray((points + 1.0) / 2.0), np.asarray(weights / 2.0 ** (power + 1))


def _family(
    linear: str,
    dimension: int,
    corners: tuple[tuple[int, ...], ...],
    topology: tuple[tuple[tuple[int, int], ...], tuple[tuple[int, ...], ...]],
    kinds: dict[str, tuple[str, Sequence[tuple[int, ...]]]],
) -> dict[str, CellType]:
    """The kinds of one shape: what each has beyond its corners, by name."""
    own = tuple((i,) for i in range(len(corners)))
    return {
        name: CellType(name, dimension, corners, *topology, (*own, *more), face, linear)
        for name, (face, more) in kinds.items()
    }


_SQUARE_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0))
_TRIANGLE_EDGES = ((0, 1), (1, 2), (2, 0))
_SQUARE_MIDDLE = ((0, 1, 2, 3),)
_CUBE_MIDDLES = (*CUBE_FACES, tuple(range(8)))

#: Every kind of cell that this package works with.
CELL_TYPES: dict[str, CellType] = {
    **_family(
        *("triangle", 2, TRIANGLE, (_TRIANGLE_EDGES, ())),
        {"triangle": ("", ()), "triangle6": ("", _TRIANGLE_EDGES)},
    ),
    **_family(
        *("quad", 2, SQUARE, (_SQUARE_EDGES, ())),
        {
            "quad": ("", ()),
            "quad8": ("", _SQUARE_EDGES),
            "quad9": ("", (*_SQUARE_EDGES, *_SQUARE_MIDDLE)),
        },
    ),
    **_family(
        *("tetra", 3, TETRAHEDRON, (TETRAHEDRON_EDGES, TETRAHEDRON_FACES)),
        {"tetra": ("triangle", ()), "tetra10": ("triangle6", TETRAHEDRON_EDGES)},
    ),
    **_family(
        *("hexahedron", 3, CUBE, (CUBE_EDGES, CUBE_FACES)),
        {
            "hexahedron": ("quad", ()),
            "hexahedron20": ("quad8", CUBE_EDGES),
            "hexahedron27": ("quad9", (*CUBE_EDGES, *_CUBE_MIDDLES)),
        },
    ),
}


def cell_type(kind: str, part: str = "mesh") -> CellType:
    """The cell type of that name.

    Parameters
    ----------
    kind : str
        meshio's name.
    part : str
        Named in an error.

    Raises
    ------
    ModelError
        A kind that this package does not work with.
    """
    if kind not in CELL_TYPES:
        raise ModelError(
            part,
            f"has cells of type {kind!r}, which cannot be used.",
            f"Mesh with {', '.join(CELL_TYPES)}.",
        )
    return CELL_TYPES[kind]
