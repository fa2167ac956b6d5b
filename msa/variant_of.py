"""Structures that differ in numbers alone share what their topology decides.

A study varies sections, materials and stiffnesses of one machine a thousand times. Which coordinate
meets which, the order of elimination and the clusters of nodes are the same for all of them: they
are made once, for the structure that was changed, and only numbers are put in anew.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from strutwork.msa.program import Program
from strutwork.msa.structure import Structure

Array = NDArray[Any]

#: Derived data of a structure that no number of its parts changes.
_TOPOLOGY = (
    "flexible_bodies",
    "mesh_nodes",
    "mesh_index",
    "segments",
    "vertex_of_node",
    "reference_nodes",
)

_ORIGIN, _POSES = "_origin", "_expected_poses"


def share_topology(structure: Structure, origin: Structure) -> None:
    """Let a structure take from another what does not depend on the numbers of its parts.

    Parameters
    ----------
    structure : Structure
        Of the same nodes, bodies, joints with the same free, locked and elastic directions, beams
        with as many elements, springs, and elements.
    origin : Structure
    """
    # a frozen dataclass keeps derived data in its __dict__, as functools.cached_property does
    for name in _TOPOLOGY:
        structure.__dict__[name] = getattr(origin, name)
    structure.__dict__[_ORIGIN] = origin_of(origin) or origin


def origin_of(structure: Structure) -> Structure | None:
    """The structure whose topology a structure shares; None where it was made by itself.

    Parameters
    ----------
    structure : Structure
    """
    found: Structure | None = structure.__dict__.get(_ORIGIN)
    return found


def expect_poses(structure: Structure, poses: int) -> None:
    """State at how many poses a structure and its like will be solved, which decides the solver.

    Parameters
    ----------
    structure : Structure
        Left as it is where it shares no topology: its program would serve it alone.
    poses : int
        Of all structures of one topology together.
    """
    if _ORIGIN in structure.__dict__:
        structure.__dict__[_POSES] = poses


def expected_poses(structure: Structure) -> int:
    """The poses of `expect_poses`, zero where nothing was stated.

    Parameters
    ----------
    structure : Structure
    """
    return int(structure.__dict__.get(_POSES, 0))


def renumbered(program: Program, structure: Structure, offsets: Array) -> Program:
    """A program with the numbers of another structure of the same topology.

    Parameters
    ----------
    program : Program
    structure : Structure
        As `share_topology` states.
    offsets : (e, 2, 3)
        From the nodes to the ends of its beam elements, m.
    """
    joints, springs = structure.linkage.joints, structure.springs
    direction = program.axis_direction + 3 * program.turns
    elastic = np.zeros(len(direction))
    for c, (joint, d) in enumerate(zip(program.axis_joint, direction, strict=True)):
        if joint >= 0:
            elastic[c] = joints[joint].stiffness_matrix[d, d]
    links = [np.diag(s.diagonal) for s in springs]
    links += [joints[j].stiffness_matrix for j in program.link_joint[len(springs) :]]
    orientation = [
        b.orientation if isinstance(b.orientation, tuple) else (np.nan,) * 3
        for b in structure.beams
    ]
    spread = program.spread._replace(outer_value=elastic[program.spread.outer_coordinate])
    return program._replace(
        item_offsets=offsets,
        properties=np.array([b.properties for b in structure.beams]).reshape(-1, 6),
        orientation=np.array(orientation).reshape(-1, 3),
        link_stiffness=np.array(links, dtype=float).reshape(-1, 6, 6),
        spring_value=elastic[program.spring_coordinate],
        spread=spread,
    )
