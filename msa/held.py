"""Whether beams hold each flexible body together."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from strutwork.errors import ModelError

if TYPE_CHECKING:
    from strutwork.msa.structure import Structure


def check_held(structure: Structure) -> None:
    """Check that every flexible body is one piece, else the rigidified linkage is another machine.

    Parameters
    ----------
    structure : Structure

    Raises
    ------
    ModelError
        Names a body and its nodes.
    """
    vertex = structure.vertex_of_node[: len(structure.linkage.nodes)]
    piece = list(range(structure.vertex_count))

    def root(v: int) -> int:
        while piece[v] != v:
            v = piece[v]
        return v

    known = structure.linkage.node_index
    for nodes in structure.flexible_parts:
        tied = [int(vertex[known[n]]) for n in nodes]
        tied = [v for v in tied if v >= 0]
        for other in tied[1:]:
            piece[root(other)] = root(tied[0])
    for b, body in enumerate(structure.linkage.body_names):
        members = np.flatnonzero(structure.linkage.body_of_node == b)
        roots = {root(int(vertex[m])) for m in members}
        if len(roots) > 1:
            loose = [structure.linkage.nodes[m] for m in members]
            raise ModelError(
                f"body {body}",
                f"its nodes {', '.join(loose)} are not held together by its beams.",
                "Add the missing beam or rigid group.",
            )
