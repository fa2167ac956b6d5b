"""From a solid and its interfaces to a superelement, kept on disk."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Literal

import numpy as np

from strutwork.errors import ModelError
from strutwork.fea.factorize import SOLVERS, installed_solvers
from strutwork.fea.interface import Interface, tie
from strutwork.fea.memory import require_solid
from strutwork.fea.solid import Solid
from strutwork.fea.solid_matrices import solid_matrices
from strutwork.fea.superelement import Superelement, superelement
from strutwork.fea.superelement_file import cached_superelement
from strutwork.fea.tied_solid import TiedSolid, tied_solid


def tied(
    solid: Solid,
    interfaces: Sequence[Interface],
    fixed: Sequence[str] = (),
    solver: str | None = None,
) -> TiedSolid:
    """Assemble a solid and tie patches of its surface to nodes.

    Parameters
    ----------
    solid : Solid
        With densities.
    interfaces : sequence of Interface
    fixed : sequence of str
        Node sets or patches held in all directions.
    solver : str, optional
        What will factorise it, as in `factorize`: its memory is foreseen.

    Returns
    -------
    TiedSolid

    Raises
    ------
    ModelError
        An unknown patch, an empty or collinear one, two interfaces of one name.
    NumericalError
        A solid that will not fit into memory.
    """
    names = [i.name for i in interfaces]
    for name in names:
        if names.count(name) > 1:
            raise ModelError(f"interface {name}", "is defined twice.", "Give it another name.")
    mesh = solid.mesh
    # a solver that is unknown or not installed is named by `factorize`
    library = SOLVERS.get(solver or "", SOLVERS[installed_solvers()[0]]).NAME
    require_solid(solid.name, solid.kind, solid.order, len(mesh.points), mesh.cell_count, library)
    matrices = solid_matrices(solid)
    patches = [tie(i, matrices.points, *matrices.patch(i.patch)) for i in interfaces]
    held = None
    if fixed:
        nodes = np.unique(np.concatenate([matrices.nodes_of_set(name) for name in fixed]))
        held = (3 * nodes[:, None] + np.arange(3)).ravel()
    return tied_solid(solid.name, matrices.points, matrices.stiffness, matrices.mass, patches, held)


def reduce_solid(
    solid: Solid,
    interfaces: Sequence[Interface],
    cutoff: float | None = None,
    modes: int = 12,
    method: Literal["craig_bampton", "krylov"] = "craig_bampton",
    fixed: Sequence[str] = (),
    solver: str | None = None,
    folder: Path | None = None,
) -> Superelement:
    """Reduce a solid to its interfaces; what was reduced before comes from disk.

    Parameters
    ----------
    solid : Solid
        With densities.
    interfaces : sequence of Interface
    cutoff : float, optional
        Hz: modes with the interfaces held are retained beyond it.
    modes : int
        Without a cutoff, how many modes (Krylov: shapes), as `superelement`.
    method : "craig_bampton" or "krylov"
    fixed : sequence of str
        Node sets or patches held in all directions.
    solver : str, optional
        Of `factorize`.
    folder : Path, optional
        Of the stored superelements; default `superelement_file.cache_folder`.

    Returns
    -------
    Superelement

    Raises
    ------
    StrutworkError
        As `tied` and `superelement`.
    """
    mesh = solid.mesh
    patches = [
        (i, [(f.kind, f.nodes.tolist()) for f in mesh.patch(i.patch).faces]) for i in interfaces
    ]
    content = [
        solid.name,
        solid.order,
        sorted((region, repr(material)) for region, material in solid.materials.items()),
        mesh.regions,
        mesh.points,
        *(part for b in mesh.blocks for part in (b.kind, b.nodes, b.region)),
        patches,
        [
            (name, mesh.node_sets[name].tolist() if name in mesh.node_sets else name)
            for name in fixed
        ],
        (cutoff, modes, method),
    ]
    return cached_superelement(
        content,
        lambda: superelement(
            tied(solid, interfaces, fixed, solver), solid.cells, cutoff, modes, method, solver
        ),
        folder,
    )
