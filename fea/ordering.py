"""Order of elimination by nested dissection, and the fill it will bring."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray

Array = NDArray[Any]

pymetis: Any
try:
    import pymetis
except ImportError:  # factorisations have orders of their own too, SuperLU's with more fill
    pymetis = None

try:
    from strutwork.jit import jit
except ImportError:  # the same code runs without numba, slower

    def jit(*, contract: bool = False) -> Any:  # noqa: ARG001
        """Leave the function as it is."""
        return lambda function: function


#: Separators that METIS tries at each division. A second saves 5 % of the operations at 92 000
#: degrees of freedom for a tenth of a second; more save no more.
SEPARATORS = 2


@dataclass(frozen=True)
class Ordering:
    """An order of elimination of a symmetric pattern.

    Parameters
    ----------
    order : (n,)
        Row i of the ordered matrix is order[i].
    fill : int
        Entries of the Cholesky factor, diagonal included.
    flops : float
        Multiplications and additions of the Cholesky factorisation, no unit: the sum of the squares
        of the columns' lengths.
    """

    order: NDArray[np.intp]
    fill: int
    flops: float

    def __repr__(self) -> str:
        return f"<Ordering: {len(self.order)} rows, fill {self.fill:,}, {self.flops:.3g} flops>"


def nested_dissection(matrix: sp.csc_array) -> Ordering:
    """Fill-reducing order of a symmetric pattern.

    Rows of one node of a mesh have one pattern and are kept together, which makes the graph
    that METIS divides, and the tree that counts the fill, as small as the mesh.

    Source: Karypis and Kumar (1998), METIS; fill by row subtrees of the elimination tree,
    Liu (1990), SIAM Journal on Matrix Analysis and Applications 11, 134.

    Parameters
    ----------
    matrix : (n, n) sparse
        Of symmetric pattern; its values do not matter: any unit.
    """
    pattern = sp.csr_array(matrix)
    group, members = _alike(pattern)
    first = np.full(int(group.max(initial=-1)) + 1, len(group), dtype=np.intp)
    np.minimum.at(first, group, np.arange(len(group)))
    small = sp.csr_array(pattern[first][:, first]) if len(first) < len(group) else pattern
    row = np.repeat(np.arange(small.shape[0]), np.diff(small.indptr))
    beside = row != small.indices
    degrees = np.bincount(row[beside], minlength=small.shape[0])
    starts = np.concatenate([[0], np.cumsum(degrees)]).astype(np.int64)
    neighbours = small.indices[beside].astype(np.int64)
    graph = pymetis.CSRAdjacency(starts, neighbours)
    found = pymetis.nested_dissection(adjacency=graph, options=pymetis.Options(nseps=SEPARATORS))
    order = np.asarray(found[0], dtype=np.int64)
    weight = np.bincount(group, minlength=len(first))
    below = _counts(starts, neighbours, order, weight[order])
    # the columns of one group of w rows are below + w, below + w - 1, ..., below + 1 long
    w, c = weight[order].astype(float), below.astype(float)
    fill = w * c + w * (w + 1) / 2
    flops = w * c**2 + c * w * (w + 1) + w * (w + 1) * (2 * w + 1) / 6
    position = np.empty(len(order), dtype=np.int64)
    position[order] = np.arange(len(order))
    whole = members[np.argsort(position[group[members]], kind="stable")]
    return Ordering(whole.astype(np.intp), round(float(fill.sum())), float(flops.sum()))


def _alike(pattern: sp.csr_array) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Group of every row, rows of one pattern together, and the rows sorted by group."""
    n = pattern.shape[0]
    random = np.random.default_rng(0).integers(0, 2**63, size=n, dtype=np.uint64)
    sums = np.concatenate([[np.uint64(0)], np.cumsum(random[pattern.indices], dtype=np.uint64)])
    marks = sums[pattern.indptr[1:]] - sums[pattern.indptr[:-1]]
    _, group = np.unique(marks, return_inverse=True)
    group = np.asarray(group, dtype=np.intp)
    return group, np.argsort(group, kind="stable")


@jit()
def _counts(starts, neighbours, order, weight):  # type: ignore[no-untyped-def]
    """Rows below the diagonal in each column of the factor, weighted, in elimination order."""
    n = order.size
    position = np.empty(n, np.int64)
    for k in range(n):
        position[order[k]] = k
    parent = np.full(n, -1, np.int64)
    mark = np.full(n, -1, np.int64)
    below = np.zeros(n, np.int64)
    for k in range(n):
        mark[k] = k
        for p in range(starts[order[k]], starts[order[k] + 1]):
            j = position[neighbours[p]]
            if j > k:
                continue
            while mark[j] != k:
                if parent[j] == -1:
                    parent[j] = k
                below[j] += weight[k]
                mark[j] = k
                j = parent[j]
    return below
