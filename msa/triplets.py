"""A sparse matrix put together from dense blocks."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from strutwork.msa.structure import rigid_map

if TYPE_CHECKING:
    import scipy.sparse as sp

Array = NDArray[Any]


class Triplets:
    """Dense blocks at rows and columns; what falls on one place is added."""

    def __init__(self) -> None:
        self._parts: list[tuple[Array, Array, Array]] = []

    def add(self, rows: NDArray[np.intp], columns: NDArray[np.intp], block: Array) -> None:
        """Add a dense block.

        Parameters
        ----------
        rows : (k,)
        columns : (l,)
        block : (k, l)
            Any unit.
        """
        row = np.repeat(rows, len(columns))
        self._parts.append((row, np.tile(columns, len(rows)), block.ravel()))

    def add_entries(self, rows: NDArray[np.intp], columns: NDArray[np.intp], values: Array) -> None:
        """Add entries, each at its row and column.

        Parameters
        ----------
        rows, columns : (e,)
        values : (e,)
            Any unit.
        """
        self._parts.append((rows, columns, values))

    def matrix(self, shape: tuple[int, int]) -> sp.csr_array:
        """The matrix of all blocks.

        Parameters
        ----------
        shape : (int, int)
            Rows and columns.
        """
        # loading it takes longer than the check of a model, which makes no such matrix
        import scipy.sparse as sp  # noqa: PLC0415

        if not self._parts:
            return sp.csr_array(shape)
        row, column, value = (np.concatenate(x) for x in zip(*self._parts, strict=True))
        return sp.coo_array((value, (row, column)), shape=shape).tocsr()


def sum_of_parts(
    parts: Iterable[tuple[NDArray[np.intp], Array, Array, NDArray[np.intp]]],
) -> Triplets:
    """Matrices of parts at mesh nodes, brought to the clusters of these nodes.

    Parameters
    ----------
    parts : iterable of (nodes (k,), matrix (6k, 6k), arms (k, 3), clusters (k,))
        The arms from the reference nodes of the clusters, m; cluster −1 is ground.
    """
    # parts of one size together: by far the most are beam elements
    sizes: dict[int, list[tuple[Array, Array, NDArray[np.intp]]]] = {}
    for nodes, matrix, arms, cluster in parts:
        sizes.setdefault(len(nodes), []).append((matrix, arms, cluster))
    found = Triplets()
    for k, listed in sizes.items():
        stack, arms, cluster = (np.asarray(x) for x in zip(*listed, strict=True))
        if np.any(arms):
            maps = rigid_map(arms)
            blocks = stack.reshape(-1, k, 6, k, 6)
            stack = np.einsum("saji,sajbk,sbkl->saibl", maps, blocks, maps, optimize=True)
            stack = stack.reshape(-1, 6 * k, 6 * k)
        dofs = (6 * cluster[..., None] + np.arange(6)).reshape(len(cluster), -1)
        moves = np.repeat(cluster >= 0, 6, axis=1)
        row, column = np.broadcast_arrays(dofs[:, :, None], dofs[:, None, :])
        kept = moves[:, :, None] & moves[:, None, :]
        found.add_entries(row[kept], column[kept], stack[kept])
    return found
