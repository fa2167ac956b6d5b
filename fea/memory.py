"""Memory that a factorisation will take, against what the machine has, before it starts."""

from __future__ import annotations

from strutwork.errors import NumericalError
from strutwork.memory import available_memory

#: Bytes per entry of the Cholesky factor and per entry of the matrix at a factorisation's peak,
#: measured on bricks of 22 000 to 295 000 dofs: values and supernodes' padding, and indices,
#: copies and working space.
BYTES = {
    "CHOLMOD": (8.6, 33.0),
    "MUMPS": (11.0, 25.0),
    "PARDISO": (8.8, 28.0),
    "SuperLU": (16.0, 55.0),
}

#: Bytes a factorisation of a solid takes for each dof to the power 4/3: the least of what was
#: measured at 92 000 and 295 000 dofs, on an L-frame, whose factors are smaller than a cube's.
LEAST_FACTOR = {"SuperLU": 350.0}
LEAST_OTHERS = 190.0

#: Entries of a row of the stiffness, and dofs a cell, of large meshes by kind of cell and order.
ROW_ENTRIES = {
    ("hexahedron", 1): 81,
    ("hexahedron", 2): 192,
    ("tetra", 1): 45,
    ("tetra", 2): 84,
    ("hexahedron20", 2): 175,
    ("hexahedron27", 2): 192,
    ("tetra10", 2): 84,
}

#: Bytes of each entry while a solid is assembled: stiffness, mass, their symmetric sums and the
#: triplets of both; measured.
ASSEMBLED = 48.0


def solid_dofs(kind: str, order: int, points: int, cells: int) -> int:
    """Dofs of the field on a mesh, a lower bound: middle nodes on faces of the surface left out.

    Parameters
    ----------
    kind : str
        Of the mesh's cells: `hexahedron`, `tetra10`, ...
    order : int
    points, cells : int
        Of the mesh.
    """
    if order == 1 or kind not in {"hexahedron", "tetra"}:
        # the points of quadratic cells are all there are
        return 3 * points
    # a hexahedron has a node of its own, three faces, three edges and a corner; a tetrahedron
    # seven sixths of an edge
    return 3 * max(points, 8 * cells if kind == "hexahedron" else points + 7 * cells // 6)


def require_solid(
    name: str, kind: str, order: int, points: int, cells: int, library: str
) -> tuple[int, float]:
    """Refuse a solid that will not fit before it is assembled.

    Parameters
    ----------
    name : str
    kind, order, points, cells
        As `solid_dofs`.
    library : str
        What will factorise it, as in `BYTES`.

    Returns
    -------
    dofs : int
    need : float
        Bytes that it takes at the least.

    Raises
    ------
    NumericalError
        More than is available.
    """
    dofs = solid_dofs(kind, order, points, cells)
    assembly = float(dofs) * ROW_ENTRIES[kind, order] * ASSEMBLED
    factor = LEAST_FACTOR.get(library, LEAST_OTHERS) * float(dofs) ** (4.0 / 3.0)
    need, available = max(assembly, factor), available_memory()
    if need > available:
        lighter = "order = 1, " if order == 2 else ""
        raise NumericalError(
            f"solid {name}",
            f"its {cells:,} cells of order {order} have {dofs:,} dofs or more; their reduction "
            f"takes {need / 1e9:.3g} GB at the least with {library}, and {available / 1e9:.3g} GB "
            "are available.",
            f"Choose {lighter}larger cells, or divide it into several solids; strutwork[accel] "
            "takes half of SuperLU's memory.",
        )
    return dofs, need


def foreseen_memory(fill: int, entries: int, library: str, scalar: int = 8) -> float:
    """Bytes at the peak of a factorisation.

    Parameters
    ----------
    fill : int
        Entries of the Cholesky factor.
    entries : int
        Entries of the matrix.
    library : str
        Key of `BYTES`.
    scalar : int
        Bytes of a number: 8 real, 16 complex.
    """
    factor, matrix = BYTES[library]
    return (fill * factor + entries * matrix) * scalar / 8.0


def require_memory(size: int, need: float, name: str) -> None:
    """Refuse a factorisation that will not fit.

    Parameters
    ----------
    size : int
        Degrees of freedom, for the message.
    need : float
        Bytes that it takes.
    name : str
        What will factorise it.

    Raises
    ------
    NumericalError
        The estimate is above what is available.
    """
    available = available_memory()
    if need > available:
        raise NumericalError(
            f"factorisation of {size:,} dofs",
            f"will take about {need / 1e9:.3g} GB with {name}; "
            f"{available / 1e9:.3g} GB are available.",
            "Mesh coarser (memory grows as dofs to the power 4/3), reduce the parts one by one, "
            "install strutwork[accel], which takes half of SuperLU's memory, or share the work "
            'among machines with solver="slepc", which needs petsc4py, slepc4py and MPI.',
        )
