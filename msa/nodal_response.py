"""Displacements under loads and misfits that differ from pose to pose."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.errors import ModelError
from strutwork.msa.assembly import System, system_of
from strutwork.msa.diagnosis import mechanisms_under
from strutwork.msa.rigid_map import rigid_map
from strutwork.msa.solve import METHODS, default_method
from strutwork.msa.structure import PlacedStructure
from strutwork.names import choices
from strutwork.outcome import solve_poses

Array = NDArray[Any]

#: Poses solved at once: keeps a stack of frames within some megabytes.
CHUNK = 64


def nodal_displacements(placed: PlacedStructure, loads: Array, gaps: Array | None = None) -> Array:
    """Displacements of the mesh nodes under loads at them.

    Parameters
    ----------
    placed : PlacedStructure
    loads : (..., n, 6, m)
        At the mesh nodes, global axes, N and N·m.
    gaps : (..., r, m), optional
        Misfits on the constraint rows, m and rad; none by default.

    Returns
    -------
    displacements : (..., n, 6, m)
        Global axes, m and rad.

    Raises
    ------
    MechanismError
        A load does work in a motion that nothing resists; names the joints.
    StrutworkError
        As `solve`, at any pose.
    """
    system = system_of(placed)
    flat = loads.reshape(system.poses, *loads.shape[-3:])
    rows = len(system.row_labels)
    on_rows = (
        np.zeros((system.poses, rows, loads.shape[-1]))
        if gaps is None
        else gaps.reshape(system.poses, rows, loads.shape[-1])
    )
    found = np.zeros(flat.shape)

    def run(part: NDArray[np.intp]) -> None:
        for start in range(0, len(part), CHUNK):
            some = part[start : start + CHUNK]
            here = system_of(system.placed[some])
            here.placed.check()
            method = METHODS[default_method(here)]
            unknowns = method(here, here.gather(flat[some]), on_rows[some])
            found[some] = here.expand(unknowns.displacements)

    solve_poses(
        run, system.poses, lambda: mechanisms_under(system, lambda part: _gathered(part, flat))
    ).require_all()
    return found.reshape(loads.shape)


def _gathered(part: System, loads: Array) -> Array:
    # of a part of the poses the loads at the first ones tell as well what moves
    return part.gather(loads[: part.poses])


def tool_displacement(placed: PlacedStructure, displacements: Array) -> Array:
    """Displacements of the tool, relative to the workpiece where the linkage names one.

    Parameters
    ----------
    placed : PlacedStructure
        With a tool.
    displacements : (..., n, 6, m)
        Of the mesh nodes, the linkage's first; global axes, m and rad.

    Returns
    -------
    (..., 6, m)
        Global axes, m and rad; relative to the point of the workpiece at which the tool stands.

    Raises
    ------
    ModelError
        No tool.
    """
    linkage = placed.structure.linkage
    if linkage.tool is None:
        raise ModelError("tool", "the linkage has none.", "Name a node as the tool.")
    tool = linkage.node_index[linkage.tool]
    found = displacements[..., tool, :, :]
    if linkage.against is None:
        return np.asarray(found)
    other = linkage.node_index[linkage.against]
    places = placed.placement.positions
    arm = places[..., tool, :] - places[..., other, :]
    return np.asarray(found - rigid_map(arm) @ displacements[..., other, :, :])


def relative_motion(placed: PlacedStructure, against: str | None = None) -> Array:
    """What makes the tool's motion relative to the workpiece of the motions of two nodes.

    The workpiece's node carries the point at which the tool stands: turned, it moves that point.

    Parameters
    ----------
    placed : PlacedStructure
        With a tool.
    against : str, optional
        Node of the workpiece; the ground by default.

    Returns
    -------
    (..., 6, n, 6)
        Relative displacement and rotation per displacement of every mesh node, global axes; no
        unit, m/rad.

    Raises
    ------
    ModelError
        No tool, or an unknown node.
    """
    structure = placed.structure
    linkage = structure.linkage
    if linkage.tool is None:
        raise ModelError("tool", "the linkage has none.", "Name a node as the tool.")
    if against is not None and against not in linkage.node_index:
        raise ModelError(
            "against",
            f'names the unknown node "{against}".',
            choices("Nodes", against, linkage.node_index),
        )
    count = len(structure.mesh_nodes)
    tool = linkage.node_index[linkage.tool]
    result = np.zeros((*placed.batch, 6, count, 6))
    result[..., tool, :] += np.eye(6)
    if against is not None:
        other = linkage.node_index[against]
        places = placed.placement.positions
        result[..., other, :] -= rigid_map(places[..., tool, :] - places[..., other, :])
    return result
